#define_import_path bevy_comics::lines::abstraction

// Fewer and fainter lines where the picture is abstract. Pure functions.

#import bevy_comics::depth::map::graded

// Its size is a multiple of 16 bytes, as WGSL requires of a struct inside a uniform.
struct LineAbstraction {
    // Abstraction at D = 0 and at D = 1, and the exponent of D between them.
    at_near: f32,
    at_far: f32,
    exponent: f32,
    // Factor of the response that a line needs at full abstraction, 1 or more.
    threshold: f32,
    crease_opacity: f32,
    // 1: lines follow the centre of their object and its dial; 0: their own place.
    by_objects: f32,
    // 1: near and far are exchanged.
    flip: f32,
    unused: f32,
}

// The abstraction at a depth of the map. `dial`: of the object, a factor and what is added.
fn abstraction_at(s: LineAbstraction, d: f32, dial: vec2<f32>) -> f32 {
    let by_distance = graded(s.at_near, s.at_far, s.exponent, mix(d, 1.0 - d, s.flip));
    return clamp(dial.x * by_distance + dial.y, 0.0, 1.0);
}

// The factor of the responses of edges.
fn abstract_response(s: LineAbstraction, d: f32, dial: vec2<f32>) -> f32 {
    return 1.0 / mix(1.0, s.threshold, abstraction_at(s, d, dial));
}

// The factor of the opacity of creases.
fn abstract_crease(s: LineAbstraction, d: f32, dial: vec2<f32>) -> f32 {
    return mix(1.0, s.crease_opacity, abstraction_at(s, d, dial));
}
