//! Where the lighting of a mesh is set.

use bevy::prelude::*;

use bevy_comics::{ToonLight, ToonMaterial, ToonScene, ToonShadingHandle, toon::ToonShading};

/// What sets the lighting of a mesh last, so that an edit of it stays.
#[derive(Clone, Debug, PartialEq)]
pub enum LightOwner {
    /// A shading: that of the mesh, of the name of its material, or of its scene.
    Shading(Handle<ToonShading>),
    /// [`ToonScene::light`] of this entity.
    Scene(Entity),
    /// The material itself.
    Material(Handle<ToonMaterial>),
}

impl LightOwner {
    /// `None` if the mesh has no toon material, it has not loaded, or the style of a camera lights
    /// it.
    pub fn of(world: &World, mesh: Entity) -> Option<Self> {
        let mesh = world.get_entity(mesh).ok()?;
        let material = &mesh.get::<MeshMaterial3d<ToonMaterial>>()?.0;
        let Some((root, _, chosen)) = ToonScene::original(mesh) else {
            let own = mesh.get::<ToonShadingHandle>().map(|own| &own.0);
            if let Some(shading) = own.filter(|shading| is_loaded(world, shading)) {
                return Some(Self::Shading(shading.clone()));
            }
            let materials = world.get_resource::<Assets<ToonMaterial>>()?;
            return materials
                .contains(material)
                .then(|| Self::Material(material.clone()));
        };
        let scene = world.get::<ToonScene>(root);
        let shading = [chosen, scene.and_then(|scene| scene.shading.as_ref())]
            .into_iter()
            .flatten()
            .find(|shading| is_loaded(world, shading));
        let of_scene = || scene.map(|_| Self::Scene(root));
        shading.cloned().map(Self::Shading).or_else(of_scene)
    }

    /// The lighting; `None` if the place is gone.
    pub fn light<'a>(&self, world: &'a World) -> Option<&'a ToonLight> {
        match self {
            Self::Shading(shading) => {
                let shadings = world.get_resource::<Assets<ToonShading>>()?;
                Some(&shadings.get(shading)?.light)
            }
            Self::Scene(root) => Some(&world.get::<ToonScene>(*root)?.light),
            Self::Material(material) => {
                let materials = world.get_resource::<Assets<ToonMaterial>>()?;
                Some(&materials.get(material)?.extension)
            }
        }
    }

    /// The title of a shading; empty if it has none.
    pub fn title<'a>(&self, world: &'a World) -> &'a str {
        let shadings = world.get_resource::<Assets<ToonShading>>();
        match self {
            Self::Shading(shading) => shadings
                .and_then(|shadings| shadings.get(shading))
                .map_or("", |shading| &shading.name),
            _ => "",
        }
    }

    /// Sets the lighting; `None` if the place is gone.
    pub fn set(&self, world: &mut World, light: ToonLight) -> Option<()> {
        match self {
            Self::Shading(shading) => {
                let mut shadings = world.get_resource_mut::<Assets<ToonShading>>()?;
                shadings.get_mut(shading)?.light = light;
            }
            Self::Scene(root) => world.get_mut::<ToonScene>(*root)?.light = light,
            Self::Material(material) => {
                let mut materials = world.get_resource_mut::<Assets<ToonMaterial>>()?;
                materials.get_mut(material)?.extension = light;
            }
        }
        Some(())
    }

    /// The number of meshes whose lighting is set here.
    pub fn meshes(&self, world: &mut World) -> usize {
        let all: Vec<Entity> = world
            .query_filtered::<Entity, With<MeshMaterial3d<ToonMaterial>>>()
            .iter(world)
            .collect();
        let world = &*world;
        let has_this = |mesh: &&Entity| Self::of(world, **mesh).as_ref() == Some(self);
        all.iter().filter(has_this).count()
    }
}

fn is_loaded(world: &World, shading: &Handle<ToonShading>) -> bool {
    let shadings = world.get_resource::<Assets<ToonShading>>();
    shadings.is_some_and(|shadings| shadings.contains(shading))
}

#[cfg(test)]
mod tests;
