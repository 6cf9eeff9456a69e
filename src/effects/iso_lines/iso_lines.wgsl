#define_import_path bevy_comics::effects::iso_lines

// Draws lines of equal depth, height or distance (Saito and Takahashi 1990).

#import bevy_comics::depth::map::is_background
#import bevy_comics::depth::raw::raw_depth
#import bevy_comics::depth::view::{depth_pixel, depth_texel, view}
#ifndef SAME_SIZE
#import bevy_comics::depth::view::last_texel
#endif
#ifdef MAP
#import bevy_comics::depth::map::depth_map
#import bevy_comics::depth::view::depth_frame
#endif
#import bevy_comics::depth::window::minmod
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::lines::edge::line_coverage

const DEPTH: u32 = 0u;
const HEIGHT: u32 = 1u;

struct IsoLines {
    world_from_clip: mat4x4<f32>,
    color: vec3<f32>,
    opacity: f32,
    // The point that distances are measured from.
    center: vec3<f32>,
    // Difference of two neighboring lines.
    step: f32,
    // Half the width of a line, and of every `major`-th, in physical pixels.
    half_width: f32,
    major_half_width: f32,
    major: i32,
    field: u32,
    eye: vec3<f32>,
    // Added to the height; with a WorldOrigin, that to the distance is the distance of the eye.
    offset: f32,
    // The eye from the center in the true world.
    arm: vec3<f32>,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn field_of(s: IsoLines) -> u32 {
#ifdef EFFECT_ISO_LINES_FIELD
    return #{EFFECT_ISO_LINES_FIELD}u;
#else
    return s.field;
#endif
}

// The world position at a place in normalized device coordinates, where the depth texture
// has `d`.
fn iso_place(s: IsoLines, place: vec2<f32>, d: f32) -> vec3<f32> {
    let h = s.world_from_clip * vec4(place, d, 1.0);
    return h.xyz / h.w;
}

// The value at a world position. `map`: the depth map there.
fn iso_value(s: IsoLines, p: vec3<f32>, map: f32) -> f32 {
    let field = field_of(s);
    if field == DEPTH {
        return map;
    }
#ifdef WORLD_ORIGIN
    // The distance less that of the eye: exact also far from the center.
    let by = p - s.eye;
    let more = dot(by, by + 2.0 * s.arm) / (length(s.arm + by) + length(s.arm));
    let from_center = s.offset + more;
#else
    let from_center = distance(p, s.center);
#endif
    return select(from_center, p.y + s.offset, field == HEIGHT);
}

// How exact the value is: a world position is known to about 1e-6 of its coordinates.
fn iso_error(s: IsoLines, p: vec3<f32>) -> f32 {
    let largest = max(abs(p.x), max(abs(p.y), abs(p.z)));
    return select(1e-6 * largest, 1e-6, field_of(s) == DEPTH);
}

// Coverage of the line nearest to a pixel with this value, its change over a pixel, and its
// error.
fn iso_coverage(s: IsoLines, value: f32, change: vec2<f32>, error: f32) -> f32 {
    let u = value / s.step;
    let line = round(u);
    let density = length(change) / s.step;
    // Also where the value is no number.
    if !(density < 0.5) {
        return 0.0;
    }
    let is_major = s.major > 0 && i32(line) % max(s.major, 1) == 0;
    let half_width = select(s.half_width, s.major_half_width, is_major);
    let coverage = line_coverage(abs(u - line) / max(density, 1e-6), half_width);
    // Lines fade where they are closer than 4 pixels, and where the value hardly changes:
    // a floor at the height of a line would be ink.
    let least = max(5e-4, error / s.step);
    return coverage * (1.0 - smoothstep(0.25, 0.5, density)) * smoothstep(least, 4.0 * least, density);
}

#ifdef DEPTH
// The value on the plane through a pixel of the depth texture, `by` pixels from it, and its
// error. `slope`: that of the plane.
fn value_beside(s: IsoLines, at: vec2<i32>, d: f32, slope: vec2<f32>, by: vec2<i32>) -> vec2<f32> {
    let first = vec2<f32>(view.viewport.xy);
    let size = vec2<f32>(view.viewport.zw) * view.depth_scale;
    let texel = vec2<f32>(at + by) + 0.5 - first + view.jitter * view.depth_scale;
    let place = texel / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let beside = d + dot(slope, vec2<f32>(by));
    var map = 0.0;
#ifdef MAP
    map = depth_map(depth_frame(), raw_depth(view.raw, vec2<u32>(at + by), beside)).x;
#endif
    let p = iso_place(s, place, beside);
    return vec2(iso_value(s, p, map), iso_error(s, p));
}

// The slope of the depth at a pixel of the depth texture: of the flatter side, or of the one
// that is neither sky nor outside of the picture.
fn slope_along(at: vec2<i32>, d: f32, step: vec2<i32>, first: vec2<i32>, last: vec2<i32>) -> f32 {
    let low = max(at - step, first);
    let high = min(at + step, last);
    let before = depth_texel(low, 0);
    let after = depth_texel(high, 0);
    let no_before = all(low == at) || is_background(raw_depth(view.raw, vec2<u32>(low), before));
    let no_after = all(high == at) || is_background(raw_depth(view.raw, vec2<u32>(high), after));
    if no_before || no_after {
        return select(select(d - before, after - d, no_before), 0.0, no_before && no_after);
    }
    return minmod(d - before, after - d);
}

fn iso_lines(s: IsoLines, p: Pixel) -> Pixel {
    let at = depth_pixel(vec2<i32>(floor(p.position)));
    let d = depth_texel(at, 0);
    if is_background(raw_depth(view.raw, vec2<u32>(at), d)) {
        return p;
    }
    let first = view.viewport.xy;
    var last = first + view.viewport.zw - 1;
#ifndef SAME_SIZE
    last = last_texel();
#endif
    let slope = vec2(slope_along(at, d, vec2(1, 0), first, last), slope_along(at, d, vec2(0, 1), first, last));
    let change = 0.5 * view.depth_scale * vec2(
        value_beside(s, at, d, slope, vec2(1, 0)).x - value_beside(s, at, d, slope, vec2(-1, 0)).x,
        value_beside(s, at, d, slope, vec2(0, 1)).x - value_beside(s, at, d, slope, vec2(0, -1)).x,
    );
    // From the middle of the texel to the middle of the pixel.
    let texel = (vec2<f32>(at - first) + 0.5) / view.depth_scale + view.jitter;
    let away = p.inside + 0.5 - texel;
    let own = value_beside(s, at, d, slope, vec2(0, 0));
    let value = own.x + dot(change, away);
    let drawn = mix(vec4(p.color, p.alpha), vec4(s.color, 1.0), iso_coverage(s, value, change, own.y) * s.opacity);
    var out = p;
    out.color = drawn.rgb;
    out.alpha = drawn.a;
    return out;
}
#endif
