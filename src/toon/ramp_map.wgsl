#define_import_path bevy_comics::toon::ramp_map

// Tones that are painted in an image (Lake et al. 2000; Barla, Thollot and Markosian 2006). Functions of a
// texture that is given: column k of a row is the sum of the first k texels of that row of the image, in
// linear light. So the mean of any part of a row takes four loads.

fn sum_of(sums: texture_2d<f32>, count: i32, row: i32) -> vec3<f32> {
    return textureLoad(sums, vec2(count, row), 0).rgb;
}

// The mean of a row between two places in texels. Beyond both ends, the first and the last texel go on.
fn row_mean(sums: texture_2d<f32>, low: f32, high: f32, row: i32) -> vec3<f32> {
    let last = f32(textureDimensions(sums).x) - 2.0;
    let first = clamp(floor(low), 0.0, last);
    let end = clamp(floor(high), 0.0, last);
    let after = sum_of(sums, i32(first) + 1, row);
    let left = after - sum_of(sums, i32(first), row);
    if end <= first {
        return left;
    }
    let before = sum_of(sums, i32(end), row);
    let right = sum_of(sums, i32(end) + 1, row) - before;
    let sum = left * (first + 1.0 - low) + (before - after) + right * (high - end);
    return sum / (high - low);
}

// The row of a detail from 0 to 1, in rows from the top: the last one has none.
fn map_row(sums: texture_2d<f32>, detail: f32) -> f32 {
    let last = f32(textureDimensions(sums).y) - 1.0;
    return clamp(1.0 - detail, 0.0, 1.0) * last;
}

// The mean tone where from `low` to `high` of the light arrives, between two rows.
fn map_mean(sums: texture_2d<f32>, row: f32, low: f32, high: f32) -> vec3<f32> {
    let texels = f32(textureDimensions(sums).x) - 1.0;
    let above = floor(row);
    var color = row_mean(sums, low * texels, high * texels, i32(above));
    if row > above {
        let below = row_mean(sums, low * texels, high * texels, i32(above) + 1);
        color = mix(color, below, row - above);
    }
    return color;
}

// The tone where `arriving` of the light arrives. `width` is its change over a pixel.
fn map_tone(sums: texture_2d<f32>, row: f32, arriving: f32, width: f32) -> vec3<f32> {
    return map_mean(sums, row, arriving - 0.5 * width, arriving + 0.5 * width);
}

// The same, with a part of the light in the shadow of something else: `lit` is 1 where it arrives. The
// border of a shadow is a mixture of the tones on its two sides. The part of the pixel that is lit is the
// one where most of the light arrives: where an edge and the border meet in a pixel, the darker one counts.
fn map_shadowed(sums: texture_2d<f32>, row: f32, arriving: f32, width: f32, lit: f32) -> vec3<f32> {
    let high = arriving + 0.5 * width;
    let shade = map_mean(sums, row, 0.0, 0.0);
    return mix(shade, map_mean(sums, row, high - lit * width, high), lit);
}
