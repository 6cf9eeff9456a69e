//! The object that effects of a camera point at.

use bevy::prelude::*;

/// On a camera: the object that effects of this camera point at, such as
/// [`SpeedLines`](crate::SpeedLines). They follow it over the screen.
///
/// Effects use their own center while the entity does not exist, has no `GlobalTransform`,
/// or is behind the camera.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Clone, PartialEq)]
pub struct EffectTarget {
    /// The object.
    pub entity: Entity,
    /// The point of the object, in its own frame of reference and its units. Default: its
    /// origin.
    pub offset: Vec3,
}

impl EffectTarget {
    /// The origin of an object.
    pub const fn new(entity: Entity) -> Self {
        Self {
            entity,
            offset: Vec3::ZERO,
        }
    }
}

/// Where a world position is in the viewport, in physical pixels from its top left corner;
/// `None` if it is behind the camera.
pub(crate) fn place_in(viewport: UVec4, clip_from_world: Mat4, position: Vec3) -> Option<Vec2> {
    let clip = clip_from_world * position.extend(1.0);
    let device = Vec2::new(clip.x, clip.y) / clip.w;
    let size = Vec2::new(viewport.z as f32, viewport.w as f32);
    let place = (device * Vec2::new(0.5, -0.5) + 0.5) * size;
    (clip.w > 0.0 && place.is_finite()).then_some(place)
}
