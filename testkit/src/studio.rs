//! One scene, one camera, any number of styles.

use std::time::Duration;

use bevy::{
    camera::RenderTarget, core_pipeline::tonemapping::DebandDither, ecs::system::RunSystemOnce,
    prelude::*, render::view::Msaa, time::TimeUpdateStrategy,
};
use bevy_comics::{CartoonScene, ComicStyle, ComicsPlugin, DepthMap, ToneBands, presets};

use super::{
    headless::{Headless, HeadlessOptions},
    scenes::{BuiltIn, ScenePart, Stage, Vantage},
};

/// Frames to render after a change of style: the first inserts prepasses and compiles
/// pipelines, the second draws with them. The depth range has no delay.
const SETTLE: u32 = 2;

/// What a picture advances the clock by. Sketches change with time, so that the
/// reference pictures depend on it.
const SHOT: Duration = Duration::from_micros(4 * 16_667);

pub struct Studio {
    pub headless: Headless,
    pub camera: Entity,
    pub vantage: Vantage,
}

impl Studio {
    pub fn new(scene: BuiltIn, size: UVec2, msaa: Msaa) -> Self {
        let options = HeadlessOptions { size, ..default() };
        Self::with_options(scene, options, msaa)
    }

    pub fn with_options(scene: BuiltIn, options: HeadlessOptions, msaa: Msaa) -> Self {
        let mut headless = Headless::new(options, ComicsPlugin);
        let vantage = headless
            .app
            .world_mut()
            .run_system_once(move |mut stage: Stage| stage.spawn(scene))
            .expect("the stage is there");
        set_cartoon(headless.app.world_mut(), scene == BuiltIn::Theatre);
        let target: RenderTarget = headless.render_target();
        let camera = headless
            .app
            .world_mut()
            .spawn((vantage.camera(), target, msaa))
            .id();
        headless.step(2);
        Self {
            headless,
            camera,
            vantage,
        }
    }

    /// The picture of the scene in a style; unstyled for `None`.
    pub fn shoot(&mut self, style: Option<&ComicStyle>) -> image::RgbaImage {
        let none = ComicStyle::default();
        let world = self.headless.app.world_mut();
        wear(
            &mut world.commands().entity(self.camera),
            style.unwrap_or(&none),
        );
        world.flush();
        let frame = TimeUpdateStrategy::ManualDuration(SHOT / SETTLE);
        self.headless.app.insert_resource(frame);
        self.headless.step(SETTLE as usize);
        self.headless.picture()
    }
}

/// Gives a camera a style. Tone bands switch off the engine's dither, which would
/// speckle flat areas whose tone lies at a step between two bands.
pub fn wear(camera: &mut EntityCommands, style: &ComicStyle) {
    camera.insert(match style.get::<ToneBands>() {
        Some(_) => DebandDither::Disabled,
        None => DebandDither::Enabled,
    });
    style.apply(camera);
}

/// The same style with this depth map.
pub fn with_map(mut style: ComicStyle, map: DepthMap) -> ComicStyle {
    style.depth_map = Some(map);
    style
}

/// The presets that have a golden picture in a scene. The first ten presets are those of
/// the first paper. The mountains show them, the theatre shows the others, the teapot
/// shows all, and the village shows the first ten and `graphic-novel`.
pub fn golden_presets(scene: BuiltIn) -> Vec<&'static str> {
    let is_cartoon = |name: &str| presets::ALL.iter().position(|p| p.name() == name) >= Some(10);
    let wanted = |name: &&str| match scene {
        BuiltIn::Teapot => true,
        BuiltIn::Theatre => is_cartoon(name),
        BuiltIn::Mountains => !is_cartoon(name),
        BuiltIn::Village => !is_cartoon(name) || *name == "graphic-novel",
    };
    presets::ALL
        .iter()
        .map(|preset| preset.name())
        .filter(wanted)
        .collect()
}

/// Draws the whole scene with the cartoon material, or with its own materials.
pub fn set_cartoon(world: &mut World, on: bool) {
    let mut parts = world.query_filtered::<Entity, (With<ScenePart>, Without<ChildOf>)>();
    let parts: Vec<Entity> = parts.iter(world).collect();
    for part in parts {
        if on {
            world.entity_mut(part).insert(CartoonScene::default());
        } else {
            world.entity_mut(part).remove::<CartoonScene>();
        }
    }
}
