#define_import_path bevy_comics::effects::contours

// Draws lines where the depth map jumps ([CS] 3.2).

#import bevy_comics::depth::map::{DepthFrame, EMPTY, depth_map, has, is_background}
#import bevy_comics::depth::view::{depth_frame, load_window, sample_count}
#ifndef SAME_SIZE
#import bevy_comics::depth::view::{load_texel_window, tap_distances, view}
#endif
#import bevy_comics::depth::window::{
    MISSING_E, MISSING_N, MISSING_S, MISSING_W, Steps, Window, gap_behind, map_steps, minmod, nearest_depth, prewitt, step_from,
}
#import bevy_comics::effect::pixel::Pixel

const PREWITT: u32 = 0u;
const SOBEL: u32 = 1u;
const LAPLACE: u32 = 2u;
const ROBERTS: u32 = 3u;

struct Contours {
    color: vec3<f32>,
    opacity: f32,
    // The response at which a line begins, and at which it is complete.
    low: f32,
    high: f32,
    // Half the line's width in physical pixels.
    radius: f32,
    // Fraction of the opacity that is lost at the far end of the depth map.
    opacity_fade: f32,
    operator_kind: u32,
}

// The slope of the plane through the center, from two opposite neighbors at the same
// distance: raw depth per this distance. Raw depth is affine over a plane, in perspective
// too. The plane is continued by the smaller of the two slopes, so the steps on a flat
// surface are 0 at any angle.
fn plane_slope(before: f32, c: f32, after: f32) -> f32 {
    if is_background(c) {
        return 0.0;
    }
    let no_before = is_background(before);
    let no_after = is_background(after);
    let back = c - before;
    let ahead = after - c;
    if !no_before && !no_after {
        return minmod(back, ahead);
    }
    if no_before && no_after {
        return 0.0;
    }
    return select(back, ahead, no_before);
}

// The steps of two opposite neighbors over the plane through the center: (before,
// after), in units of the depth map.
fn plane_pair(f: DepthFrame, gap: f32, before: f32, c: f32, after: f32) -> vec2<f32> {
    let sky = is_background(c);
    let slope = plane_slope(before, c, after);
    return vec2(
        step_from(f, gap, before, c - slope, sky),
        step_from(f, gap, after, c + slope, sky),
    );
}

// The steps of all eight neighbors over local planes. A pair with one side outside
// the viewport is left at 0: the border of the picture is no contour.
fn plane_steps(f: DepthFrame, gap: f32, win: Window) -> Steps {
    var steps: Steps;
    let across = (win.missing & (MISSING_W | MISSING_E)) == 0u;
    let along = (win.missing & (MISSING_N | MISSING_S)) == 0u;
    if across {
        let h = plane_pair(f, gap, win.w, win.center, win.e);
        steps.w = h.x;
        steps.e = h.y;
    }
    if along {
        let v = plane_pair(f, gap, win.n, win.center, win.s);
        steps.n = v.x;
        steps.s = v.y;
    }
    if across && along {
        let a = plane_pair(f, gap, win.nw, win.center, win.se);
        let b = plane_pair(f, gap, win.ne, win.center, win.sw);
        steps.nw = a.x;
        steps.se = a.y;
        steps.ne = b.x;
        steps.sw = b.y;
    }
    return steps;
}

// The same where the taps of opposite neighbors are at different distances from the
// center, some of them 0: (west, north, east, south). `slope` is that of the plane per
// unit of distance, across and down.
fn uneven_plane_steps(f: DepthFrame, gap: f32, win: Window, distances: vec4<f32>, slope: vec2<f32>) -> Steps {
    var steps: Steps;
    let across = (win.missing & (MISSING_W | MISSING_E)) == 0u;
    let along = (win.missing & (MISSING_N | MISSING_S)) == 0u;
    let c = win.center;
    let sky = is_background(c);
    let low = -distances.xy * slope;
    let high = distances.zw * slope;
    if across {
        steps.w = step_from(f, gap, win.w, c + low.x, sky);
        steps.e = step_from(f, gap, win.e, c + high.x, sky);
    }
    if along {
        steps.n = step_from(f, gap, win.n, c + low.y, sky);
        steps.s = step_from(f, gap, win.s, c + high.y, sky);
    }
    if across && along {
        steps.nw = step_from(f, gap, win.nw, c + low.x + low.y, sky);
        steps.se = step_from(f, gap, win.se, c + high.x + high.y, sky);
        steps.ne = step_from(f, gap, win.ne, c + high.x + low.y, sky);
        steps.sw = step_from(f, gap, win.sw, c + low.x + high.y, sky);
    }
    return steps;
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

// The kernels applied to the depth map itself. The response to a straight step of
// height h is 3h (Prewitt, Laplace), 4h (Sobel) or sqrt(2) h (Roberts) ([CS] 3.2).
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

// The same kernels applied to departures from the local plane, scaled so that the
// response to a straight step of height h is h for every operator.
fn scaled_response(operator_kind: u32, s: Steps) -> f32 {
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

// A constant where the pass defines it: see has() in map.wgsl.
fn operator_of(s: Contours) -> u32 {
#ifdef EFFECT_CONTOURS_OPERATOR
    return #{EFFECT_CONTOURS_OPERATOR}u;
#else
    return s.operator_kind;
#endif
}

fn contour_response(s: Contours, f: DepthFrame, win: Window) -> f32 {
    if has(f, EMPTY) {
        return 0.0;
    }
    let gap = gap_behind(f, f.sky_gap);
#ifdef EFFECT_CONTOURS_FAITHFUL
    return faithful_response(f, gap, operator_of(s), win);
#else
    return scaled_response(operator_of(s), plane_steps(f, gap, win));
#endif
}

// Strength of the line at this response, 0 to 1.
fn line(s: Contours, response: f32) -> f32 {
    return smoothstep(s.low, s.high, response);
}

// Draws ink over the picture, a color in linear light that is multiplied by its
// opacity, and the opacity. `depth` is D of the nearer side, which the line belongs to:
// the line fades with it.
fn draw_contour(s: Contours, picture: vec4<f32>, coverage: f32, depth: f32) -> vec4<f32> {
    return mix(picture, vec4(s.color, 1.0), clamp(coverage * s.opacity * (1.0 - s.opacity_fade * depth), 0.0, 1.0));
}

#ifdef SAME_SIZE
// (line, nearest raw depth) of one sample, with the taps `reach` pixels away.
fn tap_line(s: Contours, frame: DepthFrame, pixel: vec2<i32>, reach: i32, sample: i32) -> vec2<f32> {
    let win = load_window(pixel, reach, sample);
    return vec2(line(s, contour_response(s, frame, win)), nearest_depth(win));
}
#else
// The same where several pixels of the picture read one pixel of the depth texture. The
// taps stay where they are, so that lines keep their width, but slopes are those between
// pixels of the depth texture: between the taps, a slope would be a staircase.
fn tap_line(s: Contours, frame: DepthFrame, pixel: vec2<i32>, reach: i32, sample: i32) -> vec2<f32> {
#ifdef EFFECT_CONTOURS_FAITHFUL
    // Slopes have lines, so the whole window lies on the depth texture.
    let texels = max(i32(round(f32(reach) * view.depth_scale.y)), 1);
    let win = load_texel_window(pixel, texels, sample);
    return vec2(line(s, contour_response(s, frame, win)), nearest_depth(win));
#else
    let win = load_window(pixel, reach, sample);
    if has(frame, EMPTY) {
        return vec2(0.0, nearest_depth(win));
    }
    let distances = tap_distances(pixel, reach);
    let farther = max(distances.xy, distances.zw);
    let slope = vec2(
        texel_slope(load_texel_window(pixel, farther.x, sample), farther).x,
        texel_slope(load_texel_window(pixel, farther.y, sample), farther).y,
    );
    let gap = gap_behind(frame, frame.sky_gap);
    let steps = uneven_plane_steps(frame, gap, win, vec4<f32>(distances), slope);
    return vec2(line(s, scaled_response(operator_of(s), steps)), nearest_depth(win));
#endif
}

// The slope of the plane per pixel of the depth texture, across and down, from a window
// whose taps are at this distance. Where one side is outside of the viewport, the plane
// continues with the slope of the other side.
fn texel_slope(win: Window, distance: vec2<i32>) -> vec2<f32> {
    let w = select(win.w, 0.0, (win.missing & MISSING_W) != 0u);
    let e = select(win.e, 0.0, (win.missing & MISSING_E) != 0u);
    let n = select(win.n, 0.0, (win.missing & MISSING_N) != 0u);
    let s = select(win.s, 0.0, (win.missing & MISSING_S) != 0u);
    let slope = vec2(plane_slope(w, win.center, e), plane_slope(n, win.center, s));
    return slope / vec2<f32>(max(distance, vec2(1)));
}
#endif

// (line, nearest raw depth) of one sample, with the taps `reach` pixels away, which
// makes a line of 2 * reach pixels. Wide lines also use the rings in between, every
// two pixels; without them, thin objects would be missed.
fn ring_line(s: Contours, frame: DepthFrame, pixel: vec2<i32>, reach: i32, sample: i32) -> vec2<f32> {
    var found = vec2(0.0);
#ifdef EFFECT_CONTOURS_SINGLE_RING
    return tap_line(s, frame, pixel, reach, sample);
#endif
    for (var r = reach; r > 0; r -= 2) {
        found = max(found, tap_line(s, frame, pixel, r, sample));
    }
    return found;
}

// (coverage, D of the nearer side) of the contours at a pixel. If the radius is not
// a whole number, the two nearest reaches are mixed. With MSAA, each sample uses one
// of the two, which also anti-aliases the line; otherwise two lines are blended.
fn contour(s: Contours, frame: DepthFrame, pixel: vec2<i32>) -> vec2<f32> {
    let whole = i32(floor(s.radius));
    let part = s.radius - floor(s.radius);
    var found = vec2(0.0);
#ifdef MULTISAMPLED
    let samples = sample_count();
    for (var i = 0; i < samples; i++) {
        let wider = part * f32(samples) > f32(i) + 0.5;
        let one = ring_line(s, frame, pixel, whole + select(0, 1, wider), i);
        found = vec2(found.x + one.x / f32(samples), max(found.y, one.y));
    }
#else
    let inner = ring_line(s, frame, pixel, whole, 0);
    found = inner;
#ifndef EFFECT_CONTOURS_WHOLE
    if part > 0.0 {
        let outer = ring_line(s, frame, pixel, whole + 1, 0);
        found = vec2(mix(inner.x, max(inner.x, outer.x), part), max(inner.y, outer.y));
    }
#endif
#endif
#ifdef EFFECT_CONTOURS_STEADY
    return vec2(found.x, 0.0);
#endif
    return vec2(found.x, depth_map(frame, found.y).x);
}

fn contours(s: Contours, p: Pixel) -> Pixel {
    var out = p;
    let found = contour(s, depth_frame(), vec2<i32>(p.position));
    let drawn = draw_contour(s, vec4(p.color, p.alpha), found.x, found.y);
    out.color = drawn.rgb;
    out.alpha = drawn.a;
    return out;
}
