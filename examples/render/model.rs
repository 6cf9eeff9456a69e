//! glTF files: loaded, framed and, if they bring no light, lit.

use std::path::Path;

use bevy::{
    asset::LoadState, camera::primitives::Aabb, ecs::system::RunSystemOnce, gltf::GltfAssetLabel,
    light::light_consts::lux, prelude::*, world_serialization::WorldAssetRoot,
};

use bevy_comics_testkit::{
    headless::Headless,
    scenes::{ScenePart, Stage, Vantage, sky::Sky},
};

/// Frames that a file may take to load: the frames are short while nothing is
/// drawn.
const PATIENCE: usize = 20_000;

pub fn load(headless: &mut Headless, path: &Path) -> Result<Vantage, String> {
    let full = path
        .canonicalize()
        .map_err(|e| format!("cannot read {}: {e}", path.display()))?;
    let server = headless.app.world().resource::<AssetServer>().clone();
    let scene = server.load(GltfAssetLabel::Scene(0).from_asset(full));
    println!("loading {}", path.display());
    let mut waited = 0;
    while !server.is_loaded_with_dependencies(&scene) {
        if let Some(LoadState::Failed(error)) = server.get_load_state(&scene) {
            return Err(format!("{} is no glTF model: {error}", path.display()));
        }
        if waited == PATIENCE {
            return Err(format!("{} did not load", path.display()));
        }
        headless.step(1);
        std::thread::sleep(std::time::Duration::from_millis(2));
        waited += 1;
        if waited % 500 == 0 {
            println!("still loading");
        }
    }
    headless
        .app
        .world_mut()
        .spawn((ScenePart, WorldAssetRoot(scene)));
    // Spawning takes a frame, bounds and transforms another.
    headless.step(4);

    let bounds = headless
        .app
        .world_mut()
        .run_system_once(|meshes: Query<(&Aabb, &GlobalTransform)>| {
            let mut corners = meshes.iter().flat_map(|(aabb, transform)| {
                let (low, high) = (Vec3::from(aabb.min()), Vec3::from(aabb.max()));
                (0..8).map(move |i| {
                    let pick = |bit: u32| i >> bit & 1 == 1;
                    transform.transform_point(Vec3::new(
                        if pick(0) { high.x } else { low.x },
                        if pick(1) { high.y } else { low.y },
                        if pick(2) { high.z } else { low.z },
                    ))
                })
            });
            corners.next().map(|first| {
                corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p)))
            })
        })
        .ok()
        .flatten();
    let Some((low, high)) = bounds.filter(|(low, high)| low.is_finite() && high.is_finite()) else {
        return Err(format!(
            "{} has nothing to see: no mesh in its first scene",
            path.display()
        ));
    };
    headless
        .app
        .world_mut()
        .run_system_once(move |stage: Stage, lights: Query<(), AnyLight>| {
            frame(stage, low, high, lights.is_empty())
        })
        .map_err(|error| format!("cannot light {}: {error}", path.display()))
}

type AnyLight = Or<(With<DirectionalLight>, With<PointLight>, With<SpotLight>)>;

/// A three-quarter view of the whole, and a sun where there is no light.
fn frame(mut stage: Stage, low: Vec3, high: Vec3, dark: bool) -> Vantage {
    let centre = low.midpoint(high);
    let radius = (0.5 * low.distance(high)).max(1e-4);
    let sun = Vec3::new(0.5, 0.8, 0.6);
    if dark {
        stage.commands.spawn((
            ScenePart,
            DirectionalLight {
                illuminance: lux::AMBIENT_DAYLIGHT,
                shadow_maps_enabled: true,
                ..default()
            },
            Transform::from_translation(sun).looking_at(Vec3::ZERO, Vec3::Y),
            bevy::light::CascadeShadowConfigBuilder {
                num_cascades: 1,
                maximum_distance: 6.0 * radius,
                minimum_distance: 0.01 * radius,
                ..default()
            }
            .build(),
        ));
        stage.commands.insert_resource(GlobalAmbientLight {
            color: Color::srgb(0.75, 0.85, 1.0),
            brightness: 1800.0,
            ..default()
        });
    }
    let sky = Sky {
        zenith: 0x6f9fc8,
        middle: 0xb7d3e4,
        horizon: 0xf0ece2,
        ground: 0xcfc8b8,
        cloud: 0xffffff,
        cover: 0.25,
        sun,
    };
    let fov = 40f32.to_radians();
    Vantage {
        eye: centre + Vec3::new(0.62, 0.42, 1.0).normalize() * radius / (0.5 * fov).sin() * 1.08,
        target: centre,
        fov,
        near: radius * 0.02,
        far: radius * 100.0,
        ortho: (
            centre + Vec3::new(0.62, 0.55, 1.0).normalize() * radius * 4.0,
            centre,
        ),
        ortho_height: radius * 2.2,
        sky: stage.images.add(sky.image()),
        sky_brightness: 1000.0,
    }
}
