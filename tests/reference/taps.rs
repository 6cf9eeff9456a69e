//! Twin of `stylize/taps.wgsl`: neighbourhoods, rings and samples.

use super::{
    bindings::View,
    contours::{self, Window},
    mix,
};
use bevy_comics::{ContourForm, ContourOperator, Contours};

pub fn pixel_depth(view: &View, x: u32, y: u32) -> [f64; 2] {
    let n = f64::from(view.samples);
    let maps = (0..view.samples).map(|s| view.frame.depth_map(view.depth(x, y, s)));
    let sum = maps.fold([0.0; 2], |a, m| [a[0] + m[0], a[1] + m[1]]);
    sum.map(|v| v / n)
}

pub fn window(view: &View, x: u32, y: u32, reach: u32, sample: u32) -> Window {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    let (x, y, reach) = (i64::from(x), i64::from(y), i64::from(reach));
    let column = |i: i64| (x + i * reach).clamp(x0, x0 + w - 1) as u32;
    let row = |j: i64| (y + j * reach).clamp(y0, y0 + h - 1) as u32;
    Window {
        depths: [-1, 0, 1].map(|j| [-1, 0, 1].map(|i| view.depth(column(i), row(j), sample))),
        missing: [
            x - reach < x0,
            x + reach >= x0 + w,
            y - reach < y0,
            y + reach >= y0 + h,
        ],
    }
}

fn ring_line(s: &Contours, view: &View, at: [u32; 2], reach: u32, sample: u32) -> [f64; 2] {
    let mut found = [0.0f64; 2];
    let mut r = reach;
    while r > 0 {
        let win = window(view, at[0], at[1], r, sample);
        let line = contours::line(s, contours::response(s, &view.frame, &win));
        let nearest = win.depths.iter().flatten().copied().fold(0.0, f64::max);
        found = [found[0].max(line), found[1].max(nearest)];
        r = r.saturating_sub(2);
    }
    found
}

/// (coverage, D of the nearer side). `scale`: physical pixels a logical one.
pub fn contour(s: &Contours, view: &View, x: u32, y: u32, scale: f64) -> [f64; 2] {
    let radius = (0.5 * f64::from(s.width) * scale).clamp(0.125, 64.0);
    let (whole, part) = (radius.floor() as u32, radius.fract());
    let found = if view.samples > 1 {
        let n = f64::from(view.samples);
        (0..view.samples).fold([0.0, 0.0f64], |found, i| {
            let wider = part * n > f64::from(i) + 0.5;
            let one = ring_line(s, view, [x, y], whole + u32::from(wider), i);
            [found[0] + one[0] / n, found[1].max(one[1])]
        })
    } else {
        let inner = ring_line(s, view, [x, y], whole, 0);
        if part > 0.0 {
            let outer = ring_line(s, view, [x, y], whole + 1, 0);
            [
                mix(inner[0], inner[0].max(outer[0]), part),
                inner[1].max(outer[1]),
            ]
        } else {
            inner
        }
    };
    [found[0], view.frame.depth_map(found[1])[0]]
}

/// The Prewitt response of the plain depth map.
pub fn slope(view: &View, x: u32, y: u32) -> f64 {
    let prewitt = Contours {
        operator: ContourOperator::Prewitt,
        form: ContourForm::Faithful,
        ..Contours::default()
    };
    let mut frame = view.frame;
    frame.sky_gap = 0.0;
    contours::response(&prewitt, &frame, &window(view, x, y, 1, 0))
}
