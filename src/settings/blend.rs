//! What lies between two settings.

use bevy::{
    color::{Color, LinearRgba, Mix, Oklaba},
    math::FloatExt,
};

/// The colour `t` (0 to 1) of the way to another, through `OKLab`, clamped to what
/// a display shows.
pub fn blend_color(a: Color, b: Color, t: f32) -> Color {
    if a == b {
        return a;
    }
    // Between two colours of a display may lie some that it does not show.
    let mixed = LinearRgba::from(Oklaba::from(a).mix(&Oklaba::from(b), t));
    let shown = |part: f32| part.clamp(0.0, 1.0);
    LinearRgba {
        red: shown(mixed.red),
        green: shown(mixed.green),
        blue: shown(mixed.blue),
        alpha: shown(mixed.alpha),
    }
    .into()
}

/// The positive number `t` (0 to 1) of the way to another in equal ratios;
/// numbers that have no ratio are interpolated linearly.
pub fn blend_ratio(a: f32, b: f32, t: f32) -> f32 {
    if a == b || a <= 0.0 || b <= 0.0 {
        return a.lerp(b, t);
    }
    let (a, b) = (f64::from(a), f64::from(b));
    (a * (b / a).powf(f64::from(t))) as f32
}

/// The strength, 0 to 1, of what changes its mode half of the way.
pub(crate) fn dip(t: f32) -> f32 {
    (1.0 - 2.0 * t).abs()
}

/// What can be faded and mixed with another of its kind.
pub(crate) trait Blend: Copy {
    /// With this fraction of its strength; at 0 it changes nothing.
    fn faded(self, fraction: f32) -> Self;

    /// Whether numbers alone tell the two apart.
    fn same_modes(&self, other: &Self) -> bool;

    /// Every number `t` of the way to the other; modes stay.
    fn mixed(self, other: Self, t: f32) -> Self;

    /// `t` of the way from one to the other: what only one side has fades, and
    /// what changes its mode fades out, changes, and fades in.
    fn blend(a: Option<Self>, b: Option<Self>, t: f32) -> Option<Self> {
        Some(match (a, b) {
            (None, None) => return None,
            (Some(a), None) => a.faded(1.0 - t),
            (None, Some(b)) => b.faded(t),
            (Some(a), Some(b)) => {
                let mixed = if t < 0.5 {
                    a.mixed(b, t)
                } else {
                    b.mixed(a, 1.0 - t)
                };
                if a.same_modes(&b) {
                    mixed
                } else {
                    mixed.faded(dip(t))
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_ratios() {
        assert!((blend_ratio(1.0, 4.0, 0.5) - 2.0).abs() < 1e-6);
        assert_eq!(blend_ratio(0.0, 4.0, 0.5), 2.0, "no ratio to zero");
        assert_eq!(blend_ratio(3.0, 3.0, 0.3), 3.0);
    }

    #[test]
    fn a_mode_changes_where_its_effect_has_no_strength() {
        assert_eq!([dip(0.0), dip(0.5), dip(1.0)], [1.0, 0.0, 1.0]);
    }
}
