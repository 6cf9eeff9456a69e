//! The range that tools show for a field is the range that is used.

use super::*;

/// The `FieldRange` of a field, which tools show, is the range of `sanitized`.
#[test]
fn the_range_on_a_field_is_the_range_that_is_used() {
    use bevy::{
        math::Vec2,
        reflect::{TypeInfo, Typed, structs::Struct},
    };

    fn check<T: Struct + Typed + Default + Clone>(sanitized: impl Fn(T) -> T) {
        let TypeInfo::Struct(info) = T::type_info() else {
            panic!("{} is no struct", T::type_path());
        };
        let mut numbers = 0;
        for field in info.iter() {
            let Some(range) = crate::settings::FieldRange::of(field) else {
                continue;
            };
            for (asked, wanted) in [(f32::MAX, range.max), (f32::MIN, range.min)] {
                let mut value = T::default();
                let slot = value.field_mut(field.name()).expect("its own field");
                let whole = if asked > 0.0 { u32::MAX } else { 0 };
                if let Some(number) = slot.try_downcast_mut::<f32>() {
                    *number = asked;
                } else if let Some(number) = slot.try_downcast_mut::<Option<f32>>() {
                    *number = Some(asked);
                } else if let Some(vector) = slot.try_downcast_mut::<Vec2>() {
                    *vector = Vec2::splat(asked);
                } else if let Some(number) = slot.try_downcast_mut::<u32>() {
                    *number = whole;
                } else {
                    panic!("{} has a range and is no number", field.name());
                }
                let used = sanitized(value);
                let slot = used.field(field.name()).expect("its own field");
                let used = slot
                    .try_downcast_ref::<f32>()
                    .map(|x| f64::from(*x))
                    .or(slot
                        .try_downcast_ref::<Option<f32>>()
                        .and_then(|x| x.map(f64::from)))
                    .or(slot.try_downcast_ref::<Vec2>().map(|v| f64::from(v.y)))
                    .or(slot.try_downcast_ref::<u32>().map(|x| f64::from(*x)))
                    .expect("a number");
                let apart = (used - wanted).abs();
                assert!(
                    apart <= 1e-6 * wanted.abs(),
                    "{}::{}: {used} is used, {wanted} is shown",
                    T::type_path(),
                    field.name()
                );
            }
            numbers += 1;
        }
        assert!(numbers > 0, "{} has no numbers", T::type_path());
    }
    check(ToneBands::sanitized);
    check(Desaturation::sanitized);
    check(Colorization::sanitized);
    check(ColorHarmony::sanitized);
    check(DepthLayers::sanitized);
    check(Abstraction::sanitized);
    check(DepthLayer::sanitized);
    check(BlackFlats::sanitized);
    check(Contours::sanitized);
    check(Outlines::sanitized);
    check(Silhouettes::sanitized);
    check(Creases::sanitized);
    check(EdgeStyle::sanitized);
    check(ObjectEdges::sanitized);
    check(Sketch::sanitized);
    check(ToneRamp::sanitized);
    check(TwoTone::sanitized);
    check(SpeedLines::sanitized);
    check(Paper::sanitized);
    check(Halftone::sanitized);
    check(Hatching::sanitized);
    check(Misregistration::sanitized);
    check(Paint::sanitized);
    check(Focus::sanitized);
    check(Vignette::sanitized);
    check(DepthMap::sanitized);
    check(RangeSmoothing::sanitized);
}
