#define_import_path bevy_comics::effect::means

// Means over boxes of the picture before an effect, for effects that need `Needs::MEANS`. The
// only module that declares binding 12.
//
// Colours are averaged as square roots of linear light, nearly as they are displayed: means of
// light would be those of its brightest pixels. What is transparent, or outside of the
// viewport, is not in a mean.

#import bevy_comics::depth::view::view
#import bevy_comics::effect::color::{finite_color, luminance}
#import bevy_comics::effect::picture::load_picture

#ifdef MEANS
// Means of rows in the pass that averages them, else of boxes.
@group(0) @binding(12) var means_texture: texture_2d<u32>;
#endif

struct Means {
    // Square root of linear light.
    color: vec3<f32>,
    // Of the square of that colour's luminance.
    square: f32,
    // Fraction of the box that shows something.
    coverage: f32,
    // Half the side of the box, which is 2 half + 1 physical pixels.
    half: f32,
}

// Largest half side of a box in physical pixels.
const LARGEST: f32 = 128.0;

fn root(linear: vec3<f32>) -> vec3<f32> {
    return sign(linear) * sqrt(abs(linear));
}

// The inverse of root.
fn square(root: vec3<f32>) -> vec3<f32> {
    return root * abs(root);
}

// Variance of the luminance in a box.
fn variance(m: Means) -> f32 {
    let mean = luminance(m.color);
    return max(m.square - mean * mean, 0.0);
}

// The fraction of a pixel that is in a box, `by` pixels from its middle. The box has a side of
// 2 half + 1.
fn part_of_box(half: f32, by: i32) -> f32 {
    return clamp(half + 1.0 - f32(abs(by)), 0.0, 1.0);
}

// Luminance and its square need 32 bits, because the variance is their difference; the
// differences of red and blue from the luminance, the coverage and the size do not.
fn packed_means(m: Means) -> vec4<u32> {
    let mean = luminance(m.color);
    return vec4(
        bitcast<u32>(mean),
        bitcast<u32>(m.square),
        pack2x16float(clamp(m.color.rb - mean, vec2(-65504.0), vec2(65504.0))),
        pack2x16float(vec2(m.coverage, m.half)),
    );
}

fn unpacked_means(words: vec4<u32>) -> Means {
    let mean = bitcast<f32>(words.x);
    let by = unpack2x16float(words.z);
    let rest = unpack2x16float(words.w);
    let green = -(0.2126 * by.x + 0.0722 * by.y) / 0.7152;
    return Means(
        mean + vec3(by.x, green, by.y),
        bitcast<f32>(words.y),
        rest.x,
        rest.y,
    );
}

// Adds a box with a weight to a sum.
fn added(sum: Means, m: Means, part: f32) -> Means {
    let weight = part * m.coverage;
    return Means(
        sum.color + weight * m.color,
        sum.square + weight * m.square,
        sum.coverage + weight,
        sum.half,
    );
}

// The means from their sum over a row or column of the box.
fn divided(sum: Means) -> Means {
    let weight = max(sum.coverage, 1e-20);
    let coverage = sum.coverage / (2.0 * sum.half + 1.0);
    return Means(sum.color / weight, sum.square / weight, coverage, sum.half);
}

fn half_side(half: f32) -> f32 {
    // Written such that NaN is 0.
    return select(0.0, min(half, LARGEST), half > 0.0);
}

// The picture at a pixel of the render target.
fn means_of_pixel(pixel: vec2<i32>) -> Means {
    let found = load_picture(pixel);
    let alpha = clamp(found.a, 0.0, 1.0);
    let color = root(finite_color(found.rgb) / max(alpha, 1e-3));
    let mean = luminance(color);
    return Means(color, mean * mean, alpha, 0.0);
}

// The means of a row of pixels around one.
fn mean_across(pixel: vec2<i32>, half: f32) -> Means {
    let reach = i32(ceil(half));
    let first = max(-reach, view.viewport.x - pixel.x);
    let last = min(reach, view.viewport.x + view.viewport.z - 1 - pixel.x);
    var sum = Means(vec3(0.0), 0.0, 0.0, half);
    for (var i = first; i <= last; i++) {
        sum = added(sum, means_of_pixel(pixel + vec2(i, 0)), part_of_box(half, i));
    }
    return divided(sum);
}

// The means of the texture at a pixel of the render target, which must be inside the viewport.
fn load_means(pixel: vec2<i32>) -> Means {
#ifdef MEANS
    return unpacked_means(textureLoad(means_texture, pixel - view.viewport.xy, 0));
#else
    return Means(vec3(0.0), 0.0, 0.0, 0.0);
#endif
}

// The means of a column of rows around a pixel.
fn mean_down(pixel: vec2<i32>, half: f32) -> Means {
    let reach = i32(ceil(half));
    let first = max(-reach, view.viewport.y - pixel.y);
    let last = min(reach, view.viewport.y + view.viewport.w - 1 - pixel.y);
    var sum = Means(vec3(0.0), 0.0, 0.0, half);
    for (var i = first; i <= last; i++) {
        sum = added(sum, load_means(pixel + vec2(0, i)), part_of_box(half, i));
    }
    return divided(sum);
}
