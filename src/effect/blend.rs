//! Interpolates between two effects of one type.
//!
//! Numbers and vectors are interpolated linearly, numbers of logarithmic ranges by ratio,
//! colours in `OKLab`. A mode has
//! no value in between: the effect fades out, its mode changes at half time, when
//! it has no strength, and it fades in again, so that the picture does not jump.
//! Only fields with [`BlendField::Switch`] change at half time without a fade.

use bevy::{
    color::Color,
    math::{FloatExt, Vec2, Vec3},
    reflect::{NamedField, TypeInfo},
};

use super::Effect;
use crate::settings::{BlendField, FieldRange, blend_color, blend_ratio, crossfade_weight};

/// The effect between `a` (`t` = 0) and `b` (`t` = 1). If only one side has it, it
/// fades. If the depth map is `remapped`, the part that depends on the map fades
/// out until half time, and in again.
pub(super) fn blend<E: Effect>(a: Option<E>, b: Option<E>, t: f32, remapped: bool) -> Option<E> {
    let effect = match (a, b) {
        (None, None) => return None,
        (Some(a), None) => a.faded(1.0 - t),
        (None, Some(b)) => b.faded(t),
        (Some(a), Some(b)) => {
            let mixed = if t < 0.5 {
                a.mixed(&b, t)
            } else {
                b.mixed(&a, 1.0 - t)
            };
            if !a.same_modes(&b) {
                // No need to fade the map as well: the effect has no strength at
                // half time.
                return Some(mixed.faded(crossfade_weight(t)));
            }
            mixed
        }
    };
    Some(if remapped {
        effect.map_faded(crossfade_weight(t))
    } else {
        effect
    })
}

/// The fields of an effect, which the bounds of [`Effect`] require to be a struct.
fn fields<E: Effect>() -> impl Iterator<Item = &'static NamedField> {
    let info = match E::type_info() {
        TypeInfo::Struct(info) => Some(info),
        _ => None,
    };
    info.into_iter().flat_map(|info| info.iter())
}

pub(crate) fn mixed<E: Effect>(a: &E, b: &E, t: f32) -> E {
    let mut mixed = a.clone();
    for field in fields::<E>() {
        if field.has_attribute::<BlendField>() {
            continue;
        }
        let name = field.name();
        let (Some(slot), Some(other)) = (mixed.field_mut(name), b.field(name)) else {
            continue;
        };
        if let (Some(slot), Some(other)) = (
            slot.try_downcast_mut::<f32>(),
            other.try_downcast_ref::<f32>(),
        ) {
            let by_ratio = FieldRange::of(field).is_some_and(|range| range.logarithmic);
            *slot = if by_ratio {
                blend_ratio(*slot, *other, t)
            } else {
                FloatExt::lerp(*slot, *other, t)
            };
        } else if let (Some(slot), Some(other)) = (
            slot.try_downcast_mut::<Color>(),
            other.try_downcast_ref::<Color>(),
        ) {
            *slot = blend_color(*slot, *other, t);
        } else if let (Some(slot), Some(other)) = (
            slot.try_downcast_mut::<Vec2>(),
            other.try_downcast_ref::<Vec2>(),
        ) {
            *slot = slot.lerp(*other, t);
        } else if let (Some(slot), Some(other)) = (
            slot.try_downcast_mut::<Vec3>(),
            other.try_downcast_ref::<Vec3>(),
        ) {
            *slot = slot.lerp(*other, t);
        }
    }
    mixed
}

pub(super) fn same_modes<E: Effect>(a: &E, b: &E) -> bool {
    fields::<E>().all(|field| {
        let name = field.name();
        let (Some(a), Some(b)) = (a.field(name), b.field(name)) else {
            return true;
        };
        field.has_attribute::<BlendField>()
            || a.try_downcast_ref::<f32>().is_some()
            || a.try_downcast_ref::<Color>().is_some()
            || a.try_downcast_ref::<Vec2>().is_some()
            || a.try_downcast_ref::<Vec3>().is_some()
            || a.reflect_partial_eq(b).unwrap_or(false)
    })
}
