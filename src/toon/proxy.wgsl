#define_import_path bevy_comics::toon::proxy

// Simpler forms that normals are taken from: pure functions (Barla, Thollot and Markosian 2006).

struct Proxy {
    // Of the mesh, in its own space.
    center: vec3<f32>,
    // Of the normal, near and far away.
    amount: f32,
    // Reciprocal squares of the half sizes; 0 along an axis of a cylinder, 0 for a plane.
    weights: vec3<f32>,
    far_amount: f32,
    // As in `Detail`.
    distance: f32,
    per_log: f32,
}

// Normal of the ellipsoid around the center that a place lies on, not of length 1. Both in the
// space of the mesh.
fn proxy_normal(f: Proxy, place: vec3<f32>) -> vec3<f32> {
    return (place - f.center) * f.weights;
}

// At unit length, whatever its length is; 0 if it is 0.
fn unit_or_none(normal: vec3<f32>) -> vec3<f32> {
    let largest = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
    let scaled = normal / max(largest, 1e-30);
    return scaled * inverseSqrt(max(dot(scaled, scaled), 0.5));
}

// How much of the form's normal there is, from the distance along the view axis.
fn proxy_amount(f: Proxy, z: f32) -> f32 {
    let near = clamp(1.0 - log(max(z / f.distance, 1e-9)) * f.per_log, 0.0, 1.0);
    return mix(f.far_amount, f.amount, near);
}

// A normal between both. The first one where they are opposite.
fn between(normal: vec3<f32>, other: vec3<f32>, amount: f32) -> vec3<f32> {
    let mixed = mix(normal, other, amount);
    let long = length(mixed);
    if amount <= 0.0 || long < 1e-3 {
        return normal;
    }
    return mixed / long;
}
