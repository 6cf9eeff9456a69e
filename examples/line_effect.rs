//! Emphasis: an effect that changes lines. What is at one distance keeps its lines, all others
//! become thinner and fainter. The arrow keys move the distance. Guide: docs/your-own-effect.md.

use bevy::prelude::*;
use bevy_comics::{
    effect::*,
    lines::{LineFade, LineModifiers},
    prelude::*,
};
use serde::{Deserialize, Serialize};

/// Keeps the lines of what is at a distance.
#[derive(Component, Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
#[serde(default, deny_unknown_fields)]
pub struct Emphasis {
    /// The fraction of their width and opacity that other lines lose. Range 0 to 1, default 0.9.
    #[reflect(@FieldRange::linear(0.0, 1.0))]
    pub amount: f32,
    /// The distance whose lines are whole, in world units. Range 0.1 to 1000, default 8.
    #[reflect(@FieldRange::logarithmic(0.1, 1000.0))]
    pub distance: f32,
}

impl Default for Emphasis {
    fn default() -> Self {
        Self {
            amount: 0.9,
            distance: 8.0,
        }
    }
}

impl Effect for Emphasis {
    const NAME: &'static str = "emphasis";
    const STAGE: EffectStage = EffectStage::Ink;
    // Every effect has a function. This one leaves the pixel as it is: the lines change.
    const SHADER: EffectShader = EffectShader {
        path: "line_effect::emphasis",
        settings: None,
        source: "#define_import_path line_effect::emphasis
            #import bevy_comics::effect::pixel::Pixel
            fn emphasis(p: Pixel) -> Pixel { return p; }",
    };
    type Uniform = NoUniform;

    fn strength(&self) -> f32 {
        self.amount
    }

    fn faded(self, fraction: f32) -> Self {
        Self {
            amount: self.amount * fraction,
            ..self
        }
    }

    fn line_modifiers(&self, _: &EffectContext) -> LineModifiers {
        LineModifiers {
            fade: Some(LineFade {
                distance: Some(self.distance),
                // Lines are whole up to 1.2 times the distance, and fade up to 2.2 times.
                clear: 1.2f32.ln(),
                ramp: 1.8f32.ln(),
                amount: self.amount,
            }),
            ..default()
        }
    }

    fn affected_area(&self, _: &EffectContext) -> AffectedArea {
        AffectedArea::AtLines
    }

    fn uniform(&self, _: &EffectContext) -> NoUniform {
        NoUniform::default()
    }
}

fn main() {
    App::new()
        .add_plugins((
            DefaultPlugins,
            ComicsPlugin,
            EffectPlugin::<Emphasis>::default(),
        ))
        .add_systems(Startup, setup)
        .add_systems(Update, move_the_distance)
        .run();
}

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    let eye = Transform::from_xyz(0.0, 2.0, 9.0).looking_at(Vec3::Y, Vec3::Y);
    let style = (Outlines::default(), Emphasis::default());
    commands.spawn((Camera3d::default(), eye, style));
    commands.spawn((
        DirectionalLight::default(),
        eye.looking_to(-Vec3::ONE, Vec3::Y),
    ));
    let house = assets.add(Mesh::from(Cuboid::new(2.0, 3.0, 2.0)));
    let paint = assets.add(StandardMaterial::from(Color::hsl(40.0, 0.4, 0.7)));
    for i in 0..24 {
        let at = Vec3::new((i % 2 * 8 - 4) as f32, 0.0, 3.0 - 2.0 * i as f32);
        let (mesh, material) = (Mesh3d(house.clone()), MeshMaterial3d(paint.clone()));
        commands.spawn((mesh, material, Transform::from_translation(at)));
    }
}

fn move_the_distance(
    keys: Res<ButtonInput<KeyCode>>,
    time: Res<Time>,
    mut camera: Single<&mut Emphasis>,
) {
    let [near, far] = [KeyCode::ArrowDown, KeyCode::ArrowUp].map(|key| keys.pressed(key));
    let speed = f32::from(i8::from(far) - i8::from(near));
    if speed != 0.0 {
        camera.distance *= (speed * time.delta_secs()).exp();
    }
}
