//! The picture with a number at every pixel, as an effect of a game reads it.

use serde::{Deserialize, Serialize};

use crate::prelude::*;

/// Shows the number and the red of the pixel to the left, and its own green.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
struct Numbers<const ORDER: usize> {
    scale: f32,
}

type ShownNumbers = Numbers<0>;
/// The same after it.
type MoreNumbers = Numbers<1>;

macro_rules! shader {
    ($name:literal) => {
        EffectShader {
            path: concat!("test::", $name),
            source: concat!(
                "#define_import_path test::",
                $name,
                "
                #import bevy_comics::depth::view::inside_viewport
                #import bevy_comics::effect::aux_scalar::load_aux_scalar
                #import bevy_comics::effect::pixel::Pixel
                struct Numbers { scale: f32 }
                fn ",
                $name,
                "_aux_scalar(s: Numbers, p: Pixel) -> f32 {
                    return s.scale * (p.inside.x + 0.5 * p.inside.y);
                }
                fn ",
                $name,
                "(s: Numbers, p: Pixel) -> Pixel {
                    var out = p;
                    let left = inside_viewport(vec2<i32>(p.position) - vec2(1, 0));
                    let found = load_aux_scalar(left);
                    out.color = vec3(found.number, found.color.r, p.color.g);
                    return out;
                }"
            ),
            settings: Some("Numbers"),
        }
    };
}

impl<const ORDER: usize> Effect for Numbers<ORDER> {
    const NAME: &'static str = ["shown_numbers", "more_numbers"][ORDER];
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = [shader!("shown_numbers"), shader!("more_numbers")][ORDER];
    const AUX_SCALAR: bool = true;
    type Uniform = Vec2;

    fn strength(&self) -> f32 {
        1.0
    }

    fn faded(self, _: f32) -> Self {
        self
    }

    fn needs(&self) -> Needs {
        Needs::AUX_SCALAR
    }

    fn uniform(&self, _: &EffectContext) -> Vec2 {
        Vec2::new(self.scale, 0.0)
    }
}

fn small() -> Small {
    let effects = (
        EffectPlugin::<ShownNumbers>::default(),
        EffectPlugin::<MoreNumbers>::default(),
    );
    let mut small = Small::with_plugins(options(UVec2::new(48, 33)), Msaa::Off, effects);
    small.insert(Hdr);
    small
}

/// Everything is exact: the picture has 11 bits before and after.
#[test]
fn numbers_are_beside_their_colors() {
    let mut small = small();
    small.insert(ShownNumbers { scale: 0.5 }).settle();
    assert!(small.ran(ComicsStage::of::<ShownNumbers>()));
    let (read, wrote) = small.pass();
    let size = [read.width, read.height].map(|v| v as usize);
    for (i, found) in wrote.pixels.iter().enumerate() {
        let [x, y] = [i % size[0], i / size[0]];
        let left = x.saturating_sub(1);
        let number = 0.5 * (left as f32 + 0.5 * y as f32);
        let before = read.pixels[y * size[0] + left];
        let want = [number, before[0], read.pixels[i][1]];
        assert_eq!(found[..3], want, "({x}, {y})");
    }
    // The one after it reads what it has drawn; a color effect comes before both.
    let second = MoreNumbers { scale: 0.25 };
    small.insert((Desaturation::default(), second)).settle();
    let (_, again) = small.pass();
    for (i, found) in again.pixels.iter().enumerate() {
        let [x, y] = [i % size[0], i / size[0]];
        let number = |x: usize, scale: f32| scale * (x as f32 + 0.5 * y as f32);
        let left = x.saturating_sub(1);
        let before = number(left.saturating_sub(1), 0.5);
        assert_eq!(found[..2], [number(left, 0.25), before], "({x}, {y})");
    }
}
