//! A window on every scene in every preset.
//!
//! Drag to orbit, wheel to come closer; the keys are on the screen.

mod split;

use bevy::{
    camera::Hdr, ecs::system::SystemParam, prelude::*, render::view::Msaa, window::WindowResolution,
};
use bevy_comics::{
    ComicsDiagnostics, ComicsPlugin, ToonScene, depth::VisibleDepthRange,
    diagnostics::StageOutcome, presets, style::Preset,
};
use bevy_comics_inspector::ComicsInspectorPlugin;
use bevy_comics_testkit::{
    orbit::{Orbit, OrbitPlugin},
    scenes::{BuiltIn, ScenePart, Stage, ToonPart, Vantage, figure::motion::MotionPlugin},
    studio::set_style,
};
use split::Split;

/// What is on show.
#[derive(Resource)]
struct Show {
    scene: BuiltIn,
    /// Index into the presets.
    style: usize,
    orthographic: bool,
    /// Whether the scene is drawn with the toon material.
    toon: bool,
    help: bool,
    vantage: Option<Vantage>,
}

/// The camera with the style.
#[derive(Component)]
struct Styled;

#[derive(Component)]
struct HelpText;

const HELP: &str = "\
1 2 3 4      scene
Left Right   style
L            light: standard / toon
O            perspective / orthographic
M            samples: 1 / 4
D            HDR on / off
C            compare with the original
[ ]          move the split
R            camera back to the start
F10          the panel
H            hide this";

fn main() {
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin {
        primary_window: Some(Window {
            title: "bevy_comics gallery".into(),
            resolution: WindowResolution::new(1280, 720),
            ..default()
        }),
        ..default()
    }))
    .add_plugins((ComicsPlugin, ComicsInspectorPlugin::default()))
    .add_plugins((OrbitPlugin, MotionPlugin, split::SplitPlugin))
    .insert_resource(Show {
        scene: BuiltIn::Village,
        style: index_of(presets::GRAPHIC_NOVEL),
        orthographic: false,
        toon: false,
        help: true,
        vantage: None,
    })
    .add_systems(Startup, (spawn_text, open_scene))
    .add_systems(Update, (choose, light_scene, describe).chain());
    app.run();
}

fn spawn_text(mut commands: Commands) {
    commands.spawn((
        HelpText,
        Text::default(),
        TextFont {
            font_size: FontSize::Px(15.0),
            ..default()
        },
        Node {
            position_type: PositionType::Absolute,
            top: Val::Px(10.0),
            left: Val::Px(10.0),
            padding: UiRect::all(Val::Px(10.0)),
            ..default()
        },
        BackgroundColor(Color::srgba(0.05, 0.05, 0.08, 0.72)),
    ));
}

/// Leaves the old scene and builds the chosen one.
fn open_scene(
    mut stage: Stage,
    mut show: ResMut<Show>,
    old: Query<Entity, Or<(With<ScenePart>, With<Styled>)>>,
) {
    for entity in &old {
        stage.commands.entity(entity).despawn();
    }
    let scene = show.scene;
    let vantage = stage.spawn(scene);
    let camera = stage
        .commands
        .spawn((
            Styled,
            vantage.camera(),
            Orbit::of(&vantage),
            Msaa::Sample4,
            VisibleDepthRange::default(),
        ))
        .id();
    show.orthographic = false;
    show.vantage = Some(vantage);
    show.toon = scene.is_toon();
    apply(&mut stage.commands, camera, show.style);
}

/// A part of the scene: whether it has the toon material, and how it looks with it.
type Part = (Entity, Has<ToonScene>, Option<&'static ToonPart>);

/// Draws the scene with the material that is chosen.
fn light_scene(
    mut commands: Commands,
    show: Res<Show>,
    parts: Query<Part, (With<ScenePart>, Without<ChildOf>)>,
) {
    for (part, is_toon, look) in &parts {
        if show.toon && !is_toon {
            let look = look.cloned().unwrap_or_default();
            commands.entity(part).insert(look.0);
        } else if !show.toon && is_toon {
            commands.entity(part).remove::<ToonScene>();
        }
    }
}

fn index_of(preset: Preset) -> usize {
    let presets = presets::ALL;
    presets.iter().position(|p| *p == preset).unwrap_or(0)
}

fn preset(index: usize) -> Preset {
    presets::ALL
        .get(index)
        .copied()
        .unwrap_or(presets::GRAPHIC_NOVEL)
}

fn apply(commands: &mut Commands, camera: Entity, index: usize) {
    set_style(&mut commands.entity(camera), &preset(index).style());
}

#[derive(SystemParam)]
struct StyledCamera<'w, 's> {
    cameras: Query<
        'w,
        's,
        (
            Entity,
            &'static mut Projection,
            &'static mut Orbit,
            &'static mut Msaa,
            Has<Hdr>,
        ),
        With<Styled>,
    >,
}

fn choose(
    keys: Res<ButtonInput<KeyCode>>,
    mut commands: Commands,
    mut show: ResMut<Show>,
    mut split: ResMut<Split>,
    mut camera: StyledCamera,
) {
    let digits = [
        KeyCode::Digit1,
        KeyCode::Digit2,
        KeyCode::Digit3,
        KeyCode::Digit4,
        KeyCode::Digit5,
        KeyCode::Digit6,
        KeyCode::Digit7,
    ];
    for (key, scene) in digits.into_iter().zip(BuiltIn::ALL) {
        if keys.just_pressed(key) {
            show.scene = scene;
            commands.run_system_cached(open_scene);
            return;
        }
    }
    let Ok((entity, mut projection, mut orbit, mut msaa, hdr)) = camera.cameras.single_mut() else {
        return;
    };
    let count = presets::ALL.len();
    if keys.just_pressed(KeyCode::ArrowRight) {
        show.style = (show.style + 1) % count;
        apply(&mut commands, entity, show.style);
    }
    if keys.just_pressed(KeyCode::ArrowLeft) {
        show.style = (show.style + count - 1) % count;
        apply(&mut commands, entity, show.style);
    }
    if keys.just_pressed(KeyCode::KeyL) {
        show.toon = !show.toon;
    }
    if keys.just_pressed(KeyCode::KeyM) {
        *msaa = if *msaa == Msaa::Off {
            Msaa::Sample4
        } else {
            Msaa::Off
        };
    }
    if keys.just_pressed(KeyCode::KeyD) {
        if hdr {
            commands.entity(entity).remove::<Hdr>();
        } else {
            commands.entity(entity).insert(Hdr);
        }
    }
    if keys.just_pressed(KeyCode::KeyO)
        && let Some(vantage) = &show.vantage
    {
        (*projection, *orbit) = if show.orthographic {
            (vantage.perspective(), Orbit::of(vantage))
        } else {
            (
                vantage.orthographic(vantage.ortho_height),
                Orbit::of(&vantage.orthographic_vantage()),
            )
        };
        show.orthographic = !show.orthographic;
    }
    if keys.just_pressed(KeyCode::KeyR)
        && let Some(vantage) = &show.vantage
    {
        *orbit = Orbit::of(&if show.orthographic {
            vantage.orthographic_vantage()
        } else {
            vantage.clone()
        });
    }
    if keys.just_pressed(KeyCode::KeyC) {
        split.on = !split.on;
    }
    for (key, step) in [(KeyCode::BracketLeft, -0.05), (KeyCode::BracketRight, 0.05)] {
        if keys.just_pressed(key) {
            split.at = (split.at + step).clamp(0.05, 0.95);
        }
    }
    if keys.just_pressed(KeyCode::KeyH) {
        show.help = !show.help;
    }
}

/// Help, and what the style does in this frame.
fn describe(
    show: Res<Show>,
    diagnostics: Res<ComicsDiagnostics>,
    camera: Query<(Entity, &VisibleDepthRange), With<Styled>>,
    mut text: Query<(&mut Text, &mut Visibility), With<HelpText>>,
) {
    let (Ok((mut text, mut visibility)), Ok((camera, range))) =
        (text.single_mut(), camera.single())
    else {
        return;
    };
    *visibility = if show.help {
        Visibility::Visible
    } else {
        Visibility::Hidden
    };
    let preset = preset(show.style);
    let title = preset.style().name;
    let mut lines = format!("{} in {title} ({preset})\n\n{HELP}\n\n", show.scene.name());
    if let Some((near, far)) = range.distances() {
        lines += &format!("visible from {near:.1} to {far:.1}\n");
    }
    let stages = diagnostics.cameras.get(&camera).map(|drawn| &drawn.stages);
    for (stage, outcome) in stages.into_iter().flatten() {
        lines += &match outcome {
            StageOutcome::Ran => format!("{}\n", stage.name()),
            StageOutcome::RanWith(method) => format!("{} ({method})\n", stage.name()),
            StageOutcome::Skipped(reason) => format!("no {}: {reason}\n", stage.name()),
            _ => String::new(),
        };
    }
    if **text != lines {
        **text = lines;
    }
}
