//! Effects of a game: broken ones, and what effects may read.

use bevy_comics::effect::NoUniform;
use bevy_comics_testkit::pool::Pool;
use serde::{Deserialize, Serialize};

use super::*;
use crate::{
    prelude::*,
    small::{draw_once, start},
};

/// An effect of a game without settings: one of [`KINDS`].
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
struct Probe<const KIND: usize> {
    off: bool,
}

#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    needs: Needs,
    shader: EffectShader,
}

impl<const KIND: usize> Effect for Probe<KIND> {
    const NAME: &'static str = KINDS[KIND].name;
    const STAGE: EffectStage = EffectStage::Page;
    const SHADER: EffectShader = KINDS[KIND].shader;
    type Uniform = NoUniform;

    fn strength(&self) -> f32 {
        if self.off { 0.0 } else { 1.0 }
    }

    fn faded(self, fraction: f32) -> Self {
        let off = self.off || fraction == 0.0;
        Self { off }
    }

    fn needs(&self) -> Needs {
        KINDS[KIND].needs
    }

    fn uniform(&self, _: &EffectContext) -> NoUniform {
        NoUniform::default()
    }
}

macro_rules! kind {
    ($name:literal, $needs:expr, $wgsl:literal) => {
        Kind {
            name: $name,
            needs: $needs,
            shader: EffectShader {
                path: concat!("a_game::", $name),
                source: concat!(
                    "#define_import_path a_game::",
                    $name,
                    "\n#import bevy_comics::effect::pixel::Pixel\n",
                    $wgsl
                ),
                settings: None,
            },
        }
    };
}

const KINDS: [Kind; 8] = [
    kind!(
        "nonsense",
        Needs::empty(),
        "fn nonsense(p: Pixel) -> Pixel { return p.color; }"
    ),
    kind!(
        "nameless",
        Needs::empty(),
        "fn another_name(p: Pixel) -> Pixel { return p; }"
    ),
    // Called as what the pass defines for multisampled views.
    kind!(
        "multisampled",
        Needs::NORMALS.union(Needs::DEPTH),
        "#import bevy_comics::depth::normal::load_normal
        #import bevy_comics::depth::view::load_depth
        fn multisampled(p: Pixel) -> Pixel {
            var out = p;
            let pixel = vec2<i32>(p.position);
            let n = load_normal(pixel);
            let is_drawn = n.w > 0.0 && load_depth(pixel, 0) > 0.0;
            out.color = select(vec3(0.0), n.xyz * 0.5 + 0.5, is_drawn);
            return out;
        }"
    ),
    kind!(
        "tracer",
        Needs::LINES,
        "#import bevy_comics::lines::read::{lines_at, total_ink}
        fn tracer(p: Pixel) -> Pixel {
            var out = p;
            out.color = vec3(total_ink(lines_at(p.position)));
            return out;
        }"
    ),
    // Names that are refused.
    kind!("Upper", Needs::empty(), ""),
    kind!("wave2", Needs::empty(), ""),
    kind!("contours", Needs::empty(), ""),
    kind!("partial", Needs::empty(), ""),
];

type Nonsense = Probe<0>;
type Nameless = Probe<1>;
type Reader = Probe<2>;
type Tracer = Probe<3>;

/// Apps with these effects. A broken one that no camera has changes nothing.
static POOL: Pool = Pool::new(
    |options| {
        let effects = (
            EffectPlugin::<Nonsense>::default(),
            EffectPlugin::<Nameless>::default(),
            EffectPlugin::<Reader>::default(),
            EffectPlugin::<Tracer>::default(),
        );
        start(options, effects)
    },
    draw_once,
);

fn small_with_effects(msaa: Msaa) -> Small {
    Small::of(POOL.take(options(size())), msaa)
}

/// The original picture is shown, the diagnostics name the effect, and other
/// effects are drawn once it is removed.
fn passes_through<E: Effect>() {
    let mut small = small_with_effects(Msaa::Off);
    let bare = small.settle().picture();
    small.insert((E::default(), Colorization::SEPIA)).settle();
    assert_eq!(small.picture(), bare, "{}", E::NAME);
    for (stage, reason) in [
        (ComicsStage::of::<E>(), SkipReason::ShaderError),
        (ComicsStage::Stylize, SkipReason::PipelineNotReady),
    ] {
        let found = outcome(&small, small.camera, stage);
        assert_eq!(found, Some(StageOutcome::Skipped(reason)), "{}", E::NAME);
    }
    small.camera_mut().remove::<E>();
    small.settle();
    assert!(small.ran(ComicsStage::of::<Colorization>()));
    assert_ne!(small.picture(), bare);
}

#[test]
fn a_broken_effect_is_named_and_the_picture_passes_through() {
    passes_through::<Nonsense>();
    passes_through::<Nameless>();
}

/// Normals and raw depth as the prepass has them.
#[test]
fn an_effect_reads_normals_and_depth() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut small = small_with_effects(msaa);
        small.insert(Reader::default()).settle();
        assert!(small.ran(ComicsStage::of::<Reader>()), "{msaa:?}");
        // It does not read the range.
        assert!(!small.ran(ComicsStage::DepthRange));
        let normals = small.normals().expect("a normal prepass");
        let (_, shown) = small.pass();
        let mut seen = 0;
        for (pixel, normal) in shown.pixels.iter().zip(&normals.pixels) {
            // Decoded: from -1 to 1; (-1, -1, -1) where there is no surface.
            let squared: f32 = normal[..3].iter().map(|n| n * n).sum();
            let is_surface = (0.5..=1.5).contains(&squared);
            seen += usize::from(is_surface);
            // The target stores 8-bit sRGB: one step is at most 1/255 of the
            // slope of the transfer function, below 0.01 in linear light.
            let is_right = |i: usize| {
                let want = if is_surface {
                    normal[i] * 0.5 + 0.5
                } else {
                    0.0
                };
                (pixel[i] - want).abs() < 0.01
            };
            assert!((0..3).all(is_right), "{msaa:?}: {pixel:?}, {normal:?}");
        }
        assert!(seen > 1000, "{msaa:?}: {seen} normals");
    }
}

/// An effect that reads lines gets those that another effect requests, and is
/// left out where no effect requests any.
#[test]
fn an_effect_reads_lines_where_there_are_any() {
    let mut small = small_with_effects(Msaa::Off);
    small.insert(Tracer::default()).settle();
    let found = outcome(&small, small.camera, ComicsStage::of::<Tracer>());
    let missing = StageOutcome::Skipped(SkipReason::NoSuchLines);
    assert_eq!(found, Some(missing));
    small.insert(Outlines::SILHOUETTES).settle();
    assert!(small.ran(ComicsStage::of::<Tracer>()));
    let inked = small.picture().pixels().filter(|p| p.0[0] > 200).count();
    assert!(inked > 50, "{inked} pixels of lines");
}

/// Names that would break the shader, a style file or another effect.
#[test]
fn names_that_cannot_work_are_refused() {
    let mut app = App::new();
    app.add_plugins((
        ComicsPlugin,
        EffectPlugin::<Probe<4>>::default(),
        EffectPlugin::<Probe<5>>::default(),
        EffectPlugin::<Probe<6>>::default(),
        EffectPlugin::<Probe<7>>::default(),
    ));
    let registry = app.world().resource::<EffectRegistry>();
    let names = |registry: &EffectRegistry| -> Vec<_> {
        registry.types().iter().map(|effect| effect.name).collect()
    };
    assert_eq!(names(registry), names(&EffectRegistry::built_in()));
    let contours = registry.get("contours").expect("built in");
    assert!(contours.shader.settings.is_some(), "another effect");
}
