//! What the scenes of strips are given: marks, fog, glass, other models.

use bevy::{
    anti_alias::taa::TemporalAntiAliasing,
    core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass},
    prelude::*,
};
use bevy_comics::{
    NoStyle, SelectionOutline, XRayOutline,
    objects::{DepthWrite, LineWidths},
};
use bevy_comics_testkit::{forest, specimens::Specimen, studio::Studio};

use crate::toon::matt;

/// The camera draws with temporal anti-aliasing.
pub fn jitter(studio: &mut Studio) {
    let world = studio.headless.app.world_mut();
    world.entity_mut(studio.camera).insert((
        TemporalAntiAliasing::default(),
        DepthPrepass,
        MotionVectorPrepass,
    ));
}

/// The meshes of the scene, those with most vertices first.
fn meshes(world: &mut World) -> Vec<Entity> {
    let mut meshes = world.query::<(Entity, &Mesh3d)>();
    let assets = world.resource::<Assets<Mesh>>();
    let count = |mesh: &Mesh3d| assets.get(&mesh.0).map_or(0, Mesh::count_vertices);
    let mut found: Vec<_> = meshes
        .iter(world)
        .map(|(entity, mesh)| (count(mesh), entity))
        .collect();
    found.sort_by_key(|(count, entity)| (std::cmp::Reverse(*count), *entity));
    found.into_iter().map(|(_, entity)| entity).collect()
}

/// The mesh that is nearest to a place.
fn nearest(world: &mut World, to: Vec3) -> Option<Entity> {
    let mut meshes = world.query_filtered::<(Entity, &GlobalTransform), With<Mesh3d>>();
    let away = |at: &GlobalTransform| at.translation().distance_squared(to);
    let all = meshes.iter(world);
    all.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)))
        .map(|(entity, _)| entity)
}

/// A person behind a house beside the path of the village, from the path.
pub fn hide_a_figure(studio: &mut Studio) {
    studio.vantage.eye = Vec3::new(0.0, 2.2, 7.0);
    studio.vantage.target = Vec3::new(-8.0, 1.4, -4.0);
    let at = Transform::from_xyz(-9.2, 1.0, -4.2);
    for part in put(studio, Specimen::Figure, at) {
        let world = studio.headless.app.world_mut();
        world.entity_mut(part).insert(XRayOutline::default());
    }
}

/// What the camera looks at is selected.
pub fn select_one(studio: &mut Studio) {
    let target = studio.vantage.target;
    let world = studio.headless.app.world_mut();
    if let Some(mesh) = nearest(world, target) {
        world.entity_mut(mesh).insert(SelectionOutline::default());
    }
}

/// What the camera looks at keeps its colors.
pub fn unstyle_one(studio: &mut Studio) {
    let target = studio.vantage.target;
    let world = studio.headless.app.world_mut();
    if let Some(mesh) = nearest(world, target) {
        world.entity_mut(mesh).insert(NoStyle::default());
    }
}

/// A fog that begins near the camera.
pub fn fog(studio: &mut Studio) {
    let fog = DistanceFog {
        color: Color::srgb(0.75, 0.8, 0.85),
        falloff: FogFalloff::Linear {
            start: 15.0,
            end: 90.0,
        },
        ..default()
    };
    let world = studio.headless.app.world_mut();
    world.entity_mut(studio.camera).insert(fog);
}

/// A pane of glass that writes depth, in front of a part of the scene, and one beside it that does
/// not.
pub fn glass(studio: &mut Studio) {
    let (eye, target) = (studio.vantage.eye, studio.vantage.target);
    let world = studio.headless.app.world_mut();
    let mesh = Mesh3d(world.add_asset(Sphere::new(0.5)));
    let glass = StandardMaterial::from_color(Color::srgba(0.5, 0.75, 0.95, 0.6));
    let material = MeshMaterial3d(world.add_asset::<StandardMaterial>(glass));
    let middle = target.lerp(eye, 0.3);
    let size = 0.25 * eye.distance(target);
    let side = (eye - target).cross(Vec3::Y).normalize_or(Vec3::X) * 0.6 * size;
    for (i, place) in [middle - side, middle + side].into_iter().enumerate() {
        let at = Transform::from_translation(place).with_scale(Vec3::splat(size));
        let mut ball = world.spawn((mesh.clone(), material.clone(), at));
        if i == 0 {
            ball.insert(DepthWrite::default());
        }
    }
}

/// Widths of lines from the vertices: they change over each mesh.
pub fn widths(studio: &mut Studio) {
    let world = studio.headless.app.world_mut();
    for mesh in meshes(world) {
        world.entity_mut(mesh).insert(LineWidths::default());
    }
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    for (_, mesh) in meshes.iter_mut() {
        let places = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
        let Some(places) = places.and_then(|places| places.as_float3()) else {
            continue;
        };
        let [low, high] = places
            .iter()
            .fold([f32::MAX, f32::MIN], |[low, high], place| {
                [low.min(place[1]), high.max(place[1])]
            });
        let width = |place: &[f32; 3]| (high - place[1]) / (high - low).max(1e-6);
        let widths: Vec<f32> = places.iter().map(width).collect();
        let mut colors = match mesh.attribute(Mesh::ATTRIBUTE_COLOR) {
            Some(bevy::mesh::VertexAttributeValues::Float32x4(colors)) => colors.clone(),
            _ => vec![[1.0; 4]; widths.len()],
        };
        for (color, width) in colors.iter_mut().zip(widths) {
            color[3] = width;
        }
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    }
}

/// Adds a model to the scene. Returns its parts.
fn put(studio: &mut Studio, specimen: Specimen, at: Transform) -> Vec<Entity> {
    let world = studio.headless.app.world_mut();
    let add = |(mesh, color): (Mesh, Color)| {
        let mesh = Mesh3d(world.add_asset(mesh));
        let material = MeshMaterial3d(world.add_asset::<StandardMaterial>(matt(color)));
        world.spawn((mesh, material, at)).id()
    };
    specimen.parts().into_iter().map(add).collect()
}

/// Only this model, in place of the scene, as large as the view.
fn only(studio: &mut Studio, specimen: Specimen, size: f32) {
    hide(studio);
    let (eye, target) = (studio.vantage.eye, studio.vantage.target);
    let scale = Vec3::splat(size * eye.distance(target));
    put(
        studio,
        specimen,
        Transform::from_translation(target).with_scale(scale),
    );
}

/// Removes the meshes of the scene.
fn hide(studio: &mut Studio) {
    let world = studio.headless.app.world_mut();
    for mesh in meshes(world) {
        world.entity_mut(mesh).despawn();
    }
}

/// Wires, most of them thinner than a pixel.
pub fn wires(studio: &mut Studio) {
    only(studio, Specimen::Wires, 0.25);
}

/// A body with folds that fade out.
pub fn folds(studio: &mut Studio) {
    only(studio, Specimen::Organic, 0.3);
}

/// The same as small as a hand in a picture: its folds hover around the threshold.
pub fn distant_folds(studio: &mut Studio) {
    only(studio, Specimen::Organic, 0.1);
}

/// The forest on a meadow, from its distance.
pub fn trees(studio: &mut Studio) {
    hide(studio);
    let world = studio.headless.app.world_mut();
    let meadow = Plane3d::default().mesh().size(4000.0, 4000.0).build();
    let meadow = Mesh3d(world.add_asset(meadow));
    let grass = matt(Color::srgb_u8(0x8d, 0xb2, 0x4f));
    let grass = MeshMaterial3d(world.add_asset::<StandardMaterial>(grass));
    world.spawn((meadow, grass));
    let material = MeshMaterial3d(world.add_asset::<StandardMaterial>(matt(Color::WHITE)));
    for (mesh, places) in forest::forest() {
        let mesh = Mesh3d(world.add_asset(mesh));
        for at in places {
            world.spawn((mesh.clone(), material.clone(), at));
        }
    }
    let (at, fov) = forest::view();
    studio.vantage.eye = at.translation;
    studio.vantage.target = Vec3::Y * 3.0;
    world
        .entity_mut(studio.camera)
        .insert(Projection::Perspective(PerspectiveProjection {
            fov,
            ..default()
        }));
}
