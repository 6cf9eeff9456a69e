//! Twin of `lines/memory.wgsl`: how lines remember the frames before.

/// The number of frames in the memory, this one included.
pub fn frames_at(before: f64, share: f64, speed: f64) -> f64 {
    let most = if speed > 0.05 { 1.0 / share } else { 128.0 };
    most.min(before + 1.0)
}

/// The fraction of this frame where lines move by `speed` pixels per frame.
pub fn share_at(frames: f64, speed: f64) -> f64 {
    (1.0 / frames.max(1.0) + speed / 8.0).min(1.0)
}

/// Ink of one kind; `nearby`: the least and the largest ink nearby in this frame.
pub fn remembered(past: f64, now: f64, nearby: [f64; 2], share: f64) -> f64 {
    let kept = past.max(nearby[0]).min(nearby[1]);
    kept * (1.0 - share) + now * share
}
