//! The effects of the page.

use super::*;

/// Every number of an effect by its documented range.
fn fuzz_fields<E: Effect>() {
    use bevy::reflect::TypeInfo;
    let TypeInfo::Struct(info) = E::type_info() else {
        panic!("{} is no struct", E::NAME);
    };
    for field in info.iter() {
        let Some(range) = crate::settings::FieldRange::of(field) else {
            continue;
        };
        if E::default()
            .field(field.name())
            .and_then(|value| value.try_downcast_ref::<f32>())
            .is_none()
        {
            continue;
        }
        let (low, high) = (range.min as f32, range.max as f32);
        fuzz(&format!("{}::{}", E::NAME, field.name()), low, high, |x| {
            let mut effect = E::default();
            let slot = effect.field_mut(field.name()).expect("its own field");
            *slot.try_downcast_mut::<f32>().expect("a number") = x;
            let used = effect.sanitized();
            let slot = used.field(field.name()).expect("its own field");
            *slot.try_downcast_ref::<f32>().expect("a number")
        });
    }
}

#[test]
fn any_number_of_the_page_effects_is_clamped() {
    fuzz_fields::<ColorHarmony>();
    fuzz_fields::<DepthLayers>();
    fuzz_fields::<Abstraction>();
    fuzz_fields::<Halftone>();
    fuzz_fields::<Hatching>();
    fuzz_fields::<Misregistration>();
    fuzz_fields::<Paint>();
    fuzz_fields::<Focus>();
    fuzz_fields::<Vignette>();
}
