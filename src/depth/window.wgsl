#define_import_path bevy_comics::depth::window

// Differences of the depth map in a window of 3 x 3 depths. Pure functions.

#import bevy_comics::depth::map::{DepthFrame, EMPTY, depth_step, has, is_background, spread_divisor}

// Raw depths around a pixel, row by row. Where a side is outside of the viewport, its
// bit of `missing` is set and its depths are those of the viewport's border.
struct Window {
    nw: f32, n: f32, ne: f32,
    w: f32, center: f32, e: f32,
    sw: f32, s: f32, se: f32,
    missing: u32,
}

const MISSING_W: u32 = 1u;
const MISSING_E: u32 = 2u;
const MISSING_N: u32 = 4u;
const MISSING_S: u32 = 8u;

// Difference of D between each neighbor and its reference, which is the center or a
// plane through it.
struct Steps {
    nw: f32, n: f32, ne: f32,
    w: f32, e: f32,
    sw: f32, s: f32, se: f32,
}

// Slope limiter: the smaller of two slopes of the same sign, otherwise 0.
fn minmod(a: f32, b: f32) -> f32 {
    if (a > 0.0) != (b > 0.0) {
        return 0.0;
    }
    return select(b, a, abs(a) < abs(b));
}

// Difference of D between the farthest geometry and the sky, which is at D = 1 + gap.
// The farthest geometry is at D = 1, or below that if the range is below its floor.
fn gap_behind(f: DepthFrame, gap: f32) -> f32 {
    return gap + (1.0 - (f.near - f.far) / spread_divisor(f));
}

// D(d) - D(p), with the sky `gap` behind the farthest geometry. Without a branch: the
// sky's depth is replaced by the far end, and the gap is added.
fn step_from(f: DepthFrame, gap: f32, d: f32, p: f32, p_is_sky: bool) -> f32 {
    let d_is_sky = is_background(d);
    let behind = select(0.0, gap, d_is_sky) - select(0.0, gap, p_is_sky);
    return depth_step(f, select(d, f.far, d_is_sky), select(p, f.far, p_is_sky)) + behind;
}

// Differences to the center. They include slopes, as in [CS].
fn map_steps(f: DepthFrame, gap: f32, win: Window) -> Steps {
    let c = win.center;
    let sky = is_background(c);
    return Steps(
        step_from(f, gap, win.nw, c, sky),
        step_from(f, gap, win.n, c, sky),
        step_from(f, gap, win.ne, c, sky),
        step_from(f, gap, win.w, c, sky),
        step_from(f, gap, win.e, c, sky),
        step_from(f, gap, win.sw, c, sky),
        step_from(f, gap, win.s, c, sky),
        step_from(f, gap, win.se, c, sky),
    );
}

// Length of the Prewitt gradient.
fn prewitt(s: Steps) -> f32 {
    return length(vec2((s.ne + s.e + s.se) - (s.nw + s.w + s.sw), (s.sw + s.s + s.se) - (s.nw + s.n + s.ne)));
}

// Prewitt response of the depth map in a window. It includes slopes. The sky counts as
// the far end of the range. A view without geometry has no range, and no slope.
fn window_slope(f: DepthFrame, win: Window) -> f32 {
    if has(f, EMPTY) {
        return 0.0;
    }
    return prewitt(map_steps(f, gap_behind(f, 0.0), win));
}

// The largest raw depth of a window, which is that of the nearest geometry.
fn nearest_depth(win: Window) -> f32 {
    let row = max(max(win.nw, win.n), max(win.ne, win.w));
    return max(max(row, win.center), max(max(win.e, win.sw), max(win.s, win.se)));
}
