//! Reference of `lines/memory/memory.wgsl`: how lines remember the frames before.

/// The number of frames in the memory, this one included.
pub fn frames_at(before: f64, share: f64, speed: f64) -> f64 {
    let most = if speed > 0.05 { 1.0 / share } else { 128.0 };
    most.min(before + 1.0)
}

/// The number of frames in a row in which the memory was not between the ink nearby.
pub fn missing_at(before: f64, is_missing: bool) -> f64 {
    if is_missing { before + 1.0 } else { 0.0 }
}

/// How unsteady the nearest surface is, by whether it has changed.
pub fn unsteady_at(before: f64, has_changed: bool, speed: f64) -> f64 {
    if speed > 0.05 {
        0.0
    } else if has_changed {
        (before + 16.0).min(48.0)
    } else {
        (before - 1.0).max(0.0)
    }
}

/// Whether a change of the nearest surface means that something has come or gone.
pub fn is_steady(unsteady: f64) -> bool {
    unsteady <= 32.0
}

/// Whether the memory is limited to the ink nearby: in motion, or after two rounds of eight offsets.
pub fn is_limited(missing: f64, speed: f64) -> bool {
    missing > 16.0 || speed > 0.05
}

/// The fraction of this frame where lines move by `speed` pixels per frame.
pub fn share_at(frames: f64, speed: f64) -> f64 {
    (1.0 / frames.max(1.0) + speed / 4.0).min(1.0)
}

/// Weights of four texels at a fraction from the second one: the cubic polynomials whose values
/// and slopes at the inner two are those of Catmull and Rom (1974).
pub fn cubic_weights(f: f64) -> [f64; 4] {
    // Hermite's basis.
    let start = (1.0 - f).powi(2) * (1.0 + 2.0 * f);
    let end = f * f * (3.0 - 2.0 * f);
    let leaving = f * (1.0 - f).powi(2);
    let arriving = f * f * (f - 1.0);
    [
        -0.5 * leaving,
        start - 0.5 * arriving,
        end + 0.5 * leaving,
        0.5 * arriving,
    ]
}

/// Ink of one kind; `nearby`: the least and the largest ink nearby in this frame.
pub fn remembered(past: f64, now: f64, nearby: [f64; 2], share: f64) -> f64 {
    let kept = past.max(nearby[0]).min(nearby[1]);
    kept * (1.0 - share) + now * share
}
