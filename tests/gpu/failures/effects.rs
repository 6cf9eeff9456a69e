//! Effects of a game: broken ones, and what effects may read.

use bevy::render::render_resource::ShaderType;
use serde::{Deserialize, Serialize};

use super::*;
use crate::prelude::*;

/// An effect of a game: one of [`KINDS`].
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
    level: f32,
}

#[derive(ShaderType, Clone, Copy)]
struct Level {
    level: f32,
}

impl<const KIND: usize> Effect for Probe<KIND> {
    const NAME: &'static str = KINDS[KIND].name;
    const STAGE: EffectStage = EffectStage::Page;
    const SHADER: EffectShader = KINDS[KIND].shader;
    type Uniform = Level;

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

    fn uniform(&self, _: &EffectContext) -> Level {
        let level = KINDS[KIND].level;
        Level { level }
    }
}

/// A kind without settings.
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
            level: 0.0,
        }
    };
}

/// A kind whose settings are a single number: it sets a channel of the colour.
macro_rules! channel {
    ($name:literal, $settings:literal, $level:literal) => {
        Kind {
            level: $level,
            shader: EffectShader {
                path: concat!("a_game::", $name),
                source: concat!(
                    "#define_import_path a_game::",
                    $name,
                    "\n#import bevy_comics::effect::pixel::Pixel\nstruct ",
                    $settings,
                    " { level: f32 }\nfn ",
                    $name,
                    "(s: ",
                    $settings,
                    ", p: Pixel) -> Pixel { var out = p; out.color.",
                    $name,
                    " = s.level; return out; }"
                ),
                settings: Some($settings),
            },
            ..kind!($name, Needs::empty(), "")
        }
    };
}

const KINDS: [Kind; 12] = [
    kind!(
        "nonsense",
        Needs::empty(),
        "fn nonsense(p: Pixel) -> Pixel { return p.colour; }"
    ),
    kind!(
        "nameless",
        Needs::empty(),
        "fn another_name(p: Pixel) -> Pixel { return p; }"
    ),
    kind!(
        "reader",
        Needs::NORMALS.union(Needs::DEPTH),
        "#import bevy_comics::depth::normal::load_normal
        #import bevy_comics::depth::view::load_depth
        fn reader(p: Pixel) -> Pixel {
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
    kind!("Upper", Needs::empty(), ""),
    kind!("wave2", Needs::empty(), ""),
    kind!("depth", Needs::empty(), ""),
    kind!("contours", Needs::empty(), ""),
    kind!("partial", Needs::empty(), ""),
    channel!("r", "Red", 0.25),
    channel!("g", "Green", 0.5),
    channel!("b", "Blue", 0.75),
];

type Nonsense = Probe<0>;
type Nameless = Probe<1>;
type Reader = Probe<2>;
type Tracer = Probe<3>;
type Upper = Probe<4>;
type Digit = Probe<5>;
type Depth = Probe<6>;
type Taken = Probe<7>;
type Key = Probe<8>;
type Red = Probe<9>;
type Green = Probe<10>;
type Blue = Probe<11>;

fn small_with<E: Effect>(msaa: Msaa) -> Small {
    Small::with_plugins(options(size()), msaa, EffectPlugin::<E>::default())
}

/// The original picture is shown, the diagnostics name the effect, and other
/// effects are drawn once it is removed.
fn passes_through<E: Effect>() {
    let mut small = small_with::<E>(Msaa::Off);
    small.settle();
    let bare = small.picture();
    small.insert((E::default(), Colorization::SEPIA)).settle();
    assert_eq!(small.picture(), bare, "{}", E::NAME);
    let camera = small.camera;
    let of = |stage| Some(StageOutcome::Skipped(stage));
    assert_eq!(
        outcome(&small, camera, ComicsStage::of::<E>()),
        of(SkipReason::ShaderError),
        "{}",
        E::NAME
    );
    assert_eq!(
        outcome(&small, camera, ComicsStage::Stylize),
        of(SkipReason::PipelineNotReady)
    );
    small.world().entity_mut(camera).remove::<E>();
    small.settle();
    assert!(small.ran(ComicsStage::of::<Colorization>()));
    assert_ne!(small.picture(), bare);
    assert_eq!(small.errors(), 0);
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
        let mut small = small_with::<Reader>(msaa);
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
    let mut small = small_with::<Tracer>(Msaa::Off);
    small.insert(Tracer::default()).settle();
    let camera = small.camera;
    assert_eq!(
        outcome(&small, camera, ComicsStage::of::<Tracer>()),
        Some(StageOutcome::Skipped(SkipReason::NoSuchLines))
    );
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
        EffectPlugin::<Upper>::default(),
        EffectPlugin::<Digit>::default(),
        EffectPlugin::<Depth>::default(),
        EffectPlugin::<Taken>::default(),
        EffectPlugin::<Key>::default(),
    ));
    let registry = app.world().resource::<EffectRegistry>();
    let names = |registry: &EffectRegistry| -> Vec<&str> {
        registry.types().iter().map(|effect| effect.name).collect()
    };
    assert_eq!(names(registry), names(&EffectRegistry::built_in()));
    assert!(
        registry
            .get("contours")
            .is_some_and(|c| c.shader.settings.is_some())
    );
}

/// Every effect is packed at a multiple of 16 bytes, whatever precedes it.
#[test]
fn effects_of_odd_sizes_stand_side_by_side() {
    let plugins = (
        EffectPlugin::<Red>::default(),
        EffectPlugin::<Green>::default(),
        EffectPlugin::<Blue>::default(),
    );
    let mut small = Small::with_plugins(options(size()), Msaa::Off, plugins);
    small.insert((Red::default(), Green::default(), Blue::default()));
    small.settle();
    let (_, shown) = small.pass();
    let [r, g, b, _] = shown.pixels[0];
    // Half a code of an 8-bit target, in linear light.
    for (shown, want) in [(r, 0.25), (g, 0.5), (b, 0.75)] {
        assert!((shown - want).abs() < 0.01, "{:?}", shown);
    }
}
