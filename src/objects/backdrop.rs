//! Meshes that are seen, but are no part of the scene: skies.

use bevy::{
    app::{App, PostUpdate},
    camera::primitives::Aabb,
    core_pipeline::prepass::{AlphaMask3dPrepass, Opaque3dPrepass},
    ecs::{
        change_detection::DetectChangesMut,
        component::Component,
        entity::Entity,
        query::With,
        reflect::ReflectComponent,
        resource::Resource,
        system::{Query, Res, ResMut},
    },
    math::{Vec3, Vec3A},
    mesh::Mesh3d,
    reflect::{Reflect, std_traits::ReflectDefault},
    render::{Extract, render_phase::ViewBinnedRenderPhases, sync_world::MainEntity},
    transform::components::GlobalTransform,
};

use super::{
    changes::Follow,
    inherit::{Inherit, Inherited, watch},
    shared::Shared,
};

/// Leaves this mesh out of the depth prepass, so that effects treat its pixels as sky: for sky domes, clouds and
/// painted distances.
///
/// It has no lines and no object id, is at the far end of the depth map, and does not stretch the visible
/// range. Colour effects change it as they change the sky. The picture is the same: the main pass draws it, and
/// what is in front hides it. With deferred rendering it works for forward materials only.
///
/// [`DepthMap::sky_beyond`](crate::DepthMap::sky_beyond) does the same for all geometry from a distance on.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct Backdrop {
    /// Applies to all descendants as well. Default: `true`.
    pub inherit: bool,
}

impl Default for Backdrop {
    fn default() -> Self {
        Self { inherit: true }
    }
}

impl Inherit for Backdrop {
    fn is_inherited(&self) -> bool {
        self.inherit
    }
}

/// The meshes of backdrops. Both worlds have a copy.
#[derive(Resource, Default)]
pub(crate) struct Backdrops(Shared<()>);

impl Backdrops {
    pub fn contains(&self, mesh: Entity) -> bool {
        self.0.get(mesh).is_some()
    }
}

impl Follow for Backdrops {
    fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet) {
        self.0.follow(&main.0, changed);
    }
}

fn find_backdrops(
    mut marked: Inherited<Backdrop>,
    mut meshes: Query<&mut Mesh3d>,
    mut backdrops: ResMut<Backdrops>,
) {
    let changed = marked.update();
    backdrops.0.begin();
    for entity in changed {
        let is_backdrop = marked.of(entity).is_some();
        let was_other = backdrops.0.set(entity, is_backdrop.then_some(()));
        // The engine then puts it into the prepass again.
        if was_other
            && !is_backdrop
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
) {
    if backdrops.0.is_empty() {
        return;
    }
    let meshes = || backdrops.0.keys().map(MainEntity::from);
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

/// A distance from a point below which no backdrop is; `None` without backdrops. That of a dome is taken from its
/// box.
pub(crate) fn nearest_backdrop(
    backdrops: &Backdrops,
    boxes: &BackdropBoxes,
    eye: Vec3,
) -> Option<f32> {
    let distance = |mesh: Entity| {
        let (aabb, at) = boxes.get(mesh).ok()?;
        let (scale, rotation, _) = at.to_scale_rotation_translation();
        let centre = at.transform_point(aabb.center.into());
        let half = aabb.half_extents * Vec3A::from(scale.abs());
        let from = rotation.inverse() * (eye - centre);
        let outside = from.abs() - Vec3::from(half);
        let distance = if outside.max_element() > 0.0 {
            outside.max(Vec3::ZERO).length()
        } else {
            half.min_element() - from.length()
        };
        Some(distance.max(0.0))
    };
    backdrops.0.keys().filter_map(distance).reduce(f32::min)
}

pub(super) fn build(app: &mut App) {
    watch::<Backdrop>(app);
    app.register_type::<Backdrop>()
        .init_resource::<Backdrops>()
        .add_systems(PostUpdate, find_backdrops);
}
