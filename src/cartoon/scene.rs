//! A component that draws a whole scene with the cartoon material.

use bevy::{
    asset::{AssetEvent, AssetId, Assets, Handle},
    ecs::{
        change_detection::{DetectChanges, Ref},
        component::Component,
        entity::Entity,
        hierarchy::ChildOf,
        lifecycle::RemovedComponents,
        message::MessageReader,
        query::With,
        reflect::ReflectComponent,
        system::{Commands, Local, Query, Res, ResMut},
    },
    material::OpaqueRendererMethod,
    pbr::{MeshMaterial3d, StandardMaterial},
    platform::collections::HashMap,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

use super::{CartoonLight, CartoonMaterial};

/// Draws an entity and all its descendants with [`CartoonMaterial`]. Put it on the
/// root of a glTF scene, for example.
///
/// Every `MeshMaterial3d<StandardMaterial>` on these entities is replaced by a
/// cartoon copy of its material, also on entities that are spawned later. The copy
/// follows changes of the standard material and of this component. Removing the
/// component restores the standard materials. If several ancestors of an entity have
/// the component, the nearest one applies.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CartoonScene {
    /// Lighting of the materials. Default: [`CartoonLight::default`].
    pub light: CartoonLight,
}

/// On a converted mesh: its standard material, and the root that converted it.
#[derive(Component)]
pub(super) struct Original {
    material: Handle<StandardMaterial>,
    root: Entity,
}

/// The cartoon copies by root and standard material, so that meshes that share a
/// material share its copy.
pub(super) type Copies = HashMap<(Entity, AssetId<StandardMaterial>), Handle<CartoonMaterial>>;

/// The nearest entity with a [`CartoonScene`] among an entity and its ancestors.
fn root_of(
    entity: Entity,
    parents: &Query<&ChildOf>,
    roots: &Query<Ref<CartoonScene>>,
) -> Option<Entity> {
    let above = parents.iter_ancestors(entity);
    std::iter::once(entity)
        .chain(above)
        .find(|e| roots.contains(*e))
}

/// The cartoon copy of a standard material.
fn copy(original: &StandardMaterial, light: &CartoonLight) -> CartoonMaterial {
    CartoonMaterial {
        base: StandardMaterial {
            opaque_render_method: OpaqueRendererMethod::Forward,
            ..original.clone()
        },
        extension: light.clone(),
    }
}

/// Converts the meshes below a root that have a standard material.
pub(super) fn convert(
    mut commands: Commands,
    roots: Query<Ref<CartoonScene>>,
    parents: Query<&ChildOf>,
    meshes: Query<(Entity, &MeshMaterial3d<StandardMaterial>)>,
    (standard, mut cartoon): (
        Res<Assets<StandardMaterial>>,
        ResMut<Assets<CartoonMaterial>>,
    ),
    mut copies: Local<Copies>,
) {
    if roots.is_empty() {
        copies.clear();
        return;
    }
    // The copies of a root are kept as long as the root exists.
    copies.retain(|(root, _), _| roots.contains(*root));
    for (entity, material) in &meshes {
        let Some(root) = root_of(entity, &parents, &roots) else {
            continue;
        };
        let (Some(original), Ok(scene)) = (standard.get(&material.0), roots.get(root)) else {
            continue;
        };
        let handle = copies
            .entry((root, material.0.id()))
            .or_insert_with(|| cartoon.add(copy(original, &scene.light)))
            .clone();
        commands
            .entity(entity)
            .remove::<MeshMaterial3d<StandardMaterial>>()
            .insert((
                MeshMaterial3d(handle),
                Original {
                    material: material.0.clone(),
                    root,
                },
            ));
    }
}

/// Restores the standard material of meshes whose nearest root has changed.
pub(super) fn restore(
    mut commands: Commands,
    mut removed: RemovedComponents<CartoonScene>,
    roots: Query<Ref<CartoonScene>>,
    parents: Query<&ChildOf>,
    moved: Query<(), bevy::ecs::query::Changed<ChildOf>>,
    converted: Query<(Entity, &Original), With<MeshMaterial3d<CartoonMaterial>>>,
) {
    let root_gone = removed.read().count() > 0;
    let root_new = roots.iter().any(|root| root.is_added());
    if !root_gone && !root_new && moved.is_empty() {
        return;
    }
    for (entity, original) in &converted {
        if root_of(entity, &parents, &roots) != Some(original.root) {
            commands
                .entity(entity)
                .remove::<(MeshMaterial3d<CartoonMaterial>, Original)>()
                .insert(MeshMaterial3d(original.material.clone()));
        }
    }
}

/// Updates the copies after changes of standard materials or of a root's settings.
pub(super) fn follow_materials(
    mut events: MessageReader<AssetEvent<StandardMaterial>>,
    roots: Query<Ref<CartoonScene>>,
    converted: Query<(&Original, &MeshMaterial3d<CartoonMaterial>)>,
    standard: Res<Assets<StandardMaterial>>,
    mut cartoon: ResMut<Assets<CartoonMaterial>>,
) {
    let changed: Vec<_> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    let tuned = roots
        .iter()
        .any(|root| root.is_changed() && !root.is_added());
    if changed.is_empty() && !tuned {
        return;
    }
    for (original, handle) in &converted {
        let Ok(scene) = roots.get(original.root) else {
            continue;
        };
        if !scene.is_changed() && !changed.contains(&original.material.id()) {
            continue;
        }
        if let Some(source) = standard.get(&original.material)
            && let Some(mut material) = cartoon.get_mut(&handle.0)
        {
            *material = copy(source, &scene.light);
        }
    }
}
