#define_import_path bevy_comics::effects::iso_lines

// Draws lines of equal depth, height or distance (Saito and Takahashi 1990).

#import bevy_comics::depth::map::{DepthFrame, depth_map, is_background}
#import bevy_comics::depth::raw::raw_depth
#import bevy_comics::depth::view::{depth_frame, depth_pixel, depth_texel, view}
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::lines::edge::line_coverage

const DEPTH: u32 = 0u;
const HEIGHT: u32 = 1u;

struct IsoLines {
    world_from_clip: mat4x4<f32>,
    color: vec3<f32>,
    opacity: f32,
    // The point that distances are measured from.
    centre: vec3<f32>,
    // Difference of two neighbouring lines.
    step: f32,
    // Half the width of a line, and of every `major`-th, in physical pixels.
    half_width: f32,
    major_half_width: f32,
    major: i32,
    field: u32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn field_of(s: IsoLines) -> u32 {
#ifdef ISO_LINES_FIELD
    return #{ISO_LINES_FIELD}u;
#else
    return s.field;
#endif
}

// The value at a place in normalized device coordinates, where the depth texture has
// `d`. `map`: the depth map there.
fn iso_value(s: IsoLines, place: vec2<f32>, d: f32, map: f32) -> f32 {
    let field = field_of(s);
    if field == DEPTH {
        return map;
    }
    let h = s.world_from_clip * vec4(place, d, 1.0);
    let p = h.xyz / h.w;
    return select(distance(p, s.centre), p.y, field == HEIGHT);
}

// Coverage of the line nearest to a pixel with this value, and its change over a pixel.
fn iso_coverage(s: IsoLines, value: f32, change: vec2<f32>) -> f32 {
    let u = value / s.step;
    let line = round(u);
    let density = length(change) / s.step;
    let is_major = s.major > 0 && i32(line) % max(s.major, 1) == 0;
    let half_width = select(s.half_width, s.major_half_width, is_major);
    let coverage = line_coverage(abs(u - line) / max(density, 1e-6), half_width);
    // Lines fade where they are closer than 4 pixels, and where the value hardly changes:
    // a floor at the height of a line would be ink.
    return coverage * (1.0 - smoothstep(0.25, 0.5, density)) * smoothstep(5e-4, 2e-3, density);
}

// The smaller of two slopes of the same sign, otherwise 0: that of the plane through a pixel.
fn flatter(before: f32, after: f32) -> f32 {
    if (before > 0.0) != (after > 0.0) {
        return 0.0;
    }
    return select(after, before, abs(before) < abs(after));
}

#ifdef MAP
// The value on the plane through a pixel of the depth texture, `by` pixels from it. `slope`:
// that of the plane.
fn value_beside(s: IsoLines, frame: DepthFrame, at: vec2<i32>, d: f32, slope: vec2<f32>, by: vec2<i32>) -> f32 {
    let first = vec2<f32>(view.viewport.xy);
    let size = vec2<f32>(view.viewport.zw) * view.depth_scale;
    let place = (vec2<f32>(at + by) + 0.5 - first) / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let beside = d + dot(slope, vec2<f32>(by));
    let map = depth_map(frame, raw_depth(view.raw, vec2<u32>(at + by), beside)).x;
    return iso_value(s, place, beside, map);
}

fn iso_lines(s: IsoLines, p: Pixel) -> Pixel {
    let frame = depth_frame();
    let at = depth_pixel(vec2<i32>(floor(p.position)));
    let d = depth_texel(at, 0);
    if is_background(raw_depth(view.raw, vec2<u32>(at), d)) {
        return p;
    }
    let first = view.viewport.xy;
    let last = first + vec2<i32>(ceil(vec2<f32>(view.viewport.zw) * view.depth_scale)) - 1;
    let west = depth_texel(vec2(max(at.x - 1, first.x), at.y), 0);
    let east = depth_texel(vec2(min(at.x + 1, last.x), at.y), 0);
    let north = depth_texel(vec2(at.x, max(at.y - 1, first.y)), 0);
    let south = depth_texel(vec2(at.x, min(at.y + 1, last.y)), 0);
    let slope = vec2(flatter(d - west, east - d), flatter(d - north, south - d));
    let change = 0.5 * view.depth_scale * vec2(
        value_beside(s, frame, at, d, slope, vec2(1, 0)) - value_beside(s, frame, at, d, slope, vec2(-1, 0)),
        value_beside(s, frame, at, d, slope, vec2(0, 1)) - value_beside(s, frame, at, d, slope, vec2(0, -1)),
    );
    let value = value_beside(s, frame, at, d, slope, vec2(0, 0));
    let drawn = mix(vec4(p.color, p.alpha), vec4(s.color, 1.0), iso_coverage(s, value, change) * s.opacity);
    var out = p;
    out.color = drawn.rgb;
    out.alpha = drawn.a;
    return out;
}
#endif
