#define_import_path bevy_comics::effects::focus

// Leaves what is nearer or farther than a distance out of focus. A pixel gathers what reaches
// it, but nothing that is nearer and sharper than it.

#import bevy_comics::depth::map::is_background
#import bevy_comics::depth::view::{inside_viewport, view}
#ifdef MIDDLE_DEPTH
#import bevy_comics::depth::view::middle_depth
#endif
#ifdef DEPTH
#import bevy_comics::depth::view::{load_depth, sample_count}
#endif
#import bevy_comics::effect::color::separated
#import bevy_comics::effect::aux_scalar::load_aux_scalar
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::effect::screen::{LEAST, euclidean, paler}
#import bevy_comics::effects::paint::{chosen_color, whole_box_paint}

const BLURRED: u32 = 0u;
const OFFSET: u32 = 1u;
const PAINTED: u32 = 2u;
const DOTS: u32 = 3u;
const LINES: u32 = 4u;
// Distance of the sky.
const SKY: f32 = 1e30;
// By how much the angle grows from one place of a spiral to the next: the golden angle.
const TURN: mat2x2<f32> = mat2x2(vec2(-0.73736888, 0.67549029), vec2(-0.67549029, -0.73736888));
// Unit vector from the blue to the red plate.
const DIAGONAL: vec2<f32> = vec2(0.8, 0.6);

struct Focus {
    // The distance at a raw depth d is x / (d + y), in an orthographic view x + y d.
    axis: vec2<f32>,
    // Distance of the focus.
    distance: f32,
    // Orthographic views: the length that distances are measured in; 0 in perspective.
    reference: f32,
    clear: f32,
    steepness: f32,
    // In physical pixels.
    radius: f32,
    // 1: the focus is at what the middle of the view shows.
    at_center: u32,
    // DOTS: where the screens begin in the render target, the size of their cells in physical
    // pixels, and how much of them is seen where all is out of focus.
    center: vec2<f32>,
    cell_size: f32,
    amount: f32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn style_of(s: Focus) -> u32 {
#ifdef EFFECT_FOCUS_STYLE
    let compiled = #{EFFECT_FOCUS_STYLE}u;
    return compiled;
#else
    return 0u;
#endif
}

// Whether the view is orthographic: a constant where the pass defines it.
fn is_parallel(s: Focus) -> bool {
#ifdef EFFECT_FOCUS_PARALLEL
    let compiled = #{EFFECT_FOCUS_PARALLEL}u;
    return compiled == 1u;
#else
    return s.reference > 0.0;
#endif
}

// How near something at a raw depth is: 1 / distance along the view's axis, in an orthographic
// view minus the distance. It takes no division per pixel.
fn nearness_of(s: Focus, raw: f32) -> f32 {
    if is_parallel(s) {
        return select(-s.axis.x - s.axis.y * raw, -SKY, is_background(raw));
    }
    let per_distance = clamp((raw + s.axis.y) * (1.0 / s.axis.x), 1.0 / SKY, 1e9);
    return select(per_distance, 1.0 / SKY, is_background(raw));
}

// How near a pixel of the viewport is: the nearest of its samples, because an edge of a figure
// belongs to the figure.
fn nearness_at(s: Focus, pixel: vec2<i32>) -> f32 {
#ifdef DEPTH
    var nearest = nearness_of(s, load_depth(pixel, 0));
#ifdef MULTISAMPLED
    for (var i = 1; i < sample_count(); i++) {
        nearest = max(nearest, nearness_of(s, load_depth(pixel, i)));
    }
#endif
    return nearest;
#else
    return select(1.0, -1.0, is_parallel(s));
#endif
}

// Distance of the focus.
fn focus_distance(s: Focus) -> f32 {
    if s.at_center == 1u {
#ifdef MIDDLE_DEPTH
        let near = nearness_of(s, middle_depth());
#else
        let near = nearness_at(s, view.viewport.xy + view.viewport.zw / 2);
#endif
        return select(1.0 / near, -near, is_parallel(s));
    }
    return s.distance;
}

// How far nearer than the focus something is: natural logarithm of the ratio of distances; in an
// orthographic view, the difference as a fraction of a length.
fn nearer_by(s: Focus, nearness: f32, focus_at: f32) -> f32 {
    if is_parallel(s) {
        return (nearness + focus_at) * (1.0 / s.reference);
    }
    return log(nearness * focus_at);
}

// Radius in physical pixels by which something is out of focus, negative if it is nearer than the
// focus.
fn defocus(s: Focus, nearness: f32, focus_at: f32) -> f32 {
    let nearer = nearer_by(s, nearness, focus_at);
    let t = clamp((abs(nearer) - s.clear) * s.steepness, 0.0, 1.0);
    let radius = s.radius * t * t * (3.0 - 2.0 * t);
    return select(radius, -radius, nearer > 0.0);
}

// What a pixel that is out of focus may take from another one: all from behind, and from nearer
// things as much as they are out of focus too. Of what lies on the same side of the focus, the one
// that is farther from the focus has the larger radius, so that both radii tell. Signed.
fn taken(own: f32, other: f32) -> f32 {
    let blurred = min(abs(other) * (1.0 / max(abs(own), 1e-6)), 1.0);
    return select(blurred, 1.0, own < 0.0);
}

// Whether something with a radius reaches a pixel at a distance of `by`.
fn reaching(radius: f32, by: f32) -> f32 {
    let t = clamp(0.5 * (radius - by) + 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Signed radius of a pixel.
fn focus_of(s: Focus, pixel: vec2<i32>, focus_at: f32) -> f32 {
    return defocus(s, nearness_at(s, pixel), focus_at);
}

// The number that is stored beside the picture, for BLURRED and OFFSET.
fn focus_aux_scalar(s: Focus, p: Pixel) -> f32 {
    return focus_of(s, vec2<i32>(p.position), focus_distance(s));
}

// Number of places in a disc of a radius: their error grows little with the radius, see
// docs/internals/measurements.md. It needs not grow with the area, because the spiral fills the
// disc evenly.
fn place_count(radius: f32) -> i32 {
    return 12 + i32(radius);
}

// Sum of the pixels on a spiral. `own`: signed radius.
fn blurred(pixel: vec2<i32>, own: f32) -> vec4<f32> {
    let count = place_count(abs(own));
    let per_place = own * own / f32(count);
    var spoke = vec2(1.0, 0.0);
    var sum = vec4(0.0);
    for (var i = 0; i < count; i++) {
        let by = sqrt((f32(i) + 0.5) * per_place);
        let other = inside_viewport(pixel + vec2<i32>(floor(by * spoke + 0.5)));
        spoke = TURN * spoke;
        let there = load_aux_scalar(other);
        sum += reaching(abs(there.number), by) * taken(own, there.number) * there.color;
    }
    return sum;
}

// A pixel without what may not be taken. `instead`: what is there in its place.
fn taken_from(pixel: vec2<i32>, own: f32, instead: vec3<f32>) -> vec3<f32> {
    let found = load_aux_scalar(inside_viewport(pixel));
    let color = found.color.rgb + (1.0 - found.color.a) * instead;
    return mix(instead, color, taken(own, found.number));
}

// The pixel that is nearest to a place on the diagonal, from the pixel in its middle.
fn on_diagonal(by: f32) -> vec2<i32> {
    return vec2<i32>(floor(by * DIAGONAL + 0.5));
}

// The picture at a distance along the diagonal, of what may be taken: between the two nearest of
// the places at whole distances, whose pixels are next to each other. The four pixels around the
// place would be twice as many. `side`: 1 or -1.
fn taken_along(pixel: vec2<i32>, side: f32, own: f32, instead: vec3<f32>) -> vec3<f32> {
    let by = abs(own);
    let low = floor(by);
    let first = taken_from(pixel + on_diagonal(side * low), own, instead);
    let next = taken_from(pixel + on_diagonal(side * (low + 1.0)), own, instead);
    return mix(first, next, by - low);
}

// Half the side of a box of PAINTED, in whole pixels: CPU adapters would execute twice the work for
// boxes between two sizes.
fn focus_half_box(s: Focus, p: Pixel) -> f32 {
    let radius = focus_of(s, vec2<i32>(p.position), focus_distance(s));
    return floor(0.5 * abs(radius) + 0.5);
}

// Coverage by a plate. `turn`: cosine and sine of its angle; `phase` in cells.
fn dots(s: Focus, place: vec2<f32>, turn: vec2<f32>, phase: f32, tone: f32) -> f32 {
    let at = vec2(dot(place, turn), dot(place, vec2(-turn.y, turn.x))) / s.cell_size + phase;
    return paler(euclidean(at, clamp(tone, LEAST, 1.0 - LEAST), s.cell_size), tone);
}

// A color in dots of four ideal inks, at the angles of Halftone. `amount`: how much of the dots
// is seen; the rest is printed as plain tones, so that the mean stays.
fn dotted(s: Focus, position: vec2<f32>, color: vec3<f32>, amount: f32) -> vec3<f32> {
    let shown = clamp(color, vec3(0.0), vec3(1.0));
    let tones = separated(shown, 0.7);
    let place = position - s.center;
    let k = vec4(
        dots(s, place, vec2(0.9659258, 0.2588190), 0.0, tones.x),
        dots(s, place, vec2(0.2588190, 0.9659258), 0.0, tones.y),
        dots(s, place, vec2(1.0, 0.0), 0.0, tones.z),
        dots(s, place, vec2(0.70710678, 0.70710678), 0.25, tones.w),
    );
    let plates = 1.0 - mix(tones, k, amount);
    // Light above 1 stays.
    return color - shown + plates.xyz * plates.w;
}

// The color out of focus, not multiplied by the opacity. `own`: signed radius.
fn out_of_focus(s: Focus, p: Pixel, own: f32) -> vec3<f32> {
    let pixel = vec2<i32>(p.position);
    let color = p.color / max(p.alpha, 1e-3);
    if style_of(s) == DOTS {
        return dotted(s, p.position, color, s.amount * abs(own) / max(s.radius, 1e-6));
    }
    if style_of(s) == OFFSET {
        let red = taken_along(pixel, 1.0, own, color);
        let blue = taken_along(pixel, -1.0, own, color);
        return vec3(red.r, color.g, blue.b);
    }
    if style_of(s) == PAINTED {
        let c = whole_box_paint(pixel, floor(0.5 * abs(own) + 0.5), 4.0, true);
        return select(color, chosen_color(c), c.sum.w > 0.0);
    }
    let sum = blurred(pixel, own);
    return select(color, sum.rgb / max(sum.a, 1e-30), sum.a > 0.0);
}

fn focus(s: Focus, p: Pixel) -> Pixel {
    var out = p;
    if style_of(s) == LINES {
        return out;
    }
    let pixel = vec2<i32>(p.position);
    var own = 0.0;
    if style_of(s) == BLURRED || style_of(s) == OFFSET {
        own = load_aux_scalar(pixel).number;
    } else {
        own = focus_of(s, pixel, focus_distance(s));
    }
    if own != 0.0 && p.alpha > 0.0 {
        out.color = out_of_focus(s, p, own) * p.alpha;
    }
    return out;
}
