//! Steps of the history that change materials.

use bevy::{
    asset::{Assets, Handle},
    ecs::{entity::Entity, world::World},
    pbr::{Material, MeshMaterial3d, StandardMaterial},
};

use super::super::history::{Exchange, Subject};
use crate::{CartoonLight, CartoonMaterial, CartoonScene, cartoon::LightPlace};

/// The lighting that was set in a place.
pub struct LightStep {
    pub place: LightPlace,
    pub light: CartoonLight,
}

/// What an edit of the lighting in a place changes.
pub fn subject_of(place: &LightPlace) -> Subject {
    match place {
        LightPlace::Look(look) => Subject::Asset(look.id().untyped()),
        LightPlace::Scene(root) => Subject::Part(*root, std::any::TypeId::of::<CartoonScene>()),
        LightPlace::Material(material) => Subject::Asset(material.id().untyped()),
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
    cartoon: Handle<CartoonMaterial>,
    /// Which one the step gives them.
    to_cartoon: bool,
}

impl MaterialStep {
    /// The step that gives a cartoon material to all meshes that have a standard material. `None`
    /// if that material has not loaded.
    pub fn cartoon(world: &mut World, standard: &Handle<StandardMaterial>) -> Option<Self> {
        let base = world
            .get_resource::<Assets<StandardMaterial>>()?
            .get(standard)?
            .clone();
        let cartoon = world
            .get_resource_mut::<Assets<CartoonMaterial>>()?
            .add(CartoonMaterial {
                base,
                extension: CartoonLight::default(),
            });
        Some(Self {
            meshes: with_material(world, standard),
            standard: standard.clone(),
            cartoon,
            to_cartoon: true,
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
        // The cartoon material is of the step alone.
        Subject::Asset(self.standard.id().untyped())
    }

    fn exchange(mut self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>> {
        let (standard, cartoon) = (&self.standard, &self.cartoon);
        let to_cartoon = self.to_cartoon;
        // Meshes that are gone, or that have a third material now, are left as they are.
        self.meshes.retain(|mesh| {
            if to_cartoon {
                replace(world, *mesh, standard, cartoon)
            } else {
                replace(world, *mesh, cartoon, standard)
            }
        });
        self.to_cartoon = !to_cartoon;
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
