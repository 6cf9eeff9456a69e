#define_import_path bevy_comics::toon::shadow_texels

// The engine's Gaussian filters of shadow maps with the slope of what they return: pure functions. The
// filter of flat maps is that of Castaño (2013, "Shadow mapping summary, part 1").

// A filtered shadow, and its change per unit: of flat maps per texel.
struct Filtered {
    shadow: f32,
    slope: vec2<f32>,
}

// Where the filter lies. `corner` is the corner of texels next to the place, `part` the place from the
// middle of the texel before the corner, 0 to 1.
struct Texels {
    corner: vec2<f32>,
    part: vec2<f32>,
}

// `at` is a place in texels.
fn texels_at(at: vec2<f32>) -> Texels {
    let corner = floor(at + 0.5);
    return Texels(corner, at + 0.5 - corner);
}

// Weights of two of the six texels of a row, times 12: `pair` 0 to 2, in the order of the texels.
fn weights(pair: u32, part: f32) -> vec2<f32> {
    switch pair {
        case 0u: { return vec2(1.0 - part, 3.0 - 2.0 * part); }
        case 1u: { return vec2(4.0 - part, 3.0 + part); }
        default: { return vec2(1.0 + 2.0 * part, part); }
    }
}

// How these change with `part`.
fn weight_slopes(pair: u32) -> vec2<f32> {
    switch pair {
        case 0u: { return vec2(-1.0, -2.0); }
        case 1u: { return vec2(-1.0, 1.0); }
        default: { return vec2(2.0, 1.0); }
    }
}

// With four texels more, as `textureGatherCompare` returns them.
fn with_texels(f: Filtered, four: vec4<f32>, pair: vec2<u32>, part: vec2<f32>) -> Filtered {
    let x = weights(pair.x, part.x);
    let y = weights(pair.y, part.y);
    // Rows of the smaller and of the larger y.
    let rows = vec2(dot(x, four.wz), dot(x, four.xy));
    let dx = weight_slopes(pair.x);
    let row_slopes = vec2(dot(dx, four.wz), dot(dx, four.xy));
    var next = f;
    next.shadow += dot(y, rows) / 144.0;
    next.slope += vec2(dot(y, row_slopes), dot(weight_slopes(pair.y), rows)) / 144.0;
    return next;
}

// With one more of the eight samples of a cube map. The slope is a sum until `slope_of_sums`.
fn with_sample(f: Filtered, at: vec2<f32>, weight: f32, sample: f32) -> Filtered {
    var next = f;
    next.shadow += weight * sample;
    next.slope += weight * sample * (at - MEAN);
    return next;
}

// The weighted mean of the places of the eight samples, and the inverse of their covariance.
const MEAN: vec2<f32> = vec2(-0.024987, 0.018756);
const INVERSE_COVARIANCE: vec3<f32> = vec3(3.544332, 0.374325, 3.527045);

// The slope of the plane that is nearest to the samples (least squares with their weights).
fn slope_of_sums(f: Filtered) -> vec2<f32> {
    let m = INVERSE_COVARIANCE;
    return vec2(m.x * f.slope.x + m.y * f.slope.y, m.y * f.slope.x + m.z * f.slope.y);
}
