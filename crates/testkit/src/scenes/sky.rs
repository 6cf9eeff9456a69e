//! A painted sky as a cube map: a gradient, a sun and a few clouds.

use bevy::{
    asset::RenderAssetUsages,
    prelude::*,
    render::render_resource::{
        Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
    },
};
use half::f16;

use super::{
    noise::{fractal, smoothstep},
    shape::{blend, rgb},
};

/// Colors are sRGB codes such as `0xc8413a`.
pub struct Sky {
    pub zenith: u32,
    pub middle: u32,
    pub horizon: u32,
    pub ground: u32,
    pub cloud: u32,
    /// Cloudiness, 0 (no clouds) to 1.
    pub cover: f32,
    /// Direction to the sun.
    pub sun: Vec3,
}

const SIDE: u32 = 256;

impl Sky {
    pub fn color(&self, direction: Vec3) -> [f32; 4] {
        let up = direction.y;
        if up < 0.0 {
            let below = smoothstep(0.0, 0.25, -up);
            return blend(rgb(self.horizon), rgb(self.ground), below);
        }
        let above = smoothstep(0.0, 0.22, up);
        let low = blend(rgb(self.horizon), rgb(self.middle), above);
        let mut color = blend(low, rgb(self.zenith), smoothstep(0.18, 0.9, up));
        // Clouds on a plane overhead that fade out towards the horizon.
        let plane = Vec2::new(direction.x, direction.z) / (up + 0.12);
        let density = fractal(plane * 1.1 + 7.3, 5) * 0.5 + 0.5;
        let edge = 1.0 - self.cover;
        let cloud = smoothstep(edge, edge + 0.16, density) * smoothstep(0.02, 0.2, up);
        color = blend(color, rgb(self.cloud), cloud * 0.9);
        let towards = direction.dot(self.sun.normalize()).max(0.0);
        let glow = 0.35 * towards.powi(24) + smoothstep(0.9985, 0.9993, towards);
        blend(color, [1.0, 0.95, 0.8, 1.0], glow)
    }

    pub fn image(&self) -> Image {
        cube_map(SIDE, 1, |direction, _| self.color(direction))
    }
}

/// A cube map of `side` texels with `levels` mip levels, whose linear colors
/// depend on the direction in world space and on the level.
pub fn cube_map(side: u32, levels: u32, color: impl Fn(Vec3, u32) -> [f32; 4]) -> Image {
    let mut data = Vec::new();
    for face in 0..6 {
        for level in 0..levels {
            let side = side >> level;
            for y in 0..side {
                for x in 0..side {
                    let direction = direction_of_texel(face, x, y, side);
                    for c in color(direction, level) {
                        data.extend(f16::from_f32(c).to_le_bytes());
                    }
                }
            }
        }
    }
    let size = Extent3d {
        width: side,
        height: side,
        depth_or_array_layers: 6,
    };
    let mut image = Image::new_uninit(
        size,
        TextureDimension::D2,
        TextureFormat::Rgba16Float,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.data = Some(data);
    image.texture_descriptor.mip_level_count = levels;
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::Cube),
        ..default()
    });
    image
}

/// World direction to the center of a texel of a cube map.
pub fn direction_of_texel(face: u32, x: u32, y: u32, side: u32) -> Vec3 {
    let u = (x as f32 + 0.5) / side as f32 * 2.0 - 1.0;
    let v = (y as f32 + 0.5) / side as f32 * 2.0 - 1.0;
    let direction = match face {
        0 => Vec3::new(1.0, -v, -u),
        1 => Vec3::new(-1.0, -v, u),
        2 => Vec3::new(u, 1.0, v),
        3 => Vec3::new(u, -1.0, -v),
        4 => Vec3::new(u, -v, 1.0),
        _ => Vec3::new(-u, -v, -1.0),
    };
    // The engine looks cube maps up left-handed: z is mirrored.
    (direction * Vec3::new(1.0, 1.0, -1.0)).normalize()
}
