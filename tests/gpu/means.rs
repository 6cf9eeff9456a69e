//! Means over boxes, as an effect of a game reads them.

use bevy_comics_testkit::reference::box_statistics::{Means, Sheet, part_of_box};
use serde::{Deserialize, Serialize};

use crate::{halftone::fill, prelude::*};

/// Shows the means: their colors, or luminance, variance and coverage.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
struct ShownMeans {
    half: f32,
    numbers: f32,
}

impl Effect for ShownMeans {
    const NAME: &'static str = "shown_means";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = EffectShader {
        path: "test::shown_means",
        source: "#define_import_path test::shown_means
            #import bevy_comics::effect::box_statistics::{load_means, mean_color, variance}
            #import bevy_comics::effect::pixel::Pixel
            struct ShownMeans { half: f32, numbers: f32 }
            fn shown_means_half_box(s: ShownMeans, p: Pixel) -> f32 { return s.half; }
            fn shown_means(s: ShownMeans, p: Pixel) -> Pixel {
                var out = p;
                let m = load_means(vec2<i32>(p.position));
                let numbers = vec3(m.mean, variance(m), m.coverage);
                out.color = select(mean_color(m), numbers, s.numbers > 0.0);
                return out;
            }",
        settings: Some("ShownMeans"),
    };
    const HALF_BOX: bool = true;
    type Uniform = Vec2;

    fn sanitized(self) -> Self {
        self
    }

    fn strength(&self) -> f32 {
        1.0
    }

    fn faded(self, _: f32) -> Self {
        self
    }

    fn needs(&self) -> Needs {
        Needs::BOX_STATISTICS
    }

    fn uniform(&self, _: &EffectContext) -> Vec2 {
        Vec2::new(self.half, self.numbers)
    }
}

fn small() -> Small {
    let effects = EffectPlugin::<ShownMeans>::default();
    let mut small = Small::with_plugins(options(UVec2::new(48, 33)), Msaa::Off, effects);
    small.insert(Hdr);
    fill(&mut small, Color::linear_rgb(9.0, 3.0, 0.5));
    small
}

/// Direct sums over the pixels of a box, each by its part that is inside.
fn direct(sheet: &Sheet, at: [i64; 2], half: f64) -> Means {
    let reach = half.ceil() as i64;
    let by = || (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| [x, y]));
    let parts = by().filter_map(|[x, y]| {
        let other = [at[0] + x, at[1] + y];
        let part = part_of_box(half, x) * part_of_box(half, y);
        (sheet.contains(other)).then(|| (part, Means::of(sheet.nearest(other))))
    });
    Means::mean(parts, (2.0 * half + 1.0).powi(2))
}

/// Truth: direct sums of what the pass read. The picture, its means and what is shown are
/// rounded to 11 bits, so square roots are off by up to 0.0002, 0.0005 and 0.0005, and above 1 by
/// as much of what they are: the sky is brighter.
#[test]
fn means_are_direct_sums_of_the_picture() {
    let mut small = small();
    for half in [0.0, 0.75, 2.0, 5.5] {
        for numbers in [0.0, 1.0] {
            small.insert(ShownMeans { half, numbers }).settle();
            assert!(small.ran(ComicsStage::of::<ShownMeans>()));
            let (read, wrote) = small.pass();
            let size = [read.width, read.height].map(|v| v as usize);
            let sheet = Sheet::new(size, |[x, y]| read.pixels[y * size[0] + x].map(f64::from));
            for (i, found) in wrote.pixels.iter().enumerate() {
                let at = [i % size[0], i / size[0]].map(|v| v as i64);
                let want = direct(&sheet, at, f64::from(half));
                let [r, g, b] = want.color;
                let want = if numbers == 0.0 {
                    [r, g, b]
                } else {
                    let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
                    [luminance, want.variance(), want.coverage]
                };
                for c in 0..3 {
                    let apart = (f64::from(found[c]) - want[c]).abs() / want[c].max(1.0);
                    assert!(apart < 0.0015, "{half}, {at:?}: {found:?}, {want:?}");
                }
            }
        }
    }
}
