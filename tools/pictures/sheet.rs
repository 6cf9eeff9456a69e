//! Sheets of many pictures: each style in its own scene, every scene in every preset.

use std::{path::Path, time::Instant};

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{presets, style::Preset};
use image::{RgbaImage, imageops};

use bevy_comics_testkit::{
    scenes::BuiltIn,
    studio::{Studio, golden_styles, hatched_theatre},
};

use crate::{gallery::scene_of, save};

const GAP: u32 = 6;
/// The color of gutters.
const PAPER: image::Rgba<u8> = image::Rgba([250, 248, 242, 255]);

fn style(name: &str) -> Result<bevy_comics::ComicStyle, String> {
    presets::find(name)
        .map(Preset::style)
        .ok_or_else(|| format!("no preset {name}"))
}

/// A preset, or the original.
type Look = Option<&'static str>;

/// One picture of a scene for every look.
fn shoot(scene: BuiltIn, size: UVec2, looks: &[Look]) -> Result<Vec<RgbaImage>, String> {
    println!("{}: building", scene.name());
    let mut studio = Studio::new(scene, size, Msaa::Sample4);
    let mut pictures = Vec::new();
    for look in looks {
        pictures.push(match look {
            Some(name) => studio.shoot(Some(&style(name)?)),
            None => studio.shoot(None),
        });
        println!("{}: {}", scene.name(), look.unwrap_or("original"));
    }
    Ok(pictures)
}

/// The middle of a picture, enlarged to its size: every pixel is a square.
pub fn enlarged(picture: &RgbaImage, zoom: u32) -> RgbaImage {
    let (width, height) = picture.dimensions();
    let (x, y) = ((width - width / zoom) / 2, (height - height / zoom) / 2);
    let middle = imageops::crop_imm(picture, x, y, width / zoom, height / zoom).to_image();
    imageops::resize(&middle, width, height, imageops::FilterType::Nearest)
}

/// Pictures in a row of the sheet of styles.
const COLUMNS: usize = 6;

/// Every style of the gallery in the scene that shows it best, in the gallery's order. Says after
/// each picture how long the others will take.
pub fn styles(size: UVec2, out: &Path) -> Result<(), String> {
    let started = Instant::now();
    let count = presets::STYLES.len();
    let mut pictures = vec![RgbaImage::default(); count];
    let mut drawn = 0;
    for scene in BuiltIn::ALL {
        let shown: Vec<usize> = (0..count)
            .filter(|k| scene_of(presets::STYLES[*k]) == scene)
            .collect();
        if shown.is_empty() {
            continue;
        }
        let mut studio = Studio::new(scene, size, Msaa::Sample4);
        for k in shown {
            let preset = presets::STYLES[k];
            pictures[k] = studio.shoot(Some(&preset.style()));
            drawn += 1;
            let left = started.elapsed().as_secs_f64() / drawn as f64 * (count - drawn) as f64;
            println!("{drawn:2} of {count}, about {left:.0} s left: {preset}");
        }
    }
    save(&in_rows(&pictures, COLUMNS, size, GAP), out)
}

/// Rows of presets, the original first; columns of scenes. `zoom` enlarges the middle of each.
pub fn contact_sheet(size: UVec2, zoom: u32, out: &Path) -> Result<(), String> {
    let looks: Vec<Look> = std::iter::once(None)
        .chain(presets::ALL.iter().map(|preset| Some(preset.name())))
        .collect();
    let columns: Vec<Vec<RgbaImage>> = BuiltIn::ALL
        .into_iter()
        .map(|scene| {
            let pictures = shoot(scene, size, &looks)?;
            Ok(pictures
                .iter()
                .map(|picture| enlarged(picture, zoom))
                .collect())
        })
        .collect::<Result<_, String>>()?;
    let rows: Vec<Vec<&RgbaImage>> = (0..looks.len())
        .map(|row| columns.iter().map(|column| &column[row]).collect())
        .collect();
    save(&grid(&rows, size, GAP), out)
}

/// The styles of the banner, from left to right; `None` is the original.
const BANNER: [Look; 5] = [
    None,
    Some("saturday-morning"),
    Some("graphic-novel"),
    Some("watercolor"),
    Some("noir"),
];

/// The picture at the top of the README: one scene in several styles, in slanted panels.
pub fn banner(out: &Path) -> Result<(), String> {
    /// Half the width of the gutter between two panels, pixels.
    const GUTTER: f32 = 3.0;
    /// How far the gutters lean: pixels to the left for each pixel down.
    const LEAN: f32 = 0.22;
    let size = UVec2::new(1200, 480);
    let pictures = shoot(BuiltIn::Village, size, &BANNER)?;
    let panel = size.x as f32 / pictures.len() as f32;
    let picture = RgbaImage::from_fn(size.x, size.y, |x, y| {
        let across = x as f32 + 0.5 + LEAN * (y as f32 - 0.5 * size.y as f32);
        let nearest = (across / panel)
            .round()
            .clamp(1.0, pictures.len() as f32 - 1.0);
        let index = (across / panel).clamp(0.0, pictures.len() as f32 - 1.0) as usize;
        let coverage = (GUTTER + 0.5 - (across - nearest * panel).abs()).clamp(0.0, 1.0);
        let mut pixel = *pictures[index].get_pixel(x, y);
        for (channel, paper) in pixel.0.iter_mut().zip(PAPER.0) {
            *channel = (f32::from(*channel) * (1.0 - coverage) + f32::from(paper) * coverage) as u8;
        }
        pixel
    });
    save(&picture, out)
}

/// Size of a small picture in a grid.
const SMALL: UVec2 = UVec2::new(288, 162);

/// As [`shoot`], small: drawn at twice the size and reduced, since lines are as wide in a small
/// picture as in a large one.
fn shoot_small(scene: BuiltIn, looks: &[Look]) -> Result<Vec<RgbaImage>, String> {
    let pictures = shoot(scene, 2 * SMALL, looks)?;
    let reduced = |picture: &RgbaImage| {
        imageops::resize(picture, SMALL.x, SMALL.y, imageops::FilterType::Triangle)
    };
    Ok(pictures.iter().map(reduced).collect())
}

/// A row of styles, for the page of the examples.
pub fn style_row(out: &Path) -> Result<(), String> {
    let looks = [
        "saturday-morning",
        "graphic-novel",
        "pencil-sketch",
        "watercolor",
    ]
    .map(Some);
    let pictures = shoot_small(BuiltIn::Theatre, &looks)?;
    save(&in_rows(&pictures, 4, SMALL, GAP), out)
}

/// The page of the presets: one scene in twelve of them.
pub fn presets(out: &Path) -> Result<(), String> {
    let names = [
        "saturday-morning",
        "graphic-novel",
        "twilight-toon",
        "clear-bands",
        "watercolor",
        "pencil-sketch",
        "silent-film",
        "ligne-claire",
        "noir",
        "golden-hour",
        "cobalt-night",
        "blueprint",
    ];
    let pictures = shoot_small(BuiltIn::Village, &names.map(Some))?;
    save(&in_rows(&pictures, 3, SMALL, GAP), out)
}

/// Pictures in rows of so many columns, on paper.
pub fn in_rows(pictures: &[RgbaImage], columns: usize, size: UVec2, gap: u32) -> RgbaImage {
    let rows = pictures.chunks(columns);
    let rows: Vec<Vec<&RgbaImage>> = rows.map(|row| row.iter().collect()).collect();
    grid(&rows, size, gap)
}

/// Pictures side by side and one below the other, on paper.
pub fn grid(rows: &[Vec<&RgbaImage>], size: UVec2, gap: u32) -> RgbaImage {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let cell = size + UVec2::splat(gap);
    let whole = cell * UVec2::new(columns, rows.len() as u32) + UVec2::splat(gap);
    let mut sheet = RgbaImage::from_pixel(whole.x, whole.y, PAPER);
    for (y, row) in rows.iter().enumerate() {
        for (x, picture) in row.iter().enumerate() {
            let at = UVec2::splat(gap) + cell * UVec2::new(x as u32, y as u32);
            imageops::replace(&mut sheet, *picture, i64::from(at.x), i64::from(at.y));
        }
    }
    sheet
}

/// The reference pictures of the tests, 320x180. `only`: names of styles with commas between them;
/// empty: all.
pub fn golden(folder: &Path, only: &str) -> Result<(), String> {
    let wanted = |name: &str| only.is_empty() || only.split(',').any(|one| one == name);
    for scene in BuiltIn::ALL {
        let mut studio = Studio::new(scene, UVec2::new(320, 180), Msaa::Off);
        for (name, style) in golden_styles(scene) {
            if !wanted(name) {
                continue;
            }
            let picture = studio.shoot_golden(name, &style);
            let path = folder.join(format!("{}-{name}.png", scene.name()));
            save(&picture, &path)?;
        }
    }
    if wanted("hatched-material") {
        let path = folder.join("theatre-hatched-material.png");
        save(&hatched_theatre(), &path)?;
    }
    Ok(())
}
