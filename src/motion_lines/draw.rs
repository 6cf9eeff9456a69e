//! Follows objects, and draws their ribbons.

use bevy::{
    camera::visibility::{NoFrustumCulling, RenderLayers},
    ecs::system::SystemParam,
    light::NotShadowCaster,
    math::DVec3,
    prelude::*,
};

use super::{
    MotionLines,
    ink::MotionInk,
    ribbon::Ribbons,
    seeds::seeds_of,
    trail::{Pose, SeedsOf, Trail},
};
use crate::{
    CameraCut, clock,
    origin::WorldOrigin,
    page::{LengthScale, PageHeight, PageScale},
};

/// Marks the entity with the ribbons of an object.
#[derive(Component)]
pub(super) struct RibbonsOf;

/// Objects move between the shots of a film.
pub(super) fn forget_at_cut(_: On<CameraCut>, mut trails: Query<&mut Trail>) {
    for mut trail in &mut trails {
        trail.forget();
    }
}

pub(super) fn remove_ribbons(
    removed: On<Remove, MotionLines>,
    trails: Query<&Trail>,
    mut commands: Commands,
) {
    if let Ok(trail) = trails.get(removed.entity)
        && let Some(ink) = trail.ink
        && let Ok(mut ink) = commands.get_entity(ink)
    {
        ink.despawn();
    }
    if let Ok(mut object) = commands.get_entity(removed.entity) {
        object.try_remove::<Trail>();
    }
}

/// Notes where every object is.
pub(super) fn follow(
    mut objects: Query<(&MotionLines, &mut Trail, &GlobalTransform, &Mesh3d)>,
    meshes: Res<Assets<Mesh>>,
    (time, origin): (Res<Time>, Option<Res<WorldOrigin>>),
    mut last_origin: Local<DVec3>,
) {
    let origin = WorldOrigin::of(origin.as_deref());
    let shift = (*last_origin - origin).as_vec3();
    *last_origin = origin;
    for (lines, mut trail, transform, mesh) in &mut objects {
        if shift != Vec3::ZERO {
            trail.shift(shift);
        }
        let lines = lines.sanitized();
        let of = SeedsOf {
            mesh: mesh.0.id(),
            count: lines.points,
            seed: lines.seed,
        };
        if trail.seeds_of != Some(of)
            && let Some(mesh) = meshes.get(of.mesh)
        {
            let seeds = seeds_of(mesh, of.count, of.seed);
            if seeds.is_empty() {
                warn_once!("`MotionLines` does nothing on a mesh whose triangles cannot be read");
            }
            trail.set_seeds(seeds, of);
        }
        let pose = Pose {
            time: time.elapsed_secs_f64(),
            world_from_mesh: transform.affine(),
        };
        trail.add(pose, f64::from(lines.duration));
    }
}

/// What says how the ribbons of an object are drawn.
type Object = (
    &'static MotionLines,
    &'static mut Trail,
    &'static GlobalTransform,
    Option<&'static InheritedVisibility>,
    Option<Ref<'static, RenderLayers>>,
);

pub(super) fn draw(mut objects: Query<Object>, time: Res<Time>, mut paper: Paper) {
    let scale = paper.scale();
    for (lines, mut trail, transform, visibility, layers) in &mut objects {
        let lines = lines.sanitized();
        if let Some(layers) = &layers
            && layers.is_changed()
        {
            paper.move_to(trail.ink, layers);
        }
        let origin = transform.translation();
        if visibility.is_some_and(|visibility| !visibility.get()) {
            trail.drawing = None;
            paper.hide(trail.ink);
            continue;
        }
        let drawing = clock::drawing(time.elapsed_secs_f64(), lines.rate);
        if lines.rate > 0.0 && trail.drawing == Some(drawing) {
            continue;
        }
        trail.drawing = Some(drawing);
        let ribbons = Ribbons::new(&lines, &trail, origin);
        if ribbons.is_empty() {
            paper.hide(trail.ink);
            continue;
        }
        let ink = MotionInk {
            color: lines.color.to_linear(),
            half_width: 0.5 * lines.width * scale,
        };
        let known = trail.ink.filter(|ink| paper.ribbons.contains(*ink));
        match known {
            Some(entity) => paper.redraw(entity, origin, &ink, ribbons),
            None => trail.ink = Some(paper.begin(origin, ink, ribbons, layers.as_deref())),
        }
    }
}

/// Where ribbons are drawn.
#[derive(SystemParam)]
pub(super) struct Paper<'w, 's> {
    commands: Commands<'w, 's>,
    meshes: ResMut<'w, Assets<Mesh>>,
    inks: ResMut<'w, Assets<MotionInk>>,
    ribbons: Query<'w, 's, Drawn, (With<RibbonsOf>, Without<MotionLines>)>,
    cameras: Query<'w, 's, (&'static Camera, Option<&'static PageHeight>), With<Camera3d>>,
    players: Res<'w, PageScale>,
}

/// The parts of the entity with the ribbons.
type Drawn = (
    &'static mut Transform,
    &'static mut GlobalTransform,
    &'static mut Visibility,
    &'static Mesh3d,
    &'static MeshMaterial3d<MotionInk>,
);

impl Paper<'_, '_> {
    /// Physical pixels per unit of length.
    fn scale(&self) -> f32 {
        let mut active = self.cameras.iter().filter(|(camera, _)| camera.is_active);
        let drawn = active.find(|(camera, _)| camera.target_scaling_factor().is_some());
        drawn.map_or(1.0, |(camera, page)| {
            LengthScale::new(camera, page, *self.players).factor
        })
    }

    fn hide(&mut self, ribbons: Option<Entity>) {
        if let Some(entity) = ribbons
            && let Ok((_, _, mut visibility, ..)) = self.ribbons.get_mut(entity)
        {
            visibility.set_if_neq(Visibility::Hidden);
        }
    }

    fn move_to(&mut self, ribbons: Option<Entity>, layers: &RenderLayers) {
        if let Some(entity) = ribbons
            && let Ok(mut ribbons) = self.commands.get_entity(entity)
        {
            ribbons.insert(layers.clone());
        }
    }

    fn redraw(&mut self, entity: Entity, origin: Vec3, ink: &MotionInk, ribbons: Ribbons) {
        let Ok((mut transform, mut global, mut visibility, mesh, material)) =
            self.ribbons.get_mut(entity)
        else {
            return;
        };
        let place = Transform::from_translation(origin);
        transform.set_if_neq(place);
        global.set_if_neq(place.into());
        visibility.set_if_neq(Visibility::Inherited);
        if let Some(mut mesh) = self.meshes.get_mut(&mesh.0) {
            ribbons.put_into(&mut mesh);
        }
        if self.inks.get(&material.0).is_some_and(|old| old != ink)
            && let Some(mut material) = self.inks.get_mut(&material.0)
        {
            *material = ink.clone();
        }
    }

    fn begin(
        &mut self,
        origin: Vec3,
        ink: MotionInk,
        ribbons: Ribbons,
        layers: Option<&RenderLayers>,
    ) -> Entity {
        let place = Transform::from_translation(origin);
        let mut entity = self.commands.spawn((
            RibbonsOf,
            place,
            GlobalTransform::from(place),
            Mesh3d(self.meshes.add(ribbons.into_mesh())),
            MeshMaterial3d(self.inks.add(ink)),
            NoFrustumCulling,
            NotShadowCaster,
        ));
        if let Some(layers) = layers {
            entity.insert(layers.clone());
        }
        entity.id()
    }
}
