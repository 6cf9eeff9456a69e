#define_import_path bevy_comics::stylize::taps

// Reads the neighbourhoods that the styles ask for.

#ifdef DEPTH
#import bevy_comics::stylize::bindings::{comics, load_depth, sample_count}
#import bevy_comics::depth::map::{DepthFrame, depth_map}
#import bevy_comics::styles::contours::{
    Contours, Window, PREWITT,
    MISSING_W, MISSING_E, MISSING_N, MISSING_S,
    contour_response, faithful_response, gap_behind, line, nearest_depth,
}

// (D, L) of a pixel, the mean of its samples, as its colour is theirs.
fn pixel_depth(frame: DepthFrame, pixel: vec2<i32>) -> vec2<f32> {
#ifdef MULTISAMPLED
    var sum = vec2(0.0);
    let samples = sample_count();
    for (var s = 0; s < samples; s++) {
        sum += depth_map(frame, load_depth(pixel, s));
    }
    return sum / f32(samples);
#else
    return depth_map(frame, load_depth(pixel, 0));
#endif
}

// The depths at `reach` pixels around one; what lies outside the viewport is
// read at its border and marked.
fn window(pixel: vec2<i32>, reach: i32, sample: i32) -> Window {
    let first = comics.viewport.xy;
    let last = first + comics.viewport.zw - 1;
    let low = pixel - reach;
    let high = pixel + reach;
    let a = max(low, first);
    let b = min(high, last);
    var win: Window;
    win.centre = load_depth(pixel, sample);
    win.nw = load_depth(a, sample);
    win.n = load_depth(vec2(pixel.x, a.y), sample);
    win.ne = load_depth(vec2(b.x, a.y), sample);
    win.w = load_depth(vec2(a.x, pixel.y), sample);
    win.e = load_depth(vec2(b.x, pixel.y), sample);
    win.sw = load_depth(vec2(a.x, b.y), sample);
    win.s = load_depth(vec2(pixel.x, b.y), sample);
    win.se = load_depth(b, sample);
    win.missing = select(0u, MISSING_W, low.x < first.x) | select(0u, MISSING_E, high.x > last.x)
        | select(0u, MISSING_N, low.y < first.y) | select(0u, MISSING_S, high.y > last.y);
    return win;
}

// (line, nearest raw depth) of one sample with the taps `reach` pixels away,
// which makes a line of 2 * reach pixels. Wide lines look at rings in between
// as well, or thin objects would fall through.
fn ring_line(s: Contours, frame: DepthFrame, pixel: vec2<i32>, reach: i32, sample: i32) -> vec2<f32> {
    var found = vec2(0.0);
#ifdef SINGLE_RING
    let win = window(pixel, reach, sample);
    return vec2(line(s, contour_response(s, frame, win)), nearest_depth(win));
#endif
    for (var r = reach; r > 0; r -= 2) {
        let win = window(pixel, r, sample);
        found = max(found, vec2(line(s, contour_response(s, frame, win)), nearest_depth(win)));
    }
    return found;
}

// (coverage, D of the nearer side) of the contours at a pixel. A width between
// two whole reaches is a mix of both: over the samples where there are several,
// which anti-aliases the line itself, else of two lines.
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
#ifndef WHOLE_CONTOURS
    if part > 0.0 {
        let outer = ring_line(s, frame, pixel, whole + 1, 0);
        found = vec2(mix(inner.x, max(inner.x, outer.x), part), max(inner.y, outer.y));
    }
#endif
#endif
#ifdef STEADY_CONTOURS
    return vec2(found.x, 0.0);
#endif
    return vec2(found.x, depth_map(frame, found.y).x);
}

// The Prewitt response of the depth map, slopes and all, per pixel.
fn slope(frame: DepthFrame, pixel: vec2<i32>) -> f32 {
    return faithful_response(frame, gap_behind(frame, 0.0), PREWITT, window(pixel, 1, 0));
}
#endif
