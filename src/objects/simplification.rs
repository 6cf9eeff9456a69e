//! Objects that are simpler or more detailed than their distance makes them.

use bevy::prelude::*;

use super::inherit::{Inherited, Values};
use crate::settings::{FieldRange, impl_sanitized};

/// Changes how much effects simplify this object with distance: a hero keeps all details, or a
/// crowd is simple even near the camera.
///
/// Effects follow it that simplify whole objects; of this crate's,
/// [`Abstraction`](crate::Abstraction) with
/// [`Granularity::Object`](crate::effects::Granularity::Object), which is the default. The meshes
/// of an [`OutlineGroup`](crate::OutlineGroup) are one object: if several of them have this
/// component, it is not specified which one applies.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ObjectSimplification {
    /// Simplification of the object at every distance: 0 is all detail, 1 is none. `None` keeps the
    /// simplification by distance. Range 0 to 1, default `None`.
    #[reflect(@FieldRange::FRACTION)]
    pub level: Option<f32>,
    /// Added to it; the sum is limited to 0 and 1. Range -1 to 1, default 0.
    #[reflect(@FieldRange::linear(-1.0, 1.0))]
    pub offset: f32,
    /// Applies to all descendants as well, except for those with an `ObjectSimplification` of their
    /// own. Default: `true`.
    pub inherit: bool,
}

impl Default for ObjectSimplification {
    fn default() -> Self {
        Self {
            level: None,
            offset: 0.0,
            inherit: true,
        }
    }
}

impl ObjectSimplification {
    /// For an object and its descendants: the simplification is `level` at every distance.
    pub const fn fixed(level: f32) -> Self {
        Self {
            level: Some(level),
            offset: 0.0,
            inherit: true,
        }
    }

    /// The factor of the simplification by distance, and what is added to it.
    fn factor_and_offset(self) -> Vec2 {
        let s = self.sanitized();
        match s.level {
            Some(level) => Vec2::new(0.0, level + s.offset),
            None => Vec2::new(1.0, s.offset),
        }
    }
}

impl_sanitized!(ObjectSimplification);

/// The factor and offset of an object without an [`ObjectSimplification`].
pub(super) const BY_DISTANCE: Vec2 = Vec2::X;

/// The factor and offset of each mesh that has a simplification of its own.
pub(super) type Simplifications = Values<ObjectSimplification, Vec2>;

/// Keeps [`Simplifications`] up to date.
pub(super) fn assign_simplifications(
    mut simplified: Inherited<ObjectSimplification>,
    mut simplifications: ResMut<Simplifications>,
) {
    simplifications.update(&mut simplified, |own| own.factor_and_offset());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_and_offsets_are_within_their_ranges() {
        let of = |level, offset| {
            ObjectSimplification {
                level,
                offset,
                inherit: false,
            }
            .factor_and_offset()
        };
        assert_eq!(
            ObjectSimplification::default().factor_and_offset(),
            BY_DISTANCE
        );
        assert_eq!(of(None, 0.25), Vec2::new(1.0, 0.25));
        assert_eq!(of(Some(0.5), -0.25), Vec2::new(0.0, 0.25));
        assert_eq!(of(Some(7.0), -9.0), Vec2::new(0.0, 0.0));
        assert_eq!(of(Some(f32::NAN), f32::NAN), Vec2::new(0.0, 0.0));
        assert_eq!(of(None, f32::INFINITY).x, 1.0);
        assert!(of(None, f32::INFINITY).y.abs() <= 1.0);
    }
}
