//! Pictures of the matrix: what they show, and how far apart they are.

use bevy::math::URect;
use image::RgbaImage;

use crate::prelude::*;

/// Display codes that two pictures of one tone may differ by. A picture of 8 bits, and the deferred
/// renderer's colors of 8 bits, are off by one code each. The steepest curve between, of dots
/// and strokes that are antialiased over a pixel, makes less than five of each.
pub const CODES: u8 = 12;

/// The part of a picture inside a rectangle.
pub fn crop(picture: &RgbaImage, rect: URect) -> RgbaImage {
    let size = rect.size();
    RgbaImage::from_fn(size.x, size.y, |x, y| {
        *picture.get_pixel(rect.min.x + x, rect.min.y + y)
    })
}

/// The fraction of pixels for which `is_it` holds.
pub fn fraction(size: UVec2, is_it: impl Fn(u32, u32) -> bool) -> f64 {
    let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
    let count = pixels.filter(|(x, y)| is_it(*x, *y)).count();
    count as f64 / f64::from(size.x * size.y)
}

pub fn size(picture: &RgbaImage) -> UVec2 {
    UVec2::new(picture.width(), picture.height())
}

/// The positions of a picture at most `reach` pixels away, across, down and along the diagonals.
pub fn near(size: UVec2, x: u32, y: u32, reach: u32) -> impl Iterator<Item = (u32, u32)> {
    let last = size - 1;
    let columns = x.saturating_sub(reach)..=(x + reach).min(last.x);
    let rows = y.saturating_sub(reach)..=(y + reach).min(last.y);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// Smallest and largest code of each channel within `reach` pixels.
fn codes_near(picture: &RgbaImage, x: u32, y: u32, reach: u32) -> [(u8, u8); 3] {
    let mut found = [(u8::MAX, u8::MIN); 3];
    for (x, y) in near(size(picture), x, y, reach) {
        for (range, code) in found.iter_mut().zip(picture.get_pixel(x, y).0) {
            *range = (range.0.min(code), range.1.max(code));
        }
    }
    found
}

/// Whether a pixel is at most `reach` pixels from an edge: neighbors whose codes differ by more
/// than
/// [`CODES`].
pub fn is_at_edge(picture: &RgbaImage, x: u32, y: u32, reach: u32) -> bool {
    near(size(picture), x, y, reach).any(|(x, y)| {
        let codes = codes_near(picture, x, y, 1);
        codes.iter().any(|(low, high)| high - low > CODES)
    })
}

/// Whether a pixel has a color that `other` has within `reach` pixels, or one between those:
/// anti-aliasing mixes colors of neighbors, other samples move edges to neighbors.
pub fn is_explained(
    picture: &RgbaImage,
    other: &RgbaImage,
    (x, y): (u32, u32),
    reach: u32,
) -> bool {
    let codes = codes_near(other, x, y, reach);
    let pixel = picture.get_pixel(x, y).0;
    (codes.iter().zip(pixel)).all(|((low, high), code)| {
        (low.saturating_sub(CODES)..=high.saturating_add(CODES)).contains(&code)
    })
}

/// The mean of each channel in codes.
pub fn mean(picture: &RgbaImage) -> [f64; 3] {
    let count = f64::from(picture.width() * picture.height());
    [0, 1, 2].map(|channel| {
        let sum = |p: &image::Rgba<u8>| f64::from(p.0[channel]);
        picture.pixels().map(sum).sum::<f64>() / count
    })
}

/// Fraction of the pixels that differ by more than one code.
pub fn changed(a: &RgbaImage, b: &RgbaImage) -> f64 {
    fraction(size(a), |x, y| {
        let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x, y).0);
        a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 1)
    })
}

/// Where things are that are not sky: one value per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    pub size: UVec2,
    pub things: Vec<bool>,
}

impl Mask {
    pub fn at(&self, x: u32, y: u32) -> bool {
        self.things[(y * self.size.x + x) as usize]
    }

    /// Whether there are both things and sky at most `reach` pixels away.
    pub fn is_at_rim(&self, x: u32, y: u32, reach: u32) -> bool {
        let mut near = near(self.size, x, y, reach);
        near.any(|(i, j)| self.at(i, j) != self.at(x, y))
    }

    /// The fraction of pixels that differ from another mask, and are more than `reach` pixels from
    /// the rim of this one.
    pub fn apart(&self, other: &Self, reach: u32) -> f64 {
        assert_eq!(self.size, other.size);
        fraction(self.size, |x, y| {
            self.at(x, y) != other.at(x, y) && !self.is_at_rim(x, y, reach)
        })
    }
}

/// Of the pixels at the rim of things, the fraction that has ink within 2 pixels: a pixel whose
/// largest channel is below 100. Anti-aliasing lightens a line of 2 pixels near the steps of its
/// sides only: between these there are dark pixels. Sky and floor have none.
pub fn inked_rim(picture: &RgbaImage, mask: &Mask) -> f64 {
    let size = mask.size;
    let is_dark = |(x, y): (u32, u32)| picture.get_pixel(x, y).0[..3].iter().all(|c| *c < 100);
    let is_inside = |x: u32, y: u32| (2..size.x - 2).contains(&x) && (2..size.y - 2).contains(&y);
    let is_rim = |x: u32, y: u32| is_inside(x, y) && mask.is_at_rim(x, y, 1);
    let rim = fraction(size, is_rim);
    assert!(rim > 0.02, "{rim} of the picture is rim");
    fraction(size, |x, y| {
        is_rim(x, y) && near(size, x, y, 2).any(is_dark)
    }) / rim
}
