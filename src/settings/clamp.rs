//! Clamps of all fields of a type, by reflection.

use bevy::{
    color::Color,
    math::{Vec2, Vec3},
    reflect::{PartialReflect, ReflectMut, ReflectRef, TypeInfo, Typed, structs::Struct},
};

use super::{FieldRange, clamp_color, clamp_or_default, clamp_vec2_or_default};

/// The value with every `f32`, `u32`, `Vec2`, `Vec3` and `Option<f32>` in the [`FieldRange`] of its
/// field, if it has one. A number that is not finite becomes that of the type's default. Colours
/// are clamped to what a display shows. Nested structs are clamped with the default of the outer
/// type; other types, structs in options and fields of enums are not changed.
pub fn clamp_fields<T: Struct + Typed + Default>(mut value: T) -> T {
    clamp_struct(&mut value, &T::default());
    value
}

fn clamp_struct(value: &mut dyn Struct, default: &dyn Struct) {
    let Some(TypeInfo::Struct(info)) = value.get_represented_type_info() else {
        return;
    };
    for (i, field) in info.iter().enumerate() {
        if let (Some(field_value), Some(default)) = (value.field_at_mut(i), default.field_at(i)) {
            clamp_field(field_value, default, FieldRange::of(field));
        }
    }
}

fn clamp_field(
    value: &mut dyn PartialReflect,
    default: &dyn PartialReflect,
    range: Option<FieldRange>,
) {
    if let (Some(color), Some(default)) = (
        value.try_downcast_mut::<Color>(),
        default.try_downcast_ref::<Color>(),
    ) {
        *color = clamp_color(*color, *default);
    } else if let Some(range) = range {
        clamp_number(value, default, range);
    } else if let (ReflectMut::Struct(value), ReflectRef::Struct(default)) =
        (value.reflect_mut(), default.reflect_ref())
    {
        clamp_struct(value, default);
    }
}

fn clamp_number(value: &mut dyn PartialReflect, default: &dyn PartialReflect, range: FieldRange) {
    // The attribute is a game's: a range upside down is the same range.
    let (least, most) = (range.min.min(range.max), range.max.max(range.min));
    let (low, high) = (least as f32, most as f32);
    if let Some(number) = value.try_downcast_mut::<f32>() {
        let default = default.try_downcast_ref::<f32>().copied();
        *number = clamp_or_default(*number, default.unwrap_or(low), low, high);
    } else if let Some(number) = value.try_downcast_mut::<u32>() {
        *number = (*number).clamp(least as u32, most as u32);
    } else if let Some(vector) = value.try_downcast_mut::<Vec2>() {
        let default = default.try_downcast_ref::<Vec2>().copied();
        *vector = clamp_vec2_or_default(*vector, default.unwrap_or(Vec2::splat(low)), low, high);
    } else if let Some(vector) = value.try_downcast_mut::<Vec3>() {
        let default = default.try_downcast_ref::<Vec3>().copied();
        let default = default.unwrap_or(Vec3::splat(low));
        *vector = Vec3::from_array(std::array::from_fn(|i| {
            clamp_or_default(vector[i], default[i], low, high)
        }));
    } else if let Some(Some(number)) = value.try_downcast_mut::<Option<f32>>() {
        let default = default.try_downcast_ref::<Option<f32>>().copied().flatten();
        *number = clamp_or_default(*number, default.unwrap_or(low), low, high);
    }
}
