#define_import_path bevy_comics::stylize::bindings

// The only owner of the fused pass's bindings and of the #ifdefs that go with
// them. Everything else is called with values.

#import bevy_comics::depth::map::{DepthFrame, EMPTY}
#import bevy_comics::depth::raw::{RawDepth, raw_depth}
#import bevy_comics::styles::desaturation::Desaturation
#import bevy_comics::styles::colorization::Colorization
#import bevy_comics::styles::contours::Contours
#import bevy_comics::styles::black_flats::BlackFlats

// Uniform structs inside a struct must start at multiples of 16 bytes, so each
// of them is a multiple of 16 bytes long.
struct Comics {
    // Origin and size of the viewport in pixels.
    viewport: vec4<i32>,
    // Depth pixels per colour pixel (1 unless the main pass has a resolution
    // of its own).
    depth_scale: vec2<f32>,
    // 1: near and far of the depth map change places for the colours.
    flip: u32,
    raw: RawDepth,
    depth: DepthFrame,
    desaturation: Desaturation,
    colorization: Colorization,
    contours: Contours,
    black_flats: BlackFlats,
}

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var<uniform> comics: Comics;
#ifdef DEPTH
#ifdef MULTISAMPLED
@group(0) @binding(2) var depth_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(2) var depth_texture: texture_2d<f32>;
#endif
#endif
#ifdef VISIBLE_RANGE
// (key of the nearest, key of the farthest): see range.wgsl.
@group(0) @binding(3) var<uniform> range_keys: vec4<u32>;
#endif

#ifdef DEPTH
fn sample_count() -> i32 {
#ifdef MULTISAMPLED
    return i32(textureNumSamples(depth_texture));
#else
    return 1;
#endif
}

// Raw depth at a pixel of the viewport; the caller has clamped it.
fn load_depth(pixel: vec2<i32>, sample: i32) -> f32 {
    let inside = floor((vec2<f32>(pixel - comics.viewport.xy) + 0.5) * comics.depth_scale);
    let at = comics.viewport.xy + vec2<i32>(inside);
#ifdef MULTISAMPLED
    let d = textureLoad(depth_texture, at, sample).r;
#else
    let d = textureLoad(depth_texture, at, 0).r;
#endif
    return raw_depth(comics.raw, vec2<u32>(at), d);
}

// The range that the depth map spans in this frame.
fn depth_frame() -> DepthFrame {
    var frame = comics.depth;
#ifdef VISIBLE_RANGE
    frame.near = bitcast<f32>(range_keys.x);
    frame.far = bitcast<f32>(0u - range_keys.y);
    if range_keys.x == 0u {
        frame.flags |= EMPTY;
    }
#endif
    return frame;
}
#endif
