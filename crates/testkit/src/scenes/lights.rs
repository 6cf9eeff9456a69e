//! Other lights for a scene of the size of the theatre: one kind alone.

use bevy::{
    light::{CascadeShadowConfigBuilder, EnvironmentMapLight, RectLight},
    prelude::*,
};

use super::{ScenePart, noise::smoothstep, sky::cube_map};

/// The kind of lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lighting {
    /// An environment map.
    Environment,
    /// A directional light with shadows.
    Sun,
    /// Three point lights with shadows: warm, cold and white.
    Lamps,
    /// A rectangular light above.
    Area,
}

impl Lighting {
    pub const ALL: [Self; 4] = [Self::Environment, Self::Sun, Self::Lamps, Self::Area];
}

type AnyLight = Or<(
    With<DirectionalLight>,
    With<PointLight>,
    With<SpotLight>,
    With<RectLight>,
)>;

/// Replaces all lights of the scene that a camera sees.
pub fn relight(world: &mut World, camera: Entity, lighting: Lighting) {
    let mut lights = world.query_filtered::<Entity, AnyLight>();
    let lights: Vec<Entity> = lights.iter(world).collect();
    for light in lights {
        world.despawn(light);
    }
    world.entity_mut(camera).remove::<EnvironmentMapLight>();
    let brightness = if lighting == Lighting::Environment {
        0.0
    } else {
        330.0
    };
    world.insert_resource(GlobalAmbientLight {
        brightness,
        ..default()
    });
    match lighting {
        Lighting::Environment => {
            let map = (world.resource_mut::<Assets<Image>>()).add(environment());
            world.entity_mut(camera).insert(EnvironmentMapLight {
                diffuse_map: map.clone(),
                specular_map: map,
                intensity: 1200.0,
                ..default()
            });
        }
        Lighting::Sun => sun(world),
        Lighting::Lamps => lamps(world),
        Lighting::Area => {
            let light = RectLight {
                intensity: 240_000.0,
                width: 3.0,
                height: 2.0,
                range: 60.0,
                ..default()
            };
            let at = Transform::from_xyz(-2.5, 5.5, 4.5);
            world.spawn((ScenePart, light, at.looking_at(Vec3::Y, Vec3::Y)));
        }
    }
}

/// Light from a bright sky on the left, and from a brown floor.
fn environment() -> Image {
    cube_map(16, 1, |direction, _| {
        let (floor, sky) = (Vec3::new(0.3, 0.22, 0.16), Vec3::new(0.55, 0.68, 0.9));
        let base = floor.lerp(sky, smoothstep(-0.7, 0.7, direction.y));
        let bright = Vec3::new(-0.6, 0.6, 0.5)
            .normalize()
            .dot(direction)
            .max(0.0);
        let light = base + Vec3::new(1.5, 1.35, 1.05) * bright * bright;
        light.extend(1.0).to_array()
    })
}

fn sun(world: &mut World) {
    let light = DirectionalLight {
        illuminance: 4500.0,
        color: Color::srgb(1.0, 0.95, 0.86),
        shadow_maps_enabled: true,
        ..default()
    };
    let cascades = CascadeShadowConfigBuilder {
        num_cascades: 1,
        maximum_distance: 26.0,
        ..default()
    };
    let from = Transform::from_xyz(-0.55, 0.8, 0.62).looking_at(Vec3::ZERO, Vec3::Y);
    world.spawn((ScenePart, light, from, cascades.build()));
}

fn lamps(world: &mut World) {
    let lamps = [
        (Vec3::new(-4.2, 3.4, 3.2), Color::srgb(1.0, 0.72, 0.42), 1.0),
        (Vec3::new(4.4, 3.0, 3.6), Color::srgb(0.5, 0.72, 1.0), 1.0),
        (Vec3::new(0.2, 5.6, 5.5), Color::WHITE, 1.4),
    ];
    for (at, color, strength) in lamps {
        let light = PointLight {
            intensity: 620_000.0 * strength,
            color,
            range: 30.0,
            shadow_maps_enabled: true,
            ..default()
        };
        world.spawn((ScenePart, light, Transform::from_translation(at)));
    }
}
