//! Reference of `effects/paint/paint.wgsl`.

use std::f64::consts::{PI, TAU};

use bevy_comics::{Paint, effects::PaintKernel};

use super::{
    Rgb, Rgba,
    box_statistics::{Means, Sheet, means, part_of_box, root, square},
    color, mix,
};

/// Variance that is not seen.
const UNSEEN: f64 = 1e-4;
const SAMPLES: u32 = 64;

/// What is painted, by column and row of the viewport.
pub struct Scene<'a> {
    pub sheet: &'a Sheet,
    /// The depth map, 0 to 1.
    pub depth: &'a dyn Fn([usize; 2]) -> f64,
    /// Ids of objects.
    pub id: &'a dyn Fn([usize; 2]) -> u32,
    /// Physical pixels per logical pixel.
    pub scale: f64,
}

/// An area around a pixel: its means, and its weight before its variance counts.
pub type Area = (Means, f64);

/// The color of the areas by their weights and variances; `None` if there are none.
pub fn chosen(areas: &[Area], sharpness: f64) -> Option<Rgb> {
    let seen = |m: &Means| m.variance() + UNSEEN;
    let used = || areas.iter().filter(|(_, factor)| *factor > 0.0);
    let least = used().map(|(m, _)| seen(m)).reduce(f64::min)?;
    let weight = |(m, factor): &Area| factor * (least / seen(m)).powf(0.5 * sharpness);
    let sum: f64 = used().map(weight).sum();
    Some(std::array::from_fn(|i| {
        let color: f64 = used().map(|area| weight(area) * area.0.color[i]).sum();
        square(color / sum)
    }))
}

impl Scene<'_> {
    fn radius(&self, s: &Paint, at: [usize; 2]) -> f64 {
        let depth = (self.depth)(at).clamp(0.0, 1.0);
        mix(f64::from(s.at_near), f64::from(s.at_far), depth) * self.scale
    }

    fn figure_factor(&self, s: &Paint, own: [usize; 2], other: [i64; 2]) -> f64 {
        let same = !s.figures || (self.id)(own) == (self.id)(other.map(|v| v as usize));
        if same { 1.0 } else { 0.125 }
    }

    /// The picture after the effect.
    pub fn painted(&self, s: &Paint) -> Sheet {
        let half = |at| 0.5 * self.radius(s, at);
        let boxes = match s.kernel {
            PaintKernel::Box => means(self.sheet, &half),
            _ => Vec::new(),
        };
        Sheet::new(self.sheet.size, |at| {
            let factor = |other| self.figure_factor(s, at, other);
            let areas = match s.kernel {
                PaintKernel::Box => box_areas(self.sheet, &boxes, at, half(at), &factor),
                _ => self.sectors(s, at),
            };
            over(
                self.sheet.at(at),
                chosen(&areas, f64::from(s.sharpness)),
                f64::from(s.amount),
            )
        })
    }

    /// The sectors of the ellipse around a pixel.
    fn sectors(&self, s: &Paint, at: [usize; 2]) -> Vec<Area> {
        let radius = self.radius(s, at);
        let edge = edge(tensor(self.sheet, at));
        let stretch = 1.0 + edge[2];
        let long = [edge[0], edge[1]].map(|v| v * radius * stretch);
        let short = [-edge[1], edge[0]].map(|v| v * radius / stretch);
        let center = at.map(|v| v as f64 + 0.5);
        let place = |[x, y]: [f64; 2]| [0, 1].map(|i| center[i] + x * long[i] + y * short[i]);
        let disc: Vec<_> = (0..SAMPLES)
            .map(|i| {
                let angle = f64::from(i) * PI * (3.0 - 5f64.sqrt());
                let length = ((f64::from(i) + 0.5) / f64::from(SAMPLES)).sqrt();
                let at = [angle.cos() * length, angle.sin() * length];
                (at, Means::of(self.sheet.between(place(at))))
            })
            .collect();
        let sector = |k: u32| {
            let angle = f64::from(k) * TAU / 8.0;
            let direction = [angle.cos(), angle.sin()];
            let weight = |at| sector_weight(at, direction);
            let whole = disc.iter().map(|(at, _)| weight(*at)).sum();
            let m = Means::mean(disc.iter().map(|(at, m)| (weight(*at), *m)), whole);
            let middle = place(direction.map(|v| 0.5 * v)).map(|v| v.floor() as i64);
            let factor = if self.sheet.contains(middle) {
                self.figure_factor(s, at, middle)
            } else {
                1.0
            };
            (m, m.coverage * factor)
        };
        (0..8).map(sector).collect()
    }
}

/// The boxes around a pixel, at both whole distances around half the radius. `boxes`: the means
/// around every pixel; `factor`: the factor for a box with its middle in another pixel.
pub fn box_areas(
    sheet: &Sheet,
    boxes: &[Means],
    at: [usize; 2],
    half: f64,
    factor: &dyn Fn([i64; 2]) -> f64,
) -> Vec<Area> {
    let low = half.floor();
    let mut areas = Vec::new();
    for (distance, part) in [(low, 1.0 - (half - low)), (low + 1.0, half - low)] {
        for k in (0..9).filter(|k| *k != 4) {
            let by = [k % 3 - 1, k / 3 - 1].map(|v| v * distance as i64);
            let other = [at[0] as i64 + by[0], at[1] as i64 + by[1]];
            if sheet.contains(other) {
                let m = boxes[other[1] as usize * sheet.size[0] + other[0] as usize];
                let reaches = reaching_fraction(m.half, half, distance as i64);
                areas.push((m, part * m.coverage * reaches * factor(other)));
            }
        }
    }
    areas
}

/// The factor for a box of half a side of `found` instead of `half`: how much of the pixel, at
/// this distance, it contains, of what it should.
fn reaching_fraction(found: f64, half: f64, distance: i64) -> f64 {
    (part_of_box(found, distance) / part_of_box(half, distance).max(1e-6)).min(1.0)
}

/// Paint over a pixel.
fn over(pixel: Rgba, paint: Option<Rgb>, amount: f64) -> Rgba {
    let Some(paint) = paint else {
        return pixel;
    };
    let alpha = pixel[3];
    let mixed = |i: usize| mix(pixel[i], paint[i] * alpha, amount * alpha);
    [mixed(0), mixed(1), mixed(2), alpha]
}

/// The weight of a place of the unit disc in the sector of this direction.
fn sector_weight([x, y]: [f64; 2], direction: [f64; 2]) -> f64 {
    const ZETA: f64 = 1.0 / 3.0;
    let gamma = 3.0 * PI / 16.0;
    let eta = (ZETA + gamma.cos()) / gamma.sin().powi(2);
    let along = x * direction[0] + y * direction[1];
    let across = x * direction[1] - y * direction[0];
    let inside = (along + ZETA - eta * across * across).max(0.0);
    inside * inside * (-3.125 * (x * x + y * y)).exp()
}

/// The structure tensor around a pixel: Sobel, smoothed over 3 x 3 pixels.
fn tensor(sheet: &Sheet, at: [usize; 2]) -> [f64; 3] {
    let luminance = |x: i64, y: i64| {
        let [r, g, b, _] = sheet.nearest([x, y]);
        color::luminance([r, g, b].map(root))
    };
    let [x, y] = at.map(|v| v as i64);
    let near = || (-1i64..=1).flat_map(|dy| (-1i64..=1).map(move |dx| (dx, dy)));
    let mut sum = [0.0; 3];
    for (dx, dy) in near() {
        let mut slope = [0.0; 2];
        for (i, j) in near() {
            let found = luminance(x + dx + i, y + dy + j);
            slope[0] += 0.125 * (i * (2 - j.abs())) as f64 * found;
            slope[1] += 0.125 * (j * (2 - i.abs())) as f64 * found;
        }
        let weight = ((2 - dx.abs()) * (2 - dy.abs())) as f64 / 16.0;
        sum[0] += weight * slope[0] * slope[0];
        sum[1] += weight * slope[0] * slope[1];
        sum[2] += weight * slope[1] * slope[1];
    }
    sum
}

/// Unit vector along the edge in a tensor, and how much of an edge it is.
fn edge([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let spread = (0.5 * (xx - yy)).hypot(xy);
    let certain = spread / (0.5 * (xx + yy) + UNSEEN);
    if spread < 1e-30 {
        return [-1.0, 0.0, certain];
    }
    // Half the angle of the tensor is the angle across the edge, to the right or down.
    let across = 0.5 * xy.atan2(0.5 * (xx - yy));
    let side = if xx <= yy && across < 0.0 { -1.0 } else { 1.0 };
    [-side * across.sin(), side * across.cos(), certain]
}
