//! How well paint and focus keep to what they paint. Computed with the shaders' references, which
//! every pixel of a picture equals.

use bevy_comics::{
    Focus, Paint,
    effects::{FocusAt, FocusStyle, PaintKernel},
};

use crate::reference::{
    Rgb,
    box_statistics::{Means, Sheet, means, square},
    color, focus, noise,
    paint::{Scene, box_areas, chosen},
};

/// Number `i` of a sequence without order, 0 to 1.
pub fn random(i: usize) -> f64 {
    f64::from(noise::hash(i as u32) >> 8) / f64::from(1 << 24)
}

/// A sheet of random colors.
pub fn noisy(size: [usize; 2]) -> Sheet {
    Sheet::new(size, |[x, y]| {
        let of = |c: usize| random(3 * (y * size[0] + x) + c);
        [of(0), of(1), of(2), 1.0]
    })
}

/// The pixels of a quadrant of Kuwahara's filter (1976). `side`: 1 or -1 by axis.
pub fn quadrant(sheet: &Sheet, at: [i64; 2], side: [i64; 2], radius: i64) -> Vec<Means> {
    let places = (0..=radius).flat_map(|j| (0..=radius).map(move |i| [i, j]));
    let pixel = |[i, j]: [i64; 2]| sheet.nearest([at[0] + side[0] * i, at[1] + side[1] * j]);
    places.map(|place| Means::of(pixel(place))).collect()
}

/// The signs of the four quadrants, in the order of their boxes.
pub const QUADRANTS: [[i64; 2]; 4] = [[-1, -1], [1, -1], [-1, 1], [1, 1]];

/// Kuwahara's filter (1976) at a pixel, from the pixels: the mean of the quadrant whose luminance
/// varies least.
fn classic(sheet: &Sheet, at: [i64; 2], radius: i64) -> Rgb {
    let areas = QUADRANTS.map(|side| {
        let pixels = quadrant(sheet, at, side, radius);
        let count = pixels.len() as f64;
        let mean = |c: usize| pixels.iter().map(|m| m.color[c]).sum::<f64>() / count;
        let color = [0, 1, 2].map(mean);
        let apart = |m: &Means| (color::luminance(m.color) - color::luminance(color)).powi(2);
        (pixels.iter().map(apart).sum::<f64>() / count, color)
    });
    let best = areas.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or([0.0; 3], |(_, color)| color.map(square))
}

/// The largest difference, in linear light, of Kuwahara's filter from the same filter with means
/// over boxes in place of its quadrants, on noise. Even radii.
pub fn kuwahara_error(radius: usize) -> f64 {
    let sheet = noisy([26, 22]);
    let half = (radius / 2) as f64;
    let boxes = means(&sheet, &|_| half);
    let inside = |size: usize| radius..size - radius;
    let places = inside(22).flat_map(|y| inside(26).map(move |x| [x, y]));
    let apart = places.map(|at| {
        // Without the boxes beside, above and below the pixel, which Kuwahara does not have; as
        // sharp as his choice.
        let around = box_areas(&sheet, &boxes, at, half, &|_| 1.0);
        let corners = [0, 2, 5, 7].map(|i| around[i]);
        let boxed = chosen(&corners, 1e6).unwrap_or_default();
        let want = classic(&sheet, at.map(|v| v as i64), radius as i64);
        (0..3)
            .map(|c| (boxed[c] - want[c]).abs())
            .fold(0.0, f64::max)
    });
    apart.fold(0.0, f64::max)
}

/// How far paint moves an anti-aliased edge that moves by `slope` pixels to the right in each row:
/// pixels across the edge, on the mean of its rows, measured as they are seen, in square roots of
/// light.
pub fn edge_moved(form: PaintKernel, radius: f32, slope: f64) -> f64 {
    // Coverage of a pixel beside the edge, as 8 x 8 samples.
    let coverage = |[x, y]: [usize; 2]| {
        let inside = (0..64).filter(|i| {
            let [i, j] = [i % 8, i / 8].map(|v| (f64::from(v) + 0.5) / 8.0);
            x as f64 + i > 20.0 + slope * (y as f64 + j - 20.0)
        });
        inside.count() as f64 / 64.0
    };
    let sheet = Sheet::new([40, 40], |at| {
        let light = 0.1 + 0.7 * coverage(at);
        [light, light, light, 1.0]
    });
    let contrast = 0.8f64.sqrt() - 0.1f64.sqrt();
    let s = Paint {
        kernel: form,
        at_near: radius,
        at_far: radius,
        ..Paint::default()
    };
    let scene = Scene {
        sheet: &sheet,
        depth: &|_| 0.0,
        id: &|_| 0,
        scale: 1.0,
    };
    let painted = scene.painted(&s);
    let rows = 10..30;
    let moved: f64 = rows
        .clone()
        .flat_map(|y| (0..40).map(move |x| [x, y]))
        .map(|at| (painted.at(at)[1].sqrt() - sheet.at(at)[1].sqrt()) / contrast)
        .sum();
    // Across the edge, not along the row.
    moved / rows.len() as f64 / slope.hypot(1.0)
}

/// Slopes and radii for [`edge_moved`].
pub const SLOPES: [f64; 4] = [0.0, 0.1, 0.37, 0.8];
pub const RADII: [f32; 3] = [2.0, 4.0, 6.5];

/// The most light of a red figure in focus that is seen outside of it, before stripes of blue and
/// green that are out of focus.
pub fn bled(style: FocusStyle) -> f64 {
    let figure = |[x, y]: [usize; 2]| (16..32).contains(&x) && (9..23).contains(&y);
    let sheet = Sheet::new([48, 32], |at| match at[0] / 3 % 2 {
        _ if figure(at) => [1.0, 0.0, 0.0, 1.0],
        0 => [0.0, 1.0, 0.0, 1.0],
        _ => [0.0, 0.0, 1.0, 1.0],
    });
    let s = Focus {
        at: FocusAt::Distance,
        style,
        distance: 5.0,
        radius: 8.0,
        ..Focus::default()
    };
    let scene = focus::Scene {
        sheet: &sheet,
        distance: &|at| if figure(at) { 5.0 } else { 80.0 },
        focus_at: 5.0,
        reference: None,
        scale: 1.0,
        nudge: 1.0,
    };
    let focused = scene.focused(&s);
    let outside = (0..48 * 32)
        .map(|i| [i % 48, i / 48])
        .filter(|at| !figure(*at));
    outside.map(|at| focused.at(at)[0]).fold(0.0, f64::max)
}
