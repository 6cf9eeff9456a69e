//! Reference of `fused/fused.wgsl` with the effects of this crate: the fused pass for
//! one pixel, without the composite, the debug views and screens of grains.

use bevy::math::{UVec2, UVec4};

use super::{
    Rgb, Rgba, black_flats, color, color_harmony, colorization, contours, depth_layers,
    desaturation,
    draw::Ink,
    halftone, mix, paper, read,
    sheet::Sheet,
    sketch, tone_bands, tone_ramp, tone_range,
    view::{View, map_slope, pixel_depth},
    vignette,
};
use bevy_comics::{
    BlackFlats, ColorHarmony, Colorization, ComicStyle, Contours, DepthLayers, Desaturation,
    Halftone, Outlines, Paper, Sketch, ToneBands, ToneRamp, ToneRange, Vignette,
};

/// What the pass reads besides the view.
pub struct Input<'a> {
    /// The unstyled picture, linear RGBA by (column, row).
    pub picture: &'a dyn Fn(u32, u32) -> [f32; 4],
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    pub lines: Option<(&'a Outlines, &'a Ink)>,
    /// Number of the sketch's drawing that is shown.
    pub drawing: u32,
    /// The pixel at which quads of 2 x 2 pixels begin: the corner of the viewport if the first
    /// pass draws a texture of the viewport's size.
    pub quads: [u32; 2],
    /// The percentiles of the picture's tones, if a [`ToneRange`] reads them.
    pub tones: Option<[f64; 2]>,
}

impl Input<'_> {
    fn light(&self, x: u32, y: u32) -> Rgb {
        let [r, g, b, _] = (self.picture)(x.min(self.size[0] - 1), y.min(self.size[1] - 1));
        [r, g, b].map(color::finite)
    }

    /// Opacity of the unstyled picture, 0 to 1.
    fn opacity(&self, x: u32, y: u32) -> f64 {
        color::finite((self.picture)(x, y)[3]).clamp(0.0, 1.0)
    }

    /// Change of the lightness over a pixel: the sum of the differences to its two
    /// neighbors in the same quad of 2 x 2 pixels, as `fwidthFine`. Outside of the viewport, its
    /// border counts.
    fn change(&self, viewport: [u32; 4], x: u32, y: u32, lightness: fn(Rgb) -> f64) -> f64 {
        let at = |x, y| lightness(self.light(x, y));
        let [left, top, width, height] = viewport;
        let beside = |v: u32, quads: u32, first: u32, size: u32| {
            let other = (v.wrapping_sub(quads) ^ 1).wrapping_add(quads);
            // Before the first pixel of a target, the number has wrapped.
            if other < first || other > v + 1 {
                first
            } else {
                other.min(first + size - 1)
            }
        };
        let across = beside(x, self.quads[0], left, width);
        let down = beside(y, self.quads[1], top, height);
        (at(x, y) - at(across, y)).abs() + (at(x, y) - at(x, down)).abs()
    }
}

/// The unstyled picture in its range of tones.
fn toned(style: &ComicStyle, input: &Input, [x, y]: [u32; 2]) -> Rgb {
    let light = input.light(x, y);
    let Some(s) = style.get::<ToneRange>() else {
        return light;
    };
    let alpha = input.opacity(x, y);
    let line = tone_range::line(s, input.tones);
    let brought = tone_range::brought(line, light.map(|c| c / alpha.max(1e-3)));
    let amount = f64::from(s.amount) * (1e3 * alpha).min(1.0);
    std::array::from_fn(|i| mix(light[i], brought[i] * alpha, amount))
}

/// A pixel after the effects that change colors, with its depth map and its complement.
struct Colored {
    picture: Rgba,
    depth: [f64; 2],
}

fn colored(
    style: &ComicStyle,
    view: &View,
    input: &Input,
    [x, y]: [u32; 2],
    nudge: f64,
) -> Colored {
    let alpha = input.opacity(x, y);
    let mut linear = toned(style, input, [x, y]);
    // What is lighter than white can be brought below it.
    let unlimited: fn(Rgb) -> f64 = |c| color::luminance(c).max(0.0).sqrt();
    let (lightness, gain) =
        style
            .get::<ToneRange>()
            .map_or((color::lightness as fn(Rgb) -> f64, 1.0), |s| {
                let [gain, _] = tone_range::line(s, input.tones);
                (unlimited, mix(1.0, gain, f64::from(s.amount)))
            });
    let mut depth = pixel_depth(view, x, y);
    if view.flip {
        depth.reverse();
    }
    let [d, l] = depth;
    let opacity = alpha.max(1e-3);
    let change = gain * input.change(view.viewport, x, y, lightness);
    let change = (change + nudge).max(0.0);
    if let Some(s) = style.get::<ToneRamp>() {
        let seen = linear.map(|c| (c / opacity).max(0.0) * (1.0 + nudge));
        let tones = tone_ramp::toned(s, seen, change, tone_ramp::tone_detail(s, d));
        linear = std::array::from_fn(|i| mix(linear[i], tones[i] * alpha, (1e3 * alpha).min(1.0)));
    }
    if let Some(s) = style.get::<ToneBands>() {
        let seen = linear.map(|c| c / opacity * (1.0 + nudge));
        let banded = tone_bands::banded_color(s, seen, change, 1.0);
        linear = std::array::from_fn(|i| mix(linear[i], banded[i] * alpha, (1e3 * alpha).min(1.0)));
    }
    let mut saturation = 1.0;
    if let Some(s) = style.get::<Desaturation>() {
        saturation = desaturation::saturation_left(s, l);
        let seen = linear.map(|c| c / opacity);
        linear = desaturation::desaturate(s, seen, saturation).map(|c| c * opacity);
    }
    if let Some(s) = style.get::<Colorization>() {
        let seen = linear.map(|c| c / opacity);
        linear = colorization::colorize(s, seen, d, l, saturation).map(|c| c * opacity);
    }
    if let Some(s) = style.get::<ColorHarmony>() {
        let seen = linear.map(|c| c / opacity);
        linear = color_harmony::harmonize(s, seen, d, l).map(|c| c * opacity);
    }
    if let Some(s) = style.get::<DepthLayers>() {
        let seen = linear.map(|c| c / opacity * (1.0 + nudge));
        let weights = depth_layers::pixel_weights(s, view, [x, y]);
        linear = depth_layers::color(s, seen, weights, change).map(|c| c * alpha);
    }
    Colored {
        picture: with(linear, alpha),
        depth,
    }
}

/// A picture of the viewport at a place between the centers of pixels. `load`: its pixels,
/// by column and row of the target.
fn between(viewport: [u32; 4], load: &dyn Fn([u32; 2]) -> Rgba, at: [f64; 2]) -> Rgba {
    let corner = at.map(|v| (v - 0.5).floor());
    let pixel = |dx: f64, dy: f64| {
        let of = |axis: usize, by: f64| {
            let first = f64::from(viewport[axis]);
            let last = first + f64::from(viewport[axis + 2]) - 1.0;
            (corner[axis] + by).clamp(first, last) as u32
        };
        load([of(0, dx), of(1, dy)])
    };
    let [fx, fy] = [at[0] - 0.5 - corner[0], at[1] - 0.5 - corner[1]];
    let row = |dy| {
        let (left, right) = (pixel(0.0, dy), pixel(1.0, dy));
        std::array::from_fn::<f64, 4, _>(|i| mix(left[i], right[i], fx))
    };
    let (above, below) = (row(0.0), row(1.0));
    std::array::from_fn(|i| mix(above[i], below[i], fy))
}

/// A pixel after the screens.
fn print(style: &ComicStyle, view: &View, input: &Input, at: [u32; 2], nudge: f64) -> Colored {
    let mut pixel = colored(style, view, input, at, nudge);
    // Between passes, the picture is stored in 11 bits.
    let stored = if nudge == 0.0 {
        1.0
    } else {
        1.0 + nudge.signum() / 2048.0
    };
    let load = |at| {
        let [r, g, b, alpha] = colored(style, view, input, at, nudge).picture;
        with([r, g, b].map(|c| c * stored), alpha)
    };
    if let Some(s) = style.get::<Halftone>() {
        let viewport = UVec4::from_array(view.viewport);
        let read = |at| between(view.viewport, &load, at);
        let cells = halftone::Cells {
            center: halftone::center(s, viewport, UVec2::from_array(input.size)),
            sheet: (style.get::<Paper>()).map_or(Sheet::SMOOTH, |s| Sheet::new(s, 1.0, 0)),
            picture: &read,
        };
        let at = at.map(|v| f64::from(v) + 0.5);
        let rgb = halftone::halftone(s, pixel.picture, at, pixel.depth[0], &cells);
        pixel.picture = with(rgb, pixel.picture[3]);
    }
    pixel
}

/// The stylized pixel in linear light and its opacity, at a scale factor of 1 and a
/// sketch amount of 1.
///
/// `nudge` moves every threshold slightly. Two calls with opposite nudges show how
/// far rounding at a threshold can move the color.
pub fn stylize(style: &ComicStyle, view: &View, input: &Input, x: u32, y: u32, nudge: f64) -> Rgba {
    let source = toned(style, input, [x, y]);
    let printed = print(style, view, input, [x, y], nudge);
    let (mut linear, mut alpha) = parts(printed.picture);
    let [_, l] = printed.depth;
    if let Some(s) = style.get::<BlackFlats>() {
        let slope = map_slope(view, x, y) + nudge;
        let dark = black_flats::dark_area(s, source.map(|c| c - nudge), l);
        let steep = black_flats::steep_area(s, slope, view.viewport[3]);
        linear = black_flats::fill(s, with(linear, alpha), dark.max(steep));
    }
    if let Some(s) = style.get::<Contours>() {
        let threshold = s.threshold - nudge as f32;
        let [coverage, near] = contours::contour(&Contours { threshold, ..*s }, view, x, y, 1.0);
        let drawn = contours::draw(s, with(linear, alpha), coverage, near);
        (linear, alpha) = parts(drawn);
    }
    let sketch = style.get::<Sketch>();
    let [left, top, width, height] = view.viewport.map(f64::from);
    let place = [f64::from(x) + 0.5 - left, f64::from(y) + 0.5 - top];
    match (sketch, input.lines) {
        (Some(s), Some((outlines, ink))) => {
            let inside = [x - view.viewport[0], y - view.viewport[1]].map(f64::from);
            let blank = (0..s.strokes).fold(1.0, |blank, stroke| {
                let by = sketch::stray(s, inside, stroke, input.drawing, 1.0);
                let at = [place[0] + by[0], place[1] + by[1]];
                let pressure = sketch::pen_pressure(s, inside, stroke, input.drawing, 1.0);
                let ink = read::total(outlines, read::lines_at(ink, at, true, nudge));
                blank * (1.0 - (ink * pressure).clamp(0.0, 1.0))
            });
            linear = sketch::draw_sketch(s, with(linear, alpha), 1.0 - blank);
            alpha = 1.0;
        }
        (None, Some((outlines, ink))) => {
            let found = read::lines_at(ink, place, false, nudge);
            (linear, alpha) = parts(read::draw(outlines, with(linear, alpha), found));
        }
        _ => {}
    }
    if let Some(s) = style.get::<Paper>() {
        let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        linear = paper::paper(s, with(linear, alpha), at, 1.0, 0);
    }
    if let Some(s) = style.get::<Vignette>() {
        linear = vignette::vignette(s, with(linear, alpha), place, [width, height]);
    }
    with(linear, alpha)
}

fn with([r, g, b]: Rgb, alpha: f64) -> Rgba {
    [r, g, b, alpha]
}

fn parts([r, g, b, alpha]: Rgba) -> (Rgb, f64) {
    ([r, g, b], alpha)
}
