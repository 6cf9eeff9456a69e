//! Clamps of all fields of a type, by reflection.

use bevy::{
    color::Color,
    math::{Vec2, Vec3},
    reflect::{PartialReflect, ReflectMut, ReflectRef, TypeInfo, Typed, structs::Struct},
};

use super::{FieldRange, clamp_color, clamp_or_default, clamp_vec2_or_default};

/// The value with every number in the [`FieldRange`] of its field. A number that is not finite
/// becomes that of the type's default. Colours are clamped to what a display shows.
///
/// Numbers in nested structs and `Option<f32>` are clamped, too; structs in options and fields of
/// enums are not.
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
    let (low, high) = (range.min as f32, range.max as f32);
    if let Some(number) = value.try_downcast_mut::<f32>() {
        let default = default.try_downcast_ref::<f32>().copied();
        *number = clamp_or_default(*number, default.unwrap_or(low), low, high);
    } else if let Some(number) = value.try_downcast_mut::<u32>() {
        *number = (*number).clamp(range.min as u32, range.max as u32);
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
