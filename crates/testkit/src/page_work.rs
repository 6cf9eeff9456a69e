//! Counts the texels that effects of the page fetch, in all passes of their view together.
//!
//! How many there are does not depend on the colors of the picture. So every pass returns its
//! count instead of colors, and adds that of the passes before it.

use bevy::render::{RenderApp, sync_world::RenderEntity};
use bevy_comics::{
    ColorHarmony, Colorization, ComicStyle, ComicsDiagnostics, DepthLayers, Focus, Halftone,
    Hatching, Misregistration, Paint, Paper, SpeedLines, TwoTone,
    effects::{FocusAt, FocusStyle, Granularity, ScreenSampling, ScreenShape},
};

use crate::{
    line_work::draw,
    studio::Studio,
    work::{FUSED, RESULT, counted, counting, edit_shaders, teapot},
};

const BOX_STATISTICS: &str = "bevy_comics/effect/box_statistics.wgsl";
const AUX_SCALAR: &str = "bevy_comics/effect/aux_scalar.wgsl";
const PICTURE: &str = "bevy_comics/effect/picture.wgsl";
/// The files whose functions read textures for effects of the page, sorted.
const READERS: [&str; 8] = [
    "bevy_comics/depth/normal.wgsl",
    "bevy_comics/depth/view.wgsl",
    AUX_SCALAR,
    "bevy_comics/effect/blue_noise.wgsl",
    BOX_STATISTICS,
    PICTURE,
    FUSED,
    "bevy_comics/objects/objects.wgsl",
];

/// The texels that the passes of a view fetch per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PageWork {
    pub name: &'static str,
    /// Mean and maximum. One that is read between texels counts as four.
    pub texels: [f64; 2],
    /// Bytes, mean.
    pub bytes: f64,
}

/// The effect that the others are compared with: one pass, which reads its own pixel.
pub const ONE_PASS: &str = "one tint";

/// Effects that read no more than their own pixel.
pub const OWN_PIXEL: [&str; 5] = [
    "halftone",
    "paper",
    "halftone and paper with spread",
    "two tones",
    "speed lines",
];

/// Effects of the page, each alone.
pub fn effects() -> Vec<(&'static str, ComicStyle)> {
    let style = ComicStyle::new;
    let focus = |style| Focus {
        at: FocusAt::Center,
        style,
        ..Focus::default()
    };
    let rough = Paper {
        ink_bleed: 1.0,
        ..Paper::default()
    };
    let screen = |shape, sampling| Halftone {
        shape,
        sampling,
        ..Halftone::default()
    };
    let pixels = DepthLayers {
        granularity: Granularity::Pixel,
        ..DepthLayers::default()
    };
    let [dots, grains] = [ScreenShape::Euclidean, ScreenShape::Stochastic];
    let [pixel, cell] = [ScreenSampling::Pixel, ScreenSampling::Cell];
    vec![
        (ONE_PASS, style().with(Colorization::SEPIA)),
        (OWN_PIXEL[0], style().with(screen(dots, pixel))),
        (OWN_PIXEL[1], style().with(Paper::default())),
        (OWN_PIXEL[2], style().with(screen(dots, pixel)).with(rough)),
        (OWN_PIXEL[3], style().with(TwoTone::default())),
        (OWN_PIXEL[4], style().with(SpeedLines::default())),
        ("halftone in grains", style().with(screen(grains, pixel))),
        ("halftone in whole dots", style().with(screen(dots, cell))),
        ("misregistration", style().with(Misregistration::default())),
        ("paint", style().with(Paint::default())),
        ("focus, blur", style().with(focus(FocusStyle::Blur))),
        ("focus, offset", style().with(focus(FocusStyle::Offset))),
        ("focus, paint", style().with(focus(FocusStyle::Paint))),
        ("focus, dots", style().with(focus(FocusStyle::Dots))),
        ("hatching", style().with(Hatching::default())),
        ("color harmony", style().with(ColorHarmony::default())),
        ("depth layers", style().with(DepthLayers::default())),
        ("depth layers of pixels", style().with(pixels)),
    ]
}

/// What the passes before this one have counted at a pixel, by the texture that they drew.
const BEFORE_PICTURE: &str = "
fn counted_picture(pixel: vec2<i32>) -> vec2<f32> {
#ifdef CONTINUED
    return textureLoad(picture_texture, pixel - view.viewport.xy, 0).xy;
#else
    return vec2(0.0);
#endif
}
";
const BEFORE_MEANS: &str = "
fn counted_means(pixel: vec2<i32>) -> vec2<f32> {
#ifdef BOX_STATISTICS
    return vec2<f32>(textureLoad(means_texture, pixel - view.viewport.xy, 0).xy);
#else
    return vec2(0.0);
#endif
}
";
const BEFORE_NUMBERS: &str = "
fn counted_numbers(pixel: vec2<i32>) -> vec2<f32> {
#ifdef AUX_SCALAR
    return vec2<f32>(textureLoad(aux_scalar_texture, pixel - view.viewport.xy, 0).xw);
#else
    return vec2(0.0);
#endif
}
";
/// The count of a pass and of those before it.
const TOTAL: &str = "
#import bevy_comics::effect::box_statistics::counted_means
#import bevy_comics::effect::aux_scalar::counted_numbers
#import bevy_comics::effect::picture::counted_picture
fn total(pixel: vec2<i32>) -> vec2<f32> {
#ifdef BOX_STATISTICS
    return fetched_so_far() + counted_means(pixel);
#else ifdef AUX_SCALAR
    return fetched_so_far() + counted_numbers(pixel);
#else
    return fetched_so_far() + counted_picture(pixel);
#endif
}
";
/// The ends of the passes: how their results are returned, and how counts are returned instead.
const ENDS: [(&str, &str); 4] = [
    (
        "return pass_color(p);",
        "return vec4(total(pixel), p.color.r, 1.0);",
    ),
    (
        "return packed_means(mean_along(pixel, half_box(pixel)));",
        "let m = packed_means(mean_along(pixel, half_box(pixel)));
         return vec4(vec2<u32>(total(pixel)), m.zw);",
    ),
    (
        "return packed_number(pass_color(p), number_of(p));",
        "let n = packed_number(vec4(1.0), number_of(p));
         return vec4(u32(total(pixel).x), n.y, n.z, u32(total(pixel).y));",
    ),
    (
        "return vec4(fetched_so_far(), to_stored(result.rgb).r, 1.0);",
        "return vec4(total(pixel), to_stored(result.rgb).r, 1.0);",
    ),
];

fn counting_all(path: &str, text: &str) -> String {
    let mut text = counting(path, text);
    match path {
        PICTURE => text.push_str(BEFORE_PICTURE),
        BOX_STATISTICS => text.push_str(BEFORE_MEANS),
        AUX_SCALAR => text.push_str(BEFORE_NUMBERS),
        FUSED => {
            assert!(!text.contains(RESULT), "the end of the last pass counts");
            for (end, counted) in ENDS {
                assert!(text.contains(end), "the end of a pass has moved: {end}");
                text = text.replace(end, counted);
            }
            let (imports, rest) = text.split_once("\nstruct ").expect("imports, then structs");
            text = format!("{imports}\n{TOTAL}\nstruct {rest}");
        }
        _ => {}
    }
    text
}

/// Counts the work of styles on the teapot at 160 x 90 pixels, in one app.
pub struct PageCounter {
    studio: Studio,
}

impl Default for PageCounter {
    fn default() -> Self {
        let mut studio = teapot();
        let changed = edit_shaders(studio.headless.app.world_mut(), &READERS, counting_all);
        assert_eq!(changed, READERS, "the files that read textures");
        Self { studio }
    }
}

impl PageCounter {
    pub fn count(&mut self, name: &'static str, style: &ComicStyle) -> PageWork {
        draw(&mut self.studio, style);
        let (studio, camera) = (&self.studio, self.studio.camera);
        let world = studio.headless.app.world();
        let is_compiling = world.resource::<ComicsDiagnostics>().is_compiling(camera);
        assert!(!is_compiling, "the style before {name} is still drawn");
        let view = world.get::<RenderEntity>(camera).expect("extracted").id();
        let (texels, bytes) = counted(studio.headless.app.sub_app(RenderApp).world(), view);
        PageWork {
            name,
            texels,
            bytes,
        }
    }
}
