#define_import_path bevy_comics::toon::ambient

// Light from all around in two tones: pure functions.

// Light at surfaces that face along the six axes.
struct AxisLight {
    right: vec3<f32>,
    left: vec3<f32>,
    up: vec3<f32>,
    down: vec3<f32>,
    // Towards +Z and -Z.
    back: vec3<f32>,
    front: vec3<f32>,
}

struct TwoTones {
    // Light of surfaces that face away from `direction`.
    shade: vec3<f32>,
    // What the surfaces that face along `direction` receive in addition. A channel is
    // negative where the other side has more of it.
    more: vec3<f32>,
    // Unit vector to the brightest side.
    direction: vec3<f32>,
}

fn brightness(light: vec3<f32>) -> f32 {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

// Light of two tones with the same mean over all directions as the six: of the brightest
// side and of the side that faces away from it.
fn two_tones(s: AxisLight) -> TwoTones {
    let x = s.right - s.left;
    let y = s.up - s.down;
    let z = s.back - s.front;
    let towards = vec3(brightness(x), brightness(y), brightness(z));
    let length_squared = dot(towards, towards);
    var tones: TwoTones;
    // From the smallest normal number upwards, the root and the quotient are finite.
    tones.direction = vec3(0.0, 1.0, 0.0);
    if length_squared > 1.2e-38 {
        tones.direction = towards * inverseSqrt(length_squared);
    }
    let d = tones.direction;
    let mean = max((s.right + s.left + s.up + s.down + s.back + s.front) / 6.0, vec3(0.0));
    // Half the difference of the two sides, as the engine mixes such light by the squares of
    // the normal. Neither tone is negative.
    let difference = 0.5 * (x * d.x * abs(d.x) + y * d.y * abs(d.y) + z * d.z * abs(d.z));
    let half_difference = clamp(difference, -mean, mean);
    tones.shade = mean - half_difference;
    tones.more = 2.0 * half_difference;
    return tones;
}
