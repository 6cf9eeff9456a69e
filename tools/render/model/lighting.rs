//! Light for models: a studio that turns with the camera, or the model's own
//! lights at a level that suits the exposure.

use std::f32::consts::PI;

use bevy::{
    camera::Exposure, core_pipeline::tonemapping::Tonemapping, light::CascadeShadowConfigBuilder,
    prelude::*,
};

use bevy_comics_testkit::scenes::environment;

use super::framing::Framing;

/// A directional light of the studio.
struct Lamp {
    /// Direction to the light in the camera's frame: `x` right, `y` up, `z`
    /// towards the camera.
    towards: Vec3,
    /// Value to which a white surface that faces the lamp is exposed by it alone.
    level: f32,
    /// The same for the toon material.
    flat_level: f32,
    color: Color,
    shadows: bool,
}

/// Level of a model's own lights together.
const OWN_LEVEL: f32 = 0.5;

/// Beside the environment map, the lamps are weak: its panels give most of the
/// light, and the highlight of a lamp without size clips on metal. The toon
/// material has no environment map, so the lamps are stronger there.
const LAMPS: [Lamp; 3] = [
    // Key.
    Lamp {
        towards: Vec3::new(-0.55, 0.62, 0.62),
        level: 0.28,
        flat_level: 0.66,
        color: Color::srgb(1.0, 0.985, 0.96),
        shadows: true,
    },
    // Fill.
    Lamp {
        towards: Vec3::new(0.85, 0.1, 0.55),
        level: 0.08,
        flat_level: 0.08,
        color: Color::srgb(0.92, 0.96, 1.0),
        shadows: false,
    },
    // Rim.
    Lamp {
        towards: Vec3::new(0.55, 0.5, -0.75),
        level: 0.14,
        flat_level: 0.1,
        color: Color::WHITE,
        shadows: false,
    },
];

/// Illuminance, lux, that exposes a white surface to this value.
fn illuminance(level: f32) -> f32 {
    level * PI / Exposure::default().exposure()
}

/// Level of the ambient light in the shadows of the toon material.
const FLAT_AMBIENT: f32 = 0.16;

/// Gives the camera the tone mapping, surroundings and, if the model has no
/// lights, the lamps of the studio. `flat`: for the toon material.
pub fn light_camera(
    world: &mut World,
    camera: Entity,
    framing: &Framing,
    (lamps, flat): (bool, bool),
) {
    let white = 1.0 / Exposure::default().exposure();
    // Made for this: base colors come out as they are, highlights never clip.
    world
        .entity_mut(camera)
        .insert(Tonemapping::KhronosPbrNeutral);
    if flat {
        // Lamps and even light have clearer shapes than the soft panels around.
        world.entity_mut(camera).insert(AmbientLight {
            brightness: FLAT_AMBIENT * white,
            ..default()
        });
    } else {
        let environment = environment::light(&mut world.resource_mut::<Assets<Image>>(), white);
        world.entity_mut(camera).insert(environment);
    }
    if !lamps {
        return;
    }
    let cascades = CascadeShadowConfigBuilder {
        num_cascades: 1,
        minimum_distance: framing.near,
        maximum_distance: framing.far,
        ..default()
    }
    .build();
    for lamp in &LAMPS {
        let light = DirectionalLight {
            color: lamp.color,
            illuminance: illuminance(if flat { lamp.flat_level } else { lamp.level }),
            shadow_maps_enabled: lamp.shadows,
            // The default suits models of a few units; it is a distance.
            shadow_depth_bias: 1e-3 * (framing.far - framing.near),
            ..default()
        };
        world.spawn((
            light,
            Transform::default().looking_to(-lamp.towards, Vec3::Y),
            cascades.clone(),
            ChildOf(camera),
        ));
    }
}

/// Turns the surroundings with the camera, about the vertical axis.
pub fn turn_environment(transform: &Transform, environment: &mut EnvironmentMapLight) {
    let back = transform.back();
    environment.rotation = Quat::from_rotation_y(back.x.atan2(back.z));
}

/// What a model's own lights are.
#[derive(bevy::ecs::system::SystemParam)]
pub struct OwnLights<'w, 's> {
    suns: Query<'w, 's, &'static mut DirectionalLight>,
    points: Query<'w, 's, (&'static mut PointLight, &'static GlobalTransform)>,
    spots: Query<'w, 's, (&'static mut SpotLight, &'static GlobalTransform)>,
}

impl OwnLights<'_, '_> {
    pub fn is_empty(&self) -> bool {
        self.suns.is_empty() && self.points.is_empty() && self.spots.is_empty()
    }

    /// Scales all lights by one factor, so that together they light the model,
    /// where it is nearest to them, at [`OWN_LEVEL`]. Exporters differ by orders of
    /// magnitude in the intensities that they write.
    pub fn level(&mut self, center: Vec3, radius: f32) {
        // Lux at the nearest point of the model's sphere. Of a light within the
        // sphere, lux at the distance of its radius.
        let received = |lumens: f32, transform: &GlobalTransform| {
            let distance = (transform.translation().distance(center) - radius).max(radius);
            lumens / (4.0 * PI * distance * distance)
        };
        let points = self.points.iter();
        let spots = self.spots.iter();
        let total = self.suns.iter().map(|l| l.illuminance).sum::<f32>()
            + points.map(|(l, at)| received(l.intensity, at)).sum::<f32>()
            + spots.map(|(l, at)| received(l.intensity, at)).sum::<f32>();
        let factor = illuminance(OWN_LEVEL) / total;
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        for mut light in &mut self.suns {
            light.illuminance *= factor;
        }
        // The engine's default range suits scenes of a few meters.
        let reach = |at: &GlobalTransform| at.translation().distance(center) + 2.0 * radius;
        for (mut light, at) in &mut self.points {
            light.intensity *= factor;
            light.range = light.range.max(reach(at));
        }
        for (mut light, at) in &mut self.spots {
            light.intensity *= factor;
            light.range = light.range.max(reach(at));
        }
    }
}
