#define_import_path bevy_comics::effects::focus

// Leaves what is nearer or farther than a distance out of focus. A pixel gathers what reaches
// it, but nothing that is nearer and sharper than it.

#import bevy_comics::depth::map::is_background
#import bevy_comics::depth::view::{inside_viewport, view}
#ifdef DEPTH
#import bevy_comics::depth::view::{load_depth, sample_count}
#endif
#import bevy_comics::effect::color::{finite_color, separated}
#import bevy_comics::effect::means::square
#import bevy_comics::effect::picture::load_picture
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::effect::screen::{LEAST, euclidean, paler}
#import bevy_comics::effects::paint::{Paint, box_paint}

const OFFSET: u32 = 1u;
const PAINTED: u32 = 2u;
const DOTS: u32 = 3u;
const LINES: u32 = 4u;
// Distance of the sky.
const SKY: f32 = 1e30;
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
    at_centre: u32,
    // DOTS: where the screens begin in the render target, their period in physical pixels, and
    // how much of them is seen where all is out of focus.
    centre: vec2<f32>,
    period: f32,
    amount: f32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn style_of(s: Focus) -> u32 {
#ifdef FOCUS_STYLE
    let compiled = #{FOCUS_STYLE}u;
    return compiled;
#else
    return 0u;
#endif
}

// Distance along the view's axis at a raw depth.
fn distance_of(s: Focus, raw: f32) -> f32 {
    if is_background(raw) {
        return SKY;
    }
    if s.reference > 0.0 {
        return s.axis.x + s.axis.y * raw;
    }
    return clamp(s.axis.x / max(raw + s.axis.y, 1e-30), 1e-9, SKY);
}

// The distance that a pixel of the viewport shows: the nearest of its samples, because an edge of
// a figure belongs to the figure.
fn distance_at(s: Focus, pixel: vec2<i32>) -> f32 {
#ifdef DEPTH
    var nearest = distance_of(s, load_depth(pixel, 0));
#ifdef MULTISAMPLED
    for (var i = 1; i < sample_count(); i++) {
        nearest = min(nearest, distance_of(s, load_depth(pixel, i)));
    }
#endif
    return nearest;
#else
    return s.distance;
#endif
}

fn focus_distance(s: Focus) -> f32 {
    if s.at_centre == 1u {
        return distance_at(s, view.viewport.xy + view.viewport.zw / 2);
    }
    return s.distance;
}

// How far apart two distances are.
fn distances_apart(s: Focus, a: f32, b: f32) -> f32 {
    if s.reference > 0.0 {
        return abs(a - b) / s.reference;
    }
    return abs(log(a / b));
}

// Radius in physical pixels by which something at a distance is out of focus.
fn defocus(s: Focus, distance: f32, focus_at: f32) -> f32 {
    let t = (distances_apart(s, distance, focus_at) - s.clear) * s.steepness;
    return s.radius * smoothstep(0.0, 1.0, t);
}

// What may be taken from another pixel: all from behind, and from nearer things as much as they
// are out of focus too. `own`, `other`: distance and radius.
fn taken(own: vec2<f32>, other: vec2<f32>) -> f32 {
    let blurred = clamp(other.y / max(own.y, 1e-6), 0.0, 1.0);
    return select(blurred, 1.0, other.x >= own.x);
}

// Whether something with a radius reaches a pixel at a distance of `by`.
fn reaching(radius: f32, by: f32) -> f32 {
    return smoothstep(by - 1.0, by + 1.0, radius);
}

// Distance and radius of a pixel.
fn focus_of(s: Focus, pixel: vec2<i32>, focus_at: f32) -> vec2<f32> {
    let distance = distance_at(s, pixel);
    return vec2(distance, defocus(s, distance, focus_at));
}

// Sum of the pixels on a spiral of the golden angle, and their number, not above the area of
// the disc.
fn blurred(s: Focus, pixel: vec2<i32>, own: vec2<f32>, focus_at: f32) -> vec4<f32> {
    let count = clamp(i32(own.y * own.y), 12, 64);
    let turn = mat2x2(vec2(-0.73736888, 0.67549029), vec2(-0.67549029, -0.73736888));
    var spoke = vec2(1.0, 0.0);
    var sum = vec4(0.0);
    for (var i = 0; i < count; i++) {
        let by = own.y * sqrt((f32(i) + 0.5) / f32(count));
        let other = inside_viewport(pixel + vec2<i32>(floor(by * spoke + 0.5)));
        spoke = turn * spoke;
        let there = focus_of(s, other, focus_at);
        let weight = reaching(there.y, by) * taken(own, there);
        if weight > 0.0 {
            let found = load_picture(other);
            sum += weight * vec4(finite_color(found.rgb), found.a);
        }
    }
    return sum;
}

// The picture between the centres of pixels, without what may not be taken. `instead`: what is
// there in its place.
fn taken_at(s: Focus, place: vec2<f32>, own: vec2<f32>, focus_at: f32, instead: vec3<f32>) -> vec3<f32> {
    let low = floor(place - 0.5);
    let part = place - 0.5 - low;
    var sum = vec3(0.0);
    for (var i = 0; i < 4; i++) {
        let corner = vec2(i & 1, i >> 1u);
        let weight = select(1.0 - part, part, corner == vec2(1));
        let other = inside_viewport(vec2<i32>(low) + corner);
        let found = load_picture(other);
        let color = finite_color(found.rgb) + (1.0 - found.a) * instead;
        let share = taken(own, focus_of(s, other, focus_at));
        sum += weight.x * weight.y * mix(instead, color, share);
    }
    return sum;
}

fn focus_half_box(s: Focus, p: Pixel) -> f32 {
    return 0.5 * focus_of(s, vec2<i32>(p.position), focus_distance(s)).y;
}

// Coverage by a plate. `turn`: cosine and sine of its angle; `phase` in cells.
fn dots(s: Focus, place: vec2<f32>, turn: vec2<f32>, phase: f32, tone: f32) -> f32 {
    let at = vec2(dot(place, turn), dot(place, vec2(-turn.y, turn.x))) / s.period + phase;
    return paler(euclidean(at, clamp(tone, LEAST, 1.0 - LEAST), s.period), tone);
}

// A colour in dots of four ideal inks, at the angles of Halftone. `amount`: how much of the dots
// is seen; the rest is printed as plain tones, so that the mean stays.
fn dotted(s: Focus, position: vec2<f32>, color: vec3<f32>, amount: f32) -> vec3<f32> {
    let shown = clamp(color, vec3(0.0), vec3(1.0));
    let tones = separated(shown, 0.7);
    let place = position - s.centre;
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

// The colour out of focus, not multiplied by the opacity. `own`: distance and radius.
fn out_of_focus(s: Focus, p: Pixel, own: vec2<f32>, focus_at: f32) -> vec3<f32> {
    let pixel = vec2<i32>(p.position);
    let color = p.color / max(p.alpha, 1e-3);
    if style_of(s) == DOTS {
        return dotted(s, p.position, color, s.amount * own.y / max(s.radius, 1e-6));
    }
    if style_of(s) == OFFSET {
        let by = own.y * DIAGONAL;
        let red = taken_at(s, p.position + by, own, focus_at, color);
        let blue = taken_at(s, p.position - by, own, focus_at, color);
        return vec3(red.r, color.g, blue.b);
    }
    if style_of(s) == PAINTED {
        let c = box_paint(Paint(0.0, 0.0, 4.0, 1.0), pixel, 0.5 * own.y);
        return select(color, square(c.color / max(c.weight, 1e-30)), c.weight > 0.0);
    }
    let sum = blurred(s, pixel, own, focus_at);
    return select(color, sum.rgb / max(sum.a, 1e-30), sum.a > 0.0);
}

fn focus(s: Focus, p: Pixel) -> Pixel {
    var out = p;
    if style_of(s) == LINES {
        return out;
    }
    let focus_at = focus_distance(s);
    let own = focus_of(s, vec2<i32>(p.position), focus_at);
    if own.y > 0.0 && p.alpha > 0.0 {
        out.color = out_of_focus(s, p, own, focus_at) * p.alpha;
    }
    return out;
}
