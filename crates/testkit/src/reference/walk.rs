//! Reference of `lines/find/walk.wgsl`: the bounds below which there is no crack.

/// Bounds are this much lower than where ink begins.
pub const BELOW: f64 = 0.999;

/// The part of the ramp of the ink whose ink is 0 after rounding to eight bits.
pub const INVISIBLE: f64 = 0.0257;

/// The response between the ends of the ramp of the ink at which ink is visible.
pub fn visible([low, high]: [f64; 2]) -> f64 {
    low + INVISIBLE * (high - low)
}

/// Whether a step may have the ink of a silhouette. `least` is the response at which ink
/// is visible, `k` that of \[CL\] Eq. 2, `near` the larger of both raw depths.
pub fn may_be_silhouette([least, k]: [f64; 2], excess: f64, reference: f64, near: f64) -> bool {
    near > 0.0 && excess > BELOW * 2.0 * k * least.sqrt() * reference
}

/// Whether a fold may have the ink of a crease.
pub fn may_be_crease([least, k]: [f64; 2], fold: f64) -> bool {
    fold > BELOW * 4.0 * k * k * least
}
