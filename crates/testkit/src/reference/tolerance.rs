//! Reference of `objects/depth_test/tolerance.wgsl`.

/// Largest distance of two depths of one surface: rounding moves it by 2^-12 of its depth, in
/// orthographic views by 2^-22, and across the screen by a sixteenth of a pixel. Samples are up to
/// half a pixel from the middle, so with several of them, it is three quarters. `slope`: the change of
/// depth over a pixel in x and in y, added up.
pub fn tolerance(nearest: f64, slope: f64, multisampled: bool) -> f64 {
    let pixels = if multisampled { 0.75 } else { 1.0 / 16.0 };
    nearest / 4096.0 + 1.0 / 4_194_304.0 + pixels * slope
}

/// Whether a fragment is what the depth prepass shows; there is nothing at depth 0.
pub fn is_near(drawn: f64, found: f64, slope: f64, multisampled: bool) -> bool {
    let apart = (drawn - found).abs();
    found > 0.0 && apart <= tolerance(drawn.max(found), slope, multisampled)
}
