#define_import_path bevy_comics::styles::sketch

struct Sketch {
    paper: vec3<f32>,
    wash: f32,
    ink: vec3<f32>,
    gamma: f32,
    // Physical pixels.
    jitter: f32,
    wavelength: f32,
    pressure: f32,
    strokes: u32,
    // Which drawing of the strokes this is: changes a few times a second.
    drawing: u32,
    // How much of the drawing covers the picture.
    amount: f32,
    // 1: the picture below has these lines; 0: only the sketch has them.
    lines_below: f32,
}

// A 32-bit hash of the PCG family (Jarzynski and Olano 2020).
fn hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A number from -1 to 1 at a corner of the lattice.
fn lattice(cell: vec2<i32>, seed: u32) -> f32 {
    let h = hash(bitcast<u32>(cell.x) ^ hash(bitcast<u32>(cell.y) ^ hash(seed)));
    return f32(h >> 8u) / 8388608.0 - 1.0;
}

// Smooth noise from -1 to 1.
fn wave(at: vec2<f32>, seed: u32) -> f32 {
    let cell = vec2<i32>(floor(at));
    let f = fract(at);
    let t = f * f * (3.0 - 2.0 * f);
    let above = mix(lattice(cell, seed), lattice(cell + vec2(1, 0), seed), t.x);
    let below = mix(lattice(cell + vec2(0, 1), seed), lattice(cell + vec2(1, 1), seed), t.x);
    return mix(above, below, t.y);
}

// How far a stroke strays at a place, in pixels.
fn stray(s: Sketch, at: vec2<f32>, stroke: u32) -> vec2<f32> {
    let seed = s.drawing * 16u + stroke * 4u;
    let p = at / s.wavelength;
    return s.jitter * vec2(wave(p, seed), wave(p, seed + 1u));
}

// How hard the pen is pressed at a place, 0 to 1.
fn pen_pressure(s: Sketch, at: vec2<f32>, stroke: u32) -> f32 {
    let n = wave(at / s.wavelength * 1.7, s.drawing * 16u + stroke * 4u + 2u);
    return 1.0 - s.pressure * (0.5 + 0.5 * n);
}

// One stroke over what is already there.
fn add_stroke(inked: f32, stroke: f32) -> f32 {
    return 1.0 - (1.0 - inked) * (1.0 - clamp(stroke, 0.0, 1.0));
}

// Ink on paper, in linear light.
fn draw_sketch(s: Sketch, picture: vec3<f32>, inked: f32) -> vec3<f32> {
    let ground = mix(s.paper, s.paper * picture, s.wash);
    let ink = select(pow(max(inked, 1e-30), s.gamma), 0.0, inked <= 0.0);
    return mix(ground, s.ink, clamp(ink, 0.0, 1.0));
}
