//! Reference of `depth/view.wgsl`: the view that is drawn, and its depth around a pixel.

use super::{
    map::{Frame, Projection},
    window::{self, Window},
};
use crate::read_back::{FloatImage, IdImage, WidthImage};

/// The view that is drawn.
pub struct View<'a> {
    /// x, y, width and height of the viewport in physical pixels.
    pub viewport: [u32; 4],
    /// Depth samples per pixel.
    pub samples: u32,
    /// Width of the target in physical pixels.
    pub width: u32,
    /// Bits of the raw depth: `samples` values per pixel, row by row.
    pub depth_bits: &'a [u32],
    pub frame: Frame,
    /// As `DepthMap::flip`.
    pub flip: bool,
    /// World normals, components -1 to 1.
    pub normals: Option<&'a FloatImage>,
    pub ids: Option<&'a IdImage>,
    /// Factors of the width of lines, if they are drawn.
    pub widths: Option<&'a WidthImage>,
    /// Height of an orthographic view in world units.
    pub height: f64,
    /// The least bend of raw depth over pixels where planes of a right angle meet, as a fraction of
    /// [`jump_reference`](Self::jump_reference).
    pub least_bend: f64,
    /// Unit vector towards the light that lines follow.
    pub to_light: [f64; 3],
    /// Unit vector to the right of the camera.
    pub right: [f64; 3],
}

impl View<'_> {
    pub fn contains(&self, x: u32, y: u32) -> bool {
        let [x0, y0, w, h] = self.viewport;
        (x0..x0 + w).contains(&x) && (y0..y0 + h).contains(&y)
    }

    /// The length that jumps are measured in, as raw depth. `nearest` is the largest
    /// raw depth nearby. Perspective: proportional to the reciprocal of its
    /// distance. Orthographic: the distance from which a perspective view of 45
    /// degrees has the same height.
    pub fn jump_reference(&self, nearest: f64) -> f64 {
        match self.frame.projection {
            Projection::Perspective { offset } => nearest + offset,
            Projection::Orthographic { extent, .. } => {
                let distance = 0.5 * self.height / 22.5f64.to_radians().tan();
                distance / extent
            }
        }
    }

    /// Raw depth of a sample.
    pub fn depth(&self, x: u32, y: u32, sample: u32) -> f64 {
        let index = (y * self.width + x) * self.samples + sample;
        f64::from(f32::from_bits(self.depth_bits[index as usize]))
    }
}

/// (D, L) of a pixel: the mean of its samples.
pub fn pixel_depth(view: &View, x: u32, y: u32) -> [f64; 2] {
    let n = f64::from(view.samples);
    let maps = (0..view.samples).map(|s| view.frame.depth_map(view.depth(x, y, s)));
    let sum = maps.fold([0.0; 2], |a, m| [a[0] + m[0], a[1] + m[1]]);
    sum.map(|v| v / n)
}

/// The raw depths of 3 x 3 taps `reach` pixels apart. Taps outside the viewport are
/// read at its border and marked as missing.
pub fn load_window(view: &View, x: u32, y: u32, reach: u32, sample: u32) -> Window {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    let (x, y, reach) = (i64::from(x), i64::from(y), i64::from(reach));
    let column = |i: i64| (x + i * reach).clamp(x0, x0 + w - 1) as u32;
    let row = |j: i64| (y + j * reach).clamp(y0, y0 + h - 1) as u32;
    Window {
        depths: [-1, 0, 1].map(|j| [-1, 0, 1].map(|i| view.depth(column(i), row(j), sample))),
        missing: [
            x - reach < x0,
            x + reach >= x0 + w,
            y - reach < y0,
            y + reach >= y0 + h,
        ],
    }
}

/// Prewitt response of the depth map, slopes included. The sky is at D = 1.
pub fn map_slope(view: &View, x: u32, y: u32) -> f64 {
    let mut frame = view.frame;
    frame.sky_gap = 0.0;
    if frame.ends.is_none() {
        return 0.0;
    }
    window::prewitt(&window::map_steps(&frame, &load_window(view, x, y, 1, 0)))
}
