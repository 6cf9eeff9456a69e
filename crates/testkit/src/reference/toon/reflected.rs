//! What a surface reflects of directional lights and of light from all around: references of
//! `toon/two_shades.wgsl` and, for the modes of ramps, of `toon/light_fraction.wgsl`,
//! `toon/per_light.wgsl` and `toon/brightest.wgsl`.

use std::f64::consts::PI;

use bevy::math::DVec3;
use bevy_comics::{
    ToonLight,
    toon::{DetailAxis, Ramp, RampBlend, RampMode},
};

use super::{
    super::{color::luminance, detail, light::edge_at},
    tones::Tones,
};

/// A surface in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// The color of the material.
    pub base: DVec3,
    pub normal: DVec3,
    /// Changes of the normal over a pixel, to the right and down.
    pub steps: [DVec3; 2],
    pub to_eye: DVec3,
    /// Of the ramp, if it is the same in every light.
    pub detail: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct Sun {
    pub color: DVec3,
    pub to_light: DVec3,
}

#[derive(Clone, Debug)]
pub struct Lights {
    pub suns: Vec<Sun>,
    pub around: DVec3,
    pub exposure: f64,
}

/// The color of a surface. No shadow of something else falls on it, and it has no highlights.
pub fn reflected(light: &ToonLight, s: &Surface, lights: &Lights) -> DVec3 {
    let Some(ramp) = &light.ramp else {
        return two_shades(light, s, lights);
    };
    let of = Ramped { light, ramp, s };
    match ramp.mode {
        RampMode::PerLight => of.per_light(lights),
        RampMode::Brightest => of.brightest(lights),
        _ => of.light_fraction(lights),
    }
}

fn bright(color: DVec3) -> f64 {
    luminance(color.to_array())
}

/// Cosine between the normal and a light, and its change over a pixel.
fn cosine(s: &Surface, sun: &Sun) -> (f64, f64) {
    let over_pixel = s.steps.iter().map(|step| step.dot(sun.to_light).abs());
    (s.normal.dot(sun.to_light), over_pixel.sum())
}

/// How much of a light the shadow of a surface on itself takes away.
fn form_shadow(light: &ToonLight) -> f64 {
    match light.form_shadows {
        true => light.shadow_strength.into(),
        false => 0.0,
    }
}

fn two_shades(light: &ToonLight, s: &Surface, lights: &Lights) -> DVec3 {
    let left = |sun: &Sun| {
        let (cosine, width) = cosine(s, sun);
        let faces = edge_at(light.shadow_threshold.into(), cosine, width);
        1.0 - form_shadow(light) * (1.0 - faces)
    };
    let direct: DVec3 = lights.suns.iter().map(|sun| sun.color * left(sun)).sum();
    lights.exposure * s.base * (direct / PI + lights.around)
}

struct Ramped<'a> {
    light: &'a ToonLight,
    ramp: &'a Ramp,
    s: &'a Surface,
}

impl Ramped<'_> {
    fn angle(&self, sun: &Sun) -> (f64, f64) {
        match form_shadow(self.light) > 0.0 {
            true => cosine(self.s, sun),
            false => (1.0, 0.0),
        }
    }

    fn detail(&self, sun: &Sun) -> f64 {
        match self.ramp.detail.as_ref().map(|detail| detail.axis) {
            Some(axis @ DetailAxis::Highlight { .. }) => {
                let reflection = -sun.to_light.reflect(self.s.normal);
                detail::detail(axis, reflection.dot(self.s.to_eye))
            }
            _ => self.s.detail,
        }
    }

    /// The tone of a part of the light. Weak shadows take away only a part of the full tone.
    fn tone(&self, (part, width): (f64, f64), detail: f64) -> DVec3 {
        let tones = Tones::new(self.ramp, detail);
        let is_shaded = self.light.form_shadows || self.light.cast_shadows;
        let strength = f64::from(u8::from(is_shaded)) * f64::from(self.light.shadow_strength);
        tones.at(1.0, 0.0).lerp(tones.at(part, width), strength)
    }

    fn tone_of(&self, sun: &Sun) -> DVec3 {
        self.tone(self.angle(sun), self.detail(sun))
    }

    /// A tone under lights and light from all around.
    fn toned(&self, tone: DVec3, direct: DVec3, even: DVec3) -> DVec3 {
        match self.ramp.blend {
            RampBlend::Absolute => tone * (direct + even),
            _ => self.s.base * (tone * direct + even),
        }
    }

    /// The sum of all lights, each in its own tone. A ramp of absolute colors also colors light
    /// from all around: in the mean of the tones by the brightness of their lights, or in the tone
    /// of shade.
    fn per_light(&self, lights: &Lights) -> DVec3 {
        let toned = |sun: &Sun| sun.color * self.tone_of(sun) / PI;
        let direct: DVec3 = lights.suns.iter().map(toned).sum();
        let color = match self.ramp.blend {
            RampBlend::Absolute => {
                let all: f64 = lights.suns.iter().map(|sun| bright(sun.color)).sum();
                let weighted = |sun: &Sun| bright(sun.color) * self.tone_of(sun);
                let mean = match all > 0.0 {
                    true => lights.suns.iter().map(weighted).sum::<DVec3>() / all,
                    false => self.tone((0.0, 0.0), 1.0),
                };
                direct + mean * lights.around
            }
            _ => self.s.base * (direct + lights.around),
        };
        lights.exposure * color
    }

    /// The first of the brightest lights in its tone, and half of all others from all around.
    fn brightest(&self, lights: &Lights) -> DVec3 {
        let most = |a: &Sun, b: &Sun| bright(a.color) >= bright(b.color);
        let suns = lights.suns.iter().copied();
        let Some(key) = suns.reduce(|a, b| if most(&a, &b) { a } else { b }) else {
            let shade = self.tone((0.0, 0.0), 0.0);
            return lights.exposure * self.toned(shade, DVec3::ZERO, lights.around);
        };
        let others = lights.suns.iter().map(|sun| sun.color).sum::<DVec3>() - key.color;
        let even = 0.5 * others / PI + lights.around;
        lights.exposure * self.toned(self.tone_of(&key), key.color / PI, even)
    }

    /// The tone of the fraction of all light that arrives, in the color of all light, whose
    /// brightness is raised to the power of `keep_intensity`.
    fn light_fraction(&self, lights: &Lights) -> DVec3 {
        let all: f64 = lights.suns.iter().map(|sun| bright(sun.color)).sum();
        let mean = |of: &dyn Fn(&Sun) -> f64| {
            let weighted = lights.suns.iter().map(|sun| bright(sun.color) * of(sun));
            weighted.sum::<f64>() / all.max(1e-30)
        };
        let part = mean(&|sun| self.angle(sun).0.max(0.0));
        let width = mean(&|sun| self.angle(sun).1);
        let tone = self.tone((part, width), mean(&|sun| self.detail(sun)));
        let direct = lights.suns.iter().map(|sun| sun.color).sum::<DVec3>() / PI;
        let [direct, even] = [direct, lights.around].map(|light| lights.exposure * light);
        let intensity = bright(direct + even);
        let strength = intensity.powf(f64::from(self.ramp.keep_intensity) - 1.0);
        strength * self.toned(tone, direct, even)
    }
}
