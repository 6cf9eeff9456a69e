//! The gallery of looks: a picture and a page, with how far looks are from each other.

use std::{fmt::Write, fs, path::Path};

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{Preset, presets};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::save;

/// Scenes that looks are compared on.
const COMPARED: [BuiltIn; 3] = [BuiltIn::Village, BuiltIn::Figure, BuiltIn::Street];

/// The scene that shows a look best; else the village.
const SHOWN: [(Preset, BuiltIn); 22] = [
    (presets::SATURDAY_MORNING, BuiltIn::Figure),
    (presets::LIGNE_CLAIRE, BuiltIn::Figure),
    (presets::CLEAR_BANDS, BuiltIn::Figure),
    (presets::FIELD_GUIDE, BuiltIn::Figure),
    (presets::STAINED_GLASS, BuiltIn::Figure),
    (presets::UKIYO_E, BuiltIn::Mountains),
    (presets::MANGA_PAGE, BuiltIn::Theatre),
    (presets::SILVER_AGE, BuiltIn::Theatre),
    (presets::POP_POSTER, BuiltIn::Theatre),
    (presets::RED_POSTER, BuiltIn::Figure),
    (presets::ENGRAVING, BuiltIn::Theatre),
    (presets::HARD_BOILED, BuiltIn::Street),
    (presets::PENCIL_SKETCH, BuiltIn::Theatre),
    (presets::PENCIL_STUDY, BuiltIn::Figure),
    (presets::BALLPOINT, BuiltIn::Figure),
    (presets::RED_CHALK, BuiltIn::Figure),
    (presets::SUMI_E, BuiltIn::Figure),
    (presets::WATERCOLOR, BuiltIn::Mountains),
    (presets::TWILIGHT_TOON, BuiltIn::Mountains),
    (presets::NEON_NIGHT, BuiltIn::Street),
    (presets::NOIR, BuiltIn::Street),
    (presets::SILENT_FILM, BuiltIn::Theatre),
];

fn scene_of(look: Preset) -> BuiltIn {
    let own = SHOWN.into_iter().find(|(preset, _)| *preset == look);
    own.map_or(BuiltIn::Village, |(_, scene)| scene)
}

/// Perceptual difference of two pictures (FLIP: Andersson et al. 2020), 0 to 1.
fn flip(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let rgb = |picture: &RgbaImage| {
        let bytes: Vec<u8> = picture.pixels().flat_map(|p| [p[0], p[1], p[2]]).collect();
        nv_flip::FlipImageRgb8::with_data(picture.width(), picture.height(), &bytes)
    };
    let map = nv_flip::flip(rgb(a), rgb(b), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    f64::from(nv_flip::FlipPool::from_image(&map).mean())
}

/// The part of pixels of which every channel satisfies something.
fn part(pictures: &[RgbaImage], is: impl Fn(u8) -> bool) -> f64 {
    let (mut count, mut all) = (0usize, 0usize);
    for pixel in pictures.iter().flat_map(RgbaImage::pixels) {
        count += usize::from(pixel.0[..3].iter().all(|c| is(*c)));
        all += 1;
    }
    count as f64 / all as f64
}

/// What is measured of a look, over the compared scenes.
struct Measured {
    /// The look that is nearest, and the mean FLIP between them.
    nearest: (Preset, f64),
    /// Parts of the pictures: darker than 64 of 255, and white.
    ink: f64,
    white: f64,
}

fn measure() -> Vec<Measured> {
    let mut shots: Vec<Vec<RgbaImage>> = vec![Vec::new(); presets::LOOKS.len()];
    for scene in COMPARED {
        let mut studio = Studio::new(scene, UVec2::new(240, 135), Msaa::Sample4);
        for (look, shots) in presets::LOOKS.iter().zip(&mut shots) {
            shots.push(studio.shoot(Some(&look.style())));
        }
        println!("{}: compared", scene.name());
    }
    let mut apart = vec![vec![f64::INFINITY; shots.len()]; shots.len()];
    for a in 0..shots.len() {
        for b in 0..a {
            let sum: f64 = shots[a]
                .iter()
                .zip(&shots[b])
                .map(|(a, b)| flip(a, b))
                .sum();
            apart[a][b] = sum / COMPARED.len() as f64;
            apart[b][a] = apart[a][b];
        }
    }
    let of = |(k, shots): (usize, &Vec<RgbaImage>)| {
        let distances = apart[k].iter().copied().enumerate();
        let (other, distance) = distances
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .expect("several looks");
        Measured {
            nearest: (presets::LOOKS[other], distance),
            ink: part(shots, |c| c < 64),
            white: part(shots, |c| c == 255),
        }
    };
    shots.iter().enumerate().map(of).collect()
}

/// The first line of a style file: what the look is, and what it was made for.
fn intent(look: Preset) -> &'static str {
    let first = look.source().lines().next().unwrap_or_default();
    first.trim_start_matches("// ")
}

fn page(measured: &[Measured]) -> String {
    let least = measured.iter().map(|m| m.nearest.1).fold(1.0, f64::min);
    let mut text = format!(
        "# Looks\n\n\
         {} presets, one picture each. Made by `cargo run --example pictures -- gallery`, which writes this\n\
         page, too. How to use one: [styles and presets](../styles-and-presets.md).\n\n\
         Looks are compared on the village, the figure and the street: the distance of two is the mean of\n\
         FLIP (0: the same picture, 1: black and white). No two are closer than {least:.3}. *Ink* is the part of\n\
         these pictures that is darker than a quarter of the display's range, *white* the part that is white.\n",
        measured.len()
    );
    for (look, m) in presets::LOOKS.iter().zip(measured) {
        let title = look.style().name;
        write!(
            text,
            "\n## {title}\n\n![{title}]({look}.png)\n\n\
             `{look}` ([file](../../assets/styles/{look}.comic.ron)): {}\n\n\
             *The {}. Nearest look: `{}`, {:.3}. Ink {:.0} %, white {:.0} %.*\n",
            intent(*look),
            scene_of(*look).name(),
            m.nearest.0,
            m.nearest.1,
            100.0 * m.ink,
            100.0 * m.white,
        )
        .expect("memory");
    }
    text
}

pub fn write(folder: &Path) -> Result<(), String> {
    let measured = measure();
    for scene in BuiltIn::ALL {
        let looks: Vec<Preset> = (presets::LOOKS.iter().copied())
            .filter(|look| scene_of(*look) == scene)
            .collect();
        if looks.is_empty() {
            continue;
        }
        let mut studio = Studio::new(scene, UVec2::new(560, 315), Msaa::Sample4);
        for look in looks {
            let picture = studio.shoot(Some(&look.style()));
            save(&picture, &folder.join(format!("{look}.png")))?;
        }
    }
    fs::write(folder.join("README.md"), page(&measured))
        .map_err(|error| format!("cannot write the page: {error}"))
}
