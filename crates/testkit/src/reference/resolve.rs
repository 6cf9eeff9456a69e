//! Reference of `lines/find/resolve.wgsl`: the sample of a pixel that lines read.

use super::view::View;
use crate::read_back::{DepthImage, FloatImage, IdImage, WidthImage};

/// Positions of the samples of a pixel in the standard pattern for four, in sixteenths
/// of a pixel from its center: x to the right, y down.
pub const STANDARD_4: [[i32; 2]; 4] = [[-2, -6], [6, -2], [-6, 2], [2, 6]];

/// The sample of largest raw depth; of equal ones the first.
pub fn nearest_sample(depths: &[f32]) -> usize {
    let mut chosen = 0;
    for (sample, depth) in depths.iter().enumerate() {
        if *depth > depths[chosen] {
            chosen = sample;
        }
    }
    chosen
}

/// The sample whose normal and object are read: the first, unless a step in depth separates
/// it from the `nearest`. `least`: the height of such a step, from the raw depth of the nearest.
fn surface_sample(depths: &[f32], nearest: usize, least: impl Fn(f64) -> f64) -> usize {
    let near = f64::from(depths[nearest]);
    if f64::from(depths[0]) >= near - least(near) {
        0
    } else {
        nearest
    }
}

/// The prepass textures of a view with all samples: normals, ids and widths one image a
/// sample, none without them.
pub struct Prepass {
    pub depth: DepthImage,
    pub normals: Vec<FloatImage>,
    pub ids: Vec<IdImage>,
    pub widths: Vec<WidthImage>,
}

/// One sample of every pixel.
pub struct Resolved {
    depth_bits: Vec<u32>,
    normals: Option<FloatImage>,
    ids: Option<IdImage>,
    widths: Option<WidthImage>,
}

impl Resolved {
    /// `least`: the step in raw depth that separates two surfaces, from that of the nearer, and from
    /// whether they are of two objects or sections.
    pub fn new(prepass: &Prepass, least: impl Fn(f64, bool) -> f64) -> Self {
        let depth = &prepass.depth;
        let samples = depth.samples as usize;
        let depths =
            |bits: &[u32]| -> Vec<f32> { bits.iter().map(|b| f32::from_bits(*b)).collect() };
        let pixels = || depth.bits.chunks_exact(samples).map(depths);
        let nearest: Vec<usize> = pixels().map(|depths| nearest_sample(&depths)).collect();
        let differ = |i: usize| {
            let ids = [0, nearest[i]].map(|s| prepass.ids.get(s).map(|ids| ids.pixels[i]));
            ids[0] != ids[1]
        };
        let surface = |(i, depths): (usize, Vec<f32>)| {
            surface_sample(&depths, nearest[i], |near| least(near, differ(i)))
        };
        let surfaces: Vec<usize> = pixels().enumerate().map(surface).collect();
        let texels = || surfaces.iter().copied().enumerate();
        let normals = prepass.normals.first().map(|first| FloatImage {
            pixels: texels()
                .map(|(i, s)| prepass.normals[s].pixels[i])
                .collect(),
            ..first.clone()
        });
        let ids = prepass.ids.first().map(|first| IdImage {
            pixels: texels().map(|(i, s)| prepass.ids[s].pixels[i]).collect(),
            ..first.clone()
        });
        let widths = prepass.widths.first().map(|first| WidthImage {
            factors: texels()
                .map(|(i, s)| prepass.widths[s].factors[i])
                .collect(),
            ..first.clone()
        });
        Self {
            depth_bits: (nearest.iter().enumerate())
                .map(|(i, s)| depth.bits[i * samples + s])
                .collect(),
            normals,
            ids,
            widths,
        }
    }

    /// The view as the passes of lines see it.
    pub fn view<'a>(&'a self, view: &View<'a>) -> View<'a> {
        View {
            samples: 1,
            depth_bits: &self.depth_bits,
            normals: self.normals.as_ref(),
            ids: self.ids.as_ref(),
            widths: self.widths.as_ref(),
            ..*view
        }
    }
}
