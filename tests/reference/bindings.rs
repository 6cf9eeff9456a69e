//! Twin of `stylize/bindings.wgsl`: what a view gives the fused pass.

use super::map::Frame;

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
}

impl View<'_> {
    pub fn contains(&self, x: u32, y: u32) -> bool {
        let [x0, y0, w, h] = self.viewport;
        (x0..x0 + w).contains(&x) && (y0..y0 + h).contains(&y)
    }

    pub fn depth(&self, x: u32, y: u32, sample: u32) -> f64 {
        let index = (y * self.width + x) * self.samples + sample;
        f64::from(f32::from_bits(self.depth_bits[index as usize]))
    }
}
