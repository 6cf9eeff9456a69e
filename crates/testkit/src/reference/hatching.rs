//! Reference of `effect/strokes.wgsl` and `effects/hatching/hatching.wgsl`.

use std::f64::consts::FRAC_1_SQRT_2;

use bevy::math::{DMat4, DVec2, DVec3, DVec4, Vec4Swizzles};
use bevy_comics::{
    Hatching,
    effect::linear_rgb,
    effects::{HatchingGround, HatchingKind},
};

use super::{
    Rgb,
    edge::line_coverage,
    mix,
    nested::{coordinate, level_of, mark_of, noise_along, stroke_factor, stroke_start},
    smoothstep,
    stipple::Dots,
};

/// A place on a surface, in the frame that strokes are fixed to.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub place: DVec3,
    /// How the place changes from pixel to pixel.
    pub across: DVec3,
    pub down: DVec3,
    pub normal: DVec3,
}

impl Surface {
    /// The page, in units of the distance of its lines.
    pub fn page(place: DVec2, spacing: f64) -> Self {
        let unit = 0.5 / spacing;
        Self {
            place: (place * unit).extend(0.0),
            across: DVec3::X * unit,
            down: DVec3::Y * unit,
            normal: DVec3::Z,
        }
    }

    /// Where the ray through a place in normalized device coordinates meets a plane, by what the
    /// rays of neighboring pixels meet. `origin` and `normal`: of the plane.
    pub fn of_plane(
        world_from_clip: DMat4,
        clip: DVec2,
        size: DVec2,
        (origin, normal): (DVec3, DVec3),
    ) -> Self {
        let meets = |by: DVec2| {
            let at = clip + by * DVec2::new(2.0, -2.0) / size;
            let point = |depth: f64| {
                let h: DVec4 = world_from_clip * at.extend(depth).extend(1.0);
                h.xyz() / h.w
            };
            let (start, ray) = (point(1.0), point(0.25) - point(1.0));
            start + ray * (normal.dot(origin - start) / normal.dot(ray))
        };
        let slope = |by: DVec2| (meets(1e-4 * by) - meets(-1e-4 * by)) / 2e-4;
        Self {
            place: meets(DVec2::ZERO),
            across: slope(DVec2::X),
            down: slope(DVec2::Y),
            normal,
        }
    }
}

/// Hatching at a scale factor, of a drawing.
#[derive(Clone, Copy, Debug)]
pub struct Hatch<'a> {
    pub settings: &'a Hatching,
    pub scale: f64,
    pub drawing: u32,
}

impl<'a> Hatch<'a> {
    /// The first drawing, at a scale factor of 1.
    pub fn new(settings: &'a Hatching) -> Self {
        Self {
            settings,
            scale: 1.0,
            drawing: 0,
        }
    }

    pub fn drawn(self, drawing: u32) -> Self {
        Self { drawing, ..self }
    }

    fn spacing(&self) -> f64 {
        f64::from(self.settings.spacing) * self.scale
    }

    fn axes(&self) -> [DVec3; 3] {
        self.settings.axes().map(|axis| axis.as_dvec3().normalize())
    }

    /// Coverage by the lines of one family: `axes` are its normal and the two others.
    fn family(&self, on: &Surface, [a, b, c]: [DVec3; 3], number: u32, tone: f64) -> f64 {
        let s = self.settings;
        let spacing = self.spacing();
        let on_screen = |axis: DVec3| DVec2::new(axis.dot(on.across), axis.dot(on.down));
        let gradient = on_screen(a);
        let change = gradient.length();
        let (exponent, grown) = level_of(2.0 * spacing * change);
        let size = f64::from(exponent).exp2();
        let place = coordinate(a.dot(on.place)) / size;
        let line = on.normal.cross(a);
        let axis = if c.dot(line).abs() > 1.1 * b.dot(line).abs() {
            c
        } else {
            b
        };
        let speed = gradient.perp_dot(on_screen(axis)).abs() / change;
        let length = 1.4 * f64::from(s.length) * self.scale * speed.max(1e-25);
        let (along_exponent, along_grown) = level_of(length);
        let along = coordinate(axis.dot(on.place)) / f64::from(along_exponent).exp2();
        let free = 1.0 - tone;
        let stroke = |away: f64, half_width: f64, mark: u32| {
            let noise = |period, seed: u32| noise_along(along, along_grown, period, seed);
            let wobble = 0.5 * spacing * f64::from(s.wobble) * free;
            let away = away * size / change - wobble * noise(0.5, mark ^ self.drawing);
            let start = stroke_start(mark, along_exponent);
            let breaks = stroke_factor(along + start, along_grown, f64::from(s.breaks) * free);
            let pressure = 1.0 + f64::from(s.pressure) * free * noise(4.0, !mark ^ self.drawing);
            line_coverage(away.abs(), half_width * breaks * pressure)
        };
        let old = place.round();
        let fresh = (place - 0.5).round();
        let first = mark_of(old as i64, exponent, number);
        let second = mark_of(2 * fresh as i64 + 1, exponent - 1, number);
        let half_width = spacing * tone;
        let cover = stroke(place - old, half_width, first)
            + stroke(place - fresh - 0.5, grown * half_width, second);
        let seen = smoothstep(1.5, 2.5, 0.5 * size / change) * (1.0 - smoothstep(0.9, 1.0, tone));
        mix(tone, cover.min(1.0), seen)
    }

    /// Coverage by one layer.
    fn layer(&self, on: &Surface, layer: usize, tone: f64) -> f64 {
        let axes = self.axes();
        let g = axes.map(|axis| {
            let along = axis.dot(on.normal);
            smoothstep(0.25, 0.5, (1.0 - along * along).max(0.0).sqrt())
        });
        let own = [axes[layer], axes[(layer + 1) % 3], axes[(layer + 2) % 3]];
        let fraction: f64 = g[..=layer].iter().product();
        let (other, number) = if layer < 2 {
            ([own[1], own[2], own[0]], layer as u32 + 1)
        } else {
            // The two families that the other layers have left.
            let missing = if g[0] < g[1].min(g[2]) {
                0
            } else if g[1] < g[0].min(g[2]) {
                1
            } else {
                2
            };
            let left: Vec<DVec3> = (0..3).filter(|i| *i != missing).map(|i| axes[i]).collect();
            let between = (left[0] + left[1]) * FRAC_1_SQRT_2;
            let across = (left[0] - left[1]) * FRAC_1_SQRT_2;
            ([between, across, own[0]], 3)
        };
        let part = |weight: f64| 1.0 - (1.0 - tone).max(1e-20).powf(weight);
        let mut light = 1.0;
        if fraction > 0.0 {
            light *= 1.0 - self.family(on, own, layer as u32, part(fraction));
        }
        if fraction < 1.0 {
            light *= 1.0 - self.family(on, other, number, part(1.0 - fraction));
        }
        1.0 - light
    }

    /// Coverage by strokes or dots of a mean darkness.
    pub fn cover(&self, on: &Surface, tone: f64) -> f64 {
        match self.settings.kind {
            HatchingKind::Dots => Dots {
                settings: self.settings,
                spacing: self.spacing(),
                drawing: self.drawing,
            }
            .cover(on, tone),
            _ => self.strokes(on, tone),
        }
    }

    fn strokes(&self, on: &Surface, tone: f64) -> f64 {
        let s = self.settings;
        let mut left = tone;
        let mut light = 1.0;
        for layer in 0..s.layers {
            let last = layer + 1 == s.layers;
            let own = if last {
                left
            } else {
                left.min(f64::from(s.layer_darkness))
            };
            if own > 0.0 {
                light *= 1.0 - self.layer(on, layer as usize, own);
            }
            left = if own < 1.0 {
                (1.0 - (1.0 - left) / (1.0 - own)).max(0.0)
            } else {
                0.0
            };
        }
        1.0 - light
    }

    /// Darkness at a lightness.
    pub fn tone(&self, light: f64) -> f64 {
        let s = self.settings;
        let low = f64::from(s.solid_below);
        let high = f64::from(s.bare_above).max(low + 0.05);
        let t = (1.0 - smoothstep(low, high, light)).powf(f64::from(s.gamma));
        match s.tones {
            0 => t,
            tones => (t * f64::from(tones + 1)).floor().min(f64::from(tones)) / f64::from(tones),
        }
    }

    /// A color of a darkness that is covered by strokes.
    pub fn hatched(&self, linear: Rgb, tone: f64, cover: f64) -> Rgb {
        let s = self.settings;
        let [ink, paper] = [s.ink, s.paper].map(|c| linear_rgb(c).to_array().map(f64::from));
        std::array::from_fn(|i| {
            let ground = match s.ground {
                HatchingGround::Paper => paper[i],
                _ => {
                    let t = tone.min(0.9);
                    ((linear[i] - ink[i] * t) / (1.0 - t)).clamp(0.0, linear[i].max(1.0))
                }
            };
            mix(linear[i], mix(ground, ink[i], cover), f64::from(s.opacity))
        })
    }
}
