//! Reference of `toon/surface.wgsl`.

use bevy::math::DVec3;

/// Changes of the world position, of the normal and of the bias over a pixel, to the right and down.
#[derive(Clone, Copy, Debug, Default)]
pub struct Footprint {
    pub position: [DVec3; 2],
    pub normal: [DVec3; 2],
    pub bias: [f64; 2],
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Surface {
    pub position: DVec3,
    pub normal: DVec3,
    /// Unit vector to the camera, and 1 over its distance.
    pub to_eye: DVec3,
    pub per_eye_distance: f64,
    pub foot: Footprint,
    pub tangent: DVec3,
    /// Added to the cosines between normal and lights.
    pub bias: f64,
    /// Of the ramp.
    pub detail: f64,
    /// Perceptual roughness.
    pub roughness: f64,
}

/// Light from one source, as the WGSL struct of this name.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arriving {
    pub color: DVec3,
    pub smooth_color: DVec3,
    pub to_light: DVec3,
    pub to_highlight: DVec3,
    pub per_distance: f64,
    pub lit: f64,
    pub diffuse: f64,
    pub shine: f64,
}

/// What an angle becomes one pixel to the right and one pixel down, added up.
pub fn cosine_over_pixel(foot: &Footprint, direction: DVec3) -> f64 {
    foot.normal.iter().map(|n| n.dot(direction).abs()).sum()
}

/// The bias of a threshold from 0 to 1, of which 0.5 is neutral.
pub fn bias_of(threshold: f64) -> f64 {
    2.0 * (threshold - 0.5)
}

/// Cosine between normal and direction, with the surface's own threshold.
pub fn biased_cosine(s: &Surface, direction: DVec3) -> f64 {
    (s.normal.dot(direction) + s.bias).clamp(-1.0, 1.0)
}

/// Its change over a pixel.
pub fn biased_over_pixel(s: &Surface, direction: DVec3) -> f64 {
    let steps = s.foot.normal.iter().zip(s.foot.bias);
    steps.map(|(n, bias)| (n.dot(direction) + bias).abs()).sum()
}

/// Size of a pixel on the surface in world units.
pub fn pixel_size(foot: &Footprint) -> f64 {
    foot.position.iter().map(|step| step.length()).sum()
}

/// Unit vector half way between two, 0 where they are opposite.
pub fn half_way(a: DVec3, b: DVec3) -> DVec3 {
    (a + b).normalize_or_zero()
}
