//! Reference of `toon/detail.wgsl`.

use bevy_comics::toon::DetailAxis;

/// How much detail there is. `at` is the distance from the eye along the view axis or the cosine
/// that the axis asks for.
pub fn detail(axis: DetailAxis, at: f64) -> f64 {
    match axis {
        DetailAxis::Depth { from: near, ratio } => {
            1.0 - (at / f64::from(near)).ln() / f64::from(ratio).ln()
        }
        DetailAxis::Focus {
            distance,
            clear,
            ratio,
        } => {
            let away = (at / f64::from(distance)).ln().abs() - f64::from(clear).ln_1p();
            1.0 - away / f64::from(ratio).ln()
        }
        DetailAxis::Rim { power } => at.abs().powf(f64::from(power)),
        DetailAxis::Highlight { power } => at.max(0.0).powf(f64::from(power)),
        DetailAxis::Constant(detail) => f64::from(detail),
        DetailAxis::VisibleRange => panic!("the range of a view is needed: see `in_range`"),
        _ => panic!("an axis without a reference"),
    }
    .clamp(0.0, 1.0)
}

/// How much detail there is at a distance, between the ends of the visible range.
pub fn in_range(z: f64, near: f64, far: f64) -> f64 {
    (1.0 - (z / near).ln() / (far / near).ln()).clamp(0.0, 1.0)
}
