//! The pictures of the pages about speed lines, impacts and paper.

use std::path::Path;

use bevy::prelude::*;
use bevy_comics::{
    ComicStyle, Impact, MotionLines, Outlines, Paper, SpeedLines, ToneBands, ToonLight,
    effects::SpeedLineKind, presets, toon::Ramp,
};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::{
    save,
    sheet::in_rows,
    toon::{Room, matt, per_light},
};

const SIZE: UVec2 = UVec2::new(480, 270);
const GAP: u32 = 6;

pub fn write(folder: &Path) -> Result<(), String> {
    save(&speed_lines(), &folder.join("speed-lines.png"))?;
    save(&motion_lines(), &folder.join("motion-lines.png"))?;
    save(&impact(), &folder.join("impact.png"))?;
    save(&paper(), &folder.join("paper.png"))
}

fn row(pictures: &[RgbaImage]) -> RgbaImage {
    in_rows(pictures, pictures.len(), SIZE, GAP)
}

fn comic() -> ComicStyle {
    ComicStyle::new()
        .with(Outlines {
            width: 1.5,
            ..default()
        })
        .with(ToneBands {
            levels: 4,
            ..default()
        })
}

fn shoot(scene: BuiltIn, styles: &[ComicStyle]) -> Vec<RgbaImage> {
    let mut studio = Studio::new(scene, SIZE, Msaa::Sample4);
    let shots = styles.iter().map(|style| studio.shoot(Some(style)));
    shots.collect()
}

fn speed_lines() -> RgbaImage {
    let radial = SpeedLines {
        width: 8.0,
        rate: 0.0,
        ..default()
    };
    let parallel = SpeedLines {
        kind: SpeedLineKind::Parallel,
        angle: 8.0,
        width: 5.0,
        ..radial
    };
    let left = shoot(BuiltIn::Theatre, &[comic().with(radial)]);
    let right = shoot(BuiltIn::Village, &[comic().with(parallel)]);
    row(&[left, right].concat())
}

/// A ball that bounces, a dart, and a rotor.
fn motion_lines() -> RgbaImage {
    let eye = Transform::from_xyz(0.0, 1.6, 9.0).looking_at(Vec3::new(0.0, 1.2, 0.0), Vec3::Y);
    let mut room = Room::new(UVec2::new(800, 300), eye, 0.34);
    room.ground();
    let light = ToonLight {
        ramp: Some(per_light(Ramp::default().stops)),
        ..default()
    };
    let mut put = |mesh: Mesh, color: Color, lines: MotionLines| {
        let thing = room.put(mesh, matt(color), &light, Transform::IDENTITY);
        room.headless
            .app
            .world_mut()
            .entity_mut(thing)
            .insert(lines);
        thing
    };
    let lines = |points: u32, duration: f32| MotionLines {
        points,
        duration,
        ..default()
    };
    let ball = put(
        Sphere::new(0.36).mesh().uv(48, 24),
        Color::srgb(0.82, 0.3, 0.24),
        lines(26, 0.4),
    );
    let parcel = put(
        Cuboid::new(0.62, 0.62, 0.62).into(),
        Color::srgb(0.3, 0.48, 0.72),
        lines(40, 0.22),
    );
    let rotor = put(
        Cuboid::new(1.7, 0.2, 0.16).into(),
        Color::srgb(0.3, 0.58, 0.42),
        lines(40, 0.12),
    );
    for frame in 0..48u8 {
        // Seconds before the picture.
        let t = (f32::from(frame) - 47.0) / 60.0;
        let bounce = (0.36 + 1.9 * (3.2 * (t + 0.38)).sin().abs()).max(0.36);
        let turn = Quat::from_rotation_z(-2.2 * t) * Quat::from_rotation_y(0.6);
        let poses = [
            (ball, Transform::from_xyz(-1.5 + 3.4 * t, bounce, 0.0)),
            (
                parcel,
                Transform::from_xyz(0.75 + 6.5 * t, 1.25 + 1.5 * t - 2.0 * t * t, 0.0)
                    .with_rotation(turn),
            ),
            (
                rotor,
                Transform::from_xyz(2.75, 1.45, 0.0)
                    .with_rotation(Quat::from_rotation_z(11.0 * t + 0.5)),
            ),
        ];
        for (thing, pose) in poses {
            room.headless.app.world_mut().entity_mut(thing).insert(pose);
        }
        room.headless.step(1);
    }
    room.headless.picture()
}

/// The first frame of each drawing.
fn impact() -> RgbaImage {
    let mut studio = Studio::new(BuiltIn::Theatre, SIZE, Msaa::Sample4);
    studio.shoot(Some(&presets::SATURDAY_MORNING.style()));
    let lines = SpeedLines {
        width: 8.0,
        ..default()
    };
    studio.headless.app.world_mut().trigger(Impact {
        drawings: 3,
        alternate: true,
        lines: Some(lines),
        ..Impact::new(studio.camera)
    });
    let mut drawings = Vec::new();
    for _ in 0..3 {
        studio.headless.step(1);
        drawings.push(studio.headless.picture());
        // A twelfth of a second is two and a half of the studio's frames.
        studio.headless.step(2);
    }
    row(&drawings)
}

fn paper() -> RgbaImage {
    let coarse = Paper {
        grain: 0.6,
        shading: 0.15,
        size: 1.6,
        ..default()
    };
    let styles = [comic().with(Paper::default()), comic().with(coarse)];
    row(&shoot(BuiltIn::Village, &styles))
}
