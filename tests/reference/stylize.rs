//! Twin of `stylize/stylize.wgsl`: the whole fused pass for one pixel.

use super::{Rgb, bindings::View, black_flats, color, colorization, contours, desaturation, taps};
use bevy_comics::ComicStyle;

/// The pixel in linear light, and how far thresholds could move it: the same
/// pixel with every contour and flat a little more and a little less covered.
pub fn stylize(
    style: &ComicStyle,
    view: &View,
    stored: [f32; 4],
    x: u32,
    y: u32,
    nudge: f64,
) -> Rgb {
    let source = [stored[0], stored[1], stored[2]].map(color::finite);
    let mut linear = source;
    let mut depth = taps::pixel_depth(view, x, y);
    if view.flip {
        depth.reverse();
    }
    let [d, l] = depth;
    let mut saturation = 1.0;
    if let Some(s) = &style.desaturation {
        saturation = desaturation::saturation_left(s, l);
        linear = desaturation::desaturate(s, linear, saturation);
    }
    if let Some(s) = &style.colorization {
        linear = colorization::colorize(s, linear, d, l, saturation);
    }
    if let Some(s) = &style.black_flats {
        let slope = taps::slope(view, x, y) + nudge;
        let dark = black_flats::dark_area(s, source.map(|c| c - nudge), l);
        let steep = black_flats::steep_area(s, slope, view.viewport[3]);
        linear = black_flats::fill(s, linear, dark.max(steep));
    }
    if let Some(s) = &style.contours {
        let threshold = s.threshold - nudge as f32;
        let [coverage, near] =
            taps::contour(&bevy_comics::Contours { threshold, ..*s }, view, x, y, 1.0);
        linear = contours::draw(s, linear, coverage, near);
    }
    linear
}
