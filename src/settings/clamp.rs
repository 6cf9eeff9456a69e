//! Clamps of all fields of a type, by reflection.

use bevy::{prelude::*, reflect::attributes::CustomAttributes};

use super::{
    FieldRange, clamp_color, clamp_or_default, clamp_vec2_or_default,
    field::NotFinite,
    parts::{attributes, is_same_variant, part, part_mut},
};

/// The value with every `f32`, `u32`, `Vec2` and `Vec3` in the [`FieldRange`] of its field, if it
/// has one, also in nested structs, options and variants of enums. Colors are clamped to what a
/// display shows. Lists and other types are not changed.
///
/// A number that is not finite becomes that of its attribute [`NotFinite`], else that of the outer
/// type's default. If the default has another variant there, it becomes the least number of the
/// range, and a color becomes black.
pub fn clamp_fields<T: PartialReflect + Default>(mut value: T) -> T {
    clamp_parts(&mut value, Some(&T::default()), None);
    value
}

fn clamp_parts(
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    outer: Option<&CustomAttributes>,
) {
    let default = default.filter(|default| is_same_variant(value, *default));
    for i in 0.. {
        let attributes = attributes(value, i, outer);
        let Some(field) = part_mut(value, i) else {
            return;
        };
        clamp_part(field, default.and_then(|value| part(value, i)), attributes);
    }
}

fn clamp_part(
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    attributes: Option<&CustomAttributes>,
) {
    if let Some(color) = value.try_downcast_mut::<Color>() {
        let default = default.and_then(|value| value.try_downcast_ref::<Color>());
        *color = clamp_color(*color, default.copied().unwrap_or(Color::BLACK));
    } else if attributes.is_none_or(|attributes| !clamp_number(value, default, attributes)) {
        clamp_parts(value, default, attributes);
    }
}

/// Clamps a number that has a range. Returns whether it is one.
fn clamp_number(
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    attributes: &CustomAttributes,
) -> bool {
    let Some(range) = attributes.get::<FieldRange>() else {
        return false;
    };
    // The attribute is a game's: a range upside down is the same range.
    let (least, most) = (range.min.min(range.max), range.max.max(range.min));
    let (low, high) = (least as f32, most as f32);
    let not_finite = attributes.get::<NotFinite>().map(|number| number.0);
    if let Some(number) = value.try_downcast_mut::<f32>() {
        let default = not_finite.or_else(|| default?.try_downcast_ref().copied());
        *number = clamp_or_default(*number, default.unwrap_or(low), low, high);
    } else if let Some(number) = value.try_downcast_mut::<u32>() {
        *number = (*number).clamp(least as u32, most as u32);
    } else if let Some(vector) = value.try_downcast_mut::<Vec2>() {
        let default = (not_finite.map(Vec2::splat))
            .or_else(|| default?.try_downcast_ref().copied())
            .unwrap_or(Vec2::splat(low));
        *vector = clamp_vec2_or_default(*vector, default, low, high);
    } else if let Some(vector) = value.try_downcast_mut::<Vec3>() {
        let default = (not_finite.map(Vec3::splat))
            .or_else(|| default?.try_downcast_ref().copied())
            .unwrap_or(Vec3::splat(low));
        *vector = Vec3::from_array(std::array::from_fn(|i| {
            clamp_or_default(vector[i], default[i], low, high)
        }));
    } else {
        return false;
    }
    true
}

/// Gives types the method `sanitized`.
macro_rules! impl_sanitized {
    ($($type:ty),+) => {$(
        impl $type {
            /// The settings that are used: every number is clamped to its documented range, and
            /// colors to what a display shows. What is not finite is replaced by its default.
            #[must_use]
            pub fn sanitized(self) -> Self {
                $crate::settings::clamp_fields(self)
            }
        }
    )+};
}
pub(crate) use impl_sanitized;
