#define_import_path bevy_comics::effects::paint

// Kuwahara's filter: a pixel takes the mean color of the areas around it whose luminance
// varies least.
//
// Box form: a square of side r + 1 with its corner in the pixel is the box of that side in its
// middle, r / 2 away. So the means over all boxes are drawn first, and a pixel reads eight.
//
// Anisotropic form: sectors of an ellipse along the edges of the picture, with polynomial
// weights (Kyprianidis, Kang and Döllner 2009; Kyprianidis, Semmo, Kang and Döllner 2010).

#import bevy_comics::depth::view::view
#import bevy_comics::effect::color::luminance
#import bevy_comics::effect::box_statistics::{
    color_of, load_means, means_of, part_of_box, root, square, variance, Means,
}
#import bevy_comics::effect::picture::{load_picture, picture_at}
#import bevy_comics::effect::pixel::Pixel
#ifdef EFFECT_PAINT_FIGURES
#import bevy_comics::objects::load_object
#endif

// Radii in physical pixels at both ends of the depth map.
struct Paint {
    at_near: f32,
    at_far: f32,
    // Half the exponent of the deviation.
    half_sharpness: f32,
    amount: f32,
}

// Variance that is not seen: of rounding to 8 bits, and of noise.
const UNSEEN: f32 = 1e-4;
// Samples of the ellipse.
const SAMPLES: i32 = 64;
// By how much sectors overlap behind the pixel; eta makes those of 3/16 of a turn meet there.
const ZETA: f32 = 0.33333333;
const ETA: f32 = 3.7739;

fn paint_radius(s: Paint, depth: f32) -> f32 {
    return mix(s.at_near, s.at_far, clamp(depth, 0.0, 1.0));
}

fn paint_half_box(s: Paint, p: Pixel) -> f32 {
    return 0.5 * paint_radius(s, p.depth.x);
}

// Whether the exponent of the deviation is 8, the default: a constant where the pass defines it.
fn is_eighth(s: Paint) -> bool {
#ifdef EFFECT_PAINT_EIGHTH
    let compiled = #{EFFECT_PAINT_EIGHTH}u;
    return compiled == 1u;
#else
    return s.half_sharpness == 4.0;
#endif
}

// The areas that a pixel has chosen so far.
struct Choice {
    // Sum of their weights times: luminance, red and blue less that, 1.
    sum: vec4<f32>,
    // The smallest variance; that area has its own fraction as its weight. Unused if the exponent
    // is 8: then weights are powers of the variances themselves.
    least: f32,
}

fn no_choice() -> Choice {
    return Choice(vec4(0.0), 1e30);
}

// The color of the areas in linear light, if there are any.
fn chosen_color(c: Choice) -> vec3<f32> {
    let mean = c.sum.xyz / max(c.sum.w, 1e-37);
    return square(color_of(mean.x, mean.yz));
}

// Adds an area. `fraction`: its weight before its variance counts; 0 adds nothing.
fn chosen(c: Choice, m: Means, fraction: f32, half_sharpness: f32, eighth: bool) -> Choice {
    let found = variance(m) + UNSEEN;
    let area = vec4(m.mean, m.chroma, 1.0);
    if eighth {
        // Light of up to 65504 has variances of up to 16376: the power is above 1e-33.
        let ratio = UNSEEN / found;
        let fourth = ratio * ratio;
        return Choice(c.sum + fraction * (fourth * fourth) * area, c.least);
    }
    // Relative to the best area, because powers of the variances themselves may be too small for
    // a number.
    let ratio = pow(min(found, c.least) / max(found, c.least), half_sharpness);
    let better = found < c.least;
    let before = select(1.0, ratio, better);
    let now = fraction * select(ratio, 1.0, better);
    let next = Choice(before * c.sum + now * area, min(found, c.least));
    if fraction > 0.0 {
        return next;
    }
    return c;
}

fn is_inside(pixel: vec2<i32>) -> bool {
    let at = pixel - view.viewport.xy;
    return all(at >= vec2(0)) && all(at < view.viewport.zw);
}

// The factor for an area with its middle in another pixel: less if that shows another object.
fn figure_factor(own: vec2<i32>, other: vec2<i32>) -> f32 {
#ifdef EFFECT_PAINT_FIGURES
    return select(0.125, 1.0, load_object(own).x == load_object(other).x);
#else
    return 1.0;
#endif
}

// The factor for a box that is smaller than asked: how much of the pixel it contains, of what it
// should. One that does not reach the pixel would be even on the other side of an edge.
fn reaching_fraction(found: f32, half: f32, at: i32) -> f32 {
    return min(part_of_box(found, at) / max(part_of_box(half, at), 1e-6), 1.0);
}

// The boxes around a pixel at one distance.
struct Ring {
    pixel: vec2<i32>,
    at: i32,
    // Half the side that they should have.
    half: f32,
    fraction: f32,
    half_sharpness: f32,
    eighth: bool,
}

// Adds the box in one direction. It is read even where it does not count: CPU adapters execute
// both sides of a branch.
fn box_added(c: Choice, r: Ring, direction: vec2<i32>) -> Choice {
    let other = r.pixel + r.at * direction;
    let m = load_means(other);
    let reaches = reaching_fraction(m.half, r.half, r.at);
    let fraction = r.fraction * m.coverage * reaches * figure_factor(r.pixel, other);
    return chosen(c, m, select(0.0, fraction, is_inside(other)), r.half_sharpness, r.eighth);
}

// Adds the eight boxes of a ring.
fn ring_added(before: Choice, r: Ring) -> Choice {
    var c = box_added(before, r, vec2(-1, -1));
    c = box_added(c, r, vec2(0, -1));
    c = box_added(c, r, vec2(1, -1));
    c = box_added(c, r, vec2(-1, 0));
    c = box_added(c, r, vec2(1, 0));
    c = box_added(c, r, vec2(-1, 1));
    c = box_added(c, r, vec2(0, 1));
    return box_added(c, r, vec2(1, 1));
}

// The boxes around a pixel, whose halves are whole pixels.
fn whole_box_paint(pixel: vec2<i32>, half: f32, half_sharpness: f32, eighth: bool) -> Choice {
    return ring_added(no_choice(), Ring(pixel, i32(half), half, 1.0, half_sharpness, eighth));
}

// The boxes around a pixel. Boxes at half a pixel cannot be read: they would reach beyond the
// pixel, over an edge. So those at both whole distances are, and those that do reach over an
// edge are not chosen.
fn box_paint(pixel: vec2<i32>, half: f32, half_sharpness: f32, eighth: bool) -> Choice {
    let low = floor(half);
    let part = half - low;
    let ring = Ring(pixel, i32(low), half, 1.0 - part, half_sharpness, eighth);
    let next = Ring(pixel, i32(low) + 1, half, part, half_sharpness, eighth);
    return ring_added(ring_added(no_choice(), ring), next);
}

// Luminance of the square root of the light at a pixel.
fn luminance_at(pixel: vec2<i32>) -> f32 {
    return luminance(root(load_picture(pixel).rgb));
}

// The change of the luminance across (x) and down (y) a pixel: Sobel.
fn slope_at(pixel: vec2<i32>) -> vec2<f32> {
    let nw = luminance_at(pixel + vec2(-1, -1));
    let n = luminance_at(pixel + vec2(0, -1));
    let ne = luminance_at(pixel + vec2(1, -1));
    let w = luminance_at(pixel + vec2(-1, 0));
    let e = luminance_at(pixel + vec2(1, 0));
    let sw = luminance_at(pixel + vec2(-1, 1));
    let south = luminance_at(pixel + vec2(0, 1));
    let se = luminance_at(pixel + vec2(1, 1));
    return 0.125 * vec2(
        ne + 2.0 * e + se - nw - 2.0 * w - sw,
        sw + 2.0 * south + se - nw - 2.0 * n - ne,
    );
}

// The structure tensor around a pixel, smoothed: xx, xy, yy.
fn tensor_at(pixel: vec2<i32>) -> vec3<f32> {
    var sum = vec3(0.0);
    for (var k = 0; k < 9; k++) {
        let by = vec2(k % 3, k / 3) - 1;
        let g = slope_at(pixel + by);
        let weight = f32((2 - abs(by.x)) * (2 - abs(by.y))) / 16.0;
        sum += weight * vec3(g.x * g.x, g.x * g.y, g.y * g.y);
    }
    return sum;
}

// Unit vector along the edge in a tensor (xy), and how much of an edge it is, 0 to 1 (z).
fn direction_of(tensor: vec3<f32>) -> vec3<f32> {
    let half_sum = 0.5 * (tensor.x + tensor.z);
    let half_difference = 0.5 * (tensor.x - tensor.z);
    let spread = length(vec2(half_difference, tensor.y));
    // Across the edge, by the longer of two forms.
    let across = select(
        vec2(tensor.y, spread - half_difference),
        vec2(spread + half_difference, tensor.y),
        half_difference > 0.0,
    );
    let size = length(across);
    let unit = select(vec2(0.0, 1.0), across / max(size, 1e-30), size > 1e-30);
    return vec3(-unit.y, unit.x, spread / (half_sum + UNSEEN));
}

// Direction of one of the eight sectors.
fn sector_direction(k: i32) -> vec2<f32> {
    let side = select(1.0, -1.0, k >= 4);
    let axis = select(vec2(side, 0.0), vec2(0.0, side), (k & 2) != 0);
    let turned = vec2(-axis.y, axis.x);
    return select(axis, 0.70710678 * (axis + turned), (k & 1) != 0);
}

// The weight of a place of the unit disc in a sector.
fn sector_weight(place: vec2<f32>, direction: vec2<f32>) -> f32 {
    let along = dot(place, direction);
    let across = place.x * direction.y - place.y * direction.x;
    let inside = max(0.0, along + ZETA - ETA * across * across);
    return inside * inside * exp(-3.125 * dot(place, place));
}

// The sectors of an ellipse with these half axes.
fn sector_paint(s: Paint, position: vec2<f32>, long: vec2<f32>, short: vec2<f32>) -> Choice {
    var sums: array<vec4<f32>, 8>;
    var weights: array<f32, 8>;
    var whole: array<f32, 8>;
    // The golden angle.
    let turn = mat2x2(vec2(-0.73736888, 0.67549029), vec2(-0.67549029, -0.73736888));
    var spoke = vec2(1.0, 0.0);
    for (var i = 0; i < SAMPLES; i++) {
        let place = spoke * sqrt((f32(i) + 0.5) / f32(SAMPLES));
        spoke = turn * spoke;
        let m = means_of(picture_at(position + place.x * long + place.y * short));
        for (var k = 0; k < 8; k++) {
            let weight = sector_weight(place, sector_direction(k));
            sums[k] += weight * m.coverage * vec4(m.mean, m.square, m.chroma);
            weights[k] += weight * m.coverage;
            whole[k] += weight;
        }
    }
    var c = no_choice();
    for (var k = 0; k < 8; k++) {
        let mean = sums[k] / max(weights[k], 1e-20);
        let direction = sector_direction(k);
        let middle = vec2<i32>(floor(position + 0.5 * (direction.x * long + direction.y * short)));
        var fraction = weights[k] / whole[k];
        if is_inside(middle) {
            fraction *= figure_factor(vec2<i32>(position), middle);
        }
        let m = Means(mean.x, mean.y, mean.zw, 1.0, 0.0);
        c = chosen(c, m, fraction, s.half_sharpness, is_eighth(s));
    }
    return c;
}

// The paint at a pixel.
fn painted(s: Paint, p: Pixel) -> Choice {
    let pixel = vec2<i32>(p.position);
#ifdef EFFECT_PAINT_ANISOTROPIC
    let radius = paint_radius(s, p.depth.x);
    let edge = direction_of(tensor_at(pixel));
    let stretch = 1.0 + edge.z;
    let long = radius * stretch * edge.xy;
    let short = radius / stretch * vec2(-edge.y, edge.x);
    return sector_paint(s, p.position, long, short);
#else
    let half = paint_half_box(s, p);
#ifdef EFFECT_PAINT_WHOLE
    return whole_box_paint(pixel, half, s.half_sharpness, is_eighth(s));
#else
    return box_paint(pixel, half, s.half_sharpness, is_eighth(s));
#endif
#endif
}

fn paint(s: Paint, p: Pixel) -> Pixel {
    var out = p;
    let c = painted(s, p);
    // Light that was added to a transparent background stays.
    let color = mix(p.color, chosen_color(c) * p.alpha, s.amount * p.alpha);
    out.color = select(p.color, color, c.sum.w > 0.0);
    return out;
}
