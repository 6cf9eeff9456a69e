//! How hard the pen presses at a place of an object. `tests/gpu/pressure.rs` compares the factors
//! that are drawn with this reference.

use bevy_comics_testkit::reference::pressure::nested_wave;

/// Truth: the mean of the noise is 0 and its deviation the same at all levels, and a step of
/// 5 % of the level's length changes it by at most pi / 2 * sqrt(2) * log2(1.05).
#[test]
fn nested_noise_has_the_same_variance_at_all_levels() {
    let places: Vec<[f64; 3]> = (0..20_000)
        .map(|i| {
            let t = f64::from(i);
            [0.731 * t, 1.913 * t % 977.0, 3.177 * t % 1013.0]
        })
        .collect();
    let bound = std::f64::consts::FRAC_PI_2 * 2f64.sqrt() * 1.05f64.log2() + 1e-9;
    // Of uniform numbers, 1 / sqrt(3), interpolated along three axes: (26 / 35)^(3 / 2) of it.
    let want = (26.0f64 / 35.0).powf(1.5) / 3f64.sqrt();
    for step in 0..15 {
        let [level, next] = [step, step + 1].map(|step| 1.05f64.powi(step).log2());
        let values: Vec<f64> = places.iter().map(|p| nested_wave(*p, level, 7)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        assert!(mean.abs() < 0.02, "{step}: {mean}");
        let deviation = square.sqrt();
        assert!(
            (deviation / want - 1.0).abs() < 0.04,
            "{step}: {deviation}, {want}"
        );
        for (place, value) in places.iter().zip(&values) {
            let change = (nested_wave(*place, next, 7) - value).abs();
            assert!(change < bound, "{step}, {place:?}: {change}");
        }
    }
}
