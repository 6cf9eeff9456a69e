//! Where the lighting of a mesh is set, for the panel.

use bevy::{
    asset::{Assets, Handle},
    ecs::{entity::Entity, query::With, world::World},
    pbr::{MeshMaterial3d, StandardMaterial},
};

use super::{
    CartoonLight, CartoonMaterial, CartoonScene, ToonLook, ToonLookHandle, scene::Original,
};

/// What sets the lighting of a mesh last, so that an edit of it stays.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LightPlace {
    /// A look: that of the mesh, of the name of its material, or of its scene.
    Look(Handle<ToonLook>),
    /// [`CartoonScene::light`] of this entity.
    Scene(Entity),
    /// The material itself.
    Material(Handle<CartoonMaterial>),
}

impl LightPlace {
    /// `None` if the mesh has no cartoon material, or it has not loaded.
    pub fn of(world: &World, mesh: Entity) -> Option<Self> {
        let mesh = world.get_entity(mesh).ok()?;
        let material = &mesh.get::<MeshMaterial3d<CartoonMaterial>>()?.0;
        let Some(original) = mesh.get::<Original>() else {
            let own = mesh.get::<ToonLookHandle>().map(|own| &own.0);
            if let Some(look) = own.filter(|look| is_loaded(world, look)) {
                return Some(Self::Look(look.clone()));
            }
            let materials = world.get_resource::<Assets<CartoonMaterial>>()?;
            return materials
                .contains(material)
                .then(|| Self::Material(material.clone()));
        };
        let scene = world.get::<CartoonScene>(original.root)?;
        let look = [original.look.as_ref(), scene.look.as_ref()]
            .into_iter()
            .flatten()
            .find(|look| is_loaded(world, look));
        Some(look.map_or(Self::Scene(original.root), |look| Self::Look(look.clone())))
    }

    /// The lighting; `None` if the place is gone.
    pub fn light<'a>(&self, world: &'a World) -> Option<&'a CartoonLight> {
        match self {
            Self::Look(look) => {
                let looks = world.get_resource::<Assets<ToonLook>>()?;
                Some(&looks.get(look)?.light)
            }
            Self::Scene(root) => Some(&world.get::<CartoonScene>(*root)?.light),
            Self::Material(material) => {
                let materials = world.get_resource::<Assets<CartoonMaterial>>()?;
                Some(&materials.get(material)?.extension)
            }
        }
    }

    /// The title of a look; empty if it has none.
    pub fn title<'a>(&self, world: &'a World) -> &'a str {
        let looks = world.get_resource::<Assets<ToonLook>>();
        match self {
            Self::Look(look) => looks
                .and_then(|looks| looks.get(look))
                .map_or("", |look| &look.name),
            _ => "",
        }
    }

    /// Sets the lighting; whether the place is still there.
    pub fn set(&self, world: &mut World, light: CartoonLight) -> bool {
        match self {
            Self::Look(look) => {
                let looks = world.get_resource_mut::<Assets<ToonLook>>();
                let Some(mut looks) = looks else {
                    return false;
                };
                let look = looks.get_mut(look);
                look.map(|mut look| look.light = light).is_some()
            }
            Self::Scene(root) => {
                let scene = world.get_mut::<CartoonScene>(*root);
                scene.map(|mut scene| scene.light = light).is_some()
            }
            Self::Material(material) => {
                let materials = world.get_resource_mut::<Assets<CartoonMaterial>>();
                let Some(mut materials) = materials else {
                    return false;
                };
                let material = materials.get_mut(material);
                (material.map(|mut material| material.extension = light)).is_some()
            }
        }
    }

    /// The number of meshes whose lighting is set here.
    pub fn meshes(&self, world: &mut World) -> usize {
        let all: Vec<Entity> = world
            .query_filtered::<Entity, With<MeshMaterial3d<CartoonMaterial>>>()
            .iter(world)
            .collect();
        let world = &*world;
        let has_this = |mesh: &&Entity| Self::of(world, **mesh).as_ref() == Some(self);
        all.iter().filter(has_this).count()
    }
}

/// The standard material that a scene has replaced on a mesh.
pub(crate) fn original_of(world: &World, mesh: Entity) -> Option<&Handle<StandardMaterial>> {
    Some(&world.get::<Original>(mesh)?.material)
}

fn is_loaded(world: &World, look: &Handle<ToonLook>) -> bool {
    let looks = world.get_resource::<Assets<ToonLook>>();
    looks.is_some_and(|looks| looks.contains(look))
}

#[cfg(test)]
mod tests;
