//! Style by volume: a camera walks down the village street into a box where the style is another
//! one, and out again.

use std::process::ExitCode;

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::{
    BlackFlats, ComicStyle, Outlines, ToonScene, Vignette, presets,
    style::{InStyleVolumes, StyleVolume},
};
use bevy_comics_testkit::{
    demo::{Demo, Screen},
    headless::Headless,
    scenes::{BuiltIn, ScenePart, Stage},
    studio::set_style,
};
use image::RgbaImage;

/// Where the walk is, 0 to 1.
#[derive(Resource, Default)]
struct Walk(f32);

/// Seconds from one end to the other.
const WALK: f32 = 12.0;

fn walk(
    time: Res<Time>,
    screen: Res<Screen>,
    mut walk: ResMut<Walk>,
    mut camera: Single<&mut Transform, With<InStyleVolumes>>,
) {
    if screen.out.is_none() {
        let turn = (time.elapsed_secs() / WALK) % 2.0;
        walk.0 = 1.0 - (turn - 1.0).abs();
    }
    let z = 30.0 - 44.0 * walk.0;
    let eye = Vec3::new(0.6, 2.4, z);
    **camera =
        Transform::from_translation(eye).looking_at(eye + Vec3::new(-0.25, 0.25, -8.0), Vec3::Y);
}

/// Noir for a place in the sun: more ink than the preset has.
fn night(lines: Outlines) -> ComicStyle {
    let flats = BlackFlats {
        value: Some(0.78),
        softness: 0.05,
        ..default()
    };
    let corners = Vignette {
        amount: 0.9,
        ..default()
    };
    let noir = presets::NOIR.style().with(lines);
    noir.with(flats).with(corners)
}

fn spawn(mut stage: Stage, screen: Res<Screen>, mut styles: ResMut<Assets<ComicStyle>>) {
    let vantage = stage.spawn(BuiltIn::Village);
    let day = presets::SATURDAY_MORNING.style();
    let lines = day.get::<Outlines>().copied().unwrap_or_default();
    let mut camera = stage.commands.spawn((
        vantage.camera(),
        screen.target.clone(),
        Msaa::Sample4,
        InStyleVolumes,
    ));
    set_style(&mut camera, &day);
    stage.commands.spawn((
        Transform::from_xyz(0.0, 3.0, -14.0).with_scale(Vec3::new(24.0, 12.0, 24.0)),
        StyleVolume {
            style: styles.add(night(lines)),
            margin: 22.0,
            ..default()
        },
    ));
}

fn flatten(mut commands: Commands, parts: Query<Entity, (With<ScenePart>, Without<ChildOf>)>) {
    for part in &parts {
        commands.entity(part).insert(ToonScene::default());
    }
}

/// Four steps of the walk, from left to right.
fn steps(headless: &mut Headless) -> RgbaImage {
    let size = headless.options.size;
    let gap = 6;
    let mut strip = RgbaImage::from_pixel(
        4 * size.x + 3 * gap,
        size.y,
        image::Rgba([255, 255, 255, 255]),
    );
    for (column, at) in [0.0, 0.32, 0.62, 0.8].into_iter().enumerate() {
        headless.app.insert_resource(Walk(at));
        headless.step(4);
        let x = column as i64 * i64::from(size.x + gap);
        image::imageops::replace(&mut strip, &headless.picture(), x, 0);
    }
    strip
}

fn main() -> ExitCode {
    let demo = Demo {
        title: "Style by volume",
        keys: "The camera walks by itself. The picture shows four steps.",
        size: UVec2::new(320, 360),
        frames: 2,
    };
    let add = |app: &mut App| {
        app.init_resource::<Walk>()
            .add_systems(Startup, (spawn, flatten).chain())
            .add_systems(Update, walk);
    };
    demo.run_with(add, steps)
}
