//! Effects of a game: broken ones, and what effects may read.

use bevy::render::render_resource::ShaderType;
use bevy_comics::effect::NoUniform;
use bevy_comics_testkit::before::BeforeStylize;
use serde::{Deserialize, Serialize};

use super::*;
use crate::prelude::*;

/// An effect that takes no settings: `$name`, its need, and its WGSL.
macro_rules! test_effect {
    ($Effect:ident, $name:literal, $needs:expr, $wgsl:literal) => {
        #[derive(
            Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize,
        )]
        #[reflect(Component, Default)]
        struct $Effect {
            off: bool,
        }

        impl Effect for $Effect {
            const NAME: &'static str = $name;
            const STAGE: EffectStage = EffectStage::Page;
            const SHADER: EffectShader = EffectShader {
                path: concat!("a_game::", $name),
                source: concat!("#define_import_path a_game::", $name, "\n", $wgsl),
                settings: None,
            };
            type Uniform = NoUniform;

            fn sanitized(self) -> Self {
                self
            }

            fn strength(&self) -> f32 {
                if self.off { 0.0 } else { 1.0 }
            }

            fn faded(self, fraction: f32) -> Self {
                Self {
                    off: self.off || fraction == 0.0,
                }
            }

            fn needs(&self) -> Needs {
                $needs
            }

            fn uniform(&self, _: &EffectContext) -> NoUniform {
                NoUniform::default()
            }
        }
    };
}

test_effect!(
    Nonsense,
    "nonsense",
    Needs::empty(),
    "#import bevy_comics::effect::pixel::Pixel
    fn nonsense(p: Pixel) -> Pixel { return p.colour; }"
);
test_effect!(
    Nameless,
    "nameless",
    Needs::empty(),
    "#import bevy_comics::effect::pixel::Pixel
    fn another_name(p: Pixel) -> Pixel { return p; }"
);
test_effect!(
    Reader,
    "reader",
    Needs::NORMALS | Needs::DEPTH,
    "#import bevy_comics::effect::pixel::Pixel
    #import bevy_comics::depth::normal::load_normal
    #import bevy_comics::depth::view::load_depth
    fn reader(p: Pixel) -> Pixel {
        var out = p;
        let pixel = vec2<i32>(p.position);
        let n = load_normal(pixel);
        out.color = select(vec3(0.0), n.xyz * 0.5 + 0.5, n.w > 0.0 && load_depth(pixel, 0) > 0.0);
        return out;
    }"
);
test_effect!(
    Tracer,
    "tracer",
    Needs::LINES,
    "#import bevy_comics::effect::pixel::Pixel
    #import bevy_comics::lines::read::{lines_at, total_ink}
    fn tracer(p: Pixel) -> Pixel {
        var out = p;
        out.color = vec3(total_ink(lines_at(p.position)));
        return out;
    }"
);

fn small_with<E: Effect>(msaa: Msaa) -> Small {
    let plugins = (
        ComicsPlugin,
        EffectPlugin::<E>::default(),
        BeforeStylize::Copy,
    );
    let mut headless = Headless::new(options(size()), plugins);
    crate::small::spawn_objects(headless.app.world_mut());
    let target = headless.render_target();
    let camera = headless.app.world_mut().spawn(camera(target, msaa)).id();
    Small { headless, camera }
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
            let want = if (0.5..=1.5).contains(&squared) {
                seen += 1;
                [normal[0], normal[1], normal[2]].map(|n| n * 0.5 + 0.5)
            } else {
                [0.0; 3]
            };
            for (shown, want) in pixel[..3].iter().zip(want) {
                // The target stores 8-bit sRGB: one step is at most 1/255 of the
                // slope of the transfer function, below 0.01 in linear light.
                assert!(
                    (shown - want).abs() < 0.01,
                    "{msaa:?}: {pixel:?}, {normal:?}"
                );
            }
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
    test_effect!(Upper, "Upper", Needs::empty(), "");
    test_effect!(Digit, "wave2", Needs::empty(), "");
    test_effect!(Depth, "depth", Needs::empty(), "");
    test_effect!(Taken, "contours", Needs::empty(), "");
    test_effect!(Key, "partial", Needs::empty(), "");
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
    #[derive(ShaderType, Clone, Copy)]
    struct One {
        level: f32,
    }
    macro_rules! odd {
        ($Effect:ident, $name:literal, $level:literal) => {
            #[derive(
                Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize,
            )]
            #[reflect(Component, Default)]
            struct $Effect {
                off: bool,
            }
            impl Effect for $Effect {
                const NAME: &'static str = $name;
                const STAGE: EffectStage = EffectStage::Page;
                const SHADER: EffectShader = EffectShader {
                    path: concat!("a_game::", $name),
                    source: concat!(
                        "#define_import_path a_game::",
                        $name,
                        "
                        #import bevy_comics::effect::pixel::Pixel
                        struct ",
                        stringify!($Effect),
                        " { level: f32 }
                        fn ",
                        $name,
                        "(s: ",
                        stringify!($Effect),
                        ", p: Pixel) -> Pixel { var out = p; out.color.",
                        $name,
                        " = s.level; return out; }"
                    ),
                    settings: Some(stringify!($Effect)),
                };
                type Uniform = One;
                fn sanitized(self) -> Self {
                    self
                }
                fn strength(&self) -> f32 {
                    1.0
                }
                fn faded(self, _: f32) -> Self {
                    self
                }
                fn uniform(&self, _: &EffectContext) -> One {
                    One { level: $level }
                }
            }
        };
    }
    odd!(Red, "r", 0.25);
    odd!(Green, "g", 0.5);
    odd!(Blue, "b", 0.75);
    let plugins = (
        ComicsPlugin,
        EffectPlugin::<Red>::default(),
        EffectPlugin::<Green>::default(),
        EffectPlugin::<Blue>::default(),
        BeforeStylize::Copy,
    );
    let mut headless = Headless::new(options(size()), plugins);
    let target = headless.render_target();
    let camera = headless
        .app
        .world_mut()
        .spawn((camera(target, Msaa::Off), Red::default(), Green::default()))
        .insert(Blue::default())
        .id();
    let mut small = Small { headless, camera };
    small.settle();
    let (_, shown) = small.pass();
    let [r, g, b, _] = shown.pixels[0];
    // Half a code of an 8-bit target, in linear light.
    for (shown, want) in [(r, 0.25), (g, 0.5), (b, 0.75)] {
        assert!((shown - want).abs() < 0.01, "{:?}", shown);
    }
}
