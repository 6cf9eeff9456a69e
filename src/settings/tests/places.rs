//! The fields of a value, however deep, and values for them, by reflection.

use bevy::{
    color::Color,
    math::{Vec2, Vec3},
    reflect::{
        PartialReflect, ReflectRef, TypeInfo,
        attributes::CustomAttributes,
        enums::{DynamicEnum, DynamicVariant, Enum, VariantInfo},
        structs::DynamicStruct,
        tuple::DynamicTuple,
    },
};

use crate::settings::{
    BlendField, FieldRange,
    parts::{attributes, part, part_mut},
};

/// Where a field is in a value, and its attributes.
#[derive(Clone, Default)]
pub(super) struct Place {
    /// Indices of fields.
    pub path: Vec<usize>,
    /// Names of fields.
    pub name: String,
    attributes: Option<&'static CustomAttributes>,
}

impl Place {
    /// A whole value.
    pub fn root(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    pub fn get<'a>(&self, root: &'a dyn PartialReflect) -> &'a dyn PartialReflect {
        let below = |value, i: &usize| part(value, *i).expect("a field");
        self.path.iter().fold(root, below)
    }

    pub fn get_mut<'a>(&self, root: &'a mut dyn PartialReflect) -> &'a mut dyn PartialReflect {
        let below = |value, i: &usize| part_mut(value, *i).expect("a field");
        self.path.iter().fold(root, below)
    }

    pub fn range(&self) -> Option<FieldRange> {
        self.attributes?.get().copied()
    }

    pub fn blend(&self) -> Option<BlendField> {
        self.attributes?.get().copied()
    }

    /// All fields below, without the parts of vectors and colors.
    pub fn all_below(&self, root: &dyn PartialReflect) -> Vec<Self> {
        let value = self.get(root);
        let mut found = Vec::new();
        for i in 0.. {
            let Some(field) = part(value, i) else {
                return found;
            };
            let name = match value.reflect_ref() {
                ReflectRef::Struct(value) => value.name_at(i),
                ReflectRef::Enum(value) => value.name_at(i),
                _ => None,
            };
            let place = Self {
                path: self.path.iter().copied().chain([i]).collect(),
                name: format!("{}.{}", self.name, name.unwrap_or("0")),
                attributes: attributes(value, i, self.attributes),
            };
            let is_whole = components(field).is_some() || is_color(field);
            let below = (!is_whole).then(|| place.all_below(root));
            found.push(place);
            found.extend(below.into_iter().flatten());
        }
        found
    }
}

pub(super) fn is_color(value: &dyn PartialReflect) -> bool {
    value.try_downcast_ref::<Color>().is_some()
}

/// A number, or those of a vector; `None` if the value is neither.
pub(super) fn components(value: &dyn PartialReflect) -> Option<Vec<f32>> {
    if let Some(x) = value.try_downcast_ref::<f32>() {
        Some(vec![*x])
    } else if let Some(n) = value.try_downcast_ref::<u32>() {
        Some(vec![*n as f32])
    } else if let Some(v) = value.try_downcast_ref::<Vec2>() {
        Some(v.to_array().to_vec())
    } else {
        let v = value.try_downcast_ref::<Vec3>()?;
        Some(v.to_array().to_vec())
    }
}

/// A value of a type: a number, a vector of such numbers, black, or a struct with its defaults;
/// `None` if it is of another kind.
pub(super) fn made(info: &TypeInfo, x: f32) -> Option<Box<dyn PartialReflect>> {
    Some(if info.is::<f32>() {
        Box::new(x)
    } else if info.is::<u32>() {
        Box::new(x as u32)
    } else if info.is::<Vec2>() {
        Box::new(Vec2::splat(x))
    } else if info.is::<Vec3>() {
        Box::new(Vec3::splat(x))
    } else if info.is::<Color>() {
        Box::new(Color::BLACK)
    } else if matches!(info, TypeInfo::Struct(_)) {
        Box::new(DynamicStruct::default())
    } else {
        return None;
    })
}

/// An enum of a variant, with the least numbers of its ranges; `None` if it cannot be made.
/// `range`: of the field that the enum is in.
pub(super) fn made_variant(
    variant: &VariantInfo,
    range: Option<FieldRange>,
) -> Option<DynamicEnum> {
    let least = |attributes: &CustomAttributes| {
        let range = attributes.get().copied().or(range);
        range.map_or(0.0, |range: FieldRange| range.min as f32)
    };
    let fields = match variant {
        VariantInfo::Unit(_) => DynamicVariant::Unit,
        VariantInfo::Struct(variant) => {
            let mut fields = DynamicStruct::default();
            for field in variant.iter() {
                let value = made(field.type_info()?, least(field.custom_attributes()))?;
                fields.insert_boxed(field.name(), value);
            }
            DynamicVariant::Struct(fields)
        }
        VariantInfo::Tuple(variant) => {
            let mut fields = DynamicTuple::default();
            for field in variant.iter() {
                let value = made(field.type_info()?, least(field.custom_attributes()))?;
                fields.insert_boxed(value);
            }
            DynamicVariant::Tuple(fields)
        }
    };
    Some(DynamicEnum::new(variant.name(), fields))
}

/// The enum with every other variant that has fields.
pub(super) fn other_variants(value: &dyn Enum, range: Option<FieldRange>) -> Vec<DynamicEnum> {
    let info = value.get_represented_enum_info().expect("a type");
    let others = info.iter().filter(|variant| {
        !matches!(variant, VariantInfo::Unit(_)) && variant.name() != value.variant_name()
    });
    let made = others.filter_map(|variant| made_variant(variant, range));
    made.collect()
}
