//! Blending between two values of a setting.

use bevy::{
    color::{Color, LinearRgba, Mix, Oklaba},
    math::FloatExt,
};

/// The colour at fraction `t` (0 to 1) between two colours, mixed in `OKLab`.
///
/// Its components are clamped to 0 to 1 in linear light. Equal colours come back
/// unchanged.
pub fn blend_color(a: Color, b: Color, t: f32) -> Color {
    if a == b {
        return a;
    }
    // A mixture of two displayable colours can be outside of the display's gamut.
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

/// The number at fraction `t` (0 to 1) between two positive numbers, on a
/// logarithmic scale: equal steps of `t` are equal ratios. If either number is 0 or
/// negative, the interpolation is linear.
pub fn blend_ratio(a: f32, b: f32, t: f32) -> f32 {
    if a == b || a <= 0.0 || b <= 0.0 {
        return a.lerp(b, t);
    }
    let (a, b) = (f64::from(a), f64::from(b));
    (a * (b / a).powf(f64::from(t))) as f32
}

/// Strength, 0 to 1, of a setting that changes its mode halfway through a
/// transition: 1 at both ends, 0 at `t = 0.5`.
pub(crate) fn crossfade_weight(t: f32) -> f32 {
    (1.0 - 2.0 * t).abs()
}

/// A group of settings that can be faded out and mixed with another of its type.
pub(crate) trait Blend: Copy {
    /// The settings with `fraction` of their strength; at 0 they change nothing.
    fn faded(self, fraction: f32) -> Self;

    /// Whether the two differ in numbers and colours only, not in a mode.
    fn same_modes(&self, other: &Self) -> bool;

    /// Numbers and colours at fraction `t` between the two; modes of `self`.
    fn mixed(self, other: Self, t: f32) -> Self;

    /// The settings at fraction `t` between the two. If one is missing, the other
    /// fades. If a mode differs, the settings fade out until `t = 0.5`, change the
    /// mode there, and fade in again.
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
                    mixed.faded(crossfade_weight(t))
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
        assert_eq!(
            [
                crossfade_weight(0.0),
                crossfade_weight(0.5),
                crossfade_weight(1.0)
            ],
            [1.0, 0.0, 1.0]
        );
    }
}
