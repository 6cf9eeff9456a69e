#define_import_path bevy_comics::objects::pressure

// Smooth noise that is anchored to an object: how hard the pen presses at a place of its
// surface. Pure functions.

#import bevy_comics::effect::noise::hash

struct Pressure {
    // By what fraction lines become wider or narrower at most.
    amount: f32,
    // Length of the waves, in pixels of the viewport.
    wavelength: f32,
    unused_x: f32,
    unused_y: f32,
}

// An object in world space. Its axes may have any length and angle.
struct Frame {
    origin: vec3<f32>,
    x_axis: vec3<f32>,
    y_axis: vec3<f32>,
    z_axis: vec3<f32>,
}

// The length of the longest axis: 1 if the object is not scaled.
fn frame_scale(f: Frame) -> f32 {
    return max(max(length(f.x_axis), length(f.y_axis)), max(length(f.z_axis), 1e-20));
}

// A place of the world as the object sees it, in units of its longest axis. A place that
// moves, turns and grows with the object stays where it is. An object that is stretched along
// an axis does not stretch it.
fn place_on_object(f: Frame, world: vec3<f32>) -> vec3<f32> {
    let away = world - f.origin;
    let along = vec3(
        dot(away, f.x_axis / max(length(f.x_axis), 1e-20)),
        dot(away, f.y_axis / max(length(f.y_axis), 1e-20)),
        dot(away, f.z_axis / max(length(f.z_axis), 1e-20)),
    );
    return along / frame_scale(f);
}

// A random number from -1 to 1 at an integer grid point.
fn solid_lattice(cell: vec3<i32>, seed: u32) -> f32 {
    let c = bitcast<vec3<u32>>(cell);
    let h = hash(c.x ^ hash(c.y ^ hash(c.z ^ hash(seed))));
    return f32(h >> 8u) / 8388608.0 - 1.0;
}

fn solid_row(cell: vec3<i32>, seed: u32, t: f32) -> f32 {
    return mix(solid_lattice(cell, seed), solid_lattice(cell + vec3(1, 0, 0), seed), t);
}

// Smooth noise from -1 to 1: interpolates the random numbers at the integer grid points
// around `at`.
fn solid_wave(at: vec3<f32>, seed: u32) -> f32 {
    let low = floor(at);
    let cell = vec3<i32>(low);
    let f = at - low;
    let t = f * f * (3.0 - 2.0 * f);
    let near = mix(solid_row(cell, seed, t.x), solid_row(cell + vec3(0, 1, 0), seed, t.x), t.y);
    let far = mix(
        solid_row(cell + vec3(0, 0, 1), seed, t.x),
        solid_row(cell + vec3(0, 1, 1), seed, t.x),
        t.y,
    );
    return mix(near, far, t.z);
}

// A turn that moves the planes of the grid away from the axes of objects, along which their
// edges often lie: along such a plane, noise has less variety.
const TURN: mat3x3<f32> = mat3x3<f32>(
    2.0 / 15.0, 14.0 / 15.0, -5.0 / 15.0,
    -10.0 / 15.0, 5.0 / 15.0, 10.0 / 15.0,
    11.0 / 15.0, 2.0 / 15.0, 10.0 / 15.0,
);

// Largest power of two of an octave, up and down.
const OCTAVES: f32 = 60.0;

// Noise of one octave, with one random number per 2^octave units.
fn octave_wave(place: vec3<f32>, octave: i32, seed: u32) -> f32 {
    return solid_wave(TURN * place * ldexp(1.0, -octave), seed ^ hash(bitcast<u32>(octave)));
}

// Noise from -1 to 1 whose waves are 2^level units long at a place: that of the octaves below
// and above the level. The weights are a sine and a cosine, so its variance and the speed at
// which it changes with the level are the same at all levels.
fn nested_wave(place: vec3<f32>, level: f32, seed: u32) -> f32 {
    let within = clamp(level, -OCTAVES, OCTAVES);
    let below = floor(within);
    let angle = 1.5707964 * (within - below);
    let octave = i32(below);
    let mixed = cos(angle) * octave_wave(place, octave, seed)
        + sin(angle) * octave_wave(place, octave + 1, seed);
    return clamp(mixed, -1.0, 1.0);
}

// The factor of the width of lines at a place of an object. `pixels`: those of the viewport
// per unit of the place.
fn pressure_factor(p: Pressure, place: vec3<f32>, pixels: f32, seed: u32) -> f32 {
    let level = log2(max(p.wavelength, 1e-3) / max(pixels, 1e-20));
    return 1.0 + p.amount * nested_wave(place, level, seed);
}

// A factor as the texture of widths stores it: 127 of 255 is 1, 254 is 2.
fn stored_factor(factor: f32) -> f32 {
    return clamp(factor, 0.0, 2.0) * (127.0 / 255.0);
}

// The factor of a texel of that texture.
fn loaded_factor(texel: f32) -> f32 {
    return min(texel * (255.0 / 127.0), 2.0);
}
