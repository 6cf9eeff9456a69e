#define_import_path bevy_comics::lines::owner_plane

// Near, middle and far, and the abstraction, at the pixel that owns a line.

#import bevy_comics::depth::map::{depth_map, layer_weights}
#import bevy_comics::depth::view::{depth_frame, texel_depth, view}
#import bevy_comics::lines::abstraction::{LineAbstraction, abstract_crease}
#import bevy_comics::lines::layer_lines::LineLayers
#ifdef DEPTH_BORDERS
#import bevy_comics::depth::view::depth_borders
#endif
#ifdef OBJECT_DEPTHS
#import bevy_comics::objects::{object_depth, object_dial, texel_object}
#endif

#ifdef DEPTH
// D at a pixel of the depth texture; that of its object if `by_objects` is 1.
fn owner_depth(owner: vec2<i32>, by_objects: f32) -> f32 {
    let d = depth_map(depth_frame(), texel_depth(owner, 0)).x;
#ifdef OBJECT_DEPTHS
    let place = object_depth(texel_object(owner, 0).x);
    return mix(d, place.x, place.y * by_objects);
#else
    return d;
#endif
}
#endif

#ifdef IN_LAYERS
// Fractions of near, middle and far. `owner`: a pixel of the depth texture.
fn owner_weights(p: LineLayers, owner: vec2<i32>) -> vec3<f32> {
    let d = owner_depth(owner, p.by_objects);
    var borders = p.borders;
#ifdef DEPTH_BORDERS
    let found = depth_borders(depth_frame());
    borders = select(found, borders, found.x < 0.0);
#endif
    let w = layer_weights(borders, p.softness, d);
    return select(w, w.zyx, view.flip != 0u);
}
#endif

#ifdef ABSTRACT_CREASES
// The factor of the opacity of a crease.
fn crease_left(a: LineAbstraction, owner: vec2<i32>) -> f32 {
    var dial = vec2(1.0, 0.0);
#ifdef OBJECT_DEPTHS
    dial = mix(dial, object_dial(texel_object(owner, 0).x), a.by_objects);
#endif
    return abstract_crease(a, owner_depth(owner, a.by_objects), dial);
}
#endif
