#define_import_path bevy_comics::objects

// Which object is seen where, and what its lines have of their own: the only
// owner of bindings 6 (styles of objects) and 8 (ids).

#import bevy_comics::depth::view::depth_pixel

// What an object's lines have of their own (objects/table.rs). Slot 0 is an
// object without a style.
struct ObjectStyle {
    color: vec3<f32>,
    // 1: the colour is used.
    has_color: f32,
    // Half width in logical pixels; negative if the object does not override it.
    half_width: f32,
    // Bits of the kinds that are drawn.
    kinds: u32,
}

#ifdef OBJECT_STYLES
@group(0) @binding(6) var<storage, read> object_styles: array<ObjectStyle>;
#endif
#ifdef OBJECT_IDS
#ifdef MULTISAMPLED
@group(0) @binding(8) var object_texture: texture_multisampled_2d<u32>;
#else
@group(0) @binding(8) var object_texture: texture_2d<u32>;
#endif
#endif

#ifdef OBJECT_IDS
// (id, style slot) of the object at a pixel's first sample; id 0: no object.
fn load_object(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(object_texture, depth_pixel(pixel), 0).xy;
}
#endif

#ifdef OBJECT_STYLES
fn style_of(slot: u32) -> ObjectStyle {
    return object_styles[min(slot, arrayLength(&object_styles) - 1u)];
}
#endif

// Which kinds of line an object of this style has, as bits.
fn kinds_of(slot: u32) -> u32 {
#ifdef OBJECT_STYLES
    if slot != 0u {
        return style_of(slot).kinds;
    }
#endif
    return 7u;
}
