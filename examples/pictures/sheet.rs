//! Every scene in every preset.

use std::path::Path;

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{Preset, presets};
use image::{RgbaImage, imageops};

use bevy_comics_testkit::{
    scenes::BuiltIn,
    studio::{Studio, golden_presets},
};

use crate::save;

const GAP: u32 = 6;

fn style(name: &str) -> Result<bevy_comics::ComicStyle, String> {
    presets::find(name)
        .map(Preset::style)
        .ok_or_else(|| format!("no preset {name}"))
}

/// A preset, or the original.
type Look = Option<&'static str>;

/// One picture for every scene and look, scene by scene.
fn shoot_all(size: UVec2, looks: &[Look]) -> Result<Vec<Vec<RgbaImage>>, String> {
    let mut pictures = Vec::new();
    for scene in BuiltIn::ALL {
        println!("{}: building", scene.name());
        let mut studio = Studio::new(scene, size, Msaa::Sample4);
        let mut row = Vec::new();
        for look in looks {
            row.push(match look {
                Some(name) => studio.shoot(Some(&style(name)?)),
                None => studio.shoot(None),
            });
            println!("{}: {}", scene.name(), look.unwrap_or("original"));
        }
        pictures.push(row);
    }
    Ok(pictures)
}

/// Rows of presets, the original first; columns of scenes.
pub fn contact_sheet(size: UVec2, out: &Path) -> Result<(), String> {
    let looks: Vec<Look> = std::iter::once(None)
        .chain(presets::ALL.iter().map(|preset| Some(preset.name())))
        .collect();
    let columns = shoot_all(size, &looks)?;
    let rows: Vec<Vec<&RgbaImage>> = (0..looks.len())
        .map(|row| columns.iter().map(|column| &column[row]).collect())
        .collect();
    save(&grid(&rows, size, GAP), out)?;
    println!("wrote {}", out.display());
    Ok(())
}

/// The picture at the top of the README: rows of scenes, columns of a few looks.
pub fn banner(out: &Path) -> Result<(), String> {
    let size = UVec2::new(272, 153);
    let looks = [
        None,
        Some("crimson-dusk"),
        Some("ligne-claire"),
        Some("noir"),
    ];
    let rows = shoot_all(size, &looks)?;
    let rows: Vec<Vec<&RgbaImage>> = rows.iter().map(|row| row.iter().collect()).collect();
    save(&grid(&rows, size, GAP), out)?;
    println!("wrote {}", out.display());
    Ok(())
}

/// Pictures side by side and one below the other, on paper.
pub fn grid(rows: &[Vec<&RgbaImage>], size: UVec2, gap: u32) -> RgbaImage {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let cell = size + UVec2::splat(gap);
    let whole = cell * UVec2::new(columns, rows.len() as u32) + UVec2::splat(gap);
    let mut sheet = RgbaImage::from_pixel(whole.x, whole.y, image::Rgba([250, 248, 242, 255]));
    for (y, row) in rows.iter().enumerate() {
        for (x, picture) in row.iter().enumerate() {
            let at = UVec2::splat(gap) + cell * UVec2::new(x as u32, y as u32);
            imageops::replace(&mut sheet, *picture, i64::from(at.x), i64::from(at.y));
        }
    }
    sheet
}

/// The reference pictures of the tests, 320x180.
pub fn golden(folder: &Path) -> Result<(), String> {
    for scene in BuiltIn::ALL {
        let mut studio = Studio::new(scene, UVec2::new(320, 180), Msaa::Off);
        for name in golden_presets(scene) {
            let picture = studio.shoot(Some(&style(name)?));
            let path = folder.join(format!("{}-{name}.png", scene.name()));
            save(&picture, &path)?;
            println!("wrote {}", path.display());
        }
    }
    Ok(())
}
