#define_import_path bevy_comics::depth::histogram

// The 256 bins in which the reduction counts depths, from far (0) to near (255). Pure
// functions.
//
// In perspective a bin is an eighth of an octave of raw depth, so that its width is a
// fraction of the distance. Under an orthographic projection raw depth is proportional
// to distance, and what is visible may fill a tiny part of [0, 1]. There the bins divide
// a window, the visible range of the last frame.

const BINS: u32 = 256u;

struct Histogram {
    bins: array<u32, 256>,
    total: u32,
    // Bits of the window in whose bins an orthographic view was counted.
    window_near: u32,
    window_far: u32,
}

// An octave bin is the exponent and the upper three bits of the mantissa of a raw
// depth: 32 octaves. The farthest bin also counts everything beyond.
const FIRST_OCTAVE_BIN: u32 = 761u;
const OCTAVE_BIN_WIDTH: u32 = 1048576u;

fn octave_bin(bits: u32) -> u32 {
    return clamp(bits >> 20u, FIRST_OCTAVE_BIN, FIRST_OCTAVE_BIN + BINS - 1u) - FIRST_OCTAVE_BIN;
}

// Bits of the depth at the nearer edge of an octave bin.
fn octave_edge(bin: u32) -> u32 {
    return (bin + FIRST_OCTAVE_BIN + 1u) << 20u;
}

// Raw depths of the near and the far end of the window, and the factor that maps half
// of it to 1.
struct DepthWindow {
    near: f32,
    far: f32,
    factor: f32,
}

// `bits`: of the near and the far end. Both are 0 before the first frame: then all
// depths are in the nearest bin.
fn depth_window(bits: vec2<u32>) -> DepthWindow {
    let ends = bitcast<vec2<f32>>(bits);
    return DepthWindow(ends.x, ends.y, 2.0 / max(ends.x - ends.y, 1e-30));
}

// The bin of a depth. In each half of the window the depths at the edges of the bins are
// i^2 / 128^2 of the half from its end: percentiles are near the ends, so the bins are
// fine there. The outermost bins also count what is outside of the window.
fn window_bin(w: DepthWindow, d: f32) -> u32 {
    let from_near = max(w.near - d, 0.0) * w.factor;
    let from_far = max(d - w.far, 0.0) * w.factor;
    let i = u32(min(128.0 * sqrt(min(from_near, from_far)), 127.0));
    return select(i, BINS - 1u - i, from_near < from_far);
}

// The depth between bin - 1 and bin, for bins 0 to 256.
fn window_edge(w: DepthWindow, bin: u32) -> f32 {
    let far_half = bin <= BINS / 2u;
    let i = f32(select(BINS - bin, bin, far_half)) / 128.0;
    let from_end = 0.5 * i * i * (w.near - w.far);
    return select(w.near - from_end, w.far + from_end, far_half);
}

// (far, near) end of a bin in raw depth. `near` and `far` are the extremes of the
// counted depths, which end the outermost bins.
fn window_bin_ends(w: DepthWindow, bin: u32, near: f32, far: f32) -> vec2<f32> {
    let low = max(window_edge(w, bin), far);
    let high = min(window_edge(w, bin + 1u), near);
    return vec2(select(low, far, bin == 0u), select(high, near, bin == BINS - 1u));
}
