#define_import_path bevy_comics::stylize::bindings

// The only owner of the bindings of the fused pass and of the outlines' passes,
// and of the #ifdefs that go with them. Everything else is called with values.

#import bevy_comics::depth::map::{DepthFrame, EMPTY}
#import bevy_comics::depth::raw::{RawDepth, raw_depth}
#import bevy_comics::styles::desaturation::Desaturation
#import bevy_comics::styles::colorization::Colorization
#import bevy_comics::styles::contours::Contours
#import bevy_comics::styles::black_flats::BlackFlats
#import bevy_comics::styles::tone_bands::ToneBands
#import bevy_comics::styles::outlines::Outlines
#import bevy_comics::styles::sketch::Sketch
#import bevy_comics::finish::Finish

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
    tone_bands: ToneBands,
    outlines: Outlines,
    sketch: Sketch,
    finish: Finish,
}

// What an object's lines have of their own (objects/style.rs). Slot 0 is an
// object without a style.
struct ObjectStyle {
    color: vec3<f32>,
    // 1: the colour is used.
    has_color: f32,
    // Half of it, physical pixels a logical one; negative: none of its own.
    half_width: f32,
    // Bits of the kinds that are drawn.
    kinds: u32,
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

#ifdef EDGES
// An Edge for every pixel: see outlines.wgsl.
@group(0) @binding(4) var edge_texture: texture_2d<u32>;
#endif
#ifdef FLOOD
// The nearest line of every pixel: see flood.wgsl.
@group(0) @binding(5) var flood_texture: texture_2d<u32>;
#endif
#ifdef OBJECT_STYLES
@group(0) @binding(6) var<storage, read> object_styles: array<ObjectStyle>;
#endif
#ifdef CREASES
#ifdef MULTISAMPLED
@group(0) @binding(7) var normal_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(7) var normal_texture: texture_2d<f32>;
#endif
#endif
#ifdef OBJECT_IDS
#ifdef MULTISAMPLED
@group(0) @binding(8) var object_texture: texture_multisampled_2d<u32>;
#else
@group(0) @binding(8) var object_texture: texture_2d<u32>;
#endif
#endif

#ifdef DEPTH
// The depth texture's pixel of a pixel of the viewport.
fn depth_pixel(pixel: vec2<i32>) -> vec2<i32> {
#ifdef SAME_SIZE
    return pixel;
#endif
    let inside = floor((vec2<f32>(pixel - comics.viewport.xy) + 0.5) * comics.depth_scale);
    return comics.viewport.xy + vec2<i32>(inside);
}

fn sample_count() -> i32 {
#ifdef MULTISAMPLED
    return i32(textureNumSamples(depth_texture));
#else
    return 1;
#endif
}

// Raw depth at a pixel of the viewport; the caller has clamped it.
fn load_depth(pixel: vec2<i32>, sample: i32) -> f32 {
    let at = depth_pixel(pixel);
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

#ifdef CREASES
// World normal of a pixel's first sample; w is 0 where there is none: the sky,
// and whatever is not of unit length within what ten bits blur.
fn load_normal(pixel: vec2<i32>) -> vec4<f32> {
    let n = textureLoad(normal_texture, depth_pixel(pixel), 0).xyz * 2.0 - 1.0;
    let squared = dot(n, n);
    return vec4(n, select(0.0, 1.0, squared >= 0.5 && squared <= 1.5));
}
#endif

#ifdef OBJECT_IDS
// (id, style slot) of the object at a pixel's first sample; id 0: no object.
fn load_object(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(object_texture, depth_pixel(pixel), 0).xy;
}
#endif

// Which kinds of line an object of this style has, as bits.
fn kinds_of(slot: u32) -> u32 {
#ifdef OBJECT_STYLES
    if slot != 0u {
        return object_styles[min(slot, arrayLength(&object_styles) - 1u)].kinds;
    }
#endif
    return 7u;
}
