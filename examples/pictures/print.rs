//! The pictures of the pages about print, paint and focus: pixel for pixel, since smaller dots are
//! other dots.

use std::path::Path;

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{ComicStyle, FocusStyle, Outlines, Preset, presets};
use bevy_comics_testkit::{
    scenes::BuiltIn,
    studio::{Studio, village_focus},
};
use image::{RgbaImage, imageops};

use crate::{save, sheet::grid};

/// What is rendered, and the part of it that is shown.
const SIZE: UVec2 = UVec2::new(960, 540);
const PART: UVec2 = UVec2::new(480, 270);
const GAP: u32 = 6;

pub fn write(folder: &Path) -> Result<(), String> {
    let printed = [
        (presets::MANGA_PAGE, BuiltIn::Theatre, [250, 140]),
        (presets::NEWSPRINT, BuiltIn::Village, [40, 150]),
        (presets::SILVER_AGE, BuiltIn::Theatre, [250, 140]),
        (presets::RISOGRAPH, BuiltIn::Village, [470, 150]),
        (presets::POP_POSTER, BuiltIn::Theatre, [250, 140]),
        (presets::POP_POSTER, BuiltIn::Village, [470, 150]),
    ];
    save(&parts(&printed), &folder.join("print.png"))?;
    let painted = [
        (presets::GOUACHE, BuiltIn::Mountains, [240, 150]),
        (presets::WATERCOLOR, BuiltIn::Village, [40, 150]),
    ];
    save(&parts(&painted), &folder.join("paint.png"))?;
    save(&focus(), &folder.join("focus.png"))
}

/// Parts of scenes in presets, two in a row. The third number pair: the corner of the part.
fn parts(shown: &[(Preset, BuiltIn, [u32; 2])]) -> RgbaImage {
    let part = |(preset, scene, [x, y]): &(Preset, BuiltIn, [u32; 2])| {
        let mut studio = Studio::new(*scene, SIZE, Msaa::Sample4);
        let picture = studio.shoot(Some(&preset.style()));
        println!("{}: {preset}", scene.name());
        imageops::crop_imm(&picture, *x, *y, PART.x, PART.y).to_image()
    };
    let pictures: Vec<RgbaImage> = shown.iter().map(part).collect();
    let rows: Vec<Vec<&RgbaImage>> = pictures.chunks(2).map(|row| row.iter().collect()).collect();
    grid(&rows, PART, GAP)
}

/// Without a focus, then in its five styles.
fn focus() -> RgbaImage {
    let mut studio = Studio::new(BuiltIn::Village, PART, Msaa::Sample4);
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
    let rows: Vec<Vec<&RgbaImage>> = pictures.chunks(3).map(|row| row.iter().collect()).collect();
    grid(&rows, PART, GAP)
}
