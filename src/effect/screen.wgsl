#define_import_path bevy_comics::effect::screen

// Screens: how much of a pixel a plate prints for a tone. Pure functions.
//
// `at` are the coordinates of a pixel in cells of the screen, whose dots are at whole
// numbers. `tone` is the fraction of the area that is printed, 0 to 1: the mean of the
// coverage over a screen. `cell_size` is the size of a cell in physical pixels.

const PI: f32 = 3.1415927;

// Tone at which the discs of neighboring cells touch.
const TOUCH: f32 = 0.7853982;

// Below this tone, and above 1 minus it, dots and holes do not become smaller but paler,
// so that no pixel changes abruptly.
const LEAST: f32 = 0.03125;

// The cosine of an angle in turns, by a minimax polynomial (Hastings 1955): its own error
// is below 1e-7.
fn cos_turn(x: f32) -> f32 {
    let q = 4.0 * abs(x - round(x)) - 1.0;
    let t = q * q;
    return -q * (1.5707963 + t * (-0.64596371 + t * (0.07968968 + t * (-0.00467377 + t * 0.00015148))));
}

fn sin_turn(x: f32) -> f32 {
    return cos_turn(x - 0.25);
}

// Radius in pixels of discs of a tone that do not touch. An edge that is drawn as a ramp of one
// pixel has pi / 12 square pixels more than the disc: its variance. Where the ramps from all sides
// meet, the radius is cbrt(3 x^2) - 1/2; the polynomial of the root is within 0.0002 pixels of it down
// to x = 0.06, a cell of 2 pixels from whose smallest dot most of the ink has bled.
fn free_radius(tone: f32, cell_size: f32) -> f32 {
    let x = cell_size * sqrt(tone * (1.0 / PI));
    let root = sqrt(x);
    let cone = -0.5300484 + root * (0.8214936 + root * (0.8882642 - 0.2441458 * root));
    return select(cone, sqrt(max(x * x - 1.0 / 12.0, 0.0)), x >= 0.57735027);
}

// Radius in pixels of the discs of a tone. Touching discs: fitted, with what the ramps of their
// edges add.
fn disc_radius(tone: f32, cell_size: f32) -> f32 {
    if tone > TOUCH {
        let rest = (1.0 - tone) / (1.0 - TOUCH);
        let root = sqrt(rest);
        let touching = cell_size * (0.70710678 - root * (0.2471 - 0.04 * root));
        return touching - 0.09 * rest / (cell_size * cell_size);
    }
    return free_radius(tone, cell_size);
}

// A disc and the three next to the pixel. Edges that face each other add up; where discs
// overlap, some of it is covered twice: fitted.
fn disc(at: vec2<f32>, tone: f32, cell_size: f32) -> f32 {
    let radius = disc_radius(tone, cell_size) + 0.5;
    let own = abs(at - round(at)) * cell_size;
    let other = cell_size - own;
    let near = clamp(radius - length(own), 0.0, 1.0);
    let beside = clamp(radius - length(vec2(other.x, own.y)), 0.0, 1.0);
    let below = clamp(radius - length(vec2(own.x, other.y)), 0.0, 1.0);
    let across = clamp(radius - length(other), 0.0, 1.0);
    let largest = max(max(near, beside), max(below, across));
    let sum = min(near + beside + below + across, 1.0);
    let overlap = smoothstep(0.77, 0.8, tone);
    return mix(sum, largest, 0.31 * overlap);
}

// Dots that grow into a checkerboard and leave holes: a threshold of a sum of cosines. `offset`:
// from the middle of the cell, in cells, 0 to 1/2.
fn checker(offset: vec2<f32>, tone: f32, cell_size: f32) -> f32 {
    let waves = vec2(cos_turn(offset.x), cos_turn(offset.y));
    let height = 0.5 * (waves.x + waves.y);
    let per_pixel = PI / cell_size;
    // The ramp at the edge of a dot adds to it, that of a hole takes from the rest.
    let curved = clamp((0.5 - tone) * (1.0 / 0.11), -1.0, 1.0);
    let x = 1.0 - 2.0 * tone + curved * per_pixel * per_pixel * (1.0 / (6.0 * PI));
    let threshold = x * (0.40 + 0.65 * abs(x) - 0.05 * x * x);
    // The length of the sines.
    let slope = per_pixel * sqrt(max(2.0 - dot(waves, waves), 0.25));
    return clamp(0.5 + (height - threshold) / slope, 0.0, 1.0);
}

// Discs in the lights, a checkerboard in the middle, round holes in the shadows
// (Ostromoukhov and Hersch 1995 call it Euclidean). Discs and holes are those of tones up to 0.3:
// only the nearest one reaches a pixel, from a cell_size of 2.7 pixels on.
fn euclidean(at: vec2<f32>, tone: f32, cell_size: f32) -> f32 {
    let offset = abs(at - round(at));
    let middle = checker(offset, tone, cell_size);
    let dark = tone > 0.5;
    let away = length(select(offset, 0.5 - offset, dark)) * cell_size;
    let radius = free_radius(select(tone, 1.0 - tone, dark), cell_size);
    let round_part = clamp(radius + 0.5 - away, 0.0, 1.0);
    let ends = select(round_part, 1.0 - round_part, dark);
    return mix(ends, middle, clamp((0.35 - abs(tone - 0.5)) * (1.0 / 0.15), 0.0, 1.0));
}

// The integral of lines of a tone, which begin at whole numbers.
fn line_area(x: f32, tone: f32) -> f32 {
    let whole = floor(x);
    return whole * tone + min(x - whole, tone);
}

// Lines across x, exact for a pixel that is `footprint` cells wide along it.
fn line(x: f32, tone: f32, footprint: f32) -> f32 {
    // Only the place in the cell matters; small numbers are exact.
    let from_start = x - floor(x) + 0.5 * tone;
    let half = 0.5 * footprint;
    return (line_area(from_start + half, tone) - line_area(from_start - half, tone)) / footprint;
}

// The area of diamonds of this radius around whole numbers, in the rectangle from the middle of a
// cell to a place; negative where one of its sides goes back. The radius, half a diagonal, is at
// most 1/2.
fn diamonds_area(to: vec2<f32>, radius: f32) -> f32 {
    let cells = round(to);
    let rest = to - cells;
    let side = abs(rest);
    // What is cut off at the corners of a diamond: right triangles.
    let cut = max(vec3(radius - side, radius - side.x - side.y), vec3(0.0));
    let cuts = cut * cut;
    let square = radius * radius;
    // Columns and rows that are whole in one direction, and the quarter that is whole in none.
    let strips = sign(rest) * (square - cuts.xy);
    let quarter = 0.5 * sign(rest.x) * sign(rest.y) * (square - cuts.x - cuts.y + cuts.z);
    return 2.0 * square * cells.x * cells.y + dot(cells.yx, strips) + quarter;
}

// Diamonds. A pixel is a square of its size that lies along the cell, whatever the angle: what it
// covers is exact then, and so are tones where every cell has the same pixels.
fn diamond(at: vec2<f32>, tone: f32, cell_size: f32) -> f32 {
    let dark = tone > 0.5;
    // Beyond a half, the paper is left in diamonds at the corners of the cells.
    let placed = select(at, at + 0.5, dark);
    let offset = placed - round(placed);
    let radius = sqrt(0.5 * select(tone, 1.0 - tone, dark));
    let low = offset - 0.5 / cell_size;
    let high = offset + 0.5 / cell_size;
    let area = diamonds_area(high, radius) - diamonds_area(vec2(low.x, high.y), radius)
        - diamonds_area(vec2(high.x, low.y), radius) + diamonds_area(low, radius);
    let covered = clamp(area * cell_size * cell_size, 0.0, 1.0);
    return select(covered, 1.0 - covered, dark);
}

// Lines in two directions, independent of each other.
fn cross_lines(at: vec2<f32>, tone: f32, footprint: f32) -> f32 {
    let each = 1.0 - sqrt(max(1.0 - tone, 0.0));
    return 1.0 - (1.0 - line(at.x, each, footprint)) * (1.0 - line(at.y, each, footprint));
}

// Whether grains of these thresholds are printed, with a short ramp.
fn grain_covers(tone: f32, thresholds: vec4<f32>) -> vec4<f32> {
    return clamp((tone - thresholds) * 96.0 + 0.5, vec4(0.0), vec4(1.0));
}

// Of a tone or of what is left of it, the part that edges may take or add.
const MOST_BLED: f32 = 0.9;

// The tone at a place where the sheet has a height, -1 to 1: ink runs into valleys. Its mean over
// all heights is the tone. `length`: of the edges in a cell, in cell sizes; they are displaced
// by up to `edge` cell sizes.
fn bled_tone(tone: f32, length: f32, edge: f32, height: f32) -> f32 {
    return tone - min(length * edge, MOST_BLED * min(tone, 1.0 - tone)) * height;
}

// Length of the edges of discs in cell sizes. Beyond TOUCH: fitted.
fn disc_edges(tone: f32) -> f32 {
    return min(2.0 * sqrt(PI * tone), 5.5 * sqrt(1.0 - tone));
}

// The same of euclidean(): discs, then holes.
fn euclidean_edges(tone: f32) -> f32 {
    return 2.0 * sqrt(PI * min(tone, 1.0 - tone));
}

// The same of diamonds.
fn diamond_edges(tone: f32) -> f32 {
    return 4.0 * sqrt(min(tone, 1.0 - tone));
}

// The coverage of a tone beyond LEAST, whose dots or holes are paler instead of smaller. `k`:
// that of the tone at LEAST.
fn paler(k: f32, tone: f32) -> f32 {
    let dots = k * min(tone * (1.0 / LEAST), 1.0);
    return 1.0 - (1.0 - dots) * min((1.0 - tone) * (1.0 / LEAST), 1.0);
}

// The tone with dot gain: dots grow most in the middle tones.
fn gained(tone: f32, gain: f32) -> f32 {
    return clamp(tone + 4.0 * gain * tone * (1.0 - tone), 0.0, 1.0);
}

// The tone in a number of equal steps; 0: as it is.
fn tinted(tone: f32, tints: f32) -> f32 {
    if tints < 0.5 {
        return tone;
    }
    let x = tone * tints;
    return (floor(x) + smoothstep(0.45, 0.55, x - floor(x))) / tints;
}
