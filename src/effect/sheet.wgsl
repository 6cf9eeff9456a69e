#define_import_path bevy_comics::effect::sheet

// The surface of the sheet that a page is printed on, and the brush on it. Pure functions.

#import bevy_comics::effect::noise::wave

// Height of the sheet, -1 to 1, as likely below 0 as above: three octaves of value noise,
// with periods of 1.5, 4 and 12. Their grids are turned, against patterns with the grid of
// pixels.
fn sheet_height(at: vec2<f32>, seed: u32) -> f32 {
    let first = 0x70617065u + 3u * seed;
    let fine = wave(vec2(0.8 * at.x - 0.6 * at.y, 0.6 * at.x + 0.8 * at.y) / 1.5, first);
    let middle = wave(vec2(5.0 * at.x - 12.0 * at.y, 12.0 * at.x + 5.0 * at.y) / (13.0 * 4.0), first + 1u);
    let coarse = wave(vec2(15.0 * at.x - 8.0 * at.y, 8.0 * at.x + 15.0 * at.y) / (17.0 * 12.0), first + 2u);
    return clamp(fine + 0.6 * middle + 0.4 * coarse, -1.0, 1.0);
}

// Fraction of the ink that the bristles of a brush leave. `dry`: 0 (wet) to 1 (almost nothing
// is left); `noise`: -1 to 1, streaks along the stroke.
fn bristles(dry: f32, noise: f32) -> f32 {
    let limit = 1.6 * dry - 1.0;
    return smoothstep(limit - 0.3, limit + 0.3, noise);
}
