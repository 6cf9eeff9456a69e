#define_import_path bevy_comics::lines::owner_plane

// Where the surface that owns a line is in the depth map, and in near, middle and far.

#import bevy_comics::depth::map::{depth_map, layer_weights}
#import bevy_comics::depth::view::{depth_frame, texel_depth, view}
#import bevy_comics::lines::layer_lines::LineLayers
#ifdef DEPTH_BORDERS
#import bevy_comics::depth::view::depth_borders
#endif
#ifdef OBJECT_DEPTHS
#import bevy_comics::objects::{object_depth, texel_object}
#endif

// D of a surface at a raw depth; that of its object if `by_objects` is 1.
fn map_at(raw: f32, object: u32, by_objects: f32) -> f32 {
    let d = depth_map(depth_frame(), raw).x;
#ifdef OBJECT_DEPTHS
    let whole = object_depth(object);
    return mix(d, whole.x, whole.y * by_objects);
#else
    return d;
#endif
}

// The id of the object at a pixel of the depth texture, for map_at.
fn object_at(owner: vec2<i32>) -> u32 {
#ifdef OBJECT_DEPTHS
    return texel_object(owner, 0).x;
#else
    return 0u;
#endif
}

#ifdef IN_LAYERS
// Fractions of near, middle and far. `owner`: a pixel of the depth texture.
fn owner_weights(p: LineLayers, owner: vec2<i32>) -> vec3<f32> {
    let d = map_at(texel_depth(owner, 0), object_at(owner), p.by_objects);
    var borders = p.borders;
#ifdef DEPTH_BORDERS
    let found = depth_borders(depth_frame());
    borders = select(found, borders, found.x < 0.0);
#endif
    let w = layer_weights(borders, p.softness, d);
    return select(w, w.zyx, view.flip != 0u);
}
#endif
