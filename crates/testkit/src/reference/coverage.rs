//! Reference of `lines/draw/coverage.wgsl`: fractions of pixels that drawn lines cover.

/// Length in pixels of the ramp of coverage across a line with this direction.
pub fn line_ramp(along: [f64; 2]) -> f64 {
    let length = along[0].hypot(along[1]).max(1e-6);
    (along[0].abs().max(along[1].abs()) / length).clamp(SHORTEST_RAMP, 1.0)
}

/// That of a diagonal.
const SHORTEST_RAMP: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The coverage by a straight line: the overlap of [-half width, half width] and of an interval of
/// the length of the ramp, divided by this length.
pub fn straight_coverage(distance: f64, half_width: f64, ramp: f64) -> f64 {
    let low = (distance - 0.5 * ramp).max(-half_width);
    let high = (distance + 0.5 * ramp).min(half_width);
    (high - low).max(0.0) / ramp
}

/// The coverage by a disc around the middle of a line: the least of straight lines in all
/// directions.
pub fn disc_coverage(distance: f64, half_width: f64) -> f64 {
    let at = |ramp| straight_coverage(distance, half_width, ramp);
    at(1.0).min(at(SHORTEST_RAMP))
}

/// The coverage by a segment, or by a dot. Pixels that are up to 0.43 of its length before or
/// behind a segment count as beside it, from 0.57 as beside a dot, and between in proportion.
pub fn segment_coverage(at: [f64; 2], a: [f64; 2], b: [f64; 2], half_width: f64) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let from = [at[0] - a[0], at[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let t = (from[0] * along[0] + from[1] * along[1]) / square.max(1e-12);
    let nearest = t.clamp(0.0, 1.0);
    let away = [from[0] - nearest * along[0], from[1] - nearest * along[1]];
    let distance = away[0].hypot(away[1]);
    let beside = straight_coverage(distance, half_width, line_ramp(along));
    let dot = straight_coverage(distance, half_width, line_ramp(away)).min(2.0 * half_width);
    if square == 0.0 {
        return dot;
    }
    let beyond = (nearest - t).abs();
    let part = ((beyond - 0.43) / (0.57 - 0.43)).clamp(0.0, 1.0);
    (1.0 - part) * beside + part * dot
}
