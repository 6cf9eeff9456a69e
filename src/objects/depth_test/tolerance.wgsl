#define_import_path bevy_comics::objects::tolerance

// Whether the depth prepass shows a fragment, up to a tolerance. The test has two sides: what the
// prepass discarded (alpha masks) lies in front of its depth, and has no id.

#ifdef TOLERANT_MULTISAMPLED
@group(1) @binding(3) var prepass_depth: texture_multisampled_2d<f32>;
#else
@group(1) @binding(3) var prepass_depth: texture_2d<f32>;
#endif

// Rounding of the positions of vertices moves depth by a fraction of itself, larger where world
// coordinates are large, and in orthographic views by a fraction of 1.
const RELATIVE: f32 = 0.000244140625;
const ABSOLUTE: f32 = 2.384185791015625e-7;
// It moves surfaces across the screen, too: by at most a few steps of 1/256 pixel, to which
// positions are rounded. Pixels of slope, in x and in y.
#ifdef TOLERANT_MULTISAMPLED
// Some drivers give every sample the depth at the middle of the pixel, up to half a pixel away in
// x and in y.
const SHIFT: f32 = 0.75;
#else
const SHIFT: f32 = 0.0625;
#endif

// `slope`: change of raw depth over a pixel in x and in y, added up.
fn is_near(drawn: f32, found: f32, slope: f32) -> bool {
    let tolerance = RELATIVE * max(drawn, found) + ABSOLUTE + SHIFT * slope;
    return found > 0.0 && abs(drawn - found) <= tolerance;
}

struct Fragment {
    @builtin(position) position: vec4<f32>,
#ifdef SAMPLE_SHADING
    @builtin(sample_index) sample: u32,
#endif
}

// Takes derivatives.
fn shows(fragment: Fragment) -> bool {
    let position = fragment.position;
    let slope = fwidth(position.z);
    let at = min(vec2<u32>(position.xy), textureDimensions(prepass_depth) - 1u);
#ifdef SAMPLE_SHADING
    let found = textureLoad(prepass_depth, at, i32(fragment.sample)).x;
#else
    let found = textureLoad(prepass_depth, at, 0).x;
#endif
    return is_near(position.z, found, slope);
}
