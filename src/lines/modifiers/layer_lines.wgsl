#define_import_path bevy_comics::lines::layer_lines

// The width, opacity and color of lines in near, middle and far. Pure functions.

struct LineLayers {
    // Colors in near, middle and far in linear light, multiplied by how much of the color of a
    // line they are, and that amount.
    near_ink: vec4<f32>,
    middle_ink: vec4<f32>,
    far_ink: vec4<f32>,
    // Factors of the width in near, middle and far.
    widths: vec3<f32>,
    // Width of the borders in D.
    softness: f32,
    // Factors of the opacity.
    opacities: vec3<f32>,
    // 1: a surface is where its object is; 0: where it is itself.
    by_objects: f32,
    // D at the border between near and middle, and between middle and far.
    borders: vec2<f32>,
    unused_pair: vec2<f32>,
}

// Factors of the width and of the opacity, with these fractions of the layers.
fn layer_factors(p: LineLayers, w: vec3<f32>) -> vec2<f32> {
    return vec2(dot(p.widths, w), dot(p.opacities, w));
}

// The color, multiplied by its amount, and the amount, with these fractions of the layers.
fn layer_ink(p: LineLayers, w: vec3<f32>) -> vec4<f32> {
    return w.x * p.near_ink + w.y * p.middle_ink + w.z * p.far_ink;
}
