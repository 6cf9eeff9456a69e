//! Reference of `effect/sheet.wgsl` and `lines/modifiers/sheet.wgsl`: the surface of the sheet, and
//! ink on it.

use std::f64::consts::PI;

use bevy_comics::Paper;

use super::{mix, noise::wave, smoothstep};

/// Height of the sheet, -1 to 1, at a place in units of the grain.
pub fn height(at: [f64; 2], sheet: u32) -> f64 {
    let first = 0x7061_7065 + 3 * sheet;
    // Value noise whose grid is turned by an angle with this cosine and sine.
    let octave = |[cos, sin]: [f64; 2], period: f64, seed: u32| {
        let [x, y] = at;
        wave(
            [(cos * x - sin * y) / period, (sin * x + cos * y) / period],
            seed,
        )
    };
    let fine = octave([0.8, 0.6], 1.5, first);
    let middle = octave([5.0 / 13.0, 12.0 / 13.0], 4.0, first + 1);
    let coarse = octave([15.0 / 17.0, 8.0 / 17.0], 12.0, first + 2);
    (fine + 0.6 * middle + 0.4 * coarse).clamp(-1.0, 1.0)
}

/// Fraction of the ink that the bristles of a brush leave.
pub fn bristles(dry: f64, noise: f64) -> f64 {
    smoothstep(1.6 * dry - 1.3, 1.6 * dry - 0.7, noise)
}

/// A sheet that ink is on.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// Width in physical pixels of the band in which edges vary.
    pub ink_bleed: f64,
    pub dry_brush: f64,
    /// Physical pixels per place on the sheet.
    pub grain: f64,
    /// Physical pixels per logical pixel.
    pub unit: f64,
    pub seed: u32,
}

impl Sheet {
    /// Smooth and wet.
    pub const SMOOTH: Self = Self {
        ink_bleed: 0.0,
        dry_brush: 0.0,
        grain: 1.0,
        unit: 1.0,
        seed: 0,
    };

    /// The sheet of an effect at a scale factor.
    pub fn new(paper: &Paper, scale: f64, seed: u32) -> Self {
        Self {
            ink_bleed: f64::from(paper.amount) * f64::from(paper.ink_bleed) * scale,
            dry_brush: f64::from(paper.amount) * f64::from(paper.dry_brush),
            grain: f64::from(paper.size) * scale,
            unit: scale,
            seed,
        }
    }

    /// The sheet under a place of the render target.
    pub fn under(self, place: [f64; 2]) -> Spot {
        Spot {
            sheet: self,
            place,
            height: height(place.map(|v| v / self.grain), self.seed),
        }
    }

    /// The largest half width of a line anywhere. `half_width`: on a smooth sheet.
    pub fn largest(&self, half_width: f64) -> f64 {
        half_width + (0.5 * self.ink_bleed).min(0.75 * half_width)
    }

    /// Noise that is stretched along one of 16 directions.
    fn streak(&self, place: [f64; 2], number: u32) -> f64 {
        let (sin, cos) = (f64::from(number) / 16.0 * PI).sin_cos();
        let along = place[0] * cos + place[1] * sin;
        let across = place[1] * cos - place[0] * sin;
        let at = [along / 12.8, across / 1.6].map(|v| v / self.unit);
        wave(at, 0x6472_7962 + 16 * self.seed + number)
    }
}

/// A place on a sheet.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    pub sheet: Sheet,
    /// In the render target.
    pub place: [f64; 2],
    pub height: f64,
}

impl Spot {
    /// A place on a smooth sheet.
    pub const SMOOTH: Self = Self {
        sheet: Sheet::SMOOTH,
        place: [0.0; 2],
        height: 0.0,
    };

    /// Half the width with which a line covers the place: wider in valleys.
    pub fn half_width(&self, half_width: f64) -> f64 {
        half_width - (self.sheet.largest(half_width) - half_width) * self.height
    }

    /// Fraction of the ink of a line that a dry brush leaves. `along`: its direction.
    pub fn dry_ink(&self, [x, y]: [f64; 2], half_width: f64) -> f64 {
        let Sheet {
            dry_brush, unit, ..
        } = self.sheet;
        let wide = smoothstep(3.0, 6.0, 2.0 * half_width / unit);
        if wide == 0.0 || dry_brush == 0.0 {
            return 1.0;
        }
        let turn = (y.atan2(x) / PI * 16.0).rem_euclid(16.0);
        let first = turn.floor();
        // Only in the middle half between two directions, their streaks are mixed.
        let part = (2.0 * (turn - first) - 0.5).clamp(0.0, 1.0);
        let of = |number: f64| self.sheet.streak(self.place, number as u32 % 16);
        let noise = mix(of(first), of(first + 1.0), part) / part.hypot(1.0 - part);
        mix(
            1.0,
            bristles(dry_brush, noise),
            wide * (5.0 * dry_brush).min(1.0),
        )
    }
}
