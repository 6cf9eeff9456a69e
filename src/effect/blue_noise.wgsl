#define_import_path bevy_comics::effect::blue_noise

// A tile of 64 x 64 thresholds in an even, irregular order, for effects that need
// `Needs::BLUE_NOISE`. The only module that declares binding 11.

#ifdef BLUE_NOISE
// The rank of each threshold in 256 classes.
@group(0) @binding(11) var blue_noise_tile: texture_2d<f32>;
#else
#import bevy_comics::effect::noise::hash
#endif

// A threshold above 0 and below 1. The tile repeats every 64 steps. In a pass that has no
// tile: white noise.
fn blue_noise(at: vec2<i32>) -> f32 {
    let place = at & vec2(63);
#ifdef BLUE_NOISE
    let class_of_rank = textureLoad(blue_noise_tile, place, 0).x * 255.0;
#else
    let class_of_rank = f32(hash(u32(place.y * 64 + place.x)) & 255u);
#endif
    return (class_of_rank + 0.5) / 256.0;
}
