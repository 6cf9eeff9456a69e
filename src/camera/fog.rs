//! The engine's distance fog of a camera.

use bevy::ecs::{entity::Entity, system::SystemParam};

use crate::lines::ViewFog;

/// The distance fogs of cameras.
#[derive(SystemParam)]
pub(super) struct Fogs<'w, 's> {
    #[cfg(any(feature = "objects", feature = "toon"))]
    fogs: bevy::ecs::system::Query<'w, 's, &'static bevy::pbr::DistanceFog>,
    #[cfg(not(any(feature = "objects", feature = "toon")))]
    none: std::marker::PhantomData<(&'w (), &'s ())>,
}

impl Fogs<'_, '_> {
    /// The fog of a camera; `None` if it has none, or one that hides nothing.
    #[cfg(any(feature = "objects", feature = "toon"))]
    pub fn of(&self, camera: Entity) -> Option<ViewFog> {
        use bevy::{color::Alpha, math::Vec3, pbr::FogFalloff};
        let fog = self.fogs.get(camera).ok()?;
        let (falloff, numbers) = match fog.falloff {
            FogFalloff::Linear { start, end } => (0, Vec3::new(start, end, 0.0)),
            FogFalloff::Exponential { density } => (1, Vec3::splat(density)),
            FogFalloff::ExponentialSquared { density } => (2, Vec3::splat(density)),
            FogFalloff::Atmospheric { extinction, .. } => (3, extinction),
        };
        let most = fog.color.alpha();
        let seen = numbers.is_finite() && most.is_finite() && most > 0.0;
        seen.then_some(ViewFog {
            falloff,
            numbers,
            most,
        })
    }

    /// Without the engine's materials there is no distance fog.
    #[cfg(not(any(feature = "objects", feature = "toon")))]
    pub fn of(&self, _: Entity) -> Option<ViewFog> {
        let _ = self.none;
        None
    }
}
