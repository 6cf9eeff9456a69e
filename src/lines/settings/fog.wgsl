#define_import_path bevy_comics::lines::fog

// How much of a line the engine's distance fog hides. Pure functions.

struct Fog {
    // Position in view space from a position in normalized device coordinates:
    // xy * position + zw; in perspective at a distance of 1 along the view's axis.
    ray: vec4<f32>,
    // Distance along the view's axis from the raw depth d: in perspective x / (d + y), under
    // an orthographic projection x + y * d.
    axis: vec2<f32>,
    orthographic: u32,
    // 0: linear, 1: exponential, 2: exponential squared, 3: atmospheric.
    falloff: u32,
    // Linear: start and end; exponential: density; atmospheric: extinction by channel.
    numbers: vec3<f32>,
    // The largest fraction: the opacity of the fog's color.
    most: f32,
}

// Distance from the camera to a place: its position in normalized device coordinates, and
// its raw depth.
fn fog_distance(f: Fog, position: vec2<f32>, d: f32) -> f32 {
    let across = position * f.ray.xy + f.ray.zw;
    if f.orthographic != 0u {
        return length(vec3(across, f.axis.x + f.axis.y * d));
    }
    return f.axis.x / (d + f.axis.y) * length(vec3(across, 1.0));
}

// The fraction of a color at a distance that the fog replaces. Of atmospheric fog, the mean
// over the channels.
fn fog_fraction(f: Fog, distance: f32) -> f32 {
    if !(distance < 1e30) {
        return clamp(f.most, 0.0, 1.0);
    }
    var left = 1.0;
    switch f.falloff {
        case 0u: {
            left = clamp((f.numbers.y - distance) / max(f.numbers.y - f.numbers.x, 1e-6), 0.0, 1.0);
        }
        case 1u: {
            left = exp(-distance * f.numbers.x);
        }
        case 2u: {
            let thickness = distance * f.numbers.x;
            left = exp(-thickness * thickness);
        }
        default: {
            left = dot(exp(-distance * f.numbers), vec3(1.0 / 3.0));
        }
    }
    return clamp((1.0 - left) * f.most, 0.0, 1.0);
}
