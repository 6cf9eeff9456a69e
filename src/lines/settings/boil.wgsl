#define_import_path bevy_comics::lines::boil

// How far lines are displaced, as if they were drawn again several times a second. Pure
// functions.

#import bevy_comics::effect::noise::wave

struct Boil {
    // Largest displacement per axis, and the length of its waves, in physical pixels.
    amplitude: f32,
    wavelength: f32,
    // Number of the drawing: seeds the noise.
    animation_seed: u32,
    unused: u32,
}

// Where the lines are found that are drawn at a place of the viewport; both in physical
// pixels from its corner.
fn boiled(b: Boil, at: vec2<f32>) -> vec2<f32> {
    let p = at / b.wavelength;
    let seed = 0x6c696e65u + b.animation_seed * 2u;
    return at + b.amplitude * vec2(wave(p, seed), wave(p, seed + 1u));
}
