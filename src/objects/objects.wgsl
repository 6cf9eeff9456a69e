#define_import_path bevy_comics::objects

// Object ids and outline styles of objects: the only module that declares bindings 6
// (styles), 8 (ids), 9 (factors of the width of lines) and 32 (depths of objects).

#import bevy_comics::depth::view::depth_pixel
#ifdef WIDTH_MAP
#import bevy_comics::objects::pressure::loaded_factor
#endif

// An outline style: ObjectStyleUniform of objects/table.rs. Slot 0 of the table is for
// objects without a style.
struct ObjectStyle {
    color: vec3<f32>,
    // 1: the style overrides the color; 0: it does not.
    has_color: f32,
    // Half width in logical pixels; negative if the style does not override it.
    half_width: f32,
    // Kinds that are drawn: bit 0 silhouettes, bit 1 creases, bit 2 object edges; bit 3: the
    // color effects leave the object alone.
    kinds: u32,
    // Factor of the opacity of all lines.
    opacity: f32,
    // World units per unit of an object that screens follow, 0: they do not; its center and
    // rotation (a quaternion) in world space.
    anchor_size: f32,
    anchor_center: vec3<f32>,
    unused: f32,
    anchor_rotation: vec4<f32>,
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

#ifdef WIDTH_MAP
#ifdef MULTISAMPLED
@group(0) @binding(9) var width_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(9) var width_texture: texture_2d<f32>;
#endif

// How the factor of the width of lines at a pixel and sample of the prepass textures is stored.
fn width_texel(at: vec2<i32>, sample: i32) -> f32 {
    return textureLoad(width_texture, at, sample).x;
}

// The factor itself, 0 to 2.
fn texel_width(at: vec2<i32>, sample: i32) -> f32 {
    return loaded_factor(width_texel(at, sample));
}
#endif

#ifdef OBJECT_IDS
// The object at a pixel and sample of the prepass textures: its id, 0 if there is none, and
// its slot and section: bits 0 to 7 are the slot of its style, bits 8 to 15 its section.
fn texel_object(at: vec2<i32>, sample: i32) -> vec2<u32> {
    return textureLoad(object_texture, at, sample).xy;
}

// (id, style slot) of the object at a pixel's first sample.
fn load_object(pixel: vec2<i32>) -> vec2<u32> {
    return texel_object(depth_pixel(pixel), 0) & vec2(65535u, 255u);
}

// The slot of the style of the object at a pixel and sample of the prepass textures.
fn texel_slot(at: vec2<i32>, sample: i32) -> u32 {
    return texel_object(at, sample).y & 255u;
}
#endif

#ifdef OBJECT_STYLES
// The style in a slot, which is clamped to the table.
fn style_of(slot: u32) -> ObjectStyle {
    return object_styles[min(slot, arrayLength(&object_styles) - 1u)];
}
#endif

#ifdef OBJECT_DEPTHS
@group(0) @binding(32) var<storage, read> object_depths: array<vec4<f32>>;

// Where the object with this id is in the depth map: D of its center, and how much its pixels
// follow it, 0 to 1: 0 for what extends far in depth, and for unknown objects.
fn object_depth(id: u32) -> vec2<f32> {
    let entry = object_depths[min(id, arrayLength(&object_depths) - 1u)];
    return vec2(entry.x - 1.0, select(0.0, entry.y, entry.x > 0.0));
}

// The simplification of the object with this id: a factor of that by distance, and what is added.
fn object_simplification(id: u32) -> vec2<f32> {
    let entry = object_depths[min(id, arrayLength(&object_depths) - 1u)];
    return select(vec2(1.0, 0.0), entry.zw, entry.x > 0.0);
}

// D at a sample of a pixel of the target, and where that shows an object which is treated as a whole,
// D of this object's center.
fn whole_depth(pixel: vec2<i32>, sample: i32, d: f32) -> f32 {
    let found = object_depth(texel_object(depth_pixel(pixel), sample).x);
    return mix(d, found.x, found.y);
}
#endif

#ifdef UNSTYLED
// The fraction of a pixel's samples that show objects which the color effects leave alone.
fn unstyled_fraction(pixel: vec2<i32>) -> f32 {
    let at = depth_pixel(pixel);
#ifdef MULTISAMPLED
    let samples = #{SAMPLES};
    var found = 0u;
    for (var s = 0; s < samples; s++) {
        found += (style_of(texel_slot(at, s)).kinds >> 3u) & 1u;
    }
    return f32(found) / f32(samples);
#else
    return f32((style_of(texel_slot(at, 0)).kinds >> 3u) & 1u);
#endif
}
#endif

// The kinds of line that an object with this slot draws, as bits of ObjectStyle::kinds.
fn kinds_of(slot: u32) -> u32 {
#ifdef OBJECT_STYLES
    if slot != 0u {
        return style_of(slot).kinds;
    }
#endif
    return 7u;
}
