//! The three levels: their courses and their scenes.

use bevy::{asset::RenderAssetUsages, mesh::PrimitiveTopology, prelude::*};
use bevy_comics::ComicStyle;

use bevy_comics_testkit::scenes::{BuiltIn, ScenePart, Stage, Vantage, mountains};

use crate::{
    looks::named,
    rules::{CLOUD_RADIUS, Course, Flight},
};

/// A level of the game.
pub struct Level {
    pub name: &'static str,
    pub scene: BuiltIn,
    /// Name of a preset.
    pub style: &'static str,
}

pub const LEVELS: [Level; 3] = [
    Level {
        name: "The village",
        scene: BuiltIn::Village,
        style: "graphic-novel",
    },
    Level {
        name: "The valley",
        scene: BuiltIn::Mountains,
        style: "emerald-ink",
    },
    Level {
        name: "The village at dusk",
        scene: BuiltIn::Village,
        style: "cobalt-night",
    },
];

impl Level {
    pub fn style(&self) -> ComicStyle {
        named(self.style, &ComicStyle::default())
    }
}

/// Offset of the `i`th object of a course, -1 to 1.
fn wave(i: usize, pace: f32) -> f32 {
    (i as f32 * pace).sin()
}

/// The course of a level.
pub fn course(level: usize) -> Course {
    match level {
        0 => Course {
            start: Vec3::new(0.0, 7.0, 44.0),
            heading: 0.0,
            lanterns: (0..10)
                .map(|i| {
                    Vec3::new(
                        5.0 * wave(i, 1.1),
                        6.0 + 3.5 * wave(i, 0.8),
                        12.0 - 21.0 * i as f32,
                    )
                })
                .collect(),
            clouds: vec![
                Vec3::new(7.0, 9.0, -60.0),
                Vec3::new(-8.0, 11.0, -112.0),
                Vec3::new(6.0, 8.0, -148.0),
            ],
            seconds: 24.0,
            ground: |_| 0.0,
        },
        1 => {
            let above =
                |x: f32, z: f32, up: f32| Vec3::new(x, mountains::height(Vec2::new(x, z)) + up, z);
            Course {
                start: above(0.0, 10.0, 12.0),
                heading: 0.0,
                lanterns: (0..12)
                    .map(|i| {
                        above(
                            26.0 * wave(i, 0.7),
                            -40.0 - 40.0 * i as f32,
                            11.0 + 5.0 * wave(i, 1.3),
                        )
                    })
                    .collect(),
                clouds: (0..6)
                    .map(|i| {
                        above(
                            26.0 * wave(i * 2 + 1, 0.7) + 9.0,
                            -100.0 - 78.0 * i as f32,
                            15.0,
                        )
                    })
                    .collect(),
                seconds: 32.0,
                ground: mountains::height,
            }
        }
        _ => Course {
            start: Vec3::new(0.0, 10.0, -210.0),
            heading: std::f32::consts::PI,
            lanterns: (0..12)
                .map(|i| {
                    Vec3::new(
                        11.0 * wave(i, 0.9),
                        9.0 + 5.0 * wave(i, 1.2),
                        -185.0 + 18.0 * i as f32,
                    )
                })
                .collect(),
            clouds: (0..5)
                .map(|i| Vec3::new(-12.0 * wave(i * 2 + 1, 0.9), 12.0, -158.0 + 36.0 * i as f32))
                .collect(),
            seconds: 34.0,
            ground: |_| 0.0,
        },
    }
}

/// A lantern, by its index in [`Course::lanterns`].
#[derive(Component)]
pub struct LanternAt(pub usize);

/// A storm cloud, by its index in [`Course::clouds`].
#[derive(Component)]
pub struct CloudAt(pub usize);

/// The player's paper plane.
#[derive(Component)]
pub struct Plane;

/// A paper plane: two slightly raised wings, and between them a red keel, which makes the
/// plane easy to see in every style.
fn paper_plane() -> Mesh {
    const PAPER: [f32; 4] = [1.0, 0.98, 0.92, 1.0];
    const RED: [f32; 4] = [0.85, 0.08, 0.06, 1.0];
    let nose = Vec3::new(0.0, 0.0, -1.7);
    let (left, right) = (Vec3::new(-1.45, 0.42, 1.15), Vec3::new(1.45, 0.42, 1.15));
    let (inner_left, inner_right) = (Vec3::new(-0.16, 0.0, 1.15), Vec3::new(0.16, 0.0, 1.15));
    let keel = Vec3::new(0.0, -0.6, 1.05);
    let triangles = [
        ([nose, left, inner_left], PAPER),
        ([nose, inner_right, right], PAPER),
        ([nose, inner_left, keel], RED),
        ([nose, keel, inner_right], RED),
    ];
    let corners = |(triangle, color): &([Vec3; 3], [f32; 4])| triangle.map(|at| (at, *color));
    let (positions, colors): (Vec<[f32; 3]>, Vec<[f32; 4]>) = triangles
        .iter()
        .flat_map(corners)
        .map(|(at, color)| (at.to_array(), color))
        .unzip();
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    mesh.compute_flat_normals();
    mesh
}

/// Builds a level: its scene, its lanterns and clouds, and the plane.
pub fn build(stage: &mut Stage, level: &Level, flight: &Flight) -> Vantage {
    let vantage = stage.spawn(level.scene);
    let glow = stage.materials.add(StandardMaterial {
        base_color: Color::srgb(1.0, 0.75, 0.2),
        emissive: LinearRgba::rgb(2.4, 1.3, 0.25),
        ..default()
    });
    let lamp = stage.meshes.add(Sphere::new(1.1));
    let ring = stage.meshes.add(Torus::new(1.9, 2.25));
    for (i, at) in flight.course.lanterns.iter().enumerate() {
        let part = stage
            .commands
            .spawn((
                ScenePart,
                LanternAt(i),
                Mesh3d(lamp.clone()),
                MeshMaterial3d(glow.clone()),
                Transform::from_translation(*at),
            ))
            .id();
        stage.commands.spawn((
            ChildOf(part),
            Mesh3d(ring.clone()),
            MeshMaterial3d(glow.clone()),
            Transform::from_rotation(Quat::from_rotation_x(std::f32::consts::FRAC_PI_2)),
        ));
    }
    let storm = stage.materials.add(StandardMaterial {
        base_color: Color::srgb(0.16, 0.15, 0.2),
        perceptual_roughness: 1.0,
        ..default()
    });
    let puff = stage.meshes.add(Sphere::new(CLOUD_RADIUS * 0.62));
    for i in 0..flight.course.clouds.len() {
        let cloud = stage
            .commands
            .spawn((
                ScenePart,
                CloudAt(i),
                Transform::from_translation(flight.cloud(i)),
                Visibility::default(),
            ))
            .id();
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
    let paper = stage.materials.add(StandardMaterial {
        // Thin paper transmits light.
        diffuse_transmission: 0.6,
        double_sided: true,
        cull_mode: None,
        perceptual_roughness: 0.9,
        ..default()
    });
    let plane = stage.meshes.add(paper_plane());
    stage.commands.spawn((
        ScenePart,
        Plane,
        Mesh3d(plane),
        MeshMaterial3d(paper),
        Transform::from_translation(flight.at),
    ));
    vantage
}
