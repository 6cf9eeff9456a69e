//! Reference of `lines/find/rows.wgsl`: what is known of the border between two pixels.

use super::{
    crack::SIDES,
    edge::{Normal, fold, is_outdone, is_ridge, is_rim_ridge, step_excess},
};

/// The border between a pixel and its neighbour to the east or south.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Border {
    /// Raw depths of the pixel before, of the pixel and of the neighbour.
    pub depths: [f64; 3],
    /// See [`step_excess`].
    pub excess: f64,
    /// See [`is_outdone`].
    pub outdone: bool,
    /// `None` if one of the two normals is missing.
    pub fold: Option<f64>,
    /// See [`is_ridge`] and [`is_rim_ridge`].
    pub ridge: bool,
    pub rim: bool,
    /// Ids and marks of the objects at the pixel and at the neighbour.
    pub objects: [[u32; 2]; 2],
}

/// The six pixels in a row across a border, of which the border is in the middle, in a grid of this
/// size. `side`: an entry of [`SIDES`]. Outside of the grid are the pixels at its border.
pub fn across(size: [i64; 2], pixel: [i64; 2], side: usize) -> [[i64; 2]; 6] {
    std::array::from_fn(|i| {
        let step = i as i64 - 2;
        [0, 1].map(|k| (pixel[k] + step * SIDES[side][k]).clamp(0, size[k] - 1))
    })
}

/// The border in the middle of six pixels in a row.
pub fn border(depths: [f64; 6], normals: [Normal; 6], objects: [[u32; 2]; 6]) -> Border {
    let folds = [1, 2, 3].map(|i: usize| fold(normals[i], normals[i + 1]));
    Border {
        depths: [depths[1], depths[2], depths[3]],
        excess: step_excess(depths),
        outdone: is_outdone(depths),
        fold: folds[1],
        ridge: is_ridge(folds),
        rim: is_rim_ridge(folds),
        objects: [objects[2], objects[3]],
    }
}
