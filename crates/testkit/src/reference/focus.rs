//! Reference of `effects/focus/focus.wgsl`.

use std::f64::consts::PI;

use bevy::color::Color;
use bevy_comics::{
    Focus, Halftone,
    effects::{FocusStyle, ScreenShape},
};

use super::{
    Rgb,
    box_statistics::{Sheet, means},
    halftone::{Plate, inked, plate_cover, plate_tones},
    mix,
    paint::{box_areas, chosen},
    smoothstep,
};

/// Distance of the sky.
pub const SKY: f64 = 1e30;

/// What is out of focus, by column and row of the viewport.
pub struct Scene<'a> {
    pub sheet: &'a Sheet,
    /// The nearest distance along the view's axis that a pixel shows.
    pub distance: &'a dyn Fn([usize; 2]) -> f64,
    /// Distance of the focus.
    pub focus_at: f64,
    /// In an orthographic view: the length that distances are measured in.
    pub reference: Option<f64>,
    /// Physical pixels per logical pixel.
    pub scale: f64,
    /// Factor of all radii, to see how far rounding can move the picture.
    pub nudge: f64,
}

/// Radius in logical pixels by which something at a distance is out of focus.
fn defocus(s: &Focus, distance: f64, focus_at: f64, reference: Option<f64>) -> f64 {
    let apart = match reference {
        Some(length) => (distance - focus_at).abs() / length,
        None => (distance / focus_at).ln().abs(),
    };
    let t = (apart - f64::from(s.clear)) / f64::from(s.ramp);
    f64::from(s.radius) * smoothstep(0.0, 1.0, t)
}

/// The part that may be taken from another pixel. Distances and radii.
fn taken(own: [f64; 2], other: [f64; 2]) -> f64 {
    if other[0] >= own[0] {
        1.0
    } else {
        (other[1] / own[1].max(1e-6)).clamp(0.0, 1.0)
    }
}

impl Scene<'_> {
    fn focus_of(&self, s: &Focus, at: [usize; 2]) -> [f64; 2] {
        let distance = (self.distance)(at);
        let radius = defocus(s, distance, self.focus_at, self.reference);
        [distance, radius * self.scale * self.nudge]
    }

    fn inside(&self, at: [i64; 2]) -> [usize; 2] {
        [0, 1].map(|i| at[i].clamp(0, self.sheet.size[i] as i64 - 1) as usize)
    }

    /// The picture after the effect.
    pub fn focused(&self, s: &Focus) -> Sheet {
        // Whole pixels.
        let half = |at| (0.5 * self.focus_of(s, at)[1] + 0.5).floor();
        let boxes = match s.style {
            FocusStyle::Paint => means(self.sheet, &half),
            _ => Vec::new(),
        };
        Sheet::new(self.sheet.size, |at| {
            let pixel = self.sheet.at(at);
            let own = self.focus_of(s, at);
            let alpha = pixel[3];
            if own[1] <= 0.0 || alpha <= 0.0 {
                return pixel;
            }
            let straight = [0, 1, 2].map(|c| pixel[c] / alpha);
            let color = match s.style {
                FocusStyle::Dots => Some(self.dotted(s, at, own[1], straight)),
                FocusStyle::Lines => Some(straight),
                FocusStyle::Offset => Some(self.offset(s, at, own, straight)),
                FocusStyle::Paint => {
                    let areas = box_areas(self.sheet, &boxes, at, half(at), &|_| 1.0);
                    chosen(&areas, 8.0)
                }
                _ => self.blurred(s, at, own),
            };
            let color = color.unwrap_or(straight);
            [color[0] * alpha, color[1] * alpha, color[2] * alpha, alpha]
        })
    }

    fn blurred(&self, s: &Focus, at: [usize; 2], own: [f64; 2]) -> Option<Rgb> {
        let count = 12 + own[1].floor() as u32;
        let mut sum = [0.0; 4];
        for i in 0..count {
            let angle = f64::from(i) * PI * (3.0 - 5f64.sqrt());
            let by = own[1] * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
            let step = [angle.cos(), angle.sin()].map(|v| (by * v + 0.5).floor() as i64);
            let other = self.inside([at[0] as i64 + step[0], at[1] as i64 + step[1]]);
            let there = self.focus_of(s, other);
            let weight = smoothstep(by - 1.0, by + 1.0, there[1]) * taken(own, there);
            for (sum, found) in sum.iter_mut().zip(self.sheet.at(other)) {
                *sum += weight * found;
            }
        }
        (sum[3] > 0.0).then(|| [0, 1, 2].map(|c| sum[c] / sum[3]))
    }

    fn offset(&self, s: &Focus, at: [usize; 2], own: [f64; 2], instead: Rgb) -> Rgb {
        let [_, green, _] = instead;
        let red = self.taken_along(s, at, 1.0, own, instead)[0];
        let blue = self.taken_along(s, at, -1.0, own, instead)[2];
        [red, green, blue]
    }

    /// In ideal inks on white paper.
    fn dotted(&self, s: &Focus, at: [usize; 2], radius: f64, linear: Rgb) -> Rgb {
        let whole = (f64::from(s.radius) / 6.0).min(1.0);
        let amount = whole * radius / (f64::from(s.radius) * self.scale);
        let halftone = Halftone {
            cell_size: s.cell_size,
            cyan: Color::srgb(0.0, 1.0, 1.0),
            magenta: Color::srgb(1.0, 0.0, 1.0),
            yellow: Color::srgb(1.0, 1.0, 0.0),
            black: Color::BLACK,
            paper: Color::WHITE,
            ..Halftone::default()
        };
        let place = [0, 1].map(|i| at[i] as f64 + 0.25 - (self.sheet.size[i] / 2) as f64);
        let tones = plate_tones(&halftone, linear);
        let plates = Plate::all(&halftone, self.scale);
        let covers = std::array::from_fn(|i| {
            let cover = plate_cover(ScreenShape::Euclidean, plates[i], tones[i], &|_, _| 0.5);
            mix(tones[i], cover(place), amount)
        });
        inked(&halftone, covers)
    }

    /// Between the places at both whole distances along the diagonal.
    fn taken_along(
        &self,
        s: &Focus,
        at: [usize; 2],
        side: f64,
        own: [f64; 2],
        instead: Rgb,
    ) -> Rgb {
        let low = own[1].floor();
        let taken = |by: f64| {
            let step = [0.8, 0.6].map(|v| (side * by * v + 0.5).floor() as i64);
            let other = self.inside([at[0] as i64 + step[0], at[1] as i64 + step[1]]);
            let found = self.sheet.at(other);
            let fraction = taken(own, self.focus_of(s, other));
            [0, 1, 2].map(|c| {
                let color = found[c] + (1.0 - found[3]) * instead[c];
                mix(instead[c], color, fraction)
            })
        };
        let (near, far) = (taken(low), taken(low + 1.0));
        [0, 1, 2].map(|c| mix(near[c], far[c], own[1] - low))
    }
}
