#define_import_path bevy_comics::effects::abstraction

// How abstract the picture is at a pixel, for the effects that follow, and paler colors.

#import bevy_comics::depth::map::graded
#import bevy_comics::depth::view::view
#import bevy_comics::effect::color::luminance
#import bevy_comics::effect::pixel::Pixel
#ifdef OBJECT_DEPTHS
#import bevy_comics::depth::view::depth_pixel
#import bevy_comics::objects::{object_depth, object_simplification, texel_object}
#endif

struct Abstraction {
    // Abstraction at D = 0 and at D = 1, and the exponent of D between them.
    at_near: f32,
    at_far: f32,
    exponent: f32,
    // How often bands split where there is no abstraction.
    splits: f32,
    // Octaves by which strokes are farther apart at full abstraction.
    spacing: f32,
    // Factor of the saturation there.
    saturation: f32,
}

// The abstraction at a depth of the map, of an object with a factor and an offset of its own.
fn abstraction_at(s: Abstraction, d: f32, own: vec2<f32>) -> f32 {
    return clamp(own.x * graded(s.at_near, s.at_far, s.exponent, d) + own.y, 0.0, 1.0);
}

// The abstraction of a pixel, 0 to 1. In multisampled views, the object is that of the first
// sample.
fn abstraction_of(s: Abstraction, p: Pixel) -> f32 {
    var d = select(p.depth.x, p.depth.y, view.flip != 0u);
    var own = vec2(1.0, 0.0);
#ifdef EFFECT_ABSTRACTION_OBJECTS
#ifdef OBJECT_DEPTHS
    let object = texel_object(depth_pixel(vec2<i32>(floor(p.position))), 0).x;
    let whole = object_depth(object);
    d = mix(d, whole.x, whole.y);
    own = object_simplification(object);
#endif
#endif
    return abstraction_at(s, select(d, 1.0 - d, view.flip != 0u), own);
}

// The color with part of its saturation: mixed with the gray of its luminance.
fn abstract_color(s: Abstraction, linear: vec3<f32>, a: f32) -> vec3<f32> {
    return mix(linear, vec3(luminance(linear)), a * (1.0 - s.saturation));
}

fn abstraction(s: Abstraction, p: Pixel) -> Pixel {
    var out = p;
    let a = abstraction_of(s, p);
    out.color = abstract_color(s, p.color, a);
    out.splits = s.splits * (1.0 - a);
    out.spacing = exp2(s.spacing * a);
    return out;
}

// The debug view, in display codes.
fn abstraction_view(s: Abstraction, p: Pixel) -> vec3<f32> {
    return vec3(abstraction_of(s, p));
}
