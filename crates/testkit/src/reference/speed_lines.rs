//! Reference of `effects/speed_lines/speed_lines.wgsl`. It adds up all lines, not only those of
//! three cells.

use std::f64::consts::TAU;

use bevy_comics::{SpeedLines, effects::SpeedLineKind};

use super::{
    edge::line_coverage,
    noise::{hash, wave},
    sheet::bristles,
};

/// One drawing of the lines.
pub struct Drawing {
    pub settings: SpeedLines,
    /// Of the viewport, physical pixels.
    pub size: [f64; 2],
    /// Physical pixels per logical pixel.
    pub scale: f64,
    /// The point, physical pixels from the viewport's top left corner.
    pub center: [f64; 2],
    /// Number of the drawing.
    pub number: u32,
}

fn three(h: u32) -> [f64; 3] {
    [
        f64::from(h & 2047) / 2047.0,
        f64::from((h >> 11) & 2047) / 2047.0,
        f64::from(h >> 22) / 1023.0,
    ]
}

fn place_in_cell(random: f64) -> f64 {
    0.1 + 0.8 * random
}

impl Drawing {
    fn seed(&self) -> u32 {
        (self.settings.seed << 16) | self.number
    }

    fn axis(&self) -> [f64; 2] {
        let (sin, cos) = f64::from(self.settings.angle).to_radians().sin_cos();
        [cos, -sin]
    }

    /// Half axes of the ellipse that stays clear.
    fn hole(&self) -> [f64; 2] {
        let inner = f64::from(self.settings.inner);
        self.size.map(|v| (0.5 * inner * v).max(1e-3))
    }

    /// From the point to the farthest corner, or to its place along the lines.
    pub fn far(&self) -> f64 {
        let [x, y] = [0, 1].map(|i| {
            let c = self.center[i];
            c.abs().max((self.size[i] - c).abs())
        });
        let axis = self.axis();
        match self.settings.kind {
            SpeedLineKind::Radial => x.hypot(y),
            _ => x * axis[0].abs() + y * axis[1].abs(),
        }
    }

    fn half_width(&self, random: f64, at: f64, inner: f64, cell: f64) -> f64 {
        let grown = ((at - inner) / (self.far() - inner).max(1.0)).clamp(0.0, 1.0);
        let widest = 0.5 * f64::from(self.settings.width) * self.scale;
        let full = widest * (0.2 + 0.8 * random * random);
        (full * grown).min((1.1 * cell - 0.5).max(0.0))
    }

    /// The direction of a radial line as a fraction of a turn, and half its width where the
    /// ellipse's border is at the distance `hole`.
    pub fn radial(&self, line: u32, rho: f64, hole: f64) -> [f64; 2] {
        let count = f64::from(self.settings.count);
        let own = three(hash(line ^ hash(self.seed())));
        let group = three(hash((line / 3) ^ hash(!self.seed())));
        let inner = hole * (1.0 + 0.5 * own[1] * (0.4 + 1.2 * group[0]));
        let turn = (f64::from(line) + place_in_cell(own[0])) / count;
        [turn, self.half_width(own[2], rho, inner, TAU * rho / count)]
    }

    /// Distance of the ellipse's border in the direction of a place from the center.
    pub fn border(&self, [x, y]: [f64; 2]) -> f64 {
        let hole = self.hole();
        x.hypot(y) / (x / hole[0]).hypot(y / hole[1]).max(1e-6)
    }

    /// Fraction of a line that a dry brush leaves.
    fn dry_ink(&self, seed: u32, along: f64, across: f64) -> f64 {
        let dry = f64::from(self.settings.dry_brush);
        if dry == 0.0 {
            return 1.0;
        }
        let at = [along / (60.0 * self.scale), across / (1.6 * self.scale)];
        bristles(dry, wave(at, seed))
    }

    fn radial_coverage(&self, [x, y]: [f64; 2]) -> f64 {
        let rho = x.hypot(y);
        let turn = (y.atan2(x) / TAU + 0.5).rem_euclid(1.0);
        let hole = self.border([x, y]);
        (0..self.settings.count)
            .map(|line| {
                let [own, half_width] = self.radial(line, rho, hole);
                // The shorter way around.
                let apart = (turn - own + 0.5).rem_euclid(1.0) - 0.5;
                if apart.abs() > 0.2 {
                    return 0.0;
                }
                let across = rho * (apart * TAU).sin();
                let seed = hash(line ^ hash(self.seed()));
                line_coverage(across.abs(), half_width) * self.dry_ink(seed, rho, across)
            })
            .sum()
    }

    fn parallel_coverage(&self, [x, y]: [f64; 2]) -> f64 {
        let [ax, ay] = self.axis();
        let hole = self.hole();
        let along_axis = (hole[0] * ax).hypot(hole[1] * ay);
        let across_axis = (hole[0] * ay).hypot(hole[1] * ax);
        let across = self.size[0] * ay.abs() + self.size[1] * ax.abs();
        let spacing = across / f64::from(self.settings.count);
        let (along, v) = (x * ax + y * ay, ax * y - ay * x);
        let nearest = (v / spacing).floor() as i32;
        (nearest - 4..=nearest + 4)
            .map(|line| {
                let h = hash(line as u32 ^ hash(self.seed()));
                let (own, other) = (three(h), three(hash(h)));
                let middle = (f64::from(line) + place_in_cell(own[0])) * spacing;
                let y = middle / across_axis;
                let hole = along_axis * (1.0 - y * y).max(0.0).sqrt() * (1.0 + 0.4 * other[1]);
                let free = self.far() * (1.8 * own[1] - 1.0);
                let inner = if hole > 0.0 { free.max(hole) } else { free };
                let at = if other[0] < 0.5 { -along } else { along };
                let half_width = self.half_width(own[2], at, inner, spacing);
                let by = v - middle;
                line_coverage(by.abs(), half_width) * self.dry_ink(h, along, by)
            })
            .sum()
    }

    /// Coverage of the lines at a place of the viewport.
    pub fn coverage(&self, at: [f64; 2]) -> f64 {
        let d = [at[0] - self.center[0], at[1] - self.center[1]];
        let sum = match self.settings.kind {
            SpeedLineKind::Radial => self.radial_coverage(d),
            _ => self.parallel_coverage(d),
        };
        sum.min(1.0)
    }
}
