//! One scene, one camera, any number of styles.

use std::time::Duration;

use bevy::{
    camera::RenderTarget, ecs::system::RunSystemOnce, prelude::*, time::TimeUpdateStrategy,
};
use bevy_comics::{
    Comic, ComicStyle, ComicsPlugin, DepthMap, Focus, Halftone, Hatching, IsoLines, Outlines,
    Paint, Paper, SpeedLines, ToneRamp, ToonLight, ToonScene, TwoTone,
    effects::{
        FocusAt, FocusStyle, HalftoneMode, HatchingGround, HatchingKind, PaintKernel, ScreenAnchor,
        ScreenShape, SpeedLineKind,
    },
    objects::MeshSections,
    presets,
    style::{StyleScene, StyleScope},
};

use super::{
    headless::{Headless, HeadlessOptions},
    scenes::{BuiltIn, ScenePart, Stage, ToonPart, Vantage},
};

/// Frames to render after a change of style: the first inserts prepasses and compiles
/// pipelines, the second draws with them. The depth range has no delay.
const SETTLE: u32 = 2;

/// What a picture advances the clock by.
const SHOT: Duration = Duration::from_micros(4 * 16_667);

pub struct Studio {
    pub headless: Headless,
    pub camera: Entity,
    pub vantage: Vantage,
    is_toon: bool,
}

/// The entities of a scene come after this index. How many an app has before them changes with the
/// plugins and resources of the engine and this crate, and the pressure of lines is random by
/// entity.
const FIRST_OF_SCENE: u32 = 1024;

pub fn reserve_entities(world: &mut World) {
    while world.spawn_empty().id().index_u32() < FIRST_OF_SCENE {}
}

impl Studio {
    pub fn new(scene: BuiltIn, size: UVec2, msaa: Msaa) -> Self {
        let options = HeadlessOptions { size, ..default() };
        Self::with_options(scene, options, msaa)
    }

    pub fn with_options(scene: BuiltIn, options: HeadlessOptions, msaa: Msaa) -> Self {
        Self::with_plugins(scene, options, msaa, ComicsPlugin)
    }

    /// The plugins must include `ComicsPlugin`.
    pub fn with_plugins<M>(
        scene: BuiltIn,
        options: HeadlessOptions,
        msaa: Msaa,
        plugins: impl bevy::app::Plugins<M>,
    ) -> Self {
        let mut headless = Headless::new(options, plugins);
        reserve_entities(headless.app.world_mut());
        let vantage = headless
            .app
            .world_mut()
            .run_system_once(move |mut stage: Stage| stage.spawn(scene))
            .expect("the stage is there");
        set_toon(headless.app.world_mut(), scene.is_toon());
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
            is_toon: scene.is_toon(),
        }
    }

    /// The picture of the scene in a style; unstyled for `None`. Scenes that are made for the toon
    /// material have the light of the style, if it has one.
    pub fn shoot(&mut self, style: Option<&ComicStyle>) -> image::RgbaImage {
        let none = ComicStyle::default();
        let style = style.unwrap_or(&none);
        let world = self.headless.app.world_mut();
        let is_lit = self.is_toon && style.scene.is_some();
        if self.is_toon {
            set_default_light(world, !is_lit);
        }
        let scope = if is_lit {
            StyleScope::Layers
        } else {
            StyleScope::CameraOnly
        };
        set_whole_style(&mut world.commands().entity(self.camera), style, scope);
        world.flush();
        let frame = TimeUpdateStrategy::ManualDuration(SHOT / SETTLE);
        self.headless.app.insert_resource(frame);
        self.headless.step(SETTLE as usize);
        self.headless.picture()
    }

    /// The golden picture of a style, whatever was drawn before.
    pub fn shoot_golden(&mut self, name: &str, style: &ComicStyle) -> image::RgbaImage {
        let mut clock = Time::<Virtual>::default();
        clock.advance_to(golden_time(name) - SHOT);
        self.headless.app.insert_resource(clock);
        self.shoot(Some(style))
    }
}

/// Gives a camera a style without its light: what scenes and examples are made with stays.
pub fn set_style(camera: &mut EntityCommands, style: &ComicStyle) {
    set_whole_style(camera, style, StyleScope::CameraOnly);
}

/// Gives a camera a style at once, without an asset.
fn set_whole_style(camera: &mut EntityCommands, style: &ComicStyle, scope: StyleScope) {
    camera.insert((Comic::default(), scope));
    style.apply(camera);
}

/// The same style with this depth map.
pub fn with_map(mut style: ComicStyle, map: DepthMap) -> ComicStyle {
    style.depth_map = Some(map);
    style
}

/// The names of the presets with a golden picture in a scene: each is in the scene that suits it
/// best.
fn golden_presets(scene: BuiltIn) -> &'static str {
    match scene {
        BuiltIn::Mountains => "twilight-toon crimson-dusk emerald-ink watercolor",
        BuiltIn::Teapot => "museum-print sepia figure-7a figure-7b figure-8a figure-8b figure-8c",
        BuiltIn::Theatre => {
            "silver-age pencil-sketch clear-bands silent-film manga-page pop-poster \
             pencil-study"
        }
        BuiltIn::Village => {
            "graphic-novel ligne-claire noir cobalt-night misty-morning golden-hour \
             blueprint gouache newsprint risograph storybook copper-and-teal woodcut \
             charcoal"
        }
        BuiltIn::Figure => {
            "saturday-morning field-guide stained-glass red-poster ballpoint red-chalk \
             sumi-e pixel"
        }
        BuiltIn::Street => "hard-boiled neon-night ukiyo-e survey-map oil-sketch",
        BuiltIn::Hall => "engraving",
    }
}

/// The styles that have a golden picture in a scene, with their names: presets, and those of
/// effects that no preset has.
pub fn golden_styles(scene: BuiltIn) -> Vec<(&'static str, ComicStyle)> {
    let names = golden_presets(scene).split(' ');
    let presets = names.map(|name| presets::find(name).expect("a preset"));
    let presets = presets.map(|preset| (preset.name(), preset.style()));
    presets.chain(single_effects(scene)).collect()
}

/// When the golden picture of a style is drawn, in the app's time: some styles are drawn anew some
/// times a second.
fn golden_time(name: &str) -> Duration {
    Duration::from_millis(match name {
        "silent-film" => 834,
        "watercolor" => 1900,
        _ => 200,
    })
}

/// Styles of effects that no preset has, for one scene each.
fn single_effects(scene: BuiltIn) -> Vec<(&'static str, ComicStyle)> {
    let lines = SpeedLines {
        rate: 0.0,
        width: 6.0,
        ..SpeedLines::default()
    };
    let style = ComicStyle::new();
    match scene {
        BuiltIn::Mountains => {
            let lines = IsoLines {
                step: 100.0,
                ..IsoLines::default()
            };
            vec![("iso-lines", style.with(lines))]
        }
        BuiltIn::Teapot => {
            let outlines = Outlines::default();
            let style = style.with(outlines).with(TwoTone::default());
            let impact = style.with(lines);
            let hatched = ComicStyle::new()
                .with(Hatching::default())
                .with(Outlines::default());
            vec![("impact", impact), ("hatching", hatched)]
        }
        BuiltIn::Theatre => {
            let kind = SpeedLineKind::Parallel;
            let followed = Halftone {
                mode: HalftoneMode::Spot,
                shape: ScreenShape::Line,
                anchor: ScreenAnchor::Object,
                ..Halftone::default()
            };
            let followed = style.clone().with(followed).with_scene(StyleScene {
                screens: true,
                ..default()
            });
            let screens = followed.with(Outlines::default());
            vec![
                ("speed-lines", style.with(SpeedLines { kind, ..lines })),
                ("object-screens", screens),
            ]
        }
        BuiltIn::Village => village_effects(&style),
        BuiltIn::Figure => {
            let dots = Hatching {
                kind: HatchingKind::Dots,
                spacing: 3.0,
                wobble: 1.0,
                ground: HatchingGround::Paper,
                ..Hatching::default()
            };
            vec![("stipple", style.with(dots).with(Outlines::default()))]
        }
        BuiltIn::Street | BuiltIn::Hall => Vec::new(),
    }
}

/// The focus on the barrels and the cart in front of the village.
pub fn village_focus(style: FocusStyle) -> ComicStyle {
    let focus = Focus {
        at: FocusAt::Distance,
        style,
        distance: 11.5,
        cell_size: 4.0,
        radius: if style == FocusStyle::Offset {
            4.0
        } else {
            8.0
        },
        ..Focus::default()
    };
    ComicStyle::new().with(focus).with(Outlines::default())
}

fn village_effects(style: &ComicStyle) -> Vec<(&'static str, ComicStyle)> {
    let distance = Paint {
        at_near: 2.0,
        at_far: 9.0,
        ..Paint::default()
    };
    let hatched = Hatching {
        spacing: 3.0,
        ground: HatchingGround::Paper,
        ..Hatching::default()
    };
    let strokes = Paint {
        kernel: PaintKernel::Anisotropic,
        at_near: 6.0,
        at_far: 6.0,
        ..Paint::default()
    };
    let lined = |style: ComicStyle| style.with(Outlines::default());
    vec![
        ("paper", style.clone().with(Paper::default())),
        ("paint", lined(style.clone().with(distance))),
        ("strokes", style.clone().with(strokes)),
        ("hatching", lined(style.clone().with(hatched))),
        ("focus", village_focus(FocusStyle::Blur)),
        ("focus-offset", village_focus(FocusStyle::Offset)),
        ("focus-paint", village_focus(FocusStyle::Paint)),
        ("focus-dots", village_focus(FocusStyle::Dots)),
        ("focus-lines", village_focus(FocusStyle::Lines)),
        ("tone-ramp", lined(style.clone().with(ToneRamp::default()))),
    ]
}

/// The roots of the scene's parts.
fn roots(world: &mut World) -> Vec<Entity> {
    let mut parts = world.query_filtered::<Entity, (With<ScenePart>, Without<ChildOf>)>();
    parts.iter(world).collect()
}

/// Draws the whole scene with the toon material, or with its own materials.
pub fn set_toon(world: &mut World, on: bool) {
    for part in roots(world) {
        if on {
            let look = world.get::<ToonPart>(part).cloned().unwrap_or_default();
            world.entity_mut(part).insert(look.0);
        } else {
            world.entity_mut(part).remove::<ToonScene>();
        }
    }
}

/// Gives the parts of the scene without a light of their own the default one, or takes it away.
fn set_default_light(world: &mut World, on: bool) {
    for part in roots(world) {
        match world.get::<ToonScene>(part) {
            None if on => {
                world.entity_mut(part).insert(ToonScene::default());
            }
            Some(scene) if !on && *scene == ToonScene::default() => {
                world.entity_mut(part).remove::<ToonScene>();
            }
            _ => {}
        }
    }
}

/// The theatre with strokes on all of its materials, and outlines.
pub fn hatched_theatre() -> image::RgbaImage {
    let mut studio = Studio::new(BuiltIn::Theatre, UVec2::new(320, 180), Msaa::Off);
    let world = studio.headless.app.world_mut();
    let hatching = Some(Hatching {
        spacing: 3.0,
        at_near: 0.7,
        ..default()
    });
    for part in roots(world) {
        let light = ToonLight {
            hatching,
            ..default()
        };
        world.entity_mut(part).insert(ToonScene::new(light));
    }
    studio.headless.step(4);
    studio.shoot(Some(&ComicStyle::new().with(Outlines::default())))
}

/// Divides all meshes of the scene into sections.
pub fn set_sections(world: &mut World, sections: MeshSections) {
    for part in roots(world) {
        world.entity_mut(part).insert(sections);
    }
}
