#define_import_path bevy_comics::toon::surface

// A surface of the toon material, and light that arrives at it.

// Change of the world position, of the normal and of the bias over a pixel, to the right and down.
struct Footprint {
    position_x: vec3<f32>,
    position_y: vec3<f32>,
    normal_x: vec3<f32>,
    normal_y: vec3<f32>,
    bias: vec2<f32>,
}

struct Surface {
    position: vec3<f32>,
    // Unit normal, with the normal map.
    normal: vec3<f32>,
    // Unit normal of the mesh. The shadow maps of the engine are read with it.
    mesh_normal: vec3<f32>,
    // Unit vector to the camera.
    to_eye: vec3<f32>,
    foot: Footprint,
    // 1 over the distance from the camera; 0 in an orthographic view.
    per_eye_distance: f32,
    // Tangent of the mesh, 0 if it has none.
    tangent: vec3<f32>,
    // Added to the cosines between normal and lights before tones are found.
    bias: f32,
    // Of the ramp, see `Detail`.
    detail: f32,
    // Perceptual roughness.
    roughness: f32,
    // Coordinates of the pixel, and z in view space.
    pixel: vec2<f32>,
    view_z: f32,
    // VIEW_SCALE: pixels per unit of the lengths of materials.
    scale: f32,
    // Whether shadow maps are read.
    receives: bool,
}

// Light from one light source. Toon light has no N.L term: this is the light at a
// surface that faces the light source.
struct Arriving {
    // Illuminance in lux, in rings, before shadows and exposure.
    color: vec3<f32>,
    // The same without rings.
    smooth_color: vec3<f32>,
    // Unit vector to the light source, and to the place on it that a highlight shows.
    to_light: vec3<f32>,
    to_highlight: vec3<f32>,
    // 1 over the distance from the light source; 0 for light from infinitely far away.
    per_distance: f32,
    // 1 where the light arrives, 0 in the shadow of something else.
    lit: f32,
    // 1, or 0 if the light is part of a lightmap and only draws a highlight.
    diffuse: f32,
    // 1 if the light draws highlights, else 0.
    specular: f32,
}

// Where light comes from, as in `Arriving`.
struct Source {
    to_light: vec3<f32>,
    to_highlight: vec3<f32>,
    per_distance: f32,
}

// Change of the cosine between normal and `direction` over a pixel.
fn cosine_over_pixel(foot: Footprint, direction: vec3<f32>) -> f32 {
    return abs(dot(foot.normal_x, direction)) + abs(dot(foot.normal_y, direction));
}

// The bias of a threshold from 0 to 1, of which 0.5 is neutral.
fn bias_of(threshold: f32) -> f32 {
    return 2.0 * threshold - 1.0;
}

// Cosine between normal and `direction`, with the surface's own threshold.
fn biased_cosine(s: Surface, direction: vec3<f32>) -> f32 {
    return clamp(dot(s.normal, direction) + s.bias, -1.0, 1.0);
}

// Its change over a pixel, where it is not clamped.
fn biased_over_pixel(s: Surface, direction: vec3<f32>) -> f32 {
    let right = dot(s.foot.normal_x, direction) + s.foot.bias.x;
    let down = dot(s.foot.normal_y, direction) + s.foot.bias.y;
    return abs(right) + abs(down);
}

// Unit vector half way between two unit vectors, or 0 where they are opposite.
fn half_way(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let sum = a + b;
    return sum * inverseSqrt(max(dot(sum, sum), 1e-12));
}

// Size of a pixel on the surface in world units.
fn pixel_size(foot: Footprint) -> f32 {
    return length(foot.position_x) + length(foot.position_y);
}
