//! One scene, one camera, any number of styles.

use std::time::Duration;

use bevy::{
    camera::RenderTarget, core_pipeline::tonemapping::DebandDither, ecs::system::RunSystemOnce,
    prelude::*, render::view::Msaa, time::TimeUpdateStrategy,
};
use bevy_comics::{
    CartoonLight, CartoonScene, ComicStyle, ComicsPlugin, DepthMap, Focus, FocusAt, FocusStyle,
    Halftone, HalftoneMode, Hatching, HatchingGround, HatchingMarks, IsoLines, MeshSections,
    ObjectScreen, Outlines, Paint, PaintForm, Paper, Preset, ScreenAnchor, ScreenShape,
    SpeedLineKind, SpeedLines, ToneBands, ToneRamp, TwoTone, presets,
};

use super::{
    headless::{Headless, HeadlessOptions},
    scenes::{BuiltIn, CartoonPart, ScenePart, Stage, Vantage},
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

/// The entities of a scene come after this index. How many an app has before them changes with the
/// plugins and resources of the engine and this crate, and the pressure of lines is random by entity.
const FIRST_OF_SCENE: u32 = 1024;

fn reserve_entities(world: &mut World) {
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
        set_cartoon(headless.app.world_mut(), scene.is_cartoon());
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
        let style = style.unwrap_or(&none);
        let world = self.headless.app.world_mut();
        set_screens(world, follows_objects(style));
        wear(&mut world.commands().entity(self.camera), style);
        world.flush();
        let frame = TimeUpdateStrategy::ManualDuration(SHOT / SETTLE);
        self.headless.app.insert_resource(frame);
        self.headless.step(SETTLE as usize);
        self.headless.picture()
    }
}

/// Gives a camera a style. Tone bands, tone ramps and two tones switch off the engine's dither, which
/// would speckle flat areas whose tone lies at a step between two bands.
pub fn wear(camera: &mut EntityCommands, style: &ComicStyle) {
    let divides = style.get::<ToneBands>().is_some()
        || style.get::<ToneRamp>().is_some()
        || style.get::<TwoTone>().is_some();
    camera.insert(if divides {
        DebandDither::Disabled
    } else {
        DebandDither::Enabled
    });
    style.apply(camera);
}

/// The same style with this depth map.
pub fn with_map(mut style: ComicStyle, map: DepthMap) -> ComicStyle {
    style.depth_map = Some(map);
    style
}

/// The presets after the first paper, \[CS\], and looks that began as its contours. Golden pictures are
/// taken in the order of this list and the next: sketches change with the clock.
const COLOR_PRESETS: [Preset; 10] = [
    presets::CRIMSON_DUSK,
    presets::MUSEUM_PRINT,
    presets::EMERALD_INK,
    presets::SEPIA,
    presets::LIGNE_CLAIRE,
    presets::NOIR,
    presets::COBALT_NIGHT,
    presets::MISTY_MORNING,
    presets::GOLDEN_HOUR,
    presets::BLUEPRINT,
];

/// The presets after the second paper, \[CL\].
const LINE_PRESETS: [Preset; 12] = [
    presets::SATURDAY_MORNING,
    presets::GRAPHIC_NOVEL,
    presets::PENCIL_SKETCH,
    presets::FIGURE_7A,
    presets::FIGURE_7B,
    presets::FIGURE_8A,
    presets::FIGURE_8B,
    presets::FIGURE_8C,
    presets::TWILIGHT_TOON,
    presets::WATERCOLOR,
    presets::CLEAR_BANDS,
    presets::SILENT_FILM,
];

/// The presets that print, and the one that paints.
const PAGE_PRESETS: [Preset; 6] = [
    presets::GOUACHE,
    presets::MANGA_PAGE,
    presets::NEWSPRINT,
    presets::POP_POSTER,
    presets::SILVER_AGE,
    presets::RISOGRAPH,
];

/// The presets after the second paper that outline, and that suit a landscape.
const OUTLINE_PRESETS: [Preset; 4] = [
    presets::SATURDAY_MORNING,
    presets::GRAPHIC_NOVEL,
    presets::TWILIGHT_TOON,
    presets::SILENT_FILM,
];

/// The presets that differ by distance, harmonize colours or hatch; last, so that the clock of the
/// others is the same without them.
const LATER_PRESETS: [Preset; 6] = [
    presets::STORYBOOK,
    presets::COPPER_AND_TEAL,
    presets::ENGRAVING,
    presets::PENCIL_STUDY,
    presets::WOODCUT,
    presets::HARD_BOILED,
];

/// The presets of the golden pictures of the figure.
const FIGURE_PRESETS: [Preset; 2] = [presets::SATURDAY_MORNING, presets::GRAPHIC_NOVEL];

/// The presets that have golden pictures of the figure and of the street alone.
const NEW_PRESETS: [Preset; 10] = [
    presets::FIELD_GUIDE,
    presets::STAINED_GLASS,
    presets::UKIYO_E,
    presets::SURVEY_MAP,
    presets::RED_POSTER,
    presets::BALLPOINT,
    presets::RED_CHALK,
    presets::SUMI_E,
    presets::OIL_SKETCH,
    presets::NEON_NIGHT,
];

/// Those of the street at night, and of the hall.
const STREET_PRESETS: [Preset; 2] = [presets::GRAPHIC_NOVEL, presets::HARD_BOILED];
const HALL_PRESETS: [Preset; 2] = [presets::STORYBOOK, presets::ENGRAVING];

/// The presets that have a golden picture in a scene: all those that print or paint. The mountains
/// show those after the first paper and those that outline, the theatre those after the
/// second, the teapot all of them, and the village those after the first and
/// `graphic-novel`. The figure shows only what is for characters, the street and the hall what is for
/// nights and interiors.
pub fn golden_presets(scene: BuiltIn) -> Vec<&'static str> {
    let few: &[Preset] = match scene {
        BuiltIn::Figure => &FIGURE_PRESETS,
        BuiltIn::Street => &STREET_PRESETS,
        BuiltIn::Hall => &HALL_PRESETS,
        _ => &[],
    };
    if !few.is_empty() {
        return few.iter().map(|preset| preset.name()).collect();
    }
    let mut shown = match scene {
        BuiltIn::Theatre => Vec::new(),
        _ => COLOR_PRESETS.to_vec(),
    };
    match scene {
        BuiltIn::Teapot | BuiltIn::Theatre => shown.extend(LINE_PRESETS),
        BuiltIn::Village => shown.push(presets::GRAPHIC_NOVEL),
        _ => {}
    }
    // After the others: sketches change with the clock.
    shown.extend(PAGE_PRESETS);
    if scene == BuiltIn::Mountains {
        // Those with outlines: the meadow must not become a crowd of lines.
        shown.extend(OUTLINE_PRESETS);
    }
    shown.into_iter().map(Preset::name).collect()
}

/// The styles that have a golden picture in a scene, with their names: presets, and those of
/// effects that no preset has.
pub fn golden_styles(scene: BuiltIn) -> Vec<(&'static str, ComicStyle)> {
    let names = golden_presets(scene);
    let preset = |name| presets::find(name).expect("listed").style();
    let mut styles: Vec<_> = names.into_iter().map(|name| (name, preset(name))).collect();
    if scene == BuiltIn::Figure {
        let dots = Hatching {
            marks: HatchingMarks::Dots,
            spacing: 3.0,
            wobble: 1.0,
            ground: HatchingGround::Paper,
            ..Hatching::default()
        };
        let style = ComicStyle::new().with(dots).with(Outlines::default());
        styles.push(("stipple", style));
    }
    if let BuiltIn::Figure | BuiltIn::Street = scene {
        let new = NEW_PRESETS.map(Preset::name);
        styles.extend(new.map(|name| (name, preset(name))));
        return styles;
    }
    if scene == BuiltIn::Hall {
        return styles;
    }
    styles.extend(single_effects(scene));
    let later = LATER_PRESETS.map(Preset::name);
    styles.extend(later.map(|name| (name, preset(name))));
    if let BuiltIn::Mountains | BuiltIn::Village = scene {
        let name = presets::WATERCOLOR.name();
        styles.push((name, preset(name)));
    }
    // After the watercolour, which changes with the clock.
    let name = presets::CHARCOAL.name();
    styles.push((name, preset(name)));
    if scene == BuiltIn::Village {
        // The last one: strokes of the others change with the clock.
        let style = ComicStyle::new().with(ToneRamp::default());
        styles.push(("tone-ramp", style.with(Outlines::default())));
    }
    styles
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
            let screens = style.clone().with(followed).with(Outlines::default());
            vec![
                ("speed-lines", style.with(SpeedLines { kind, ..lines })),
                ("object-screens", screens),
            ]
        }
        BuiltIn::Village => village_effects(&style),
        _ => Vec::new(),
    }
}

/// The focus on the barrels and the cart in front of the village.
pub fn village_focus(style: FocusStyle) -> ComicStyle {
    let focus = Focus {
        at: FocusAt::Distance,
        style,
        distance: 11.5,
        period: 4.0,
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
        near: 2.0,
        far: 9.0,
        ..Paint::default()
    };
    let hatched = Hatching {
        spacing: 3.0,
        ground: HatchingGround::Paper,
        ..Hatching::default()
    };
    let strokes = Paint {
        form: PaintForm::Anisotropic,
        near: 6.0,
        far: 6.0,
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
    ]
}

/// The roots of the scene's parts.
fn roots(world: &mut World) -> Vec<Entity> {
    let mut parts = world.query_filtered::<Entity, (With<ScenePart>, Without<ChildOf>)>();
    parts.iter(world).collect()
}

/// Draws the whole scene with the cartoon material, or with its own materials.
pub fn set_cartoon(world: &mut World, on: bool) {
    for part in roots(world) {
        if on {
            let look = world.get::<CartoonPart>(part).cloned().unwrap_or_default();
            world.entity_mut(part).insert(look.0);
        } else {
            world.entity_mut(part).remove::<CartoonScene>();
        }
    }
}

/// The theatre with strokes on all of its materials, and outlines.
pub fn hatched_theatre() -> image::RgbaImage {
    let mut studio = Studio::new(BuiltIn::Theatre, UVec2::new(320, 180), Msaa::Off);
    let world = studio.headless.app.world_mut();
    let hatching = Some(Hatching {
        spacing: 3.0,
        near: 0.7,
        ..default()
    });
    for part in roots(world) {
        let light = CartoonLight {
            hatching,
            ..default()
        };
        world.entity_mut(part).insert(CartoonScene::new(light));
    }
    studio.headless.step(4);
    studio.shoot(Some(&ComicStyle::new().with(Outlines::default())))
}

/// Whether the screens of a style are those of objects with an `ObjectScreen`.
fn follows_objects(style: &ComicStyle) -> bool {
    style
        .get::<Halftone>()
        .is_some_and(|halftone| halftone.anchor == ScreenAnchor::Object)
}

/// Gives every part of the scene a screen of its own, or takes it away.
fn set_screens(world: &mut World, on: bool) {
    for part in roots(world) {
        if on {
            world.entity_mut(part).insert(ObjectScreen::default());
        } else {
            world.entity_mut(part).remove::<ObjectScreen>();
        }
    }
}

/// Divides all meshes of the scene into sections.
pub fn set_sections(world: &mut World, sections: MeshSections) {
    for part in roots(world) {
        world.entity_mut(part).insert(sections);
    }
}
