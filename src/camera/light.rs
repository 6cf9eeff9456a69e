//! The light that lines follow.

use bevy::{ecs::system::SystemParam, prelude::*};

/// Lines follow the light of this entity: it shines forward (along the entity's -Z), as a
/// directional light does. See [`LineWeight::shade`](crate::lines::LineWeight::shade).
///
/// Without a key light, lines follow the brightest visible `DirectionalLight` of the scene, if the
/// crate has the feature `objects` or `toon`; without any, a light from straight above. If there
/// are several key lights, one of them is used.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[require(Transform)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct KeyLight;

/// The lights of a scene that lines can follow.
#[derive(SystemParam)]
pub(super) struct Lights<'w, 's> {
    key: Query<'w, 's, &'static GlobalTransform, With<KeyLight>>,
    #[cfg(any(feature = "objects", feature = "toon"))]
    directional: Query<
        'w,
        's,
        (
            &'static GlobalTransform,
            &'static DirectionalLight,
            &'static InheritedVisibility,
        ),
    >,
}

impl Lights<'_, '_> {
    /// Unit vector towards the light that lines follow, in world space.
    pub fn to_light(&self) -> Vec3 {
        // A light of scale 0 has no direction.
        let towards = |light: &GlobalTransform| (light.affine().matrix3 * Vec3A::Z).try_normalize();
        let found = self.key.iter().find_map(towards);
        #[cfg(any(feature = "objects", feature = "toon"))]
        let found = found.or_else(|| {
            let visible = self.directional.iter().filter(|light| light.2.get());
            let brightest = visible.max_by(|a, b| a.1.illuminance.total_cmp(&b.1.illuminance));
            brightest.and_then(|(light, ..)| towards(light))
        });
        found.map_or(Vec3::Y, Vec3::from)
    }
}
