#define_import_path bevy_comics::effect::similarity

// How something that lies on the page follows an object: moved, turned and scaled with it
// (after Breslav et al. 2007). Pure functions.

// Apparent sizes are wrapped to one octave. In the outer part of it, from this factor on, the
// next octave fades in.
const WIDEST: f32 = 1.4142135;
const FADES_FROM: f32 = 1.3;

struct Similarity {
    // Where the center of the object is, in physical pixels of the render target.
    origin: vec2<f32>,
    // Cosine and sine of the object's turn about the view's axis, clockwise.
    turn: vec2<f32>,
    // Apparent size, times a power of two: 0.707 to 1.414; 0 if the center is behind the camera.
    size: f32,
    // Half or double of it, whichever is nearer, and how much of that is seen: 0 to 0.5.
    other: f32,
    fade: f32,
}

// A positive number times a power of two, from 1 / WIDEST to WIDEST.
fn wrapped(x: f32) -> f32 {
    let exponent = bitcast<u32>(x * WIDEST) >> 23u;
    return x * bitcast<f32>((254u - exponent) << 23u);
}

// A vector of the object's space in world space. `rotation`: a unit quaternion.
fn rotated(rotation: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return v + 2.0 * cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w * v);
}

// `viewport`: x, y, width, height in physical pixels; `center` in world space; `size`: world
// units per unit of the object.
fn similarity_of(
    clip_from_world: mat4x4<f32>, viewport: vec4<f32>,
    center: vec3<f32>, size: f32, rotation: vec4<f32>,
) -> Similarity {
    var found: Similarity;
    let clip = clip_from_world * vec4(center, 1.0);
    // Half heights of the view per world unit.
    let m = clip_from_world;
    let scale = length(vec3(m[0].y, m[1].y, m[2].y));
    let apparent = size * scale / max(clip.w, 1e-20);
    // Also false where something is not a number.
    if !(clip.w > 0.0 && apparent > 1e-30 && apparent < 1e30) {
        return found;
    }
    let page = 0.5 * viewport.zw * vec2(1.0, -1.0);
    found.origin = viewport.xy + 0.5 * viewport.zw + clip.xy / clip.w * page;
    // The upward axis of the object, or the one forward where that points at the camera.
    let upward = (m * vec4(rotated(rotation, vec3(0.0, 1.0, 0.0)), 0.0)).xy * page;
    let forward = (m * vec4(rotated(rotation, vec3(0.0, 0.0, -1.0)), 0.0)).xy * page;
    let least = 0.1 * scale * abs(page.y);
    let axis = select(forward, upward, dot(upward, upward) > least * least);
    found.turn = vec2(-axis.y, axis.x) / max(length(axis), 1e-20);
    found.size = wrapped(apparent);
    let is_large = found.size > 1.0;
    found.other = found.size * select(2.0, 0.5, is_large);
    let far = select(1.0 / found.size, found.size, is_large);
    found.fade = 0.5 * clamp((far - FADES_FROM) / (WIDEST - FADES_FROM), 0.0, 1.0);
    return found;
}
