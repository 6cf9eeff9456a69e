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

// A coordinate in units of a level.
struct Place {
    // That of an old mark near the eye.
    number: i32,
    // From this mark on.
    at: f32,
}

// `from_eye`: the coordinate from the eye on; `eye`: that of the eye.
fn place_of(from_eye: f32, eye: f32, size: f32) -> Place {
    let whole = round(clamp(eye / size, -1e9, 1e9));
    return Place(i32(whole), from_eye / size + (eye / size - whole));
}

#ifdef WORLD_ORIGIN
// The same with a coordinate of the eye that is exact far from the origin, as strokes.rs splits it: in units
// of 2^-12, modulo 2^20, and the rest in units of 2^-36.
fn place_of_split(from_eye: f32, eye: vec2<i32>, level: Level) -> Place {
    let down = u32(clamp(level.exponent + 12, 0, 31));
    let number = (eye.x << u32(clamp(-level.exponent - 12, 0, 31))) >> down;
    let units = f32(eye.x & ((1 << down) - 1)) + f32(eye.y) / 16777216.0;
    return Place(number, from_eye / level.size + units / 4096.0 / level.size);
}

// A coordinate for place_of_split.
fn split(x: f32) -> vec2<i32> {
    let units = clamp(4096.0 * x, -2e9, 2e9);
    return vec2(i32(floor(units)), i32((units - floor(units)) * 16777216.0));
}
#endif

// The number of a mark at a level: far from the origin, coordinates count modulo 2^20.
fn wrapped(number: i32, exponent: i32) -> i32 {
#ifdef WORLD_ORIGIN
    let unused = u32(clamp(exponent + 12, 0, 31));
    return (number << unused) >> unused;
#else
    return number;
#endif
}

// A random number of the mark with a number at a level, the same at every level that has the mark.
fn mark_of(any_number: i32, exponent: i32, seed: u32) -> u32 {
    let number = wrapped(any_number, exponent);
    if number == 0 {
        return hash(seed);
    }
    let twos = countTrailingZeros(number);
    return hash(bitcast<u32>(number >> u32(twos)) ^ hash(bitcast<u32>(exponent + twos) ^ hash(seed)));
}

// The same of a node of nested square lattices.
fn mark_of_node(any_node: vec2<i32>, exponent: i32, seed: u32) -> u32 {
    let node = vec2(wrapped(any_node.x, exponent), wrapped(any_node.y, exponent));
    // The node in the middle of all is of every level.
    let is_middle = (node.x | node.y) == 0;
    let twos = select(countTrailingZeros(node.x | node.y), -exponent, is_middle);
    let odd = select(node >> vec2(u32(twos) & 31u), vec2(0), is_middle);
    let of_level = bitcast<u32>(exponent + twos) * 2654435769u + seed * 2246822519u;
    return hash(bitcast<u32>(odd.x) ^ hash(bitcast<u32>(odd.y) ^ of_level));
}

// Smooth noise from -1 to 1 along a line, at two levels that are mixed: it does not jump where the
// level changes. A cell of the coarse one is 2^octave old marks wide.
fn noise_along(at: Place, level: Level, octave: i32, seed: u32) -> f32 {
    let coarse = smooth_at(at, level.exponent, octave, seed);
    let fine = smooth_at(at, level.exponent, octave - 1, seed);
    return mix(coarse, fine, level.grown);
}

fn smooth_at(at: Place, exponent: i32, octave: i32, seed: u32) -> f32 {
    var first = 0;
    var rest = at.number;
#ifdef WORLD_ORIGIN
    // The cells before the number: an f32 would round it.
    let down = u32(max(octave, 0));
    first = (at.number << u32(max(-octave, 0))) >> down;
    rest = at.number & ((1 << down) - 1);
#endif
    let x = (f32(rest) + at.at) * bitcast<f32>(u32(127 - octave) << 23u);
    let cell = floor(x);
    let f = x - cell;
    let i = first + i32(clamp(cell, -2e9, 2e9));
    let low = lattice(vec2(wrapped(i, exponent + octave), 0), seed);
    let high = lattice(vec2(wrapped(i + 1, exponent + octave), 0), seed);
    return mix(low, high, f * f * (3.0 - 2.0 * f));
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
