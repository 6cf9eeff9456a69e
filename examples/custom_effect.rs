//! Rain: an effect of your own. Space stops and starts it. Guide: docs/your-own-effect.md.
#![cfg_attr(rustfmt, rustfmt_skip)] // Short methods take one line here.

use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use bevy_comics::{effect::*, prelude::*};
use bevy_comics_inspector::ComicsInspectorPlugin;
use serde::{Deserialize, Serialize};

/// Rain in front of the scene. Near things hide what rains behind them.
#[derive(Component, Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
#[serde(default, deny_unknown_fields)]
struct Rain {
    /// How hard it rains. Range 0 (not at all) to 1, default 0.6.
    #[reflect(@FieldRange::linear(0.0, 1.0))]
    amount: f32,
    /// Speed of the nearest drops, logical pixels a second. Range 0 to 4000, default 1200.
    #[reflect(@FieldRange::linear(0.0, 4000.0).unit("px/s"), @BlendField::Switch)]
    speed: f32,
    /// Length of the nearest streaks, logical pixels. Range 4 to 240, default 110.
    #[reflect(@FieldRange::linear(4.0, 240.0).unit("px"))]
    length: f32,
    /// Degrees from straight down to the right. Range -60 to 60, default -8.
    #[reflect(@FieldRange::linear(-60.0, 60.0).unit("°"))]
    slant: f32,
    /// Color of the drops. Default: a light, bluish gray.
    #[serde(with = "bevy_comics::effect::color_serde")]
    color: Color,
}

impl Default for Rain {
    fn default() -> Self {
        let color = Color::srgb(0.8, 0.86, 0.92);
        Self { amount: 0.6, speed: 1200.0, length: 110.0, slant: -8.0, color }
    }
}

impl Effect for Rain {
    const NAME: &'static str = "rain";
    const STAGE: EffectStage = EffectStage::Page; // The last one: it falls in front of the ink.
    const SHADER: EffectShader = EffectShader {
        path: "custom_effect::rain", settings: Some("Rain"),
        source: include_str!("custom_effect/rain.wgsl"),
    };
    type Uniform = [Vec4; 2]; // The eight numbers of `Rain` in the WGSL.

    fn strength(&self) -> f32 { self.amount }
    fn faded(self, fraction: f32) -> Self { Self { amount: self.amount * fraction, ..self } }
    fn needs(&self) -> Needs { Needs::MAP }
    fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            amount: clamp_or_default(self.amount, default.amount, 0.0, 1.0),
            speed: clamp_or_default(self.speed, default.speed, 0.0, 4000.0),
            length: clamp_or_default(self.length, default.length, 4.0, 240.0),
            slant: clamp_or_default(self.slant, default.slant, -60.0, 60.0),
            color: clamp_color(self.color, default.color),
        }
    }
    fn uniform(&self, view: &EffectContext) -> [Vec4; 2] {
        let fall = (view.seconds * f64::from(self.speed) / 240.0).rem_euclid(256.0) as f32;
        let (color, slope) = (linear_rgb(self.color), self.slant.to_radians().tan());
        [color.extend(self.amount), Vec4::new(slope, self.length, fall, view.scale_factor)]
    }
}

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ComicsPlugin, EffectPlugin::<Rain>::default()))
        .add_plugins(ComicsInspectorPlugin::default())
        .add_systems(Startup, setup)
        .add_systems(Update, toggle_rain.run_if(input_just_pressed(KeyCode::Space)))
        .run();
}

fn setup(mut commands: Commands, assets: Res<AssetServer>) {
    let eye = Transform::from_xyz(0.0, 2.0, 9.0).looking_at(Vec3::Y, Vec3::Y);
    let look = (Outlines::default(), Desaturation::default(), Rain::default());
    commands.spawn((Camera3d::default(), eye, look));
    commands.spawn((DirectionalLight::default(), eye.looking_to(-Vec3::ONE, Vec3::Y)));
    let paint = |color: Color| MeshMaterial3d(assets.add(StandardMaterial::from(color)));
    let ground = assets.add(Mesh::from(Plane3d::default().mesh().size(80.0, 80.0)));
    commands.spawn((Mesh3d(ground), paint(Color::srgb(0.6, 0.55, 0.5))));
    for i in 0..20 {
        let (side, row) = ((i % 2 * 10 - 5) as f32, i as f32);
        let at = Transform::from_xyz(side, (i * 7 % 5) as f32 - 1.0, 3.0 - 2.0 * row);
        let house = assets.add(Mesh::from(Cuboid::new(3.0, 6.0, 3.0)));
        commands.spawn((Mesh3d(house), paint(Color::hsl(40.0 * row, 0.4, 0.5)), at));
    }
}

fn toggle_rain(world: &mut World) -> Result {
    let (camera, rains, _) = world.query::<(Entity, Has<Rain>, &Camera3d)>().single(world)?;
    let rain = if rains { "" } else { "rain: (amount: 0.8)" };
    let text = format!("(version: 3, outlines: (), desaturation: (), {rain})");
    let style = world.resource::<EffectRegistry>().style_from_ron(&text)?;
    world.entity_mut(camera).insert(StyleTransition::to(style, 2.0));
    Ok(())
}
