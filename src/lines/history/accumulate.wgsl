// Mixes the ink of this frame with that of the frames before, under temporal anti-aliasing:
// the engine moves depth by a part of a pixel in every frame, so lines, which follow the
// borders of pixels, move too. Only the tiles with ink are drawn; elsewhere, there is no
// history.

#import bevy_comics::depth::view::{set_view, texel_depth}
#import bevy_comics::lines::edge::{decode_ink, encode_ink, is_in_front}
#import bevy_comics::lines::history::{
    accumulated, blend_factor_at, cubic_weights, frames_at, is_limited, is_steady, missing_at,
    pack_counts, unpack_counts, unsteady_at,
}
#import bevy_comics::lines::pass::line_pass

// Ink of this frame, see draw.wgsl.
@group(0) @binding(23) var ink_texture: texture_2d<f32>;
// The engine's motion vectors: by how much each pixel of the grid has moved, in parts of the
// viewport.
@group(0) @binding(24) var motion_texture: texture_2d<f32>;
// Ink of the last frame, and of each of its pixels the nearest raw depth around it and three
// numbers, see pack_counts.
@group(0) @binding(25) var past_ink: texture_2d<f32>;
@group(0) @binding(26) var past_depth: texture_2d<f32>;

struct Accumulated {
    @location(0) ink: vec4<f32>,
    @location(1) nearest: vec2<f32>,
}

// The depths around a pixel.
struct Around {
    // The nearest of 3 x 3.
    nearest: f32,
    // The nearest of 5 x 5, and its pixel.
    wide: f32,
    pixel: vec2<i32>,
}

// The depths around a pixel of the grid, some pixels apart.
fn depths_around(center: vec2<i32>) -> Around {
    let rect = line_pass.grid.rect;
    var around = Around(0.0, -1.0, vec2(0));
    for (var i = 0; i < 25; i++) {
        let offset = vec2(i % 5 - 2, i / 5 - 2);
        let at = rect.xy + clamp(center + line_pass.history.spacing * offset, vec2(0), rect.zw - 1);
        let d = texel_depth(at, 0);
        let beside = max(abs(offset.x), abs(offset.y)) < 2;
        around.nearest = max(around.nearest, select(0.0, d, beside));
        around.pixel = select(around.pixel, at, d > around.wide);
        around.wide = max(around.wide, d);
    }
    return around;
}

fn past_texel(p: vec2<i32>) -> vec3<f32> {
    let last = line_pass.seen.viewport.zw - 1;
    return decode_ink(textureLoad(past_ink, clamp(p, vec2(0), last), 0).xyz);
}

// The ink of the last frame at a place: bicubic.
fn past_at(place: vec2<f32>) -> vec3<f32> {
    let corner = floor(place - 0.5);
    let f = place - 0.5 - corner;
    if all(f == vec2(0.0)) {
        // Nothing moves: all other weights are 0.
        return past_texel(vec2<i32>(corner));
    }
    let across = cubic_weights(f.x);
    let down = cubic_weights(f.y);
    var sum = vec3(0.0);
    for (var i = 0; i < 16; i++) {
        let offset = vec2(i & 3, i >> 2u);
        let weight = across[offset.x] * down[offset.y];
        sum += weight * past_texel(vec2<i32>(corner) + offset - 1);
    }
    return sum;
}

// The nearest raw depth around a pixel of the last frame, as wide as `wide` of depths_around.
fn past_nearest(p: vec2<i32>) -> f32 {
    let last = line_pass.seen.viewport.zw - 1;
    let far = max(vec2<i32>(round(f32(line_pass.history.spacing) / line_pass.grid.from_viewport.xy)), vec2(1));
    var nearest = 0.0;
    for (var i = 0; i < 4; i++) {
        let corner = vec2(2 * (i & 1) - 1, 2 * (i >> 1u) - 1);
        nearest = max(nearest, textureLoad(past_depth, clamp(p + far * corner, vec2(0), last), 0).x);
    }
    return nearest;
}

// The jump in raw depth that separates two surfaces.
fn jump_at(d: f32) -> f32 {
    let s = line_pass.settings;
    return s.jump * (s.reference_factor * d + s.reference_constant);
}

// Ink that rounding may change.
const ROUNDING: f32 = 0.01;

@fragment
fn accumulate(@builtin(position) position: vec4<f32>) -> Accumulated {
    set_view(line_pass.seen);
    let g = line_pass.grid;
    let size = line_pass.seen.viewport.zw;
    let pixel = vec2<i32>(position.xy);
    let texel = textureLoad(ink_texture, pixel, 0);
    let now = decode_ink(texel.xyz);
    var least = now;
    var most = now;
    for (var i = 0; i < 9; i++) {
        let p = clamp(pixel + vec2(i % 3 - 1, i / 3 - 1), vec2(0), size - 1);
        let beside = decode_ink(textureLoad(ink_texture, p, 0).xyz);
        least = min(least, beside);
        most = max(most, beside);
    }
    let center = vec2<i32>(floor(position.xy * g.from_viewport.xy + g.from_viewport.zw));
    let around = depths_around(center);
    let moved = textureLoad(motion_texture, around.pixel, 0).xy * vec2<f32>(size);
    let place = position.xy - moved;
    let seen = all(place >= vec2(0.0)) && all(place < vec2<f32>(size));
    let from_pixel = clamp(vec2<i32>(floor(place)), vec2(0), size - 1);
    let before = textureLoad(past_depth, from_pixel, 0).xy;
    let speed = length(moved);
    // What stood there in the last frame has gone.
    let uncovered = is_in_front(before.x, around.wide, jump_at(before.x));
    // Something else has come before it, or what was around it has gone.
    let past_wide = past_nearest(from_pixel);
    let covered = is_in_front(around.nearest, past_wide, jump_at(around.nearest));
    let vanished = is_in_front(past_wide, around.wide, jump_at(past_wide));
    let exists = seen && line_pass.history.blend_factor < 1.0;
    var counted = select(vec3(0.0), unpack_counts(before.y), exists);
    let unsteady = unsteady_at(counted.z, covered || uncovered || vanished, speed);
    let steady = is_steady(unsteady);
    counted = select(counted, vec3(0.0), uncovered && steady);
    let frames = frames_at(counted.x, line_pass.history.blend_factor, speed);
    let past = past_at(place);
    let outside = any(past < least - ROUNDING) || any(past > most + ROUNDING);
    let missing = missing_at(counted.y, outside);
    // The sky is still while the camera moves.
    let sky = around.wide <= 0.0;
    let limited = is_limited(missing, speed) || (steady && (covered || vanished || sky));
    let low = select(vec3(0.0), least, limited);
    let high = select(vec3(1.0), most, limited);
    let ink = accumulated(past, now, low, high, blend_factor_at(frames, speed));
    let count = pack_counts(frames, select(missing, 0.0, limited), unsteady);
    // The slot of the strongest line of this frame; where it has none, that of the last one.
    let slot = select(textureLoad(past_ink, from_pixel, 0).w, texel.w, any(now > vec3(0.0)));
    return Accumulated(vec4(encode_ink(ink), slot), vec2(around.nearest, count));
}
