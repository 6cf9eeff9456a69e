#define_import_path bevy_comics::toon::octahedral

// The unit vector of a place on an octahedron that is unfolded to the square from -1 to 1.
fn octahedral(place: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(place.x) - abs(place.y);
    let fold = max(-z, 0.0);
    let xy = place + select(vec2(fold), vec2(-fold), place >= vec2(0.0));
    return normalize(vec3(xy, z));
}
