//! Reference of `toon/proxy.wgsl`.

use super::{mix, stylized_highlight::unit};

/// A normal between two, `amount` from 0 to 1.
pub fn between(normal: [f64; 3], other: [f64; 3], amount: f64) -> [f64; 3] {
    let mixed: [f64; 3] = std::array::from_fn(|c| mix(normal[c], other[c], amount));
    let long = mixed.iter().map(|x| x * x).sum::<f64>().sqrt();
    if amount <= 0.0 || long < 1e-3 {
        return normal;
    }
    unit(mixed)
}

/// Normal of the ellipsoid with these half sizes, through a place relative to its centre: the
/// gradient of its implicit function.
pub fn ellipsoid_normal(place: [f64; 3], half: [f64; 3]) -> [f64; 3] {
    let f = |p: [f64; 3]| (0..3).map(|c| (p[c] / half[c]).powi(2)).sum::<f64>();
    let step = 1e-4;
    unit(std::array::from_fn(|c| {
        let (mut low, mut high) = (place, place);
        low[c] -= step;
        high[c] += step;
        (f(high) - f(low)) / (2.0 * step)
    }))
}
