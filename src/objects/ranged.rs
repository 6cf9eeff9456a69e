//! Meshes that the GPU alone leaves out of a view, because it is not within their range.
//!
//! The pass of ids would draw them where they are in the same place as one that is in range: levels
//! of detail often are.

use bevy::{
    camera::{
        primitives::Aabb,
        visibility::{NoCpuCulling, VisibilityRange},
    },
    ecs::system::SystemParam,
    prelude::*,
    render::{
        Extract,
        batching::gpu_preprocessing::{GpuPreprocessingMode, GpuPreprocessingSupport},
        sync_world::{MainEntity, MainEntityHashSet},
        view::{ExtractedView, NoIndirectDrawing},
    },
};

/// The meshes with ranges that only the GPU tests: their ranges and where they are.
#[derive(Resource, Default)]
pub(super) struct RangedMeshes(Vec<(MainEntity, VisibilityRange, Vec3A)>);

type Ranged = (
    Entity,
    &'static VisibilityRange,
    &'static GlobalTransform,
    Option<&'static Aabb>,
);

pub(super) fn extract_ranged_meshes(
    meshes: Extract<Query<Ranged, With<NoCpuCulling>>>,
    mut ranged: ResMut<RangedMeshes>,
) {
    ranged.0.clear();
    ranged
        .0
        .extend(meshes.iter().map(|(mesh, range, at, aabb)| {
            let center = aabb.filter(|_| range.use_aabb).map(|aabb| aabb.center);
            let place = at.affine().transform_point3a(center.unwrap_or_default());
            (mesh.into(), range.clone(), place)
        }));
}

/// Says which meshes are out of range.
#[derive(SystemParam)]
pub(super) struct InRange<'w, 's> {
    meshes: Res<'w, RangedMeshes>,
    support: Res<'w, GpuPreprocessingSupport>,
    views: Query<'w, 's, Has<NoIndirectDrawing>>,
}

impl InRange<'_, '_> {
    /// The meshes that the GPU leaves out of a view.
    pub fn out_of_range(&self, entity: Entity, view: &ExtractedView) -> MainEntityHashSet {
        let culls = self.support.max_supported_mode == GpuPreprocessingMode::Culling;
        if !culls || self.views.get(entity).unwrap_or(true) {
            return MainEntityHashSet::default();
        }
        let eye = Vec3A::from(view.world_from_view.translation());
        let meshes = self.meshes.0.iter();
        let out = meshes.filter(|(_, range, place)| range.is_culled(place.distance(eye)));
        out.map(|(mesh, ..)| *mesh).collect()
    }
}
