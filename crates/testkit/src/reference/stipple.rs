//! Reference of `effect/stipple.wgsl`.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use bevy::math::{DVec2, DVec3};
use bevy_comics::Hatching;

use super::{
    footprint::singular_values,
    hatching::Surface,
    mix,
    nested::{coordinate, level_of, mark_of_node},
    smoothstep,
};

/// Darkness of a layer at which the next one begins.
fn layer_darkness(s: &Hatching) -> f64 {
    f64::from(s.layer_darkness).clamp(0.3, 0.5)
}

/// Radius of all dots. `spacing`: in pixels.
pub fn dot_radius(s: &Hatching, spacing: f64) -> f64 {
    spacing * (layer_darkness(s) / PI).sqrt()
}

/// Coverage of a pixel by a disc of a plane.
pub fn disc_coverage(away: DVec2, right: DVec2, down: DVec2, radius: f64) -> f64 {
    let [wide, _] = singular_values(right, down);
    let edge = (right.length_squared() + down.length_squared()) / 24.0;
    let drawn = (radius * radius - edge).max(0.0).sqrt().max(0.5 * wide);
    let outwards = away.try_normalize().unwrap_or(DVec2::X);
    let change = right.dot(outwards).hypot(down.dot(outwards));
    let strength = (radius * radius / (drawn * drawn + edge)).min(1.0);
    strength * (0.5 + (drawn - away.length()) / change).clamp(0.0, 1.0)
}

/// Dots of a drawing. `spacing`: in pixels.
pub struct Dots<'a> {
    pub settings: &'a Hatching,
    pub spacing: f64,
    pub drawing: u32,
}

impl Dots<'_> {
    fn lattice(&self, on: &Surface, [u, v]: [DVec3; 2], seed: u32, tone: f64) -> f64 {
        let s = self.settings;
        let on_plane = |by: DVec3| DVec2::new(u.dot(by), v.dot(by));
        let [right, down] = [on.across, on.down].map(on_plane);
        let [long, short] = singular_values(right, down);
        let pixel = (long * short).sqrt();
        let radius = dot_radius(s, self.spacing);
        let distance = radius * (PI / tone).sqrt();
        let (exponent, grown) = level_of(distance * pixel);
        // How many dots there are for each old one: from 1 to 4.
        let count = (1.0 + grown).powi(2);
        let fine = 0.5 * f64::from(exponent).exp2();
        let place = DVec2::from(on_plane(on.place).to_array().map(coordinate));
        let spread = (0.6 * f64::from(s.pressure)).min(0.589 / tone - 1.0);
        let first = (place / fine).floor();
        let cover: f64 = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE]
            .into_iter()
            .map(|corner| {
                let node = first + corner;
                let [i, j] = [node.x as i64, node.y as i64];
                let fraction = match (i & 1, j & 1) {
                    (0, 0) => 1.0,
                    (1, 1) => count - 1.0,
                    (1, _) => count - 2.0,
                    _ => count - 3.0,
                };
                let mark = mark_of_node([i, j], exponent - 1, seed ^ self.drawing);
                let number = |bits: u32, most: u32| 2.0 * f64::from(bits) / f64::from(most) - 1.0;
                let area = 1.0 + spread * number(mark >> 20, 4095);
                let direction =
                    DVec2::new(number(mark & 1023, 1023), number(mark >> 10 & 1023, 1023));
                let full = radius * pixel * area.sqrt();
                let apart = 0.5 * distance * pixel;
                let most = (0.866 * apart).min(apart - 0.5 * long) - full.max(0.5 * long);
                let stray = most.max(0.0) * f64::from(s.wobble) * FRAC_1_SQRT_2 * direction;
                let away = place - node * fine - stray;
                let drawn = full * fraction.clamp(0.0, 1.0).sqrt();
                disc_coverage(away, right, down, drawn)
            })
            .sum();
        let shown = smoothstep(2.0, 2.8, distance * pixel / long);
        mix(tone, cover.min(1.0), shown)
    }

    /// Coverage by dots of a mean darkness.
    pub fn cover(&self, on: &Surface, tone: f64) -> f64 {
        let axes = (self.settings.axes()).map(|axis| axis.as_dvec3().normalize());
        let facing = axes.map(|axis| axis.dot(on.normal).abs());
        let most = facing.iter().copied().fold(0.0, f64::max);
        let weights = facing.map(|n| (n - most + 0.15).max(0.0));
        let sum: f64 = weights.iter().sum();
        let mut left = tone.clamp(0.0, 1.0);
        let mut light = 1.0;
        for layer in 0..5u32 {
            let own = left.min(layer_darkness(self.settings));
            let angle = 0.35 + 0.6 * f64::from(layer);
            for plane in 0..3usize {
                let part = 1.0 - (1.0 - own).powf(weights[plane] / sum);
                if part > 0.0 {
                    let [a, b] = [axes[(plane + 1) % 3], axes[(plane + 2) % 3]];
                    let turned = [
                        a * angle.cos() + b * angle.sin(),
                        b * angle.cos() - a * angle.sin(),
                    ];
                    light *= 1.0 - self.lattice(on, turned, 3 * layer + plane as u32, part);
                }
            }
            left = (1.0 - (1.0 - left) / (1.0 - own)).max(0.0);
        }
        1.0 - light * (1.0 - left)
    }
}
