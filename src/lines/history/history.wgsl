#define_import_path bevy_comics::lines::history

// How lines are blended with the frames before, under temporal anti-aliasing. Pure functions.

struct History {
    // Fraction of this frame where lines move; 1: there is no history.
    blend_factor: f32,
    // Pixels of the grid between the depths that are compared.
    spacing: i32,
    // Frames for which tiles are drawn that have no cracks any more; 0: there is no history.
    tile_frames: u32,
    unused: u32,
}

// Faster lines are as sharp as without a history, in pixels per frame.
const FASTEST: f32 = 4.0;
// Slower lines stand still.
const STILL: f32 = 0.05;
// Frames that the history of lines that stand still is the mean of: some rounds of the engine's
// offsets.
const LONGEST: f32 = 128.0;

// Frames that a line of a still view may be missing in: two rounds of the engine's offsets. Some
// edges are only found at some of the offsets.
const MISSING: f32 = 16.0;

// The number of frames in a row in which the history was not between the least and the largest ink
// nearby. `is_missing`: whether it is not in this frame.
fn missing_at(before: f32, is_missing: bool) -> f32 {
    return select(0.0, before + 1.0, is_missing);
}

// Whether the history is limited to the ink nearby in this frame: where lines move, or have been
// missing for long.
fn is_limited(missing: f32, speed: f32) -> bool {
    return missing > MISSING || speed > STILL;
}

// How unsteady the nearest surface is: more with every change, less with every frame without one.
// Surfaces narrower than a pixel come and go with the engine's offsets.
fn unsteady_at(before: f32, has_changed: bool, speed: f32) -> f32 {
    let now = select(max(before - 1.0, 0.0), min(before + MISSING, 3.0 * MISSING), has_changed);
    return select(now, 0.0, speed > STILL);
}

// Whether a change means that something has come or gone: not the third one in a short time.
fn is_steady(unsteady: f32) -> bool {
    return unsteady <= 2.0 * MISSING;
}

// Three whole numbers in one, and back: frames in the history, frames with missing lines, and
// how unsteady the nearest surface is.
fn pack_counts(frames: f32, missing: f32, unsteady: f32) -> f32 {
    return floor(frames) + 256.0 * (missing + 32.0 * unsteady);
}

fn unpack_counts(packed: f32) -> vec3<f32> {
    let upper = floor(packed / 256.0);
    let unsteady = floor(upper / 32.0);
    return vec3(packed - 256.0 * upper, upper - 32.0 * unsteady, unsteady);
}

// The number of frames in the history, this one included, from that of the last frame. Where
// lines move, there are fewer.
fn frames_at(before: f32, blend_factor: f32, speed: f32) -> f32 {
    return min(before + 1.0, select(LONGEST, 1.0 / blend_factor, speed > STILL));
}

// The fraction of this frame where lines move by `speed` pixels per frame.
fn blend_factor_at(frames: f32, speed: f32) -> f32 {
    return min(1.0 / max(frames, 1.0) + speed / FASTEST, 1.0);
}

// Weights of four texels in a row at a place between the inner two, a fraction `f` from the
// second one: Catmull-Rom. Lines that are read between texels in every frame stay sharp, where
// bilinear weights would spread them.
fn cubic_weights(f: f32) -> vec4<f32> {
    return vec4(
        f * (-0.5 + f * (1.0 - 0.5 * f)),
        1.0 + f * f * (-2.5 + 1.5 * f),
        f * (0.5 + f * (2.0 - 1.5 * f)),
        f * f * (-0.5 + 0.5 * f),
    );
}

// Ink of three kinds from that in the history and that of this frame. The history is limited to
// `least` and `most`.
fn accumulated(past: vec3<f32>, now: vec3<f32>, least: vec3<f32>, most: vec3<f32>, blend_factor: f32) -> vec3<f32> {
    return mix(clamp(past, least, most), now, blend_factor);
}
