//! Times frames of many objects with the outlines of each crate: the scenes of the report's section
//! `many-objects`.

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::{ComicsPlugin, Outlines};
use bevy_comics_testkit::{
    bench,
    headless::{Headless, HeadlessOptions},
};
use bevy_edge_detection_outline::{EdgeDetection, EdgeDetectionPlugin};
use bevy_mod_outline::{OutlineMode, OutlinePlugin, OutlineVolume};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Variant {
    Prepasses,
    Ours,
    Edges,
    Extruded,
    Flood,
}

impl Variant {
    const ALL: [Self; 5] = [
        Self::Prepasses,
        Self::Ours,
        Self::Edges,
        Self::Extruded,
        Self::Flood,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Prepasses => "depth and normal prepass",
            Self::Ours => "bevy_comics: outlines",
            Self::Edges => "bevy_edge_detection_outline 0.4.1",
            Self::Extruded => "bevy_mod_outline 0.13.0: extruded",
            Self::Flood => "bevy_mod_outline 0.13.0: jump flood",
        }
    }

    /// An app with so many cubes, which share a mesh and a material.
    fn app(self, count: usize) -> Headless {
        let options = HeadlessOptions {
            size: UVec2::splat(64),
            parallel_systems: true,
            ..default()
        };
        let mut headless = match self {
            Self::Prepasses => Headless::new(options, ()),
            Self::Ours => Headless::new(options, ComicsPlugin),
            Self::Edges => Headless::new(options, EdgeDetectionPlugin),
            Self::Extruded | Self::Flood => {
                Headless::new(options, OutlinePlugin::EXTRUDE_VERTEX)
            }
        };
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
            unlit: true,
            ..default()
        });
        let side = (count as f32).cbrt().ceil();
        for index in 0..count {
            let at = index as f32;
            let cell = Vec3::new(at % side, (at / side).floor() % side, (at / side / side).floor());
            let cube = world
                .spawn((
                    Mesh3d(mesh.clone()),
                    MeshMaterial3d(material.clone()),
                    Transform::from_translation(2.0 * cell - side)
                        .with_rotation(Quat::from_rotation_y(at)),
                ))
                .id();
            let mode = match self {
                Self::Extruded => OutlineMode::ExtrudeFlat,
                Self::Flood => OutlineMode::FloodFlat,
                _ => continue,
            };
            let volume = OutlineVolume {
                visible: true,
                colour: Color::BLACK,
                width: 2.0,
            };
            world.entity_mut(cube).insert((volume, mode));
        }
        let at = Transform::from_xyz(0.0, 0.0, 4.0 * side).looking_to(Vec3::NEG_Z, Vec3::Y);
        let mut camera = world.spawn((Camera3d::default(), target, Msaa::Off, at));
        camera.insert((DepthPrepass, NormalPrepass));
        match self {
            Self::Ours => {
                camera.insert(Outlines::default());
            }
            Self::Edges => {
                camera.insert(EdgeDetection::default());
            }
            _ => {}
        }
        headless
    }
}

/// Measures the crates in turns, as CSV. `counts`: of objects; `frames`: timed frames per round.
pub fn measure(counts: &[usize], rounds: usize, frames: usize) -> String {
    let mut rows = vec!["objects,variant,round,whole".to_owned()];
    for &count in counts {
        let mut apps = Variant::ALL.map(|variant| (variant, variant.app(count)));
        for (_, app) in &mut apps {
            // Pipelines compile, and textures and buffers get their size.
            app.step(4);
        }
        for round in 0..rounds {
            for (variant, app) in &mut apps {
                let mut times: Vec<f64> = (0..frames).map(|_| bench::whole_frame(app)).collect();
                times.sort_by(f64::total_cmp);
                let name = variant.name();
                let whole = times[times.len() / 2];
                println!("{count} objects, {name}, round {round}: {whole:.1} ms");
                rows.push(format!("{count},{name},{round},{whole:.3}"));
            }
        }
    }
    rows.join("\n") + "\n"
}
