#define_import_path bevy_comics::depth::raw

// How a texel of the depth texture becomes the raw depth that everything
// downstream reads.

struct RawDepth {
    // view_from_clip rows 2 and 3 (z and w of the view position), for oblique
    // projections alone.
    view_z: vec4<f32>,
    view_w: vec4<f32>,
    // Normalised device coordinates of a pixel: xy * pixel + zw.
    ndc: vec4<f32>,
    // 1 / near distance: scales the reciprocal distance into (0, 1].
    near: f32,
}

#ifdef OBLIQUE
// Under an oblique near plane, raw depth does not order pixels by distance.
// The reciprocal of the view depth does, and is affine over planes as well:
// near / z stands for the raw depth of a plain projection.
fn raw_depth(r: RawDepth, pixel: vec2<u32>, d: f32) -> f32 {
    if !(d > 0.0) {
        return 0.0;
    }
    let clip = vec4((vec2<f32>(pixel) + 0.5) * r.ndc.xy + r.ndc.zw, d, 1.0);
    let z = -dot(r.view_z, clip) / dot(r.view_w, clip);
    return clamp(r.near / max(z, r.near), 0.0, 1.0);
}
#else
fn raw_depth(r: RawDepth, pixel: vec2<u32>, d: f32) -> f32 {
    return d;
}
#endif

// The bits of a depth, or zero for what is none: sky, negative, above one, NaN.
fn raw_depth_key(r: RawDepth, pixel: vec2<u32>, d: f32) -> u32 {
    let bits = bitcast<u32>(raw_depth(r, pixel, d));
    return select(bits, 0u, bits > 0x3f800000u);
}
