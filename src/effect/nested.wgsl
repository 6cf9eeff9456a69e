#define_import_path bevy_comics::effect::nested

// Nested marks along a coordinate: those of one level are every second one of the next. Each has a
// number of its own that does not change with the level. Pure functions.

#import bevy_comics::effect::noise::{hash, lattice}

// A level of nested marks along a coordinate.
struct Level {
    exponent: i32,
    // Distance of the old marks, 2^exponent, in units of the coordinate.
    size: f32,
    // How far the marks between them have grown, 0 to 1.
    grown: f32,
}

// The level at which old marks are at least `least` apart, and less than twice as much.
fn level_of(least: f32) -> Level {
    let bits = bitcast<u32>(clamp(least, 1e-30, 1e30));
    let exponent = i32(bits >> 23u) - 126;
    let mantissa = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    return Level(exponent, bitcast<f32>(u32(exponent + 127) << 23u), 2.0 / mantissa - 1.0);
}

// A coordinate in units of a level: the number of an old mark near the eye, and the place from it.
// `from_eye`: the coordinate from the eye on; `eye`: that of the eye.
fn place_of(from_eye: f32, eye: f32, size: f32) -> vec2<f32> {
    let whole = round(clamp(eye / size, -1e9, 1e9));
    return vec2(whole, from_eye / size + (eye / size - whole));
}

// A random number of the mark with a number at a level, the same at every level that has the mark.
fn mark_of(number: i32, exponent: i32, seed: u32) -> u32 {
    if number == 0 {
        return hash(seed);
    }
    let twos = countTrailingZeros(number);
    return hash(bitcast<u32>(number >> u32(twos)) ^ hash(bitcast<u32>(exponent + twos) ^ hash(seed)));
}

// The same of a node of nested square lattices.
fn mark_of_node(node: vec2<i32>, exponent: i32, seed: u32) -> u32 {
    // The node in the middle of all is of every level.
    let is_middle = (node.x | node.y) == 0;
    let twos = select(countTrailingZeros(node.x | node.y), -exponent, is_middle);
    let odd = select(node >> vec2(u32(twos) & 31u), vec2(0), is_middle);
    let of_level = bitcast<u32>(exponent + twos) * 2654435769u + seed * 2246822519u;
    return hash(bitcast<u32>(odd.x) ^ hash(bitcast<u32>(odd.y) ^ of_level));
}

// Smooth noise from -1 to 1 along a line, at two levels that are mixed: it does not jump where the
// level changes. `at`: number and place, see place_of.
fn noise_along(at: vec2<f32>, grown: f32, period: f32, seed: u32) -> f32 {
    let coarse = smooth_at((at.x + at.y) / period, seed);
    let fine = smooth_at((at.x + at.y) * 2.0 / period, seed);
    return mix(coarse, fine, grown);
}

fn smooth_at(x: f32, seed: u32) -> f32 {
    let cell = floor(x);
    let f = x - cell;
    let i = i32(clamp(cell, -2e9, 2e9));
    return mix(lattice(vec2(i, 0), seed), lattice(vec2(i + 1, 0), seed), f * f * (3.0 - 2.0 * f));
}

// Where a stroke of a line begins, as a fraction of its length: at every level at the same place.
fn stroke_start(mark: u32, exponent: i32) -> f32 {
    let turn = u32(-exponent) & 31u;
    let turned = (mark << turn) | (mark >> ((32u - turn) & 31u));
    return f32(turned >> 8u) / 16777216.0;
}

// The part of a stroke's length in which it becomes thin at its end.
const TAPER: f32 = 0.15;

// Factor of a line's width by breaks between strokes; its mean is 1. `at`: place along the line
// in lengths of strokes, from the first one's beginning; `grown`: of the breaks in the middle.
fn stroke_factor(at: f32, grown: f32, breaks: f32) -> f32 {
    let taper = TAPER / (1.0 + grown);
    let from_break = abs(at - round(at));
    let old = 1.0 - breaks * (1.0 - smoothstep(0.0, taper, from_break));
    let fresh = 1.0 - breaks * grown * (1.0 - smoothstep(0.0, taper, 0.5 - from_break));
    return old * fresh / (1.0 - TAPER * breaks);
}
