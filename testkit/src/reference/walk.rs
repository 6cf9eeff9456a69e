//! Twin of `lines/walk.wgsl`: the bounds below which there is no crack.

/// Bounds are this much lower than where ink begins.
pub const BELOW: f64 = 0.999;

/// Whether a step may have the ink of a silhouette. `low` is the response at which ink
/// begins, `k` that of \[CL\] Eq. 2, `near` the larger of both raw depths.
pub fn may_be_silhouette([low, k]: [f64; 2], excess: f64, reference: f64, near: f64) -> bool {
    near > 0.0 && excess > BELOW * 2.0 * k * low.sqrt() * reference
}

/// Whether a fold may have the ink of a crease.
pub fn may_be_crease([low, k]: [f64; 2], fold: f64) -> bool {
    fold > BELOW * 4.0 * k * k * low
}
