//! Which meshes have lightmaps: the engine binds those of other layouts.

use bevy::{
    ecs::system::SystemParam,
    pbr::{Lightmap, RenderMeshInstances},
    prelude::*,
    render::{
        Extract,
        sync_world::{MainEntity, MainEntityHashSet},
    },
};

/// Meshes with lightmaps, where the engine does not say it.
#[derive(Resource, Default)]
pub(super) struct Lightmapped(MainEntityHashSet);

/// Without compute shaders, `RenderMeshInstances` names a lightmap for every mesh (Bevy 0.19.1).
pub(super) fn extract_lightmapped(
    mut own: ResMut<Lightmapped>,
    instances: Res<RenderMeshInstances>,
    meshes: Extract<Query<Entity, With<Lightmap>>>,
) {
    own.0.clear();
    if let RenderMeshInstances::CpuBuilding(_) = *instances {
        own.0.extend(meshes.iter().map(MainEntity::from));
    }
}

/// Says which meshes have lightmaps.
#[derive(SystemParam)]
pub(super) struct MeshLightmaps<'w> {
    instances: Res<'w, RenderMeshInstances>,
    own: Res<'w, Lightmapped>,
}

impl MeshLightmaps<'_> {
    pub fn has(&self, mesh: MainEntity) -> bool {
        match *self.instances {
            RenderMeshInstances::CpuBuilding(_) => self.own.0.contains(&mesh),
            RenderMeshInstances::GpuBuilding(_) => self
                .instances
                .render_mesh_queue_data(mesh)
                .is_some_and(|instance| instance.lightmap_slab_index().is_some()),
        }
    }
}
