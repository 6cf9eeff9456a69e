#define_import_path bevy_comics::lines::owner_plane

// Near, middle and far at the pixel that owns a line.

#import bevy_comics::depth::map::{depth_map, plane_weights}
#import bevy_comics::depth::view::{depth_frame, texel_depth, view}
#import bevy_comics::lines::plane_lines::LinePlanes
#ifdef DEPTH_BORDERS
#import bevy_comics::depth::view::depth_borders
#endif
#ifdef OBJECT_DEPTHS
#import bevy_comics::objects::{object_depth, texel_object}
#endif

#ifdef IN_PLANES
// Fractions of near, middle and far. `owner`: a pixel of the depth texture.
fn owner_weights(p: LinePlanes, owner: vec2<i32>) -> vec3<f32> {
    let frame = depth_frame();
    var d = depth_map(frame, texel_depth(owner, 0)).x;
#ifdef OBJECT_DEPTHS
    let place = object_depth(texel_object(owner, 0).x);
    d = mix(d, place.x, place.y * p.by_objects);
#endif
    var borders = p.borders;
#ifdef DEPTH_BORDERS
    let found = depth_borders(frame);
    borders = select(found, borders, found.x < 0.0);
#endif
    let w = plane_weights(borders, p.softness, d);
    return select(w, w.zyx, view.flip != 0u);
}
#endif
