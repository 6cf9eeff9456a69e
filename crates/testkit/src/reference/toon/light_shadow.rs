//! Reference of `toon/light_shadow.wgsl`, as far as it is about directional lights.

use bevy::math::{DMat4, DVec2, DVec3};

use super::super::{light::edge_at, mix, shadow_texels::filtered};

/// Hard border of a shadow, from the filtered shadow at a pixel and its change over the pixel.
pub fn hard_shadow(here: f64, change: f64) -> f64 {
    match here > 0.0 && here < 1.0 {
        true => edge_at(0.5, here, change),
        false => here,
    }
}

/// The depths in a square shadow map, row by row; 1 is nearest to the light.
pub struct ShadowMap {
    pub size: usize,
    pub depths: Vec<f64>,
}

impl ShadowMap {
    /// 1 where a depth is lit, else 0. Beyond the map it is as at its border.
    fn lit(&self, column: i64, row: i64, depth: f64) -> f64 {
        let [x, y] = [column, row].map(|at| at.clamp(0, self.size as i64 - 1) as usize);
        f64::from(u8::from(depth >= self.depths[y * self.size + x]))
    }
}

/// A part of the view with a shadow map of its own.
pub struct Cascade<'a> {
    /// An orthographic projection.
    pub clip_from_world: DMat4,
    /// World units that a texel is wide.
    pub texel_size: f64,
    /// The distance from the camera at which it ends.
    pub far: f64,
    pub map: &'a ShadowMap,
}

/// A directional light.
pub struct Sun<'a> {
    pub to_light: DVec3,
    /// How far the shadow map is read from the surface: along the normal in texels, and towards the
    /// light in world units.
    pub normal_bias: f64,
    pub depth_bias: f64,
    /// The part of a cascade, at its far end, over which the next one replaces it.
    pub overlap: f64,
    pub cascades: Vec<Cascade<'a>>,
}

/// A surface that may lie in shadow.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    pub position: DVec3,
    /// Unit normal of the mesh.
    pub normal: DVec3,
    /// Changes of the position over a pixel, to the right and down.
    pub steps: [DVec3; 2],
    /// Distance from the camera along its axis.
    pub distance: f64,
}

/// The part of a pixel over which the change of a shadow is found.
const STEP: f64 = 1.0 / 2048.0;

impl Sun<'_> {
    /// Where a surface is read in the map of a cascade: texture coordinates and depth.
    pub fn place(&self, index: usize, r: &Receiver) -> DVec3 {
        let cascade = &self.cascades[index];
        let away = self.normal_bias * cascade.texel_size * r.normal;
        let at = r.position + away + self.depth_bias * self.to_light;
        let clip = cascade.clip_from_world.project_point3(at);
        DVec3::new(0.5 * (1.0 + clip.x), 0.5 * (1.0 - clip.y), clip.z)
    }

    /// The filtered shadow in a cascade, 1 where the light arrives, and how much it changes over a
    /// pixel. Nothing is in shadow beside the map.
    pub fn shadow_in_cascade(&self, index: usize, r: &Receiver) -> [f64; 2] {
        let here = self.place(index, r);
        if here.min_element() < 0.0 || here.max_element() > 1.0 {
            return [1.0, 0.0];
        }
        let map = self.cascades[index].map;
        let at = |moved: DVec3| {
            let moved = Receiver {
                position: r.position + moved,
                ..*r
            };
            let place = self.place(index, &moved);
            let texels = map.size as f64 * DVec2::new(place.x, place.y);
            // All of it at the depth of the pixel.
            filtered(|x, y| map.lit(x, y, here.z), texels)
        };
        let over = |step: DVec3| (at(STEP * step) - at(-STEP * step)) / (2.0 * STEP);
        let change = r.steps.iter().map(|step| over(*step).abs()).sum::<f64>();
        [at(DVec3::ZERO), change]
    }

    /// The same at the surface's distance from the camera: in the first cascade that reaches it,
    /// which the next one replaces. There are no shadows beyond the last one.
    pub fn blended(&self, r: &Receiver) -> [f64; 2] {
        let reaches = |cascade: &Cascade| r.distance < cascade.far;
        let Some(index) = self.cascades.iter().position(reaches) else {
            return [1.0, 0.0];
        };
        let far = self.cascades[index].far;
        let start = (1.0 - self.overlap) * far;
        let own = self.shadow_in_cascade(index, r);
        if index + 1 == self.cascades.len() || r.distance < start {
            return own;
        }
        let next = self.shadow_in_cascade(index + 1, r);
        let part = (r.distance - start) / (far - start);
        [0, 1].map(|k| mix(own[k], next[k], part))
    }
}
