#define_import_path bevy_comics::effect::noise

// Random numbers that depend only on their arguments.

// A 32-bit hash: PCG (Jarzynski and Olano 2020).
fn hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A random number from -1 to 1 at an integer grid point.
fn lattice(cell: vec2<i32>, seed: u32) -> f32 {
    let h = hash(bitcast<u32>(cell.x) ^ hash(bitcast<u32>(cell.y) ^ hash(seed)));
    return f32(h >> 8u) / 8388608.0 - 1.0;
}

// Smooth noise from -1 to 1: interpolates the random numbers at the integer grid
// points around `at`.
fn wave(at: vec2<f32>, seed: u32) -> f32 {
    let cell = vec2<i32>(floor(at));
    let f = fract(at);
    let t = f * f * (3.0 - 2.0 * f);
    let above = mix(lattice(cell, seed), lattice(cell + vec2(1, 0), seed), t.x);
    let below = mix(lattice(cell + vec2(0, 1), seed), lattice(cell + vec2(1, 1), seed), t.x);
    return mix(above, below, t.y);
}
