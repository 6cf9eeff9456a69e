//! Two loops: strokes on a figure that turns, and lines while the camera goes to and fro.

use std::{
    f32::consts::TAU,
    fs::{self, File},
    io::BufWriter,
    path::Path,
};

use bevy::prelude::*;
use bevy_comics::{Paint, objects::PatternAnchor, presets};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::palette::Palette;

const SIZE: UVec2 = UVec2::new(384, 216);
const FRAMES: u16 = 36;
/// Frames per second.
const RATE: u16 = 15;

/// What the page of looks says about them.
pub const SECTION: &str = "\n## In motion\n\n\
    ![A figure turns, and broad cuts turn with it](strokes-in-motion.png)\n\n\
    *`woodcut` with a smaller brush. The figure has a `PatternAnchor`: strokes stay where they are on what moves.*\n\n\
    ![The camera goes to and fro in the village](lines-in-motion.png)\n\n\
    *`ligne-claire`: lines neither break nor jump. Made by `cargo run --example pictures -- loops`.*\n";

pub fn write(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder)
        .map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
    save(&strokes(), 24, &folder.join("strokes-in-motion.png"))?;
    save(&lines(), 56, &folder.join("lines-in-motion.png"))
}

/// From -1 to 1 and back, once over all frames.
fn swing(frame: u16) -> f32 {
    (TAU * f32::from(frame) / f32::from(FRAMES)).sin()
}

fn strokes() -> Vec<RgbaImage> {
    let mut studio = Studio::new(BuiltIn::Figure, SIZE, Msaa::Sample4);
    let world = studio.headless.app.world_mut();
    let mut named = world.query::<(Entity, &Name)>();
    let figure = named
        .iter(world)
        .find(|(_, name)| name.as_str() == "figure");
    let figure = figure.map(|(entity, _)| entity).expect("the figure");
    let screen = PatternAnchor {
        inherit: true,
        ..default()
    };
    world.entity_mut(figure).insert(screen);
    let rest = *world.get::<Transform>(figure).expect("a place");
    let mut style = presets::WOODCUT.style();
    // The brush of a small picture is small: eyes stay.
    if let Some(paint) = style.get_mut::<Paint>() {
        paint.at_near = 2.0;
    }
    studio.shoot(Some(&style));
    let frames = (0..FRAMES).map(|frame| {
        let turn = Quat::from_rotation_y(0.5 * swing(frame));
        let turned = Transform {
            rotation: turn * rest.rotation,
            ..rest
        };
        let world = studio.headless.app.world_mut();
        world.entity_mut(figure).insert(turned);
        studio.headless.step(1);
        studio.headless.picture()
    });
    frames.collect()
}

fn lines() -> Vec<RgbaImage> {
    let mut studio = Studio::new(BuiltIn::Village, SIZE, Msaa::Sample4);
    studio.shoot(Some(&presets::LIGNE_CLAIRE.style()));
    let (eye, target) = (studio.vantage.eye, studio.vantage.target);
    let frames = (0..FRAMES).map(|frame| {
        let turn = Quat::from_rotation_y(0.06 * swing(frame));
        let at = Transform::from_translation(target + turn * (eye - target));
        let world = studio.headless.app.world_mut();
        world
            .entity_mut(studio.camera)
            .insert(at.looking_at(target, Vec3::Y));
        studio.headless.step(1);
        studio.headless.picture()
    });
    frames.collect()
}

/// An animated PNG of `colors` colors. A frame has only the pixels that differ from the one
/// before.
fn save(frames: &[RgbaImage], colors: usize, path: &Path) -> Result<(), String> {
    let palette = Palette::of(frames, colors);
    let written = encode(frames, &palette, path);
    written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    println!("wrote {}", path.display());
    Ok(())
}

fn encode(frames: &[RgbaImage], palette: &Palette, path: &Path) -> Result<(), png::EncodingError> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, SIZE.x, SIZE.y);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    // The first color of the file is transparent.
    let colors = palette.colors.iter().flatten();
    encoder.set_palette([0; 3].iter().chain(colors).copied().collect::<Vec<u8>>());
    encoder.set_trns(vec![0u8]);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_animated(frames.len() as u32, 0)?;
    encoder.set_frame_delay(1, RATE)?;
    encoder.set_blend_op(png::BlendOp::Over)?;
    let mut writer = encoder.write_header()?;
    let mut last: Vec<u8> = Vec::new();
    for frame in frames {
        let places: Vec<u8> = frame.pixels().map(|p| palette.place(p) + 1).collect();
        let changed = |(k, place): (usize, &u8)| match last.get(k) == Some(place) {
            true => 0,
            false => *place,
        };
        let data: Vec<u8> = places.iter().enumerate().map(changed).collect();
        writer.write_image_data(&data)?;
        last = places;
    }
    writer.finish()
}
