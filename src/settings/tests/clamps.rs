//! Below, inside and above the range of every number, and numbers that are not finite.

use std::fmt::Debug;

use bevy::{
    color::{Color, ColorToComponents, LinearRgba},
    reflect::{PartialReflect, ReflectRef},
};

use super::places::{Place, components, is_color, made, other_variants};
use crate::{
    DepthMap, DepthMapping,
    depth::RangeSmoothing,
    effect::{AnyEffect, EffectRegistry},
    effects::DepthLayer,
    lines::{Creases, EdgeStyle, LineBoil, LineWeight, ObjectEdges, Silhouettes},
    settings::FieldRange,
};

/// How values are read, edited and sanitized.
struct Access<T> {
    view: fn(&T) -> &dyn PartialReflect,
    edit: fn(&mut T) -> &mut dyn PartialReflect,
    used: fn(T) -> T,
}

#[test]
fn every_number_of_an_effect_is_clamped_to_its_range() {
    let access = Access::<Box<dyn AnyEffect>> {
        view: |effect| effect.as_struct().as_partial_reflect(),
        edit: |effect| effect.as_struct_mut().as_partial_reflect_mut(),
        used: |effect| effect.any_sanitized(),
    };
    for effect in EffectRegistry::built_in().types() {
        let count = access.check(effect.name, (effect.default)());
        // Counted by hand, those of all options and variants included.
        let least = match effect.name {
            "outlines" => 48,
            "depth_layers" => 34,
            "black_flats" => 5,
            _ => 1,
        };
        assert!(count >= least, "{}: {count} numbers", effect.name);
    }
}

fn check<T: PartialReflect + Clone + PartialEq + Debug + Default>(used: fn(T) -> T) {
    let access = Access {
        view: |value: &T| value,
        edit: |value: &mut T| value,
        used,
    };
    let name = std::any::type_name::<T>();
    assert!(access.check(name, T::default()) > 0, "{name} has no ranges");
}

#[test]
fn every_number_of_lines_and_depth_is_clamped_to_its_range() {
    // A distance of the sky that is not finite is none: see `values.rs`.
    check(|map: DepthMap| {
        let finite = |distance: f32| {
            if distance.is_finite() {
                distance
            } else {
                0.001
            }
        };
        let sky_beyond = map.sky_beyond.map(finite);
        DepthMap { sky_beyond, ..map }.sanitized()
    });
    check(RangeSmoothing::sanitized);
    check(DepthLayer::sanitized);
    check(Silhouettes::sanitized);
    check(Creases::sanitized);
    check(ObjectEdges::sanitized);
    check(EdgeStyle::sanitized);
    check(LineWeight::sanitized);
    check(LineBoil::sanitized);
}

#[cfg(all(feature = "toon", feature = "objects"))]
#[test]
fn every_number_of_materials_and_components_is_clamped_to_its_range() {
    use crate::{MotionLines, SteppedAnimation, ToonLight, objects, toon};

    check(ToonLight::sanitized);
    check(toon::Ramp::sanitized);
    check(|stop: toon::RampStop| toon::Ramp::new([stop]).sanitized().stops[0]);
    check(toon::StylizedHighlight::sanitized);
    check(toon::Rim::sanitized);
    check(toon::ShadingProxy::sanitized);
    check(objects::OutlineStyle::sanitized);
    check(objects::SelectionOutline::sanitized);
    check(objects::XRayOutline::sanitized);
    check(objects::MeshSections::sanitized);
    check(objects::ObjectSimplification::sanitized);
    check(objects::DepthWrite::sanitized);
    check(MotionLines::sanitized);
    check(SteppedAnimation::sanitized);
}

impl<T: Clone + PartialEq + Debug> Access<T> {
    /// Checks every number and color of a default, and of the default with every other variant of
    /// its enums and options. Returns the number of numbers.
    fn check(&self, name: &str, default: T) -> usize {
        let mut todo = vec![(default, Place::root(name))];
        let mut count = 0;
        while let Some((value, below)) = todo.pop() {
            for place in below.all_below((self.view)(&value)) {
                let field = place.get((self.view)(&value));
                if is_color(field) {
                    self.check_color(&value, &place);
                } else if let (Some(_), Some(range)) = (components(field), place.range()) {
                    self.check_number(&value, &place, range);
                    count += 1;
                } else if let ReflectRef::Enum(field) = field.reflect_ref() {
                    // Its two numbers are put in order: see `values.rs`.
                    if field.as_partial_reflect().represents::<DepthMapping>() {
                        continue;
                    }
                    for variant in other_variants(field, place.range()) {
                        let next = self.with(&value, &place, &variant);
                        todo.push((next, place.clone()));
                    }
                }
            }
        }
        count
    }

    fn with(&self, value: &T, place: &Place, part: &dyn PartialReflect) -> T {
        let mut value = value.clone();
        place.get_mut((self.edit)(&mut value)).apply(part);
        value
    }

    fn check_number(&self, value: &T, place: &Place, range: FieldRange) {
        let (low, high) = (range.min as f32, range.max as f32);
        let field = place.get((self.view)(value));
        let info = field.get_represented_type_info().expect("a type");
        let put = |x: f32| self.with(value, place, &*made(info, x).expect("a number"));
        let after = |x: f32| {
            let used = (self.used)(put(x));
            components(place.get((self.view)(&used))).expect("a number")
        };
        let outside = [
            (f32::MIN, low),
            (low.next_down(), low),
            (high.next_up(), high),
            (f32::MAX, high),
        ];
        for (x, want) in outside {
            let found = after(x);
            let is_end = found.iter().all(|used| *used == want);
            assert!(is_end, "{}: {x} became {found:?}", place.name);
        }
        for x in [low, 0.5 * (low + high), high] {
            let inside = put(x);
            assert_eq!((self.used)(inside.clone()), inside, "{}: {x}", place.name);
        }
        // Deeper ones are those of other types, or of variants: see `values.rs`.
        let has_default = place.path.len() == 1 && field.try_downcast_ref::<u32>().is_none();
        let default = components(field).filter(|_| has_default);
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let found = after(x);
            let is_right = match &default {
                Some(default) => found == *default,
                None => found.iter().all(|used| (low..=high).contains(used)),
            };
            assert!(is_right, "{}: {x} became {found:?}", place.name);
        }
    }

    fn check_color(&self, value: &T, place: &Place) {
        let after = |color: Color| {
            let used = (self.used)(self.with(value, place, &color));
            let color = place.get((self.view)(&used)).try_downcast_ref::<Color>();
            *color.expect("a color")
        };
        let inside = Color::linear_rgb(0.25, 0.5, 0.75);
        assert_eq!(after(inside), inside, "{}", place.name);
        let outside = after(Color::linear_rgb(2.0, -1.0, 0.5)).to_linear();
        assert_eq!(outside, LinearRgba::rgb(1.0, 0.0, 0.5), "{}", place.name);
        let odd = after(Color::linear_rgb(f32::NAN, 0.5, 0.5)).to_linear();
        let is_shown = odd.to_f32_array().iter().all(|c| (0.0..=1.0).contains(c));
        assert!(is_shown, "{}: {odd:?}", place.name);
    }
}
