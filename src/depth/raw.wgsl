#define_import_path bevy_comics::depth::raw

// From a texel of the depth texture to the raw depth that all other shaders read.

struct RawDepth {
    // Rows 2 and 3 of view_from_clip: z and w of the view position. All fields are 0
    // unless the projection is oblique.
    view_z: vec4<f32>,
    view_w: vec4<f32>,
    // Normalized device coordinates of a position in pixels: xy * position + zw.
    ndc: vec4<f32>,
    // View depth in world units that becomes 1; smaller ones count as this.
    nearest: f32,
    // What is farther than this raw depth counts as sky: DepthMap::sky_beyond. 0: nothing does.
    sky: f32,
}

// What a search for the visible range reads of a view.
struct RangeView {
    // Origin and size of the viewport: x, y, width, height in pixels of the depth texture.
    rect: vec4<u32>,
    raw: RawDepth,
}

#ifdef OBLIQUE
// With an oblique near plane, raw depth does not order pixels by distance. The
// reciprocal of the view depth z does, and like raw depth it is affine over a plane
// on the screen: nearest / z takes the place of raw depth.
fn raw_depth(r: RawDepth, pixel: vec2<u32>, d: f32) -> f32 {
    if !(d > 0.0) {
        return 0.0;
    }
    let clip = vec4((vec2<f32>(pixel) + 0.5) * r.ndc.xy + r.ndc.zw, d, 1.0);
    let z = -dot(r.view_z, clip) / dot(r.view_w, clip);
    let raw = clamp(r.nearest / max(z, r.nearest), 0.0, 1.0);
    return select(raw, 0.0, raw < r.sky);
}
#else
fn raw_depth(r: RawDepth, pixel: vec2<u32>, d: f32) -> f32 {
    return select(d, 0.0, d < r.sky);
}
#endif

// The bits of a depth; 0 for the sky and for what is no depth (negative, above 1, NaN).
fn raw_depth_key(r: RawDepth, pixel: vec2<u32>, d: f32) -> u32 {
    let bits = bitcast<u32>(raw_depth(r, pixel, d));
    return select(bits, 0u, bits > 0x3f800000u);
}
