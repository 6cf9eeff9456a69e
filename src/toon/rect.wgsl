#define_import_path bevy_comics::toon::rect

// Light of a rectangle: pure functions.

struct Rect {
    // From the center to the middle of two sides.
    half_right: vec3<f32>,
    half_up: vec3<f32>,
}

// Angle between two unit vectors over its sine, at most 1e3.
fn angle_over_sine(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let sine = length(cross(a, b));
    // The next term of the series, 3/40 sine^4, is below 4e-9.
    if sine < 0.015 && dot(a, b) > 0.0 {
        return 1.0 + sine * sine / 6.0;
    }
    return min(atan2(sine, dot(a, b)) / max(sine, 1e-6), 1e3);
}

fn direction_of(v: vec3<f32>) -> vec3<f32> {
    return v * inverseSqrt(max(dot(v, v), 1e-20));
}

// Light of a rectangle of luminance 1 / pi at a place, as a vector: the light at a surface
// that faces along the vector is its length, 0 to 1 (Lambert's formula). A surface with the
// normal n, whose horizon the rectangle is above, has its dot product with n. `at` is the
// place, relative to the center.
fn rect_light(rect: Rect, at: vec3<f32>) -> vec3<f32> {
    let a = direction_of(rect.half_right - rect.half_up - at);
    let b = direction_of(rect.half_right + rect.half_up - at);
    let c = direction_of(rect.half_up - rect.half_right - at);
    let d = direction_of(-rect.half_right - rect.half_up - at);
    let sum = cross(a, b) * angle_over_sine(a, b) + cross(b, c) * angle_over_sine(b, c)
        + cross(c, d) * angle_over_sine(c, d) + cross(d, a) * angle_over_sine(d, a);
    // The order of the corners depends on the side that the place is on.
    return sum * (select(-1.0, 1.0, dot(sum, at) < 0.0) / 6.2831853);
}

// The point of the rectangle that a mirror at `at` shows along `reflected`, or the one that
// is nearest to it; relative to the center, as `at`.
fn mirrored(rect: Rect, at: vec3<f32>, reflected: vec3<f32>) -> vec3<f32> {
    let normal = direction_of(cross(rect.half_right, rect.half_up));
    let height = -dot(at, normal);
    let speed = dot(reflected, normal);
    // A ray that leaves the plane meets it nowhere: the border that it points to.
    let meets = height * speed > 1e-6 * abs(height);
    let hit = select(reflected * 1e4, at + reflected * (height / speed), meets);
    let x = dot(hit, rect.half_right) / max(dot(rect.half_right, rect.half_right), 1e-12);
    let y = dot(hit, rect.half_up) / max(dot(rect.half_up, rect.half_up), 1e-12);
    return rect.half_right * clamp(x, -1.0, 1.0) + rect.half_up * clamp(y, -1.0, 1.0);
}
