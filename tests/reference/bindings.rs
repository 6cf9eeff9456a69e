//! Twin of `stylize/bindings.wgsl`: what a view gives the fused pass.

use super::map::{Frame, Projection};
use crate::common::read_back::{FloatImage, IdImage};

/// A view: its viewport, its depth and its depth map.
pub struct View<'a> {
    /// Origin and size of the viewport in pixels.
    pub viewport: [u32; 4],
    pub samples: u32,
    /// Size of the target's rows in pixels.
    pub width: u32,
    pub depth_bits: &'a [u32],
    pub frame: Frame,
    pub flip: bool,
    /// World normals, decoded.
    pub normals: Option<&'a FloatImage>,
    pub ids: Option<&'a IdImage>,
    /// Height of an orthographic view, world units.
    pub height: f64,
}

impl View<'_> {
    pub fn contains(&self, x: u32, y: u32) -> bool {
        let [x0, y0, w, h] = self.viewport;
        (x0..x0 + w).contains(&x) && (y0..y0 + h).contains(&y)
    }

    /// What a jump is a share of: the reciprocal of the distance of the nearest
    /// depth around, in the buffer's units; in an orthographic view the depth
    /// that lies between the camera and where 45 degrees show as much.
    pub fn jump_reference(&self, nearest: f64) -> f64 {
        match self.frame.projection {
            Projection::Perspective { offset } => nearest + offset,
            Projection::Orthographic { extent, .. } => {
                let distance = 0.5 * self.height / 22.5f64.to_radians().tan();
                distance / extent
            }
        }
    }

    pub fn depth(&self, x: u32, y: u32, sample: u32) -> f64 {
        let index = (y * self.width + x) * self.samples + sample;
        f64::from(f32::from_bits(self.depth_bits[index as usize]))
    }
}
