//! What a level is made of: its scene, lanterns, storm clouds and the plane.

use bevy::prelude::*;
use bevy_comics::{MotionLines, OutlineGroup, ToonScene, objects::MeshSections};
use bevy_comics_testkit::scenes::{ScenePart, Stage, Vantage, paper_plane::paper_plane};

use crate::{
    Game,
    courses::{LEVELS, Level},
    rules::{CLOUD_RADIUS, Flight},
    solids::is_ground,
};

/// A lantern, by its index in [`Course::lanterns`](crate::rules::Course::lanterns).
#[derive(Component)]
pub struct LanternAt(pub usize);

/// A storm cloud, by its index in [`Course::clouds`](crate::rules::Course::clouds).
#[derive(Component)]
pub struct CloudAt(pub usize);

/// The player's paper plane.
#[derive(Component)]
pub struct Plane;

/// A part of a scene: mesh, material and place.
pub type Part = (
    &'static Mesh3d,
    &'static MeshMaterial3d<StandardMaterial>,
    &'static Transform,
);

/// Scenery: what is neither of the game nor below another entity.
type OfScene = (
    With<ScenePart>,
    Without<ChildOf>,
    Without<LanternAt>,
    Without<CloudAt>,
    Without<Plane>,
);

/// The meshes of a scene that are solid. Rain and reflections, which are mixed over the picture,
/// are not.
pub fn solid<'a>(
    parts: impl Iterator<
        Item = (
            &'a Mesh3d,
            &'a MeshMaterial3d<StandardMaterial>,
            &'a Transform,
        ),
    >,
    meshes: &'a Assets<Mesh>,
    materials: &'a Assets<StandardMaterial>,
) -> impl Iterator<Item = (&'a Mesh, &'a Transform)> {
    parts.filter_map(|(mesh, material, at)| {
        let opaque = materials.get(material)?.alpha_mode == AlphaMode::Opaque;
        Some((meshes.get(mesh)?, at)).filter(|_| opaque)
    })
}

/// Makes a new scene solid and flat. Tiles of the ground become one object, without lines between
/// them. Window frames and plinths stand out by less than a pixel from far away: as sections their
/// lines do not break into dashes.
pub fn finish(
    mut commands: Commands,
    mut game: ResMut<Game>,
    parts: Query<Part, OfScene>,
    entities: Query<(Entity, &Mesh3d), OfScene>,
    meshes: Res<Assets<Mesh>>,
    materials: Res<Assets<StandardMaterial>>,
) {
    let level = &LEVELS[game.level];
    game.flight.course.solids = level.solids(solid(parts.iter(), &meshes, &materials));
    let look = ToonScene::new(level.light());
    let root = (ScenePart, OutlineGroup, Visibility::default());
    let root = (root, Transform::IDENTITY, look.clone());
    let ground = commands.spawn(root).id();
    for (entity, mesh) in &entities {
        let mut part = commands.entity(entity);
        let is_ground = meshes.get(mesh).is_some_and(is_ground);
        if is_ground && level.tiled {
            part.insert(ChildOf(ground));
        } else if is_ground {
            part.insert(look.clone());
        } else {
            part.insert((look.clone(), MeshSections::default()));
        }
    }
}

/// Builds a level, and returns the view of its scene.
pub fn build(stage: &mut Stage, level: &Level, flight: &Flight) -> Vantage {
    let vantage = stage.spawn(level.scene);
    hang_lanterns(stage, flight);
    gather_clouds(stage, flight, level);
    fold_plane(stage, flight, level);
    vantage
}

fn hang_lanterns(stage: &mut Stage, flight: &Flight) {
    let glow = stage.materials.add(StandardMaterial {
        base_color: Color::srgb(1.0, 0.75, 0.2),
        emissive: LinearRgba::rgb(2.4, 1.3, 0.25),
        unlit: true,
        ..default()
    });
    let lamp = stage.meshes.add(Sphere::new(1.0));
    let ring = stage.meshes.add(Torus::new(1.75, 2.25));
    let scale = Vec3::splat(flight.course.scale);
    for (index, at) in flight.course.lanterns.iter().enumerate() {
        let at = Transform::from_translation(*at).with_scale(scale);
        let lantern = (ScenePart, LanternAt(index), at, Visibility::Hidden);
        let lantern = stage.commands.spawn((lantern, OutlineGroup)).id();
        for mesh in [&lamp, &ring] {
            let upright = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
            stage.commands.spawn((
                ChildOf(lantern),
                Mesh3d(mesh.clone()),
                MeshMaterial3d(glow.clone()),
                Transform::from_rotation(upright),
            ));
        }
    }
}

fn gather_clouds(stage: &mut Stage, flight: &Flight, level: &Level) {
    let storm = stage.materials.add(StandardMaterial {
        base_color: Color::srgb(0.36, 0.34, 0.5),
        // Storm clouds are seen at night.
        emissive: LinearRgba::rgb(0.1, 0.08, 0.16),
        perceptual_roughness: 1.0,
        ..default()
    });
    let puff = Sphere::new(CLOUD_RADIUS * 0.62).mesh().uv(32, 18);
    let puff = stage.meshes.add(puff);
    for index in 0..flight.course.clouds.len() {
        let at = Transform::from_translation(flight.cloud(index))
            .with_scale(Vec3::splat(flight.course.scale));
        let cloud = (ScenePart, CloudAt(index), at, Visibility::default());
        let look = ToonScene::new(level.light());
        let cloud = stage.commands.spawn((cloud, look)).id();
        for (x, y, z, size) in [
            (0.0, 0.0, 0.0, 1.0),
            (0.62, -0.12, 0.1, 0.75),
            (-0.6, -0.1, -0.05, 0.8),
            (0.15, 0.38, 0.1, 0.7),
            (-0.2, -0.05, 0.5, 0.65),
        ] {
            stage.commands.spawn((
                ChildOf(cloud),
                Mesh3d(puff.clone()),
                MeshMaterial3d(storm.clone()),
                Transform::from_translation(Vec3::new(x, y, z) * CLOUD_RADIUS)
                    .with_scale(Vec3::splat(size)),
            ));
        }
    }
}

fn fold_plane(stage: &mut Stage, flight: &Flight, level: &Level) {
    let paper = stage.materials.add(StandardMaterial {
        double_sided: true,
        cull_mode: None,
        perceptual_roughness: 0.9,
        // Paper is seen at night, too.
        emissive: LinearRgba::gray(0.25),
        ..default()
    });
    let scale = flight.course.scale;
    let lines = MotionLines {
        points: 24,
        duration: 0.22,
        min_speed: 12.0 * scale,
        width: 2.5,
        ..default()
    };
    stage.commands.spawn((
        ScenePart,
        Plane,
        Mesh3d(stage.meshes.add(paper_plane())),
        MeshMaterial3d(paper),
        ToonScene::new(level.light()),
        lines,
        Transform::from_translation(flight.at).with_scale(Vec3::splat(scale)),
    ));
}
