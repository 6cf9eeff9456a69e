//! Every scene in every preset.

use std::path::Path;

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::presets;
use image::{RgbaImage, imageops};

use crate::{
    common::{scenes::BuiltIn, studio::Studio},
    save,
};

const GAP: u32 = 6;

fn style(name: &str) -> Result<bevy_comics::ComicStyle, String> {
    presets::preset(name)
        .ok_or_else(|| format!("no preset {name}"))?
        .map_err(|error| format!("{name}: {error}"))
}

/// Rows of presets, the original first; columns of scenes.
pub fn contact_sheet(size: UVec2, out: &Path) -> Result<(), String> {
    let columns = BuiltIn::ALL.len() as u32;
    let rows = presets::NAMES.len() as u32 + 1;
    let paper = image::Rgba([250, 248, 242, 255]);
    let mut sheet = RgbaImage::from_pixel(
        columns * (size.x + GAP) + GAP,
        rows * (size.y + GAP) + GAP,
        paper,
    );
    for (column, scene) in BuiltIn::ALL.into_iter().enumerate() {
        println!("{}: building", scene.name());
        let mut studio = Studio::new(scene, size, Msaa::Sample4);
        for row in 0..rows {
            let name = row.checked_sub(1).map(|i| presets::NAMES[i as usize]);
            let picture = match name {
                Some(name) => studio.shoot(Some(&style(name)?)),
                None => studio.shoot(None),
            };
            let x = GAP + column as u32 * (size.x + GAP);
            let y = GAP + row * (size.y + GAP);
            imageops::replace(&mut sheet, &picture, i64::from(x), i64::from(y));
            println!("{}: {}", scene.name(), name.unwrap_or("original"));
        }
    }
    save(&sheet, out)?;
    println!("wrote {}", out.display());
    Ok(())
}

/// The reference pictures of the tests: every preset x scene at 320x180.
pub fn golden(folder: &Path) -> Result<(), String> {
    for scene in BuiltIn::ALL {
        let mut studio = Studio::new(scene, UVec2::new(320, 180), Msaa::Off);
        for name in presets::NAMES {
            let picture = studio.shoot(Some(&style(name)?));
            let path = folder.join(format!("{}-{name}.png", scene.name()));
            save(&picture, &path)?;
            println!("wrote {}", path.display());
        }
    }
    Ok(())
}
