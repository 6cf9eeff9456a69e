#define_import_path custom_effect::rain

// Rain in layers, the nearest first. Each layer is a grid of cells that falls as
// a whole; a cell holds one streak. Whatever is nearer than a layer hides it.

#import bevy_comics::effect::noise::lattice
#import bevy_comics::effect::pixel::Pixel

struct Rain {
    color: vec3<f32>,
    amount: f32,
    // Pixels that a drop moves sideways per pixel that it falls.
    slope: f32,
    // Length of the nearest streaks, logical pixels.
    length: f32,
    // How far the drops have fallen, in cells, modulo ROWS.
    fall: f32,
    // Physical pixels per logical pixel.
    scale: f32,
}

const LAYERS: i32 = 6;
// Size of a cell of the nearest layer, logical pixels.
const CELL: vec2<f32> = vec2(22.0, 240.0);
// After so many rows the pattern repeats: a power of two.
const ROWS: i32 = 256;
// Half the width of the nearest streaks, logical pixels.
const HALF_WIDTH: f32 = 0.9;

// A random number from 0 to 1.
fn random(cell: vec2<i32>, seed: i32) -> f32 {
    return 0.5 + 0.5 * lattice(cell, u32(seed));
}

// How much of a pixel the streaks of a layer cover. `far`: 0 for the nearest
// layer, 1 for the farthest.
fn streak(s: Rain, at: vec2<f32>, layer: i32, far: f32) -> f32 {
    let seed = 8 * layer;
    let size = s.scale * mix(1.0, 0.25, far);
    // Along the rain, columns are vertical. Each starts at a height of its own.
    let column = (at.x - s.slope * at.y) / (CELL.x * size);
    let start = random(vec2(i32(floor(column)), 0), seed) * f32(ROWS);
    let row = at.y / (CELL.y * size) + start - s.fall;
    let cell = vec2(i32(floor(column)), i32(floor(row)) & (ROWS - 1));

    // Across: a line of constant width, anti-aliased.
    let half_width = HALF_WIDTH * size;
    let middle = 0.2 + 0.6 * random(cell, seed + 1);
    let distance = abs(fract(column) - middle) * CELL.x * size * inverseSqrt(1.0 + s.slope * s.slope);
    let across = clamp(half_width + 0.5 - distance, 0.0, min(2.0 * half_width, 1.0));

    // Along: from a faint tail (0) to the head (1).
    let fraction = s.length / CELL.y;
    let t = (fract(row) - random(cell, seed + 2) * (1.0 - fraction)) / fraction;
    let along = clamp(t, 0.0, 1.0) * (1.0 - smoothstep(0.9, 1.0, t));

    // The more it rains, the more cells have their drop.
    let drop = clamp(5.0 * s.amount - 4.0 * random(cell, seed + 3), 0.0, 1.0);
    return across * along * drop * mix(0.75, 0.4, far);
}

fn rain(s: Rain, p: Pixel) -> Pixel {
    var out = p;
    let depth = p.depth.x;
    // Drops too far to be told apart are a haze.
    var clear = 1.0 - 0.25 * s.amount * depth * depth;
    for (var layer = 0; layer < LAYERS; layer++) {
        let far = f32(layer) / f32(LAYERS - 1);
        let layer_depth = 0.85 * far;
        let visible = smoothstep(layer_depth, layer_depth + 0.08, depth);
        clear *= 1.0 - visible * streak(s, p.inside, layer, far);
    }
    out.color = mix(s.color, p.color, clear);
    return out;
}
