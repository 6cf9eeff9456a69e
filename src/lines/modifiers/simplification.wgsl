#define_import_path bevy_comics::lines::simplification

// Fewer and fainter lines where the picture is simpler.

#import bevy_comics::depth::map::graded
#import bevy_comics::depth::view::view
#import bevy_comics::lines::owner_plane::map_at
#ifdef OBJECT_DEPTHS
#import bevy_comics::objects::object_simplification
#endif

struct LineSimplification {
    // Simplification at D = 0 and at D = 1, and the exponent of D between them.
    at_near: f32,
    at_far: f32,
    exponent: f32,
    // Factor of the response that a line needs at full simplification, 1 or more.
    threshold: f32,
    crease_opacity: f32,
    // 1: lines follow the center and the simplification of their object; 0: their own depth.
    by_objects: f32,
    unused_pair: vec2<f32>,
}

// The simplification of the lines of a surface: its raw depth, and the id of its object.
fn simplification_at(s: LineSimplification, raw: f32, object: u32) -> f32 {
    var own = vec2(1.0, 0.0);
#ifdef OBJECT_DEPTHS
    own = mix(own, object_simplification(object), s.by_objects);
#endif
    let d = map_at(raw, object, s.by_objects);
    let by_distance = graded(s.at_near, s.at_far, s.exponent, select(d, 1.0 - d, view.flip != 0u));
    return clamp(own.x * by_distance + own.y, 0.0, 1.0);
}

// The factor of the responses of edges.
fn response_factor(s: LineSimplification, raw: f32, object: u32) -> f32 {
    return 1.0 / mix(1.0, s.threshold, simplification_at(s, raw, object));
}

// The factor of the opacity of creases.
fn crease_factor(s: LineSimplification, raw: f32, object: u32) -> f32 {
    return mix(1.0, s.crease_opacity, simplification_at(s, raw, object));
}
