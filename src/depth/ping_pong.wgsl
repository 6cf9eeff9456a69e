#define_import_path bevy_comics::depth::ping_pong

// The reduction as a chain of fragment passes, which needs no compute shaders
// ([CS] 3.1). Even columns hold the key of the nearest depth, odd columns that of the
// farthest. Every pass halves the number of rows and of column pairs, down to a
// texture of (2, 1). An odd number is rounded up: the last row or column pair is then
// read twice, which does not change the maximum. T0 is the depth texture.

#import bevy_comics::depth::raw::{RangeView, raw_depth_key}

#ifdef FIRST
#ifdef MULTISAMPLED
@group(0) @binding(0) var depth_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(0) var depth_texture: texture_2d<f32>;
#endif
@group(0) @binding(1) var<uniform> view: RangeView;
#else
@group(0) @binding(0) var keys: texture_2d<u32>;
#endif

#ifdef FIRST
fn depth_key(pixel: vec2<u32>, farthest: bool) -> u32 {
    var best = 0u;
#ifdef MULTISAMPLED
    let samples = #{SAMPLES};
    for (var s = 0; s < samples; s++) {
        let bits = raw_depth_key(view.raw, pixel, textureLoad(depth_texture, vec2<i32>(pixel), s).r);
        best = max(best, select(bits, 0u - bits, farthest && bits != 0u));
    }
#else
    let bits = raw_depth_key(view.raw, pixel, textureLoad(depth_texture, vec2<i32>(pixel), 0).r);
    best = select(bits, 0u - bits, farthest && bits != 0u);
#endif
    return best;
}

// T0 -> T1: both columns of a pair read the same 2 x 2 depths.
@fragment
fn reduce(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let at = vec2<u32>(position.xy);
    let farthest = (at.x & 1u) == 1u;
    let last = view.rect.zw - 1u;
    let block = vec2(at.x & ~1u, at.y * 2u);
    var best = 0u;
    for (var i = 0u; i < 4u; i++) {
        let pixel = view.rect.xy + min(block + vec2(i & 1u, i >> 1u), last);
        best = max(best, depth_key(pixel, farthest));
    }
    return vec4(best, 0u, 0u, 0u);
}
#else
// Tn -> Tn+1: column pair m of row y reads pairs 2m and 2m + 1 of rows 2y and 2y + 1.
@fragment
fn reduce(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let at = vec2<u32>(position.xy);
    let size = textureDimensions(keys);
    let last = vec2(size.x / 2u - 1u, size.y - 1u);
    let parity = at.x & 1u;
    let block = vec2((at.x / 2u) * 2u, at.y * 2u);
    var best = 0u;
    for (var i = 0u; i < 4u; i++) {
        let source = min(block + vec2(i & 1u, i >> 1u), last);
        best = max(best, textureLoad(keys, vec2<i32>(vec2(source.x * 2u + parity, source.y)), 0).r);
    }
    return vec4(best, 0u, 0u, 0u);
}
#endif
