//! Reference of `depth/window.wgsl`: differences of the depth map in a window of 3 x 3
//! depths.

use super::map::Frame;

/// Raw depths of 3 x 3 taps.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Row by row.
    pub depths: [[f64; 3]; 3],
    /// Whether the taps to the west, east, north and south lie outside the viewport.
    pub missing: [bool; 4],
}

/// Difference of D between each tap and its reference, row by row; 0 in the middle.
pub type Steps = [[f64; 3]; 3];

/// Sum of the steps, weighted by a kernel.
fn convolve(steps: &Steps, kernel: [[f64; 3]; 3]) -> f64 {
    (0..3)
        .flat_map(|r| (0..3).map(move |c| (r, c)))
        .map(|(r, c)| steps[r][c] * kernel[r][c])
        .sum()
}

const PREWITT: [[f64; 3]; 3] = [[-1.0, 0.0, 1.0]; 3];

fn transposed(k: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|r| std::array::from_fn(|c| k[c][r]))
}

/// Length of the gradient: the kernel across and down.
pub fn gradient(steps: &Steps, kernel: [[f64; 3]; 3]) -> f64 {
    convolve(steps, kernel).hypot(convolve(steps, transposed(kernel)))
}

/// Differences of D to the center, slopes included.
pub fn map_steps(frame: &Frame, win: &Window) -> Steps {
    let c = frame.with_sky(win.depths[1][1]);
    win.depths.map(|row| row.map(|d| frame.with_sky(d) - c))
}

pub fn prewitt(steps: &Steps) -> f64 {
    gradient(steps, PREWITT)
}
