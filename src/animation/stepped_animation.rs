//! Characters whose picture is drawn several times a second only, while their simulation
//! runs at full rate.
//!
//! The transforms of the main world are exchanged right before the engine extracts them to
//! the render world, and put back right after. So everything that the engine derives from
//! them (meshes, skins, motion vectors) shows one pose, and no system of the game ever sees
//! it.

use bevy::{
    ecs::{change_detection::Tick, entity::EntityHashMap},
    math::{Affine3A, DVec3},
    mesh::skinning::SkinnedMesh,
    pbr::PreviousGlobalTransform,
    prelude::*,
};

use crate::{
    clock,
    origin::WorldOrigin,
    settings::{FieldRange, impl_sanitized},
};

/// Holds the poses of an object and of the meshes below it for several frames, like those of a
/// character that is animated "on twos", while the camera and everything else move at full rate.
///
/// Shown is the pose of the first frame of every drawing: the `GlobalTransform` of the
/// entity and of the meshes below it, and the joints of their skins. Simulation and
/// animation are not touched: the game reads and writes the true transforms. Motion vectors
/// are those of the picture: none while a pose is held.
///
/// Cameras and lights below the entity are never held. A `SteppedAnimation` below another one has
/// its own rate. Morph targets, materials, and what other crates draw without meshes are not held.
/// Meshes are culled, and the cascades of shadows fitted, by the true pose: an object that enters
/// the view fast can appear up to a drawing late. Needs the feature `objects` or `toon`.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct SteppedAnimation {
    /// Drawings per second. Range 1 to 60, default 12 (on twos); 8 is "on threes".
    #[reflect(@FieldRange::linear(1.0, 60.0).unit("/ s"))]
    pub rate: f32,
}

impl Default for SteppedAnimation {
    fn default() -> Self {
        Self { rate: 12.0 }
    }
}

impl_sanitized!(SteppedAnimation);

/// Exchanges the poses around the extraction of the render world.
pub(super) fn hold_while_extracting(render_app: &mut SubApp) {
    let Some(mut extract) = render_app.take_extract() else {
        return;
    };
    let mut poses = Poses::default();
    render_app.set_extract(move |main, render| {
        poses.hold(main);
        extract(main, render);
        poses.restore(main);
    });
}

#[derive(Default)]
struct Poses {
    roots: Option<QueryState<(Entity, &'static SteppedAnimation)>>,
    held: EntityHashMap<Held>,
    origin: DVec3,
    /// The true transforms, while the held ones are in the world.
    saved: Vec<Saved>,
}

/// The pose of one entity.
struct Held {
    /// What is shown.
    pose: GlobalTransform,
    /// What the last frame showed.
    shown: GlobalTransform,
    /// Number of the drawing that the pose is of; `None` if it is no longer held.
    drawing: Option<u64>,
    /// The pose changed in the last frame.
    moved: bool,
    /// Whether the next frame has to know of it.
    stays: bool,
}

struct Saved {
    entity: Entity,
    transform: GlobalTransform,
    changed: Tick,
    previous: Option<(PreviousGlobalTransform, Tick)>,
}

impl Poses {
    /// Puts the stepped poses into the world.
    fn hold(&mut self, world: &mut World) {
        let roots = self.roots.get_or_insert_with(|| world.query());
        let members = members(world, roots);
        if members.is_empty() && self.held.is_empty() {
            return;
        }
        let origin = WorldOrigin::of(world.get_resource());
        let shift = Vec3A::from((self.origin - origin).as_vec3());
        self.origin = origin;
        let mut known = std::mem::take(&mut self.held);
        for (entity, drawing) in members {
            let mut old = known.remove(&entity);
            if let Some(held) = old.as_mut().filter(|_| shift != Vec3A::ZERO) {
                // Not what was shown, with the camera's old place.
                let pose = held.pose.affine();
                held.pose = Affine3A {
                    translation: pose.translation + shift,
                    ..pose
                }
                .into();
            }
            if let Some(held) = Held::new(world.entity(entity), old, drawing) {
                self.held.entry(entity).or_insert(held);
            }
        }
        // What is no longer held.
        for (entity, old) in known {
            if let Some(&pose) = world.get::<GlobalTransform>(entity) {
                let stays = old.drawing.is_some();
                let drawing = None;
                let held = Held {
                    pose,
                    drawing,
                    stays,
                    ..old
                };
                self.held.insert(entity, held);
            }
        }
        for (&entity, held) in &mut self.held {
            self.saved.extend(held.show(world, entity));
        }
        self.held.retain(|_, held| held.stays);
    }

    /// Puts the true transforms back, with their times of change.
    fn restore(&mut self, world: &mut World) {
        for saved in self.saved.drain(..) {
            let Ok(mut entity) = world.get_entity_mut(saved.entity) else {
                continue;
            };
            if let Some(mut transform) = entity.get_mut::<GlobalTransform>() {
                *transform.bypass_change_detection() = saved.transform;
                transform.set_last_changed(saved.changed);
            }
            let previous = entity.get_mut::<PreviousGlobalTransform>();
            if let Some((mut previous, (value, changed))) = previous.zip(saved.previous) {
                *previous.bypass_change_detection() = value;
                previous.set_last_changed(changed);
            }
        }
    }
}

impl Held {
    /// The pose of an entity in a drawing. `old`: its pose in the last frame.
    fn new(entity: EntityRef, old: Option<Self>, drawing: u64) -> Option<Self> {
        let &pose = entity.get::<GlobalTransform>()?;
        let previous = entity.get::<PreviousGlobalTransform>();
        let last = previous.map_or(pose, |previous| previous.0.into());
        Some(match old {
            Some(old) if old.drawing == Some(drawing) => old,
            old => Self {
                pose,
                shown: old.as_ref().map_or(last, |old| old.shown),
                drawing: Some(drawing),
                moved: old.is_some_and(|old| old.moved),
                stays: true,
            },
        })
    }

    /// Puts the pose into the world. Returns what was there.
    fn show(&mut self, world: &mut World, entity: Entity) -> Option<Saved> {
        let mut world_entity = world.get_entity_mut(entity).ok()?;
        let mut transform = world_entity.get_mut::<GlobalTransform>()?;
        let moves = self.pose != self.shown;
        let (true_pose, changed) = (*transform, transform.last_changed());
        *transform.bypass_change_detection() = self.pose;
        // Also in the frame after a change: the engine then learns that the mesh rests.
        if moves || self.moved {
            transform.set_changed();
        }
        let previous = world_entity.get_mut::<PreviousGlobalTransform>();
        let previous = previous.map(|mut previous| {
            let saved = (previous.clone(), previous.last_changed());
            previous.bypass_change_detection().0 = self.shown.affine();
            saved
        });
        (self.shown, self.moved) = (self.pose, moves);
        Some(Saved {
            entity,
            transform: true_pose,
            changed,
            previous,
        })
    }
}

/// The entities whose transforms are held, and the number of the drawing that is shown of
/// each.
fn members(
    world: &World,
    roots: &mut QueryState<(Entity, &'static SteppedAnimation)>,
) -> Vec<(Entity, u64)> {
    let time = world.get_resource::<Time>();
    let seconds = time.map_or(0.0, Time::elapsed_secs_f64);
    let mut found = Vec::new();
    for (root, held) in roots.iter(world) {
        let drawing = clock::drawing(seconds, held.sanitized().rate);
        let mut below = vec![root];
        while let Some(entity) = below.pop() {
            let Ok(entity) = world.get_entity(entity) else {
                continue;
            };
            let is_root = entity.id() == root;
            if !is_root && entity.contains::<SteppedAnimation>() {
                continue;
            }
            if is_root || entity.contains::<Mesh3d>() {
                found.push((entity.id(), drawing));
            }
            if let Some(skin) = entity.get::<SkinnedMesh>() {
                found.extend(skin.joints.iter().map(|joint| (*joint, drawing)));
            }
            below.extend(entity.get::<Children>().into_iter().flatten());
        }
    }
    found.retain(|(entity, _)| world.get_entity(*entity).is_ok_and(can_be_held));
    found
}

/// Cameras and lights are prepared from their true transforms before extraction.
fn can_be_held(entity: EntityRef) -> bool {
    !(entity.contains::<Camera>()
        || entity.contains::<DirectionalLight>()
        || entity.contains::<PointLight>()
        || entity.contains::<SpotLight>())
}
