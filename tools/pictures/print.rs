//! The pictures of the pages about print, paint and focus: pixel for pixel, since smaller dots are
//! other dots.

use std::path::Path;

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{ComicStyle, Outlines, effects::FocusStyle, presets, style::Preset};
use bevy_comics_testkit::{
    scenes::BuiltIn,
    studio::{Studio, village_focus},
};
use image::{RgbaImage, imageops};

use crate::{save, sheet::in_rows};

const SIZE: UVec2 = UVec2::new(960, 540);
const GAP: u32 = 6;

pub fn write(folder: &Path) -> Result<(), String> {
    let printed = [
        (presets::MANGA_PAGE, BuiltIn::Theatre, [270, 140]),
        (presets::NEWSPRINT, BuiltIn::Village, [200, 150]),
        (presets::SILVER_AGE, BuiltIn::Theatre, [270, 140]),
        (presets::RISOGRAPH, BuiltIn::Village, [520, 150]),
        (presets::POP_POSTER, BuiltIn::Theatre, [270, 140]),
        (presets::POP_POSTER, BuiltIn::Village, [520, 150]),
    ];
    save(
        &parts(&printed, UVec2::new(272, 190), 3),
        &folder.join("print.png"),
    )?;
    let painted = [
        (presets::GOUACHE, BuiltIn::Mountains, [240, 150]),
        (presets::WATERCOLOR, BuiltIn::Village, [40, 150]),
    ];
    save(
        &parts(&painted, UVec2::new(480, 270), 2),
        &folder.join("paint.png"),
    )?;
    save(&focus(), &folder.join("focus.png"))
}

/// Parts of scenes in presets, with the corner of each. `columns`: how many are in a row.
fn parts(shown: &[(Preset, BuiltIn, [u32; 2])], size: UVec2, columns: usize) -> RgbaImage {
    let part = |(preset, scene, [x, y]): &(Preset, BuiltIn, [u32; 2])| {
        let mut studio = Studio::new(*scene, SIZE, Msaa::Sample4);
        let picture = studio.shoot(Some(&preset.style()));
        println!("{}: {preset}", scene.name());
        imageops::crop_imm(&picture, *x, *y, size.x, size.y).to_image()
    };
    let pictures: Vec<RgbaImage> = shown.iter().map(part).collect();
    in_rows(&pictures, columns, size, GAP)
}

/// Without a focus, then in its five styles.
fn focus() -> RgbaImage {
    let size = UVec2::new(400, 225);
    let mut studio = Studio::new(BuiltIn::Village, size, Msaa::Sample4);
    let all = [
        FocusStyle::Blur,
        FocusStyle::Offset,
        FocusStyle::Paint,
        FocusStyle::Dots,
        FocusStyle::Lines,
    ];
    let without = ComicStyle::new().with(Outlines::default());
    let styles = std::iter::once(without).chain(all.map(village_focus));
    let pictures: Vec<RgbaImage> = styles.map(|style| studio.shoot(Some(&style))).collect();
    in_rows(&pictures, 2, size, GAP)
}
