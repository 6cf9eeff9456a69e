//! Steps of the history that change materials.

use bevy::prelude::*;

use super::{
    super::history::{Exchange, Subject},
    light_owner::LightOwner,
};
use bevy_comics::{ToonLight, ToonMaterial, ToonScene};

/// The lighting that was set in a place.
pub struct LightStep {
    pub place: LightOwner,
    pub light: ToonLight,
}

/// What an edit of the lighting in a place changes.
pub fn subject_of(place: &LightOwner) -> Subject {
    match place {
        LightOwner::Shading(shading) => Subject::Asset(shading.id().untyped()),
        LightOwner::Scene(root) => Subject::Part(*root, std::any::TypeId::of::<ToonScene>()),
        LightOwner::Material(material) => Subject::Asset(material.id().untyped()),
    }
}

impl Exchange for LightStep {
    fn subject(&self) -> Subject {
        subject_of(&self.place)
    }

    fn exchange(self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>> {
        let Self { place, light } = *self;
        let before = place.light(world)?.clone();
        place.set(world, light);
        Some(Box::new(Self {
            place,
            light: before,
        }))
    }
}

/// Meshes that have one of two materials.
pub struct MaterialStep {
    meshes: Vec<Entity>,
    standard: Handle<StandardMaterial>,
    toon: Handle<ToonMaterial>,
    /// Which one the step gives them.
    to_toon: bool,
}

impl MaterialStep {
    /// The step that gives a toon material to all meshes that have a standard material. `None`
    /// if that material has not loaded.
    pub fn toon(world: &mut World, standard: &Handle<StandardMaterial>) -> Option<Self> {
        let base = world
            .get_resource::<Assets<StandardMaterial>>()?
            .get(standard)?
            .clone();
        let toon = world
            .get_resource_mut::<Assets<ToonMaterial>>()?
            .add(ToonMaterial {
                base,
                extension: ToonLight::default(),
            });
        Some(Self {
            meshes: with_material(world, standard),
            standard: standard.clone(),
            toon,
            to_toon: true,
        })
    }
}

/// The meshes that have a material.
pub fn with_material<M: Material>(world: &mut World, material: &Handle<M>) -> Vec<Entity> {
    world
        .query::<(Entity, &MeshMaterial3d<M>)>()
        .iter(world)
        .filter(|(_, own)| own.0 == *material)
        .map(|(mesh, _)| mesh)
        .collect()
}

impl Exchange for MaterialStep {
    fn subject(&self) -> Subject {
        // The toon material is of the step alone.
        Subject::Asset(self.standard.id().untyped())
    }

    fn exchange(mut self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>> {
        let (standard, toon) = (&self.standard, &self.toon);
        let to_toon = self.to_toon;
        // Meshes that are gone, or that have a third material now, are left as they are.
        self.meshes.retain(|mesh| {
            if to_toon {
                replace(world, *mesh, standard, toon)
            } else {
                replace(world, *mesh, toon, standard)
            }
        });
        self.to_toon = !to_toon;
        (!self.meshes.is_empty()).then_some(self as Box<dyn Exchange>)
    }
}

/// Gives a mesh another material; whether it had the first one.
fn replace<A: Material, B: Material>(
    world: &mut World,
    mesh: Entity,
    from: &Handle<A>,
    to: &Handle<B>,
) -> bool {
    let Ok(mut mesh) = world.get_entity_mut(mesh) else {
        return false;
    };
    let has_it = mesh
        .get::<MeshMaterial3d<A>>()
        .is_some_and(|own| own.0 == *from);
    if has_it {
        mesh.remove::<MeshMaterial3d<A>>()
            .insert(MeshMaterial3d(to.clone()));
    }
    has_it
}
