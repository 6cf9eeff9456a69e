//! Meshes that are seen, but are no part of the scene: skies.

use bevy::{
    camera::primitives::Aabb,
    core_pipeline::prepass::{AlphaMask3dPrepass, DeferredPrepass, Opaque3dPrepass},
    material::OpaqueRendererMethod,
    pbr::{PreparedMaterial, RenderMaterialInstances},
    prelude::*,
    render::{
        erased_render_asset::ErasedRenderAssets, render_phase::ViewBinnedRenderPhases,
        sync_world::MainEntity,
    },
};

use super::inherit::{Inherited, Values, register};

/// Leaves this mesh out of the depth prepass, so that effects treat its pixels as sky: for sky domes, clouds and
/// painted distances.
///
/// The mesh has no lines and no object id, is at the far end of the depth map, and does not widen
/// the visible range. Color effects change it as they change the sky. The main pass still draws
/// it, behind whatever is in front, so the unstyled picture does not change. With deferred
/// rendering it works for forward materials only.
///
/// [`DepthMap::sky_beyond`](crate::DepthMap::sky_beyond) does the same for all geometry from a distance on.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct Backdrop {
    /// Applies to all descendants as well. Default: `true`.
    pub inherit: bool,
}

/// The meshes of backdrops.
pub(crate) type Backdrops = Values<Backdrop, ()>;

fn find_backdrops(
    mut marked: Inherited<Backdrop>,
    mut meshes: Query<&mut Mesh3d>,
    mut backdrops: ResMut<Backdrops>,
) {
    for entity in backdrops.update(&mut marked, |_| ()) {
        // The engine then puts it into the prepass again.
        if !backdrops.0.contains(entity)
            && let Ok(mut mesh) = meshes.get_mut(entity)
        {
            mesh.set_changed();
        }
    }
}

/// Takes backdrops out of the prepasses of all views. Per frame, some look-ups for each of them.
pub(super) fn remove_backdrops(
    backdrops: Res<Backdrops>,
    mut opaque: ResMut<ViewBinnedRenderPhases<Opaque3dPrepass>>,
    mut masked: ResMut<ViewBinnedRenderPhases<AlphaMask3dPrepass>>,
    deferred: Query<(), With<DeferredPrepass>>,
    (instances, materials): (
        Res<RenderMaterialInstances>,
        Res<ErasedRenderAssets<PreparedMaterial>>,
    ),
) {
    if backdrops.0.is_empty() {
        return;
    }
    let meshes = || backdrops.0.keys().map(MainEntity::from);
    let is_deferred = |mesh: MainEntity| {
        let instance = instances.instances.get(&mesh);
        let material = instance.and_then(|instance| materials.get(instance.asset_id));
        material.is_some_and(|m| m.properties.render_method == OpaqueRendererMethod::Deferred)
    };
    if !deferred.is_empty() && meshes().any(is_deferred) {
        warn_once!("a `Backdrop` with a deferred material stays in the depth prepass");
    }
    for phase in opaque.values_mut() {
        meshes().for_each(|mesh| phase.remove(mesh));
    }
    for phase in masked.values_mut() {
        meshes().for_each(|mesh| phase.remove(mesh));
    }
}

/// The boxes of backdrops in world space.
pub(crate) type BackdropBoxes<'w, 's> =
    Query<'w, 's, (&'static Aabb, &'static GlobalTransform), With<Mesh3d>>;

/// A distance along the axis of a view below which no backdrop is; `None` without backdrops. That of a dome around the
/// view is taken from its box.
pub(crate) fn nearest_backdrop(
    backdrops: &Backdrops,
    boxes: &BackdropBoxes,
    (eye, clip_from_view): (&GlobalTransform, &Mat4),
) -> Option<f32> {
    // The corner of the view with the smallest part of its distance along the axis.
    let view_from_clip = clip_from_view.inverse();
    let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
    let along = |(x, y)| {
        let ray = view_from_clip
            .project_point3(Vec3::new(x, y, 0.5))
            .normalize();
        -ray.z
    };
    let along = corners.map(along).into_iter().reduce(f32::min)?;
    let parallel = clip_from_view.w_axis.w == 1.0;
    let distance = |mesh: Entity| {
        let (aabb, at) = boxes.get(mesh).ok()?;
        if parallel {
            return Some(nearest_corner(aabb, at, eye));
        }
        let (scale, rotation, _) = at.to_scale_rotation_translation();
        let half = Vec3::from(aabb.half_extents) * scale.abs();
        let center = at.transform_point(aabb.center.into());
        let from = rotation.inverse() * (eye.translation() - center);
        let outside = from.abs() - half;
        if outside.max_element() > 0.0 {
            return Some(along * outside.max(Vec3::ZERO).length());
        }
        // The facets of a dome are nearer than its corners.
        let inside = half.min_element() - from.length();
        Some(0.9 * along * inside.max(0.0))
    };
    backdrops.0.keys().filter_map(distance).reduce(f32::min)
}

/// The distance along the axis of a view to the nearest corner of a box.
fn nearest_corner(aabb: &Aabb, at: &GlobalTransform, eye: &GlobalTransform) -> f32 {
    let ahead = eye.forward();
    let corner = |i: u8| {
        let side = Vec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }));
        let corner = Vec3::from(aabb.center) + side * Vec3::from(aabb.half_extents);
        ahead.dot(at.transform_point(corner) - eye.translation())
    };
    (0..8).map(corner).fold(f32::INFINITY, f32::min)
}

pub(super) fn build(app: &mut App) {
    register::<Backdrop>(app);
    app.init_resource::<Backdrops>()
        .add_systems(PostUpdate, find_backdrops);
}
