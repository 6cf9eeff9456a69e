#define_import_path bevy_comics::effect::blue_noise

// A tile of 64 x 64 thresholds in an even, irregular order, for effects that need
// `Needs::BLUE_NOISE`. The only module that declares binding 11.

#ifdef BLUE_NOISE
// For each of four plates, as bytes: the rank of a threshold in 256 classes, and of those to its
// right, below it, and to the right below it.
@group(0) @binding(11) var blue_noise_tile: texture_2d<u32>;
#else
#import bevy_comics::effect::noise::hash

fn white_noise(at: vec2<i32>) -> f32 {
    let place = at & vec2(63);
    return f32(hash(u32(place.y * 64 + place.x)) & 255u);
}
#endif

// Where the part of the tile of each plate begins, in plates.
const PLATE: vec2<i32> = vec2(19, 37);

// The thresholds of a plate (0 to 3) at a place, to its right, below it, and to the right below it,
// each above 0 and below 1. Each plate has its own part of the tile, which repeats every 64 steps.
// In a pass that has no tile: white noise.
fn blue_noise_around(at: vec2<i32>, plate: i32) -> vec4<f32> {
#ifdef BLUE_NOISE
    let words = textureLoad(blue_noise_tile, at & vec2(63), 0);
    let classes = unpack4x8unorm(words[plate]) * 255.0;
#else
    let own = at + plate * PLATE;
    let classes = vec4(
        white_noise(own), white_noise(own + vec2(1, 0)),
        white_noise(own + vec2(0, 1)), white_noise(own + vec2(1, 1)),
    );
#endif
    return (classes + 0.5) * (1.0 / 256.0);
}

// The threshold at a place.
fn blue_noise(at: vec2<i32>) -> f32 {
    return blue_noise_around(at, 0).x;
}
