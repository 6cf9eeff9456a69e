//! Which object is at a place in the window.
//!
//! A ray is cast through what the camera sees: first against boxes, then against triangles.
//! The engine's own ray caster is in a feature that games need not have, and ids of objects are
//! only on the GPU.

use std::any::TypeId;

use bevy::{
    camera::{RenderTarget, primitives::Aabb, visibility::VisibleEntities},
    math::Affine3A,
    mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    prelude::*,
    render::render_resource::Face,
    window::{PrimaryWindow, WindowRef},
};

use super::{
    ray::{Ray, Sides},
    surface::Known,
};
#[cfg(feature = "toon")]
use bevy_comics::ToonMaterial;

/// The first object at a place in the primary window, in logical pixels: that of the camera that
/// draws last there. `cameras`: the 3D cameras, in the order in which they draw.
pub fn pick(world: &mut World, cameras: &[Entity], at: Vec2) -> Option<Entity> {
    let cameras = in_window(world, cameras);
    let world = &*world;
    let first = |camera: &Entity| nearest(world, *camera, at);
    cameras.iter().rev().find_map(first)
}

/// Those of these cameras that draw to the primary window.
pub fn in_window(world: &mut World, cameras: &[Entity]) -> Vec<Entity> {
    let primary = world
        .query_filtered::<Entity, With<PrimaryWindow>>()
        .single(world)
        .ok();
    let draws_there = |camera: &Entity| {
        let camera = world.entity(*camera);
        let is_active = camera
            .get::<Camera>()
            .is_some_and(|camera| camera.is_active);
        is_active
            && match camera.get::<RenderTarget>() {
                Some(RenderTarget::Window(WindowRef::Primary)) => true,
                Some(RenderTarget::Window(WindowRef::Entity(window))) => Some(*window) == primary,
                _ => false,
            }
    };
    cameras.iter().copied().filter(draws_there).collect()
}

/// The nearest object that a camera sees at a place in the window.
fn nearest(world: &World, camera: Entity, at: Vec2) -> Option<Entity> {
    let camera = world.entity(camera);
    let view = camera.get::<Camera>()?;
    if !view.logical_viewport_rect()?.contains(at) {
        return None;
    }
    let ray = view.viewport_to_world(camera.get::<GlobalTransform>()?, at);
    let ray = Ray::from(ray.ok()?);
    let seen = camera.get::<VisibleEntities>()?.get(TypeId::of::<Mesh3d>());
    first_of(world, seen, ray)
}

/// The first of these meshes that a ray meets.
pub fn first_of(world: &World, meshes: &[Entity], ray: Ray) -> Option<Entity> {
    let reached = |mesh: &Entity| Some((box_distance(world, *mesh, ray)?, *mesh));
    let mut reached: Vec<(f64, Entity)> = meshes.iter().filter_map(reached).collect();
    reached.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut nearest: Option<(f64, Entity)> = None;
    for (box_at, mesh) in reached {
        if nearest.is_some_and(|(at, _)| at < box_at) {
            break;
        }
        if let Some(at) = distance(world, mesh, ray)
            && nearest.is_none_or(|(before, _)| at < before)
        {
            nearest = Some((at, mesh));
        }
    }
    nearest.map(|(_, mesh)| mesh)
}

/// The least distance at which a ray can meet a mesh; `None` if it misses its box.
fn box_distance(world: &World, mesh: Entity, ray: Ray) -> Option<f64> {
    let mesh = world.get_entity(mesh).ok()?;
    match (mesh.get::<Aabb>(), mesh.contains::<SkinnedMesh>()) {
        // The box of a skinned mesh may be that at rest.
        (Some(bounds), false) => {
            let ray = ray.inside(&mesh.get::<GlobalTransform>()?.affine())?;
            let (enter, _) = ray.through(bounds.center.into(), bounds.half_extents.into())?;
            Some(enter)
        }
        _ => Some(0.0),
    }
}

/// The distance at which a ray meets a mesh. A mesh that is only on the GPU is met where the
/// ray enters its box, or leaves it, if it begins in the box.
fn distance(world: &World, entity: Entity, ray: Ray) -> Option<f64> {
    match known(world, entity)? {
        (Known::Surface(surface), space) => {
            surface.meets(ray.inside(&space)?, sides(world, entity))
        }
        (Known::Nothing, _) => None,
        (Known::Bounds, _) => {
            let mesh = world.entity(entity);
            let bounds = mesh.get::<Aabb>()?;
            let ray = ray.inside(&mesh.get::<GlobalTransform>()?.affine())?;
            let (enter, leave) = ray.through(bounds.center.into(), bounds.half_extents.into())?;
            Some(if enter > 0.0 { enter } else { leave })
        }
    }
}

/// What is known of the mesh of an entity, and the space it is in.
fn known(world: &World, entity: Entity) -> Option<(Known, Affine3A)> {
    let entity = world.get_entity(entity).ok()?;
    let mesh = world
        .get_resource::<Assets<Mesh>>()?
        .get(&entity.get::<Mesh3d>()?.0)?;
    match entity.get::<SkinnedMesh>() {
        Some(skin) => {
            let joints = joints(world, skin)?;
            Some((Known::of(mesh, Some(&joints)), Affine3A::IDENTITY))
        }
        None => {
            let space = entity.get::<GlobalTransform>()?.affine();
            Some((Known::of(mesh, None), space))
        }
    }
}

/// The sides of a mesh that its material draws, as far as the material is known.
fn sides(world: &World, mesh: Entity) -> Sides {
    match culled(world, mesh).flatten() {
        Some(Face::Back) => Sides::Front,
        Some(Face::Front) => Sides::Back,
        None => Sides::Both,
    }
}

/// The sides that the material of a mesh leaves out; `None` if the material is not known.
fn culled(world: &World, mesh: Entity) -> Option<Option<Face>> {
    #[cfg(feature = "toon")]
    if let Some(material) = asset_of::<ToonMaterial>(world, mesh) {
        return Some(material.base.cull_mode);
    }
    #[cfg(any(feature = "toon", feature = "objects"))]
    if let Some(material) = asset_of::<StandardMaterial>(world, mesh) {
        return Some(material.cull_mode);
    }
    let _ = (world, mesh);
    None
}

/// The material of a mesh, if it is of this type and has loaded.
#[cfg(any(feature = "toon", feature = "objects"))]
fn asset_of<M: Material>(world: &World, mesh: Entity) -> Option<&M> {
    let material = world.get::<MeshMaterial3d<M>>(mesh)?;
    world.get_resource::<Assets<M>>()?.get(&material.0)
}

/// The matrices of the joints of a skinned mesh; `None` until its pose has loaded.
fn joints(world: &World, skin: &SkinnedMesh) -> Option<Vec<Mat4>> {
    let poses = world
        .get_resource::<Assets<SkinnedMeshInverseBindposes>>()?
        .get(&skin.inverse_bindposes)?;
    let matrix = |(joint, pose): (&Entity, &Mat4)| {
        let joint = world.get::<GlobalTransform>(*joint);
        joint.copied().unwrap_or_default().to_matrix() * *pose
    };
    Some(skin.joints.iter().zip(poses.iter()).map(matrix).collect())
}

/// The corners of the box around an object, in the world. Corners whose numbers differ in one
/// bit share an edge.
pub fn corners(world: &World, entity: Entity) -> Option<[Vec3; 8]> {
    let mesh = world.get_entity(entity).ok()?;
    let (center, half_size, space) = if mesh.contains::<SkinnedMesh>()
        && let Some((Known::Surface(surface), space)) = known(world, entity)
    {
        let (center, half_size) = surface.bounds()?;
        (center, half_size, space)
    } else {
        let bounds = mesh.get::<Aabb>()?;
        let space = mesh.get::<GlobalTransform>()?.affine();
        (bounds.center.into(), bounds.half_extents.into(), space)
    };
    let corner = |i: usize| {
        let side = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
        space.transform_point3(center + half_size * Vec3::new(side(1), side(2), side(4)))
    };
    Some(std::array::from_fn(corner))
}

#[cfg(test)]
mod tests;
