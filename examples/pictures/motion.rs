//! The pictures of the pages about speed lines, impacts and paper.

use std::path::Path;

use bevy::{math::UVec2, render::view::Msaa, utils::default};
use bevy_comics::{
    ComicStyle, Impact, Outlines, Paper, SpeedLineKind, SpeedLines, ToneBands, presets,
};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::{save, sheet::grid};

const SIZE: UVec2 = UVec2::new(480, 270);
const GAP: u32 = 6;

pub fn write(folder: &Path) -> Result<(), String> {
    save(&speed_lines(), &folder.join("speed-lines.png"))?;
    save(&impact(), &folder.join("impact.png"))?;
    save(&paper(), &folder.join("paper.png"))
}

fn row(pictures: &[RgbaImage]) -> RgbaImage {
    grid(&[pictures.iter().collect()], SIZE, GAP)
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
