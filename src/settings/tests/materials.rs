//! The ranges that tools show for the toon material and for the components of objects are
//! those that are used.

use std::fmt::Debug;

use bevy::{
    math::{Vec2, Vec3},
    reflect::{
        NamedField, PartialReflect, ReflectMut, Typed,
        enums::{DynamicEnum, DynamicVariant, Enum, VariantInfo},
        structs::{DynamicStruct, Struct},
        tuple::DynamicTuple,
    },
};

use super::*;
use crate::settings::FieldRange;

/// A value far above or far below every range, of the type of a field; `None` if it is no number.
fn extreme(type_path: &str, high: bool) -> Option<Box<dyn PartialReflect>> {
    let number = if high { f32::MAX } else { f32::MIN };
    let count = if high { u32::MAX } else { 0 };
    Some(match type_path {
        "f32" => Box::new(number),
        "u32" => Box::new(count),
        "core::option::Option<f32>" => Box::new(Some(number)),
        "glam::Vec2" => Box::new(Vec2::splat(number)),
        "glam::Vec3" => Box::new(Vec3::splat(number)),
        path if path.starts_with("alloc::vec::Vec<") => {
            let stops = if high { 1000 } else { 0 };
            Box::new(vec![RampStop::default(); stops])
        }
        _ => return None,
    })
}

/// The numbers of a value: one, those of the axes, or the length of a list.
fn numbers(value: &dyn PartialReflect) -> Vec<f64> {
    if let Some(x) = value.try_downcast_ref::<f32>() {
        return vec![f64::from(*x)];
    }
    if let Some(x) = value.try_downcast_ref::<Option<f32>>() {
        return vec![f64::from(x.expect("on"))];
    }
    if let Some(x) = value.try_downcast_ref::<u32>() {
        return vec![f64::from(*x)];
    }
    if let Some(v) = value.try_downcast_ref::<Vec2>() {
        return v.to_array().map(f64::from).to_vec();
    }
    if let Some(v) = value.try_downcast_ref::<Vec3>() {
        return v.to_array().map(f64::from).to_vec();
    }
    let stops = value.try_downcast_ref::<Vec<RampStop>>().expect("stops");
    vec![stops.len() as f64]
}

/// `high`: whether the value came from above the range.
fn assert_end(name: &str, value: &dyn PartialReflect, range: FieldRange, high: bool) {
    let is_list = value.try_downcast_ref::<Vec<RampStop>>().is_some();
    for used in numbers(value) {
        if is_list && !high {
            // A list without items becomes the default one.
            assert!(used >= range.min, "{name}: {used} items");
            continue;
        }
        let wanted = if high { range.max } else { range.min };
        let apart = (used - wanted).abs();
        assert!(
            apart <= 1e-6 * wanted.abs(),
            "{name}: {used} is used, {wanted} is shown"
        );
    }
}

fn check<T: Struct + Typed + Default + Clone>(sanitized: impl Fn(T) -> T) {
    let info = T::type_info().as_struct().expect("a struct");
    let ranges = |field: &'static NamedField| Some((field, FieldRange::of(field)?));
    let mut count = 0;
    for (field, range) in info.iter().filter_map(ranges) {
        let name = format!("{}::{}", T::type_path(), field.name());
        for high in [false, true] {
            let mut value = T::default();
            let asked = extreme(field.type_path(), high).expect(&name);
            let slot = value.field_mut(field.name()).expect("its own field");
            // Applying a list keeps the items that it does not have.
            if let ReflectMut::List(items) = slot.reflect_mut() {
                while items.pop().is_some() {}
            }
            slot.apply(asked.as_ref());
            let used = sanitized(value);
            assert_end(
                &name,
                used.field(field.name()).expect("a field"),
                range,
                high,
            );
        }
        count += 1;
    }
    assert!(count > 0, "{} has no ranges", T::type_path());
}

/// Checks every number of every mode.
fn check_modes<T: Enum + Typed + Debug + Default>(sanitized: impl Fn(T) -> T) {
    let info = T::type_info().as_enum().expect("an enum");
    let mut count = 0;
    for variant in info.iter() {
        for high in [false, true] {
            let (fields, ranges) = mode(variant, high);
            let mut value = T::default();
            value.apply(&DynamicEnum::new(variant.name(), fields));
            let used = sanitized(value);
            assert_eq!(used.variant_name(), variant.name());
            for (i, range) in ranges.into_iter().enumerate() {
                let name = format!("{}::{}, {i}", T::type_path(), variant.name());
                assert_end(&name, used.field_at(i).expect("a field"), range, high);
                count += 1;
            }
        }
    }
    assert!(count > 0, "{} has no ranges", T::type_path());
}

/// The values of a mode, all of them extreme, and their ranges.
fn mode(variant: &'static VariantInfo, high: bool) -> (DynamicVariant, Vec<FieldRange>) {
    let value = |path: &str| extreme(path, high).unwrap_or_else(|| panic!("{path} is no number"));
    match variant {
        VariantInfo::Unit(_) => (DynamicVariant::Unit, Vec::new()),
        VariantInfo::Struct(variant) => {
            let mut fields = DynamicStruct::default();
            for field in variant.iter() {
                fields.insert_boxed(field.name(), value(field.type_path()));
            }
            let ranges = variant.iter().map(|f| FieldRange::of(f).expect("a range"));
            (DynamicVariant::Struct(fields), ranges.collect())
        }
        VariantInfo::Tuple(variant) => {
            let mut fields = DynamicTuple::default();
            for field in variant.iter() {
                fields.insert_boxed(value(field.type_path()));
            }
            let range = |f: &bevy::reflect::UnnamedField| *f.get_attribute().expect("a range");
            (
                DynamicVariant::Tuple(fields),
                variant.iter().map(range).collect(),
            )
        }
    }
}

#[test]
fn the_ranges_of_the_material_are_those_that_are_used() {
    check(ToonLight::sanitized);
    check(Ramp::sanitized);
    check::<RampStop>(|stop| Ramp::new([stop]).sanitized().stops[0]);
    check::<RampDetail>(|detail| {
        let ramp = Ramp {
            detail: Some(detail),
            ..Ramp::default()
        };
        ramp.sanitized().detail.expect("a second ramp")
    });
    check_modes(DetailAxis::sanitized);
    check(StylizedHighlight::sanitized);
    check(Rim::sanitized);
    check_modes::<RimWidth>(|width| {
        let rim = Rim {
            width,
            ..Rim::default()
        };
        rim.sanitized().width
    });
    check(ShadingProxy::sanitized);
    check_modes::<ProxyShape>(|shape| {
        let form = ShadingProxy {
            shape,
            ..ShadingProxy::default()
        };
        form.sanitized().shape
    });
}

#[test]
fn the_ranges_of_components_are_those_that_are_used() {
    check(OutlineStyle::sanitized);
    check(MeshSections::sanitized);
    check(ObjectSimplification::sanitized);
}

#[test]
fn any_alpha_cutoff_is_clamped() {
    fuzz("DepthWrite::alpha_cutoff", 0.01, 1.0, |x| {
        let write = crate::objects::DepthWrite {
            alpha_cutoff: x,
            ..Default::default()
        };
        write.sanitized().alpha_cutoff
    });
}
