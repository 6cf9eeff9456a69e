//! The surroundings of a model, made by code: a backdrop of paper, and a studio
//! for reflections.
//!
//! The studio is filtered here, on the CPU and once, because the engine's own
//! `GeneratedEnvironmentMapLight` filters its map again in every frame.

use bevy::prelude::*;

use super::sky::{cube_map, direction_of_texel};

/// Texels along the side of a face of the specular map.
const SIDE: u32 = 64;
/// Mip levels of the specular map: the engine reads level
/// `roughness * (LEVELS - 1)`.
const LEVELS: u32 = 6;
/// Texels along the side of a face that the filters read.
const SOURCE_SIDE: u32 = 24;
/// Texels along the side of a face of the diffuse map.
const DIFFUSE_SIDE: u32 = 8;

/// Radiance of the studio from a direction of the camera's turntable frame: `y`
/// is up, `z` points to the camera. One is the radiance that exposes to white.
fn studio(direction: Vec3) -> Vec3 {
    let up = direction.y;
    let (floor, wall, ceiling) = (
        Vec3::new(0.20, 0.19, 0.18),
        Vec3::new(0.34, 0.35, 0.37),
        Vec3::new(0.62, 0.65, 0.70),
    );
    let base = if up < 0.0 {
        wall.lerp(floor, smooth(0.0, 0.35, -up))
    } else {
        wall.lerp(ceiling, smooth(0.0, 0.8, up))
    };
    // A dark band behind the camera gives metals something to contrast with.
    let dark = smooth(0.55, 0.95, direction.z) * (1.0 - smooth(0.25, 0.6, up.abs()));
    base * (1.0 - 0.55 * dark)
        + Vec3::new(1.8, 1.75, 1.66) * panel(direction, Vec3::new(-0.65, 0.6, 0.5), 0.46, 0.56)
        + Vec3::new(0.9, 1.0, 1.15) * panel(direction, Vec3::new(0.95, 0.2, 0.25), 0.16, 0.6)
        + Vec3::new(1.0, 1.0, 1.0) * panel(direction, Vec3::new(0.3, 0.45, -0.85), 0.4, 0.25)
}

/// A soft-edged upright panel around `center`, one inside and zero outside.
/// `width` and `height` are half sizes as tangents of angles.
fn panel(direction: Vec3, center: Vec3, width: f32, height: f32) -> f32 {
    let center = center.normalize();
    let depth = direction.dot(center);
    if depth <= 0.0 {
        return 0.0;
    }
    let right = Vec3::Y.cross(center).normalize();
    let up = center.cross(right);
    let edge = |position: f32, half: f32| 1.0 - smooth(0.8 * half, half, (position / depth).abs());
    edge(direction.dot(right), width) * edge(direction.dot(up), height)
}

fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Directions of the filters' source, with radiance and relative solid angle.
fn samples() -> Vec<(Vec3, Vec3, f32)> {
    let side = SOURCE_SIDE;
    let texels = (0..6).flat_map(|face| {
        (0..side * side).map(move |i| direction_of_texel(face, i % side, i / side, side))
    });
    texels
        .map(|direction| {
            // The farther a texel is from the middle of its face, the smaller.
            let largest = direction.abs().max_element();
            (direction, studio(direction), largest.powi(3))
        })
        .collect()
}

/// Mean radiance, weighted by `weight(cosine to the direction)`.
fn filtered(
    samples: &[(Vec3, Vec3, f32)],
    direction: Vec3,
    weight: impl Fn(f32) -> f32,
) -> [f32; 4] {
    let (mut sum, mut total) = (Vec3::ZERO, 0.0);
    for (from, radiance, solid_angle) in samples {
        let cosine = direction.dot(*from);
        if cosine > 0.0 {
            let w = weight(cosine) * solid_angle;
            sum += *radiance * w;
            total += w;
        }
    }
    (sum / total.max(f32::MIN_POSITIVE)).extend(1.0).to_array()
}

/// The GGX distribution for a half vector between `n` and a direction at this
/// cosine to `n`, times the cosine: the filter of the split-sum approximation
/// (Karis, "Real Shading in Unreal Engine 4", 2013).
fn ggx(cosine: f32, perceptual_roughness: f32) -> f32 {
    let alpha_squared = perceptual_roughness.powi(4);
    let half_squared = 0.5 * (1.0 + cosine);
    let denominator = half_squared * (alpha_squared - 1.0) + 1.0;
    cosine * alpha_squared / (denominator * denominator)
}

/// The studio as the light of a camera. `white` is the radiance in cd/m2 that
/// exposes to white.
pub fn light(images: &mut Assets<Image>, white: f32) -> EnvironmentMapLight {
    let samples = samples();
    let specular = cube_map(SIDE, LEVELS, |direction, level| {
        // One texel of the source cannot resolve the sharpest lobes.
        let roughness = level as f32 / (LEVELS - 1) as f32;
        if level == 0 {
            studio(direction).extend(1.0).to_array()
        } else {
            filtered(&samples, direction, |cosine| ggx(cosine, roughness))
        }
    });
    let diffuse = cube_map(DIFFUSE_SIDE, 1, |direction, _| {
        filtered(&samples, direction, |cosine| cosine)
    });
    EnvironmentMapLight {
        diffuse_map: images.add(diffuse),
        specular_map: images.add(specular),
        intensity: white,
        ..default()
    }
}

/// A backdrop that is the same from all sides, so that it stands still behind a
/// turntable.
pub fn backdrop() -> Image {
    cube_map(SIDE, 1, |direction, _| {
        let (low, high) = (Vec3::new(0.78, 0.74, 0.67), Vec3::new(0.56, 0.69, 0.78));
        let color = low.lerp(high, smooth(-0.35, 0.45, direction.y));
        color.extend(1.0).to_array()
    })
}
