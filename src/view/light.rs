//! The light that lines follow.

#[cfg(any(feature = "objects", feature = "cartoon"))]
use bevy::light::DirectionalLight;
use bevy::{
    ecs::{
        component::Component,
        query::With,
        reflect::ReflectComponent,
        system::{Query, SystemParam},
    },
    math::Vec3,
    prelude::GlobalTransform,
    reflect::{Reflect, std_traits::ReflectDefault},
};

/// Lines follow the light of this entity: it shines forward (along the entity's -Z), as a
/// directional light does. See [`LineWeight::shade`](crate::LineWeight::shade).
///
/// Without a key light, lines follow the brightest `DirectionalLight` of the scene; without
/// any, a light from straight above. Of several key lights, one is taken.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct KeyLight;

/// The lights of a scene that lines can follow.
#[derive(SystemParam)]
pub(super) struct Lights<'w, 's> {
    key: Query<'w, 's, &'static GlobalTransform, With<KeyLight>>,
    #[cfg(any(feature = "objects", feature = "cartoon"))]
    directional: Query<'w, 's, (&'static GlobalTransform, &'static DirectionalLight)>,
}

impl Lights<'_, '_> {
    /// Unit vector towards the light that lines follow, in world space.
    pub fn to_light(&self) -> Vec3 {
        let towards = |light: &GlobalTransform| light.back().as_vec3();
        let found = self.key.iter().next().map(towards);
        #[cfg(any(feature = "objects", feature = "cartoon"))]
        let found = found.or_else(|| {
            let brightest = self
                .directional
                .iter()
                .max_by(|a, b| a.1.illuminance.total_cmp(&b.1.illuminance));
            brightest.map(|(light, _)| towards(light))
        });
        found
            .filter(|to_light| to_light.is_finite())
            .unwrap_or(Vec3::Y)
    }
}
