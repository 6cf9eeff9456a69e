//! Reference of `lines/modifiers/owner_plane.wgsl`: near, middle and far, and the abstraction, where lines are.

use super::{
    abstraction::{dialled, graded, lines},
    depth_layers, mix,
};

/// An object in the depth map.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// D of its centre.
    pub d: f64,
    /// How much its pixels are where its centre is.
    pub whole: f64,
    /// Its abstraction: a factor of that by distance, and what is added.
    pub dial: [f64; 2],
}

/// D where a line is: that of the pixel, or of its object. `by_objects`: how much of the one and of
/// the other.
pub fn depth(pixel: f64, object: Option<Placed>, by_objects: f64) -> f64 {
    object.map_or(pixel, |object| {
        mix(pixel, object.d, object.whole * by_objects)
    })
}

/// Fractions of near, middle and far. `flip`: near and far are exchanged.
pub fn weights(borders: [f64; 2], softness: f64, d: f64, flip: bool) -> [f64; 3] {
    let [near, middle, far] = depth_layers::weights(borders, softness, d);
    if flip {
        [far, middle, near]
    } else {
        [near, middle, far]
    }
}

/// How abstract lines are, and how much of a crease is left at full abstraction.
#[derive(Clone, Copy, Debug)]
pub struct Creases {
    /// Abstraction at D = 0 and at D = 1, and the exponent of D between them.
    pub ends: [f64; 2],
    pub exponent: f64,
    pub flip: bool,
    pub left: f64,
    pub by_objects: f64,
}

/// The factor of the opacity of a crease.
pub fn crease_left(s: &Creases, pixel: f64, object: Option<Placed>) -> f64 {
    let d = depth(pixel, object, s.by_objects);
    let by_distance = graded(s.ends, s.exponent, if s.flip { 1.0 - d } else { d });
    let [factor, added] = object.map_or([1.0, 0.0], |object| object.dial);
    let dial = [mix(1.0, factor, s.by_objects), s.by_objects * added];
    lines([1.0, s.left], dialled(by_distance, dial))[1]
}
