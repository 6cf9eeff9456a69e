#define_import_path bevy_comics::effect::box_statistics

// Means over boxes of the picture before an effect, for effects that need `Needs::BOX_STATISTICS`. The
// only module that declares binding 12.
//
// Colors are averaged as square roots of linear light, nearly as they are displayed: means of
// light would be those of its brightest pixels. What is transparent, or outside of the
// viewport, is not in a mean.

#import bevy_comics::depth::view::view
#import bevy_comics::effect::color::luminance
#import bevy_comics::effect::picture::load_inside

#ifdef BOX_STATISTICS
// Means of rows in the pass that averages them, else of boxes.
@group(0) @binding(12) var means_texture: texture_2d<u32>;
#endif

// Of the square root of linear light.
struct Means {
    // Luminance, and the square of it.
    mean: f32,
    square: f32,
    // Red and blue less the luminance.
    chroma: vec2<f32>,
    // Fraction of the box that shows something.
    coverage: f32,
    // Half the side of the box, which is 2 half + 1 physical pixels.
    half: f32,
}

// Largest half side of a box in physical pixels.
const LARGEST: f32 = 128.0;

fn root(linear: vec3<f32>) -> vec3<f32> {
    let size = sqrt(abs(linear));
    return select(size, -size, linear < vec3(0.0));
}

// The inverse of root.
fn square(root: vec3<f32>) -> vec3<f32> {
    return root * abs(root);
}

// A color from its luminance, and red and blue less that.
fn color_of(mean: f32, chroma: vec2<f32>) -> vec3<f32> {
    let green = -(0.2126 * chroma.x + 0.0722 * chroma.y) / 0.7152;
    return mean + vec3(chroma.x, green, chroma.y);
}

// Square root of linear light.
fn mean_color(m: Means) -> vec3<f32> {
    return color_of(m.mean, m.chroma);
}

// Variance of the luminance in a box.
fn variance(m: Means) -> f32 {
    return max(m.square - m.mean * m.mean, 0.0);
}

// The fraction of a pixel that is in a box, `by` pixels from its middle. The box has a side of
// 2 half + 1.
fn part_of_box(half: f32, by: i32) -> f32 {
    return clamp(half + 1.0 - f32(abs(by)), 0.0, 1.0);
}

// Luminance and its square need 32 bits, because the variance is their difference; the
// differences of red and blue from the luminance, the coverage and the size do not.
fn packed_means(m: Means) -> vec4<u32> {
    return vec4(
        bitcast<u32>(m.mean),
        bitcast<u32>(m.square),
        pack2x16float(clamp(m.chroma, vec2(-65504.0), vec2(65504.0))),
        pack2x16float(vec2(m.coverage, m.half)),
    );
}

fn unpacked_means(words: vec4<u32>) -> Means {
    let rest = unpack2x16float(words.w);
    return Means(
        bitcast<f32>(words.x),
        bitcast<f32>(words.y),
        unpack2x16float(words.z),
        rest.x,
        rest.y,
    );
}

fn no_means(half: f32) -> Means {
    return Means(0.0, 0.0, vec2(0.0), 0.0, half);
}

// Adds a box with a weight to a sum.
fn added(sum: Means, m: Means, part: f32) -> Means {
    let weight = part * m.coverage;
    return Means(
        sum.mean + weight * m.mean,
        sum.square + weight * m.square,
        sum.chroma + weight * m.chroma,
        sum.coverage + weight,
        sum.half,
    );
}

// The means from their sum over a row or column of the box.
fn divided(sum: Means) -> Means {
    let per_weight = 1.0 / max(sum.coverage, 1e-20);
    return Means(
        sum.mean * per_weight,
        sum.square * per_weight,
        sum.chroma * per_weight,
        sum.coverage / (2.0 * sum.half + 1.0),
        sum.half,
    );
}

fn half_side(half: f32) -> f32 {
    // Written such that NaN is 0.
    return select(0.0, min(half, LARGEST), half > 0.0);
}

// The means of a place of the picture: linear light multiplied by its opacity, and the opacity.
fn means_of(found: vec4<f32>) -> Means {
    let alpha = clamp(found.a, 0.0, 1.0);
    let color = root(found.rgb * (1.0 / max(alpha, 1e-3)));
    let mean = luminance(color);
    return Means(mean, mean * mean, color.rb - mean, alpha, 0.0);
}

// The pixels of a row or column that a box around one has in the viewport, from that one.
struct Span {
    first: i32,
    last: i32,
}

fn span_around(at: i32, half: f32, start: i32, size: i32) -> Span {
    let reach = i32(ceil(half));
    return Span(max(-reach, start - at), min(reach, start + size - 1 - at));
}

// The part of a pixel that is in a box and in the viewport.
fn part_in_span(half: f32, by: i32, span: Span) -> f32 {
    return select(0.0, part_of_box(half, by), by >= span.first && by <= span.last);
}

// The means of the texture at a pixel of the render target, which must be inside the viewport.
fn load_means(pixel: vec2<i32>) -> Means {
#ifdef BOX_STATISTICS
    return unpacked_means(textureLoad(means_texture, pixel - view.viewport.xy, 0));
#else
    return no_means(0.0);
#endif
}

// What a pass averages, `by` steps beside a pixel: the pixels of a row, or with BOX_STATISTICS_DOWN the
// rows of a column.
fn means_beside(pixel: vec2<i32>, by: i32) -> Means {
#ifdef BOX_STATISTICS_DOWN
    return load_means(pixel + vec2(0, by));
#else
    return means_of(load_inside(pixel + vec2(by, 0)));
#endif
}

// Adds two of these, on both sides of the middle.
fn both_added(sum: Means, pixel: vec2<i32>, by: i32, span: Span) -> Means {
    let before = added(sum, means_beside(pixel, -by), part_in_span(sum.half, -by, span));
    return added(before, means_beside(pixel, by), part_in_span(sum.half, by, span));
}

// The means of a row of pixels around one, or of a column of rows. BOX_REACH: none reaches farther than
// is defined, and most do; loops are slow on CPU adapters.
fn mean_along(pixel: vec2<i32>, half: f32) -> Means {
#ifdef BOX_STATISTICS_DOWN
    let span = span_around(pixel.y, half, view.viewport.y, view.viewport.w);
#else
    let span = span_around(pixel.x, half, view.viewport.x, view.viewport.z);
#endif
#ifdef BOX_REACH
    var sum = added(no_means(half), means_beside(pixel, 0), 1.0);
#ifdef REACHES_ONE
    sum = both_added(sum, pixel, 1, span);
#endif
#ifdef REACHES_TWO
    sum = both_added(sum, pixel, 2, span);
#endif
#ifdef REACHES_THREE
    sum = both_added(sum, pixel, 3, span);
#endif
#ifdef REACHES_FOUR
    sum = both_added(sum, pixel, 4, span);
#endif
#ifdef REACHES_FIVE
    sum = both_added(sum, pixel, 5, span);
#endif
#ifdef REACHES_SIX
    sum = both_added(sum, pixel, 6, span);
#endif
#else
    var sum = no_means(half);
    for (var i = span.first; i <= span.last; i++) {
        sum = added(sum, means_beside(pixel, i), part_of_box(half, i));
    }
#endif
    return divided(sum);
}
