//! Worlds whose origin moves.

use bevy::{math::DVec3, prelude::*};

/// The true position of the origin of the world that is rendered, in world units, for games with a
/// floating origin. Counts as zero if a component is not finite. Default: zero.
///
/// A system that adds a vector to the transforms of all roots subtracts it here, before transforms are
/// propagated. Then strokes and dots of [`Hatching`](crate::Hatching) stay on the surfaces,
/// [`IsoLines`](crate::IsoLines) at their heights and distances, and objects with
/// [`MotionLines`](crate::MotionLines) or [`SteppedAnimation`](crate::SteppedAnimation) have not
/// moved. Nothing else depends on the place. Insert the resource before the first frame: with it,
/// these two effects have other shaders. See `docs/big-worlds.md`.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Resource, Default, Clone, PartialEq)]
pub struct WorldOrigin(pub DVec3);

impl WorldOrigin {
    /// The position that is used; zero without the resource.
    pub(crate) fn of(origin: Option<&Self>) -> DVec3 {
        let origin = origin.map_or(DVec3::ZERO, |origin| origin.0);
        if origin.is_finite() {
            return origin;
        }
        warn_once!("`WorldOrigin` is {origin}, which is not finite: zero is used");
        DVec3::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_that_are_not_finite_count_as_zero() {
        let far = DVec3::new(1e12, -0.5, 0.0);
        assert_eq!(WorldOrigin::of(Some(&WorldOrigin(far))), far);
        assert_eq!(WorldOrigin::of(None), DVec3::ZERO);
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let origin = WorldOrigin(far.with_y(x));
            assert_eq!(WorldOrigin::of(Some(&origin)), DVec3::ZERO);
        }
    }
}
