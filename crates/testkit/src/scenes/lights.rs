//! Other lights for a scene of the size of the theatre: one kind alone.

use bevy::prelude::*;

use super::{ScenePart, lamplight, noise::smoothstep, shadows_within, sky::cube_map, sunlight};

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
    let is_bright = lighting == Lighting::Environment;
    let brightness = if is_bright { 0.0 } else { 330.0 };
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
        Lighting::Sun => {
            let (from, shadows) = (Vec3::new(-0.55, 0.8, 0.62), shadows_within(26.0));
            world.spawn(sunlight(from, 4500.0, [1.0, 0.95, 0.86], shadows));
        }
        Lighting::Lamps => {
            for (at, color, strength) in [
                ([-4.2, 3.4, 3.2], Color::srgb(1.0, 0.72, 0.42), 1.0),
                ([4.4, 3.0, 3.6], Color::srgb(0.5, 0.72, 1.0), 1.0),
                ([0.2, 5.6, 5.5], Color::WHITE, 1.4),
            ] {
                let intensity = 620_000.0 * strength;
                world.spawn(lamplight(at.into(), intensity, color, 30.0, true));
            }
        }
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
        let left = Vec3::new(-0.6, 0.6, 0.5).normalize();
        let bright = left.dot(direction).max(0.0);
        let light = base + Vec3::new(1.5, 1.35, 1.05) * bright * bright;
        light.extend(1.0).to_array()
    })
}
