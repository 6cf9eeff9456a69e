#define_import_path bevy_comics::styles::contours

#import bevy_comics::depth::map::{DepthFrame, EMPTY, depth_step, has, is_background, spread_divisor}

const PREWITT: u32 = 0u;
const SOBEL: u32 = 1u;
const LAPLACE: u32 = 2u;
const ROBERTS: u32 = 3u;

struct Contours {
    color: vec3<f32>,
    opacity: f32,
    // The response at which a line begins to show, and where it is full.
    low: f32,
    high: f32,
    // Half the line's width in physical pixels.
    radius: f32,
    // Share of the opacity that is gone at the far end of the depth map.
    fade: f32,
    operator_kind: u32,
    faithful: u32,
}

// Depths around a pixel, row by row; outside the viewport `centre` is repeated
// and the bit of `missing` is set.
struct Window {
    nw: f32, n: f32, ne: f32,
    w: f32, centre: f32, e: f32,
    sw: f32, s: f32, se: f32,
    missing: u32,
}

const MISSING_W: u32 = 1u;
const MISSING_E: u32 = 2u;
const MISSING_N: u32 = 4u;
const MISSING_S: u32 = 8u;

// What each neighbour's depth map has over its reference.
struct Steps {
    nw: f32, n: f32, ne: f32,
    w: f32, e: f32,
    sw: f32, s: f32, se: f32,
}

// The slope limiter: the smaller of two slopes that agree in sign, else none.
fn minmod(a: f32, b: f32) -> f32 {
    if (a > 0.0) != (b > 0.0) {
        return 0.0;
    }
    return select(b, a, abs(a) < abs(b));
}

// How far behind the farthest geometry the sky lies: a gap behind D = 1, which
// the farthest reaches wherever the range is not below its floor.
fn gap_behind(f: DepthFrame, gap: f32) -> f32 {
    return gap + (1.0 - (f.near - f.far) / spread_divisor(f));
}

// D(d) - D(p), where the sky lies a gap behind the farthest geometry. No branch:
// the sky's depth is the far end, and the gap is added.
fn step_from(f: DepthFrame, gap: f32, d: f32, p: f32, p_is_sky: bool) -> f32 {
    let d_is_sky = is_background(d);
    let behind = select(0.0, gap, d_is_sky) - select(0.0, gap, p_is_sky);
    return depth_step(f, select(d, f.far, d_is_sky), select(p, f.far, p_is_sky)) + behind;
}

// Two opposite neighbours against the plane through the centre. Raw depth is
// affine over a plane, in perspective too, so the plane goes on with the
// smaller of the two slopes and a flat surface answers zero at any angle.
fn plane_pair(f: DepthFrame, gap: f32, before: f32, c: f32, after: f32) -> vec2<f32> {
    let sky = is_background(c);
    var slope = 0.0;
    if !sky {
        let no_before = is_background(before);
        let no_after = is_background(after);
        let back = c - before;
        let ahead = after - c;
        if !no_before && !no_after {
            slope = minmod(back, ahead);
        } else if no_before && !no_after {
            slope = ahead;
        } else if no_after && !no_before {
            slope = back;
        }
    }
    return vec2(
        step_from(f, gap, before, c - slope, sky),
        step_from(f, gap, after, c + slope, sky),
    );
}

// A pair of which one side lies outside the viewport says nothing: the border
// of the picture is no contour.
fn plane_steps(f: DepthFrame, gap: f32, win: Window) -> Steps {
    var steps: Steps;
    let across = (win.missing & (MISSING_W | MISSING_E)) == 0u;
    let along = (win.missing & (MISSING_N | MISSING_S)) == 0u;
    if across {
        let h = plane_pair(f, gap, win.w, win.centre, win.e);
        steps.w = h.x;
        steps.e = h.y;
    }
    if along {
        let v = plane_pair(f, gap, win.n, win.centre, win.s);
        steps.n = v.x;
        steps.s = v.y;
    }
    if across && along {
        let a = plane_pair(f, gap, win.nw, win.centre, win.se);
        let b = plane_pair(f, gap, win.ne, win.centre, win.sw);
        steps.nw = a.x;
        steps.se = a.y;
        steps.ne = b.x;
        steps.sw = b.y;
    }
    return steps;
}

// The plain differences of the depth map, slopes included, as [CS] draws them.
fn map_steps(f: DepthFrame, gap: f32, win: Window) -> Steps {
    let c = win.centre;
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

fn prewitt(s: Steps) -> f32 {
    return length(vec2((s.ne + s.e + s.se) - (s.nw + s.w + s.sw), (s.sw + s.s + s.se) - (s.nw + s.n + s.ne)));
}

fn sobel(s: Steps) -> f32 {
    return length(vec2(
        (s.ne + 2.0 * s.e + s.se) - (s.nw + 2.0 * s.w + s.sw),
        (s.sw + 2.0 * s.s + s.se) - (s.nw + 2.0 * s.n + s.ne),
    ));
}

fn laplace(s: Steps) -> f32 {
    return abs(s.nw + s.n + s.ne + s.w + s.e + s.sw + s.s + s.se);
}

// The raw kernels of [CS] on the depth map: a straight step of height h answers
// 3h (Prewitt, Laplace), 4h (Sobel), sqrt(2) h (Roberts).
fn faithful_response(f: DepthFrame, gap: f32, operator_kind: u32, win: Window) -> f32 {
    let s = map_steps(f, gap, win);
    if operator_kind == SOBEL {
        return sobel(s);
    }
    if operator_kind == LAPLACE {
        return laplace(s);
    }
    if operator_kind == ROBERTS {
        return length(vec2(s.se, s.e - s.s));
    }
    return prewitt(s);
}

// The same kernels on departures from the local plane, scaled so that a
// straight step answers with its height, whichever the operator.
fn plane_response(f: DepthFrame, gap: f32, operator_kind: u32, win: Window) -> f32 {
    let s = plane_steps(f, gap, win);
    if operator_kind == SOBEL {
        return sobel(s) / 4.0;
    }
    if operator_kind == LAPLACE {
        return laplace(s) / 3.0;
    }
    if operator_kind == ROBERTS {
        return length(vec2(s.se - s.nw, s.sw - s.ne)) / 1.41421356;
    }
    return prewitt(s) / 3.0;
}

fn contour_response(s: Contours, f: DepthFrame, win: Window) -> f32 {
    if has(f, EMPTY) {
        return 0.0;
    }
    if s.faithful != 0u {
        return faithful_response(f, gap_behind(f, f.sky_gap), s.operator_kind, win);
    }
    return plane_response(f, gap_behind(f, f.sky_gap), s.operator_kind, win);
}

// How much of a line there is at this response.
fn line(s: Contours, response: f32) -> f32 {
    return smoothstep(s.low, s.high, response);
}

fn nearest_depth(win: Window) -> f32 {
    let row = max(max(win.nw, win.n), max(win.ne, win.w));
    return max(max(row, win.centre), max(max(win.e, win.sw), max(win.s, win.se)));
}

// Ink over the picture, in linear light. The line fades with the depth of the
// nearer side, to which it belongs.
fn draw_contour(s: Contours, linear: vec3<f32>, coverage: f32, depth: f32) -> vec3<f32> {
    return mix(linear, s.color, clamp(coverage * s.opacity * (1.0 - s.fade * depth), 0.0, 1.0));
}
