#define_import_path bevy_comics::lines::owner_plane

// Near, middle and far at the pixel that owns a line.

#import bevy_comics::depth::map::{depth_map, plane_weights}
#import bevy_comics::depth::view::{depth_frame, texel_depth}
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::plane_lines::plane_factors
#ifdef DEPTH_BORDERS
#import bevy_comics::depth::view::depth_borders
#endif
#ifdef OBJECT_DEPTHS
#import bevy_comics::objects::{object_depth, texel_object}
#endif

// Factors of the width and of the opacity of a line.
fn owner_factors(owner: vec2<i32>) -> vec2<f32> {
    let p = line_pass.planes;
    let frame = depth_frame();
    var d = depth_map(frame, texel_depth(owner, 0)).x;
#ifdef OBJECT_DEPTHS
    let place = object_depth(texel_object(owner, 0).x);
    d = mix(d, place.x, place.y);
#endif
    var borders = p.borders;
#ifdef DEPTH_BORDERS
    let found = depth_borders(frame);
    borders = select(found, borders, found.x < 0.0);
#endif
    let w = plane_weights(borders, p.softness, d);
    return plane_factors(p, select(w, w.zyx, line_pass.seen.flip != 0u));
}
