//! Blending between two values of a setting.

use bevy::{prelude::*, reflect::attributes::CustomAttributes};

use super::{
    BlendField, FieldRange,
    parts::{attributes, is_same_variant, part, part_mut},
};

/// The color at fraction `t` (0 to 1) between two colors, mixed in `OKLab`.
///
/// Its components are clamped to 0 to 1 in linear light. Equal colors come back
/// unchanged.
pub fn blend_color(a: Color, b: Color, t: f32) -> Color {
    if a == b {
        return a;
    }
    // A mixture of two displayable colors can be outside of the display's gamut.
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

/// The settings at fraction `t` between two. If one is missing, the other fades. If a mode differs,
/// the settings fade out until `t = 0.5`, change the mode there, and fade in again.
pub(crate) fn crossfade<T>(
    a: Option<T>,
    b: Option<T>,
    t: f32,
    faded: fn(T, f32) -> T,
    mixed: fn(&T, &T, f32) -> T,
    same_modes: fn(&T, &T) -> bool,
) -> Option<T> {
    Some(match (a, b) {
        (None, None) => return None,
        (Some(a), None) => faded(a, 1.0 - t),
        (None, Some(b)) => faded(b, t),
        (Some(a), Some(b)) => {
            let between = if t < 0.5 {
                mixed(&a, &b, t)
            } else {
                mixed(&b, &a, 1.0 - t)
            };
            if same_modes(&a, &b) {
                between
            } else {
                faded(between, crossfade_weight(t))
            }
        }
    })
}

/// A group of settings that can be faded out and mixed with another of its type.
pub(crate) trait Blend: PartialReflect + Clone {
    /// The settings with `fraction` of their strength; at 0 they change nothing.
    fn faded(self, fraction: f32) -> Self;

    /// Whether the two differ in numbers and colors only, not in a mode.
    fn same_modes(&self, other: &Self) -> bool {
        same_modes(self, other)
    }

    /// Numbers and colors at fraction `t` between the two; modes of `self`.
    fn mixed(&self, other: &Self, t: f32) -> Self {
        mix_fields(self, other, t)
    }

    /// The settings at fraction `t` between the two: see [`crossfade`].
    fn blend(a: Option<Self>, b: Option<Self>, t: f32) -> Option<Self> {
        crossfade(a, b, t, Self::faded, Self::mixed, Self::same_modes)
    }
}

/// The fields at fraction `t` between the two values, as [`BlendField`] says: `f32`, `Vec2`, `Vec3`
/// and colors are interpolated, all others are those of `a`.
pub(crate) fn mix_fields<T: PartialReflect + Clone>(a: &T, b: &T, t: f32) -> T {
    let mut mixed = a.clone();
    mix_parts(&mut mixed, [a, b], t, None);
    mixed
}

/// As [`mix_fields`], but from `t = 0.5` on, the fields that are not interpolated are those of `b`.
pub(crate) fn blend_fields<T: PartialReflect + Clone>(a: &T, b: &T, t: f32) -> T {
    let mut mixed = if t < 0.5 { a.clone() } else { b.clone() };
    mix_parts(&mut mixed, [a, b], t, None);
    mixed
}

/// Whether all fields are equal that are not interpolated, and not [`BlendField::Switch`].
pub(crate) fn same_modes<T: PartialReflect>(a: &T, b: &T) -> bool {
    have_same_modes(a, b, None)
}

fn mix_parts(
    slot: &mut dyn PartialReflect,
    [a, b]: [&dyn PartialReflect; 2],
    t: f32,
    outer: Option<&CustomAttributes>,
) {
    if !is_same_variant(a, b) {
        return;
    }
    for i in 0.. {
        let attributes = attributes(a, i, outer);
        let (Some(slot), Some(a), Some(b)) = (part_mut(slot, i), part(a, i), part(b, i)) else {
            return;
        };
        mix_part(slot, [a, b], t, attributes);
    }
}

fn mix_part(
    slot: &mut dyn PartialReflect,
    ends: [&dyn PartialReflect; 2],
    t: f32,
    attributes: Option<&CustomAttributes>,
) {
    let rule = attributes.and_then(|attributes| attributes.get::<BlendField>());
    if rule == Some(&BlendField::Switch) {
        return;
    }
    if let (Some(slot), Some([a, b])) = (slot.try_downcast_mut::<f32>(), typed::<f32>(ends)) {
        let range = attributes.and_then(|attributes| attributes.get::<FieldRange>());
        *slot = if range.is_some_and(|range| range.logarithmic) {
            blend_ratio(a, b, t)
        } else {
            a.lerp(b, t)
        };
    } else if let (Some(slot), Some([a, b])) =
        (slot.try_downcast_mut::<Color>(), typed::<Color>(ends))
    {
        *slot = blend_color(a, b, t);
    } else if let (Some(slot), Some([a, b])) =
        (slot.try_downcast_mut::<Vec2>(), typed::<Vec2>(ends))
    {
        *slot = a.lerp(b, t);
    } else if let (Some(slot), Some([a, b])) =
        (slot.try_downcast_mut::<Vec3>(), typed::<Vec3>(ends))
    {
        *slot = a.lerp(b, t);
    } else if rule == Some(&BlendField::Fields) {
        mix_parts(slot, ends, t, attributes);
    }
}

fn typed<T: Copy + 'static>([a, b]: [&dyn PartialReflect; 2]) -> Option<[T; 2]> {
    Some([*a.try_downcast_ref()?, *b.try_downcast_ref()?])
}

fn have_same_modes(
    a: &dyn PartialReflect,
    b: &dyn PartialReflect,
    outer: Option<&CustomAttributes>,
) -> bool {
    let is_same = |i: usize| {
        let (a_part, b_part) = (part(a, i)?, part(b, i)?);
        let attributes = attributes(a, i, outer);
        let rule = attributes.and_then(|attributes| attributes.get::<BlendField>());
        Some(match rule {
            Some(BlendField::Switch) => true,
            _ if is_interpolated(a_part) => true,
            Some(BlendField::Fields) => have_same_modes(a_part, b_part, attributes),
            None => a_part.reflect_partial_eq(b_part).unwrap_or(false),
        })
    };
    is_same_variant(a, b) && (0..).map_while(is_same).all(|is_same| is_same)
}

fn is_interpolated(value: &dyn PartialReflect) -> bool {
    value.try_downcast_ref::<f32>().is_some()
        || value.try_downcast_ref::<Color>().is_some()
        || value.try_downcast_ref::<Vec2>().is_some()
        || value.try_downcast_ref::<Vec3>().is_some()
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
