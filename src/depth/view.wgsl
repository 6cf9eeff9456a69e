#define_import_path bevy_comics::depth::view

// The view and its depth: the only module that declares bindings 2 (depth) and 3
// (visible range). An entry point calls set_view() first, with the view of its own
// uniform, because passes have different uniforms.

#import bevy_comics::depth::map::{DepthFrame, EMPTY, depth_map}
#import bevy_comics::depth::raw::{RawDepth, raw_depth}
#import bevy_comics::depth::window::{MISSING_E, MISSING_N, MISSING_S, MISSING_W, Window, window_slope}

// Its size is a multiple of 16 bytes, as WGSL requires of a struct inside a uniform.
struct View {
    // Origin and size of the viewport: x, y, width, height in physical pixels.
    viewport: vec4<i32>,
    // Pixels of the depth texture per physical pixel of the viewport: 1 unless the
    // main pass has another resolution.
    depth_scale: vec2<f32>,
    // 1: DepthMap::flip is set.
    flip: u32,
    // Raw depth from which on the picture may show a Backdrop; 0: there is none.
    backdrop: f32,
    // What belongs at a place is drawn by this much before it, in physical pixels of the viewport: the jitter of
    // temporal anti-aliasing.
    jitter: vec2<f32>,
    // A surface is in front of another one by this much raw depth: x * that of the other one + y.
    nearer: vec2<f32>,
    raw: RawDepth,
    depth: DepthFrame,
}

var<private> view: View;

fn set_view(drawn: View) {
    view = drawn;
}

// A pixel of the target, clamped to the viewport.
fn inside_viewport(pixel: vec2<i32>) -> vec2<i32> {
    let first = view.viewport.xy;
    return clamp(pixel, first, first + view.viewport.zw - 1);
}

#ifdef DEPTH
#ifdef MULTISAMPLED
@group(0) @binding(2) var depth_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(2) var depth_texture: texture_2d<f32>;
#endif
#endif
struct VisibleRange {
    // xy: of the nearest and the farthest depth, see range.wgsl. zw: see borders.wgsl.
    keys: vec4<u32>,
    // x: see middle.wgsl.
    middle: vec4<f32>,
}
#ifdef VISIBLE_RANGE
@group(0) @binding(3) var<uniform> visible_range: VisibleRange;
#else ifdef DEPTH_BORDERS
@group(0) @binding(3) var<uniform> visible_range: VisibleRange;
#else ifdef MIDDLE_DEPTH
@group(0) @binding(3) var<uniform> visible_range: VisibleRange;
#endif

// The pixel of the depth texture that belongs to a pixel of the viewport.
fn depth_pixel(pixel: vec2<i32>) -> vec2<i32> {
#ifdef SAME_SIZE
    return pixel;
#endif
    let inside = floor((vec2<f32>(pixel - view.viewport.xy) + 0.5) * view.depth_scale);
    return view.viewport.xy + vec2<i32>(inside);
}

#ifdef DEPTH
fn sample_count() -> i32 {
#ifdef MULTISAMPLED
    return #{SAMPLES};
#else
    return 1;
#endif
}

// Raw depth at a pixel, which must be inside the viewport.
fn load_depth(pixel: vec2<i32>, sample: i32) -> f32 {
    return texel_depth(depth_pixel(pixel), sample);
}

// The texel of the depth texture at a pixel of it.
fn depth_texel(at: vec2<i32>, sample: i32) -> f32 {
#ifdef MULTISAMPLED
    return textureLoad(depth_texture, at, sample).r;
#else
    return textureLoad(depth_texture, at, 0).r;
#endif
}

// Whether something is drawn at a pixel of the depth texture that counts as sky: its normal and id do not
// count either. See DepthMap::sky_beyond.
fn is_drawn_sky(at: vec2<i32>) -> bool {
    return texel_depth(at, 0) <= 0.0;
}

// Raw depth at a pixel of the depth texture.
fn texel_depth(at: vec2<i32>, sample: i32) -> f32 {
    return raw_depth(view.raw, vec2<u32>(at), depth_texel(at, sample));
}
#endif

// The depth map of this frame: with the visible range, if that is what it spans.
fn depth_frame() -> DepthFrame {
    var frame = view.depth;
#ifdef VISIBLE_RANGE
    // The ends may be subnormal, which arithmetic flushes to 0: then the map would divide
    // 0 by 0.
    let keys = visible_range.keys;
    frame.near = max(bitcast<f32>(keys.x), 1.1754944e-38);
    frame.far = max(bitcast<f32>(0u - keys.y), 1.1754944e-38);
    if keys.x == 0u {
        frame.flags |= EMPTY;
    }
#endif
    return frame;
}

#ifdef DEPTH_BORDERS
// D at the border between near and middle and at that between middle and far; -1 if none are
// known.
fn depth_borders(frame: DepthFrame) -> vec2<f32> {
    if visible_range.keys.z == 0u {
        return vec2(-1.0);
    }
    let ends = bitcast<vec2<f32>>(visible_range.keys.zw);
    return vec2(depth_map(frame, ends.x).x, depth_map(frame, ends.y).x);
}
#endif

#ifdef MIDDLE_DEPTH
// Raw depth in the middle of the view, smoothed over time.
fn middle_depth() -> f32 {
    return visible_range.middle.x;
}
#endif

#ifdef DEPTH
// (D, L) of a pixel: the mean over its samples, because its color is their mean too.
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

// The window whose corners are the pixels `low` and `high` of the depth texture.
fn read_window(low: vec2<i32>, center: vec2<i32>, high: vec2<i32>, sample: i32) -> Window {
    var win: Window;
    win.center = texel_depth(center, sample);
    win.nw = texel_depth(low, sample);
    win.n = texel_depth(vec2(center.x, low.y), sample);
    win.ne = texel_depth(vec2(high.x, low.y), sample);
    win.w = texel_depth(vec2(low.x, center.y), sample);
    win.e = texel_depth(vec2(high.x, center.y), sample);
    win.sw = texel_depth(vec2(low.x, high.y), sample);
    win.s = texel_depth(vec2(center.x, high.y), sample);
    win.se = texel_depth(high, sample);
    return win;
}

// The sides of a window with these corners that lie outside of a rectangle.
fn missing_sides(low: vec2<i32>, high: vec2<i32>, first: vec2<i32>, last: vec2<i32>) -> u32 {
    return select(0u, MISSING_W, low.x < first.x) | select(0u, MISSING_E, high.x > last.x)
        | select(0u, MISSING_N, low.y < first.y) | select(0u, MISSING_S, high.y > last.y);
}

// The depths of a pixel and of its eight neighbors `reach` pixels away. Positions
// outside of the viewport are clamped to its border and marked in `missing`.
fn load_window(pixel: vec2<i32>, reach: i32, sample: i32) -> Window {
    let first = view.viewport.xy;
    let last = first + view.viewport.zw - 1;
    let low = pixel - reach;
    let high = pixel + reach;
    var win = read_window(depth_pixel(max(low, first)), depth_pixel(pixel), depth_pixel(min(high, last)), sample);
    win.missing = missing_sides(low, high, first, last);
    return win;
}

#ifndef SAME_SIZE
// The last pixel of the depth texture that the main pass draws.
fn last_texel() -> vec2<i32> {
    let size = vec2<i32>(round(vec2<f32>(view.viewport.zw) * view.depth_scale));
    return view.viewport.xy + max(size, vec2(1)) - 1;
}

// The window of load_window on the pixels of the depth texture: `reach` of them around
// the one that belongs to a pixel of the viewport.
fn load_texel_window(pixel: vec2<i32>, reach: i32, sample: i32) -> Window {
    let first = view.viewport.xy;
    let last = last_texel();
    let center = depth_pixel(pixel);
    let low = center - reach;
    let high = center + reach;
    var win = read_window(max(low, first), center, min(high, last), sample);
    win.missing = missing_sides(low, high, first, last);
    return win;
}

// Distances from the center of load_window to its taps, in pixels of the depth texture:
// x, y to the west and north, z, w to the east and south. 0 where a tap reads the same
// pixel of the depth texture as the center.
fn tap_distances(pixel: vec2<i32>, reach: i32) -> vec4<i32> {
    let center = depth_pixel(pixel);
    let low = depth_pixel(inside_viewport(pixel - reach));
    let high = depth_pixel(inside_viewport(pixel + reach));
    return vec4(center - low, high - center);
}
#endif

// Prewitt response of the depth map per pixel, see window_slope().
fn map_slope(frame: DepthFrame, pixel: vec2<i32>) -> f32 {
#ifdef SAME_SIZE
    return window_slope(frame, load_window(pixel, 1, 0));
#else
    // Neighboring pixels of the picture can read one pixel of the depth texture.
    return window_slope(frame, load_texel_window(pixel, 1, 0)) * view.depth_scale.y;
#endif
}
#endif
