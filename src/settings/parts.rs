//! The fields of a struct, or of the variant that an enum has, by reflection.

use bevy::reflect::{
    NamedField, PartialReflect, ReflectMut, ReflectRef, attributes::CustomAttributes,
    enums::VariantInfo,
};

/// The field at an index.
pub(super) fn part(value: &dyn PartialReflect, i: usize) -> Option<&dyn PartialReflect> {
    match value.reflect_ref() {
        ReflectRef::Struct(value) => value.field_at(i),
        ReflectRef::Enum(value) => value.field_at(i),
        _ => None,
    }
}

/// The field at an index, for editing.
pub(super) fn part_mut(
    value: &mut dyn PartialReflect,
    i: usize,
) -> Option<&mut dyn PartialReflect> {
    match value.reflect_mut() {
        ReflectMut::Struct(value) => value.field_at_mut(i),
        ReflectMut::Enum(value) => value.field_at_mut(i),
        _ => None,
    }
}

/// The attributes of the field at an index. A field of a variant that has none, such as that of
/// `Some`, has those of the enum's own field: `outer`.
pub(super) fn attributes<'a>(
    value: &dyn PartialReflect,
    i: usize,
    outer: Option<&'a CustomAttributes>,
) -> Option<&'a CustomAttributes> {
    let value = match value.reflect_ref() {
        ReflectRef::Struct(value) => {
            let field = value.get_represented_struct_info()?.field_at(i);
            return field.map(NamedField::custom_attributes);
        }
        ReflectRef::Enum(value) => value,
        _ => return None,
    };
    let info = value.get_represented_enum_info()?;
    let own = match info.variant_at(value.variant_index())? {
        VariantInfo::Struct(variant) => variant.field_at(i)?.custom_attributes(),
        VariantInfo::Tuple(variant) => variant.field_at(i)?.custom_attributes(),
        VariantInfo::Unit(_) => return None,
    };
    if own.is_empty() { outer } else { Some(own) }
}

/// Whether two values of one type have the same variant. Structs have.
pub(super) fn is_same_variant(a: &dyn PartialReflect, b: &dyn PartialReflect) -> bool {
    match (a.reflect_ref(), b.reflect_ref()) {
        (ReflectRef::Enum(a), ReflectRef::Enum(b)) => a.variant_index() == b.variant_index(),
        _ => true,
    }
}
