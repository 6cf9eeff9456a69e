//! Numbers of settings that are no effects, whatever they are.

use std::fmt::Debug;

use bevy::prelude::*;

use super::non_finite::{Numbers, cases, scramble, wrong};
use crate::{
    DepthMap,
    depth::RangeSmoothing,
    effects::DepthLayer,
    lines::{Creases, EdgeStyle, LineBoil, LineWeight, ObjectEdges, Silhouettes},
};

/// Those that are used are in their ranges, and stay as they are when they are used again.
fn check<T: PartialReflect + Clone + PartialEq + Debug + Default>(sanitized: fn(T) -> T) {
    let mut numbers = Numbers::new(5);
    for _ in 0..cases() / 10 {
        let mut value = T::default();
        scramble(&mut value, &mut numbers);
        let used = sanitized(value.clone());
        assert_eq!(wrong(&used, None), None, "{value:?}");
        assert_eq!(used, sanitized(used.clone()), "{value:?}");
    }
}

#[test]
fn any_number_of_lines_and_depth_is_clamped() {
    check(DepthMap::sanitized);
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
fn any_number_of_a_component_is_clamped() {
    use crate::{MotionLines, SteppedAnimation, objects};

    check(objects::OutlineStyle::sanitized);
    check(objects::SelectionOutline::sanitized);
    check(objects::XRayOutline::sanitized);
    check(objects::MeshSections::sanitized);
    check(objects::ObjectSimplification::sanitized);
    check(objects::DepthWrite::sanitized);
    check(MotionLines::sanitized);
    check(SteppedAnimation::sanitized);
}
