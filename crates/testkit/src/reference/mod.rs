//! References of the shaders in double precision. A reference has the name of the WGSL file
//! that it mirrors. It is written from the definition, not from the shader.

pub mod bend;
pub mod black_flats;
pub mod blue_noise;
pub mod boil;
pub mod borders;
pub mod box_statistics;
pub mod budget;
pub mod chain;
pub mod color;
pub mod color_harmony;
pub mod colorization;
pub mod columns;
pub mod contours;
pub mod coverage;
pub mod crack;
pub mod depth_layers;
pub mod desaturation;
pub mod detail;
pub mod draw;
pub mod edge;
pub mod faithful;
pub mod focus;
pub mod fold;
pub mod footprint;
pub mod fused;
pub mod gaps;
pub mod halftone;
pub mod hatching;
pub mod histogram;
pub mod light;
pub mod link;
pub mod map;
pub mod nested;
pub mod noise;
pub mod normal;
pub mod octahedral;
pub mod paint;
pub mod paper;
pub mod planes;
pub mod ramp_map;
pub mod range;
pub mod raw;
pub mod read;
pub mod rect;
pub mod resolve;
mod rim;
pub mod screen;
pub mod shadow_texels;
pub mod sheet;
pub mod similarity;
pub mod sketch;
pub mod smoothing;
pub mod stipple;
mod straight;
pub mod stylized_highlight;
pub mod surface;
pub mod tone_bands;
pub mod tone_ramp;
pub mod tone_range;
pub mod toon;
pub mod view;
pub mod vignette;
pub mod weight;
pub mod window;

pub type Rgb = [f64; 3];

/// A color multiplied by its opacity, and the opacity.
pub type Rgba = [f64; 4];

/// Opaque ink over a picture.
pub fn over(picture: Rgba, [r, g, b]: Rgb, coverage: f64) -> Rgba {
    let ink = [r, g, b, 1.0];
    std::array::from_fn(|i| mix(picture[i], ink[i], coverage))
}

pub fn mix(a: f64, b: f64, t: f64) -> f64 {
    a * (1.0 - t) + b * t
}

pub fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
