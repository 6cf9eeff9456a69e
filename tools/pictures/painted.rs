//! A picture of painted ramps and of thresholds from an image.

use bevy::{
    asset::RenderAssetUsages,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use bevy_comics::{
    ToonLight,
    toon::{DetailAxis, Ramp, RampDetail, RampMap, RampMode, RampStop},
};
use image::{Rgba, RgbaImage, imageops};

use crate::{
    sheet::in_rows,
    toon::{Room, bumpy, matt, per_light},
};

const SIZE: UVec2 = UVec2::new(196, 264);
/// Width of the images of ramps in the picture.
const STRIP: u32 = 150;

/// An image as materials take it.
fn texture(picture: &RgbaImage, format: TextureFormat) -> Image {
    Image::new(
        Extent3d {
            width: picture.width(),
            height: picture.height(),
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        picture.as_raw().clone(),
        format,
        RenderAssetUsages::default(),
    )
}

fn rgba(color: Color) -> Rgba<u8> {
    Rgba(color.to_srgba().to_u8_array())
}

/// Tones with the fraction of the row at which they end.
fn row(tones: &[(f32, Color)]) -> RgbaImage {
    RgbaImage::from_fn(256, 1, |x, _| {
        let place = (x as f32 + 0.5) / 256.0;
        let tone = tones.iter().find(|(end, _)| place < *end);
        rgba(tone.map_or(Color::WHITE, |tone| tone.1))
    })
}

/// Washes of a brush: each tone is darker where it ends.
fn washes() -> RgbaImage {
    let tones = [
        (0.14, Color::srgb(0.44, 0.36, 0.62)),
        (0.17, Color::srgb(0.34, 0.22, 0.46)),
        (0.40, Color::srgb(0.80, 0.56, 0.60)),
        (0.43, Color::srgb(0.70, 0.44, 0.50)),
        (0.72, Color::srgb(0.96, 0.84, 0.76)),
        (0.75, Color::srgb(0.88, 0.72, 0.64)),
        (1.00, Color::srgb(1.0, 0.99, 0.95)),
    ];
    row(&tones)
}

/// Every hue from violet to yellow in steps that become finer towards the light.
fn steps() -> RgbaImage {
    RgbaImage::from_fn(256, 1, |x, _| {
        let place = (x as f32 + 0.5) / 256.0;
        let step = (place * place * 24.0).floor() / 24.0;
        rgba(Color::hsl(
            (270.0 + 150.0 * step) % 360.0,
            0.65,
            0.42 + 0.4 * step,
        ))
    })
}

/// Four tones at the top, where surfaces face the eye; a warm and a cold rim below.
fn rims() -> RgbaImage {
    let tones = |dark, middle, light| {
        row(&[
            (0.12, dark),
            (0.45, middle),
            (0.8, light),
            (1.0, Color::WHITE),
        ])
    };
    let inner = tones(
        Color::srgb(0.34, 0.28, 0.50),
        Color::srgb(0.74, 0.50, 0.56),
        Color::srgb(0.95, 0.82, 0.76),
    );
    let rim = row(&[
        (0.12, Color::srgb(0.40, 0.66, 0.95)),
        (1.0, Color::srgb(1.0, 0.95, 0.62)),
    ]);
    RgbaImage::from_fn(256, 64, |x, y| {
        let from = if y < 36 { &inner } else { &rim };
        *from.get_pixel(x, 0)
    })
}

/// Strokes of a dry brush: neutral in the mean.
fn bristles() -> RgbaImage {
    RgbaImage::from_fn(512, 512, |x, y| {
        let [u, v] = [x, y].map(|p| p as f32 / 512.0 * std::f32::consts::TAU);
        let waves = [(7.0, 17.0, 0.5), (-4.0, 31.0, 1.9), (9.0, 43.0, 4.0)];
        let wave = |(a, b, phase): (f32, f32, f32)| (a * u + b * v + phase).sin();
        let sum: f32 = waves.into_iter().map(wave).sum();
        let code = (127.5 + 20.0 * sum).round() as u8;
        Rgba([code, code, code, 255])
    })
}

/// What a panel has.
struct Panel {
    ramp: Ramp,
    map: Option<RgbaImage>,
    thresholds: Option<RgbaImage>,
}

fn panel(part: Panel) -> RgbaImage {
    let eye = Transform::from_xyz(0.0, 1.9, 5.6).looking_at(Vec3::new(0.0, 0.94, 0.0), Vec3::Y);
    let mut room = Room::new(SIZE, eye, 0.40);
    room.ground();
    let map = (part.map.as_ref()).map(|map| texture(map, TextureFormat::Rgba8UnormSrgb));
    let thresholds = (part.thresholds.as_ref()).map(|map| texture(map, TextureFormat::Rgba8Unorm));
    let light = ToonLight {
        highlight: 0.0,
        ramp: Some(part.ramp),
        ramp_map: map.map_or_else(RampMap::default, |map| room.image(map).into()),
        threshold_map: thresholds.map(|map| room.image(map)),
        ..default()
    };
    let color = Color::srgb(0.95, 0.70, 0.52);
    let has_map = light.threshold_map.is_some();
    let head = match has_map {
        true => Sphere::new(0.56).mesh().uv(96, 48),
        false => bumpy(0.06),
    };
    // The poles of the coordinates are above and below.
    let upright = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let at = Transform::from_xyz(0.0, 1.12, 0.0).with_rotation(upright);
    room.put(head, matt(color), &light, at);
    let foot = Torus::new(0.26, 0.62)
        .mesh()
        .minor_resolution(32)
        .major_resolution(64);
    let at = Transform::from_xyz(0.0, 0.26, 0.0);
    room.put(foot.build(), matt(color), &light, at);
    let mut picture = room.picture();
    let Some(shown) = part.map.or(part.thresholds) else {
        return picture;
    };
    let height = if shown.height() == 1 { 14 } else { 36 };
    let nearest = imageops::FilterType::Nearest;
    let shown = match shown.width() == shown.height() {
        true => imageops::crop_imm(&shown, 0, 0, STRIP, height).to_image(),
        false => imageops::resize(&shown, STRIP, height, nearest),
    };
    let framed = RgbaImage::from_pixel(STRIP + 2, height + 2, Rgba([30, 25, 40, 255]));
    let left = i64::from((SIZE.x - STRIP) / 2);
    imageops::replace(&mut picture, &framed, left - 1, 5);
    imageops::replace(&mut picture, &shown, left, 6);
    picture
}

/// Painted tones, many tones, rows for rims, and edges as of a dry brush, each under its image.
pub fn picture() -> RgbaImage {
    let plain = || per_light(Ramp::default().stops);
    let painted = |ramp, map| Panel {
        ramp,
        map: Some(map),
        thresholds: None,
    };
    let by_rim = Ramp {
        detail: Some(RampDetail {
            plain: Vec::new(),
            axis: DetailAxis::Rim { power: 1.0 },
        }),
        ..plain()
    };
    let brush = Ramp {
        mode: RampMode::PerLight,
        ..Ramp::new([
            RampStop::new(0.0, Color::srgb(0.44, 0.36, 0.62)),
            RampStop::new(0.2, Color::srgb(0.86, 0.66, 0.66)),
            RampStop::new(0.5, Color::WHITE),
        ])
    };
    let panels = [
        painted(plain(), washes()),
        painted(plain(), steps()),
        painted(by_rim, rims()),
        Panel {
            ramp: brush,
            map: None,
            thresholds: Some(bristles()),
        },
    ];
    let pictures = panels.map(panel);
    in_rows(&pictures, 4, SIZE, 4)
}
