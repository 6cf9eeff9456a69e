#define_import_path bevy_comics::effects::speed_lines

// Draws lines that run towards a point or alongside each other. A line lies at a random
// place in its cell, a sector or a row, so that a pixel is covered by lines of its own cell
// and of the two next to it only.

#import bevy_comics::effect::noise::{hash, wave}
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::effect::sheet::bristles
#import bevy_comics::lines::edge::line_coverage

const PARALLEL: u32 = 1u;
const TURN: f32 = 6.283185307;

// Lengths in physical pixels, places from the viewport's top left corner.
struct SpeedLines {
    color: vec3<f32>,
    opacity: f32,
    center: vec2<f32>,
    // Half axes of the ellipse that stays clear.
    hole: vec2<f32>,
    // Direction of parallel lines.
    axis: vec2<f32>,
    // Distance from the center at which lines are as wide as asked.
    far: f32,
    // Half the width of the widest lines.
    half_width: f32,
    count: i32,
    seed: u32,
    // Distance of two parallel lines.
    spacing: f32,
    kind: u32,
    dry_brush: f32,
    // Physical pixels per logical pixel.
    unit: f32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn kind_of(s: SpeedLines) -> u32 {
#ifdef EFFECT_SPEED_LINES_KIND
    let compiled = #{EFFECT_SPEED_LINES_KIND}u;
    return compiled;
#else
    return s.kind;
#endif
}

// Three random numbers from 0 to 1.
fn three(h: u32) -> vec3<f32> {
    return vec3(f32(h & 2047u) / 2047.0, f32((h >> 11u) & 2047u) / 2047.0, f32(h >> 22u) / 1023.0);
}

// atan(x) for x from 0 to 1, with an error of 2e-8 (Abramowitz and Stegun 4.4.49). The
// built-in functions of GPUs may be off by a tenth of a pixel at the border of a picture.
fn atan_of_fraction(x: f32) -> f32 {
    let y = x * x;
    var sum = 0.0028662257;
    sum = sum * y - 0.0161657367;
    sum = sum * y + 0.0429096138;
    sum = sum * y - 0.07528964;
    sum = sum * y + 0.1065626393;
    sum = sum * y - 0.1420889944;
    sum = sum * y + 0.1999355085;
    sum = sum * y - 0.3333314528;
    return x * (sum * y + 1.0);
}

// Direction as a fraction of a turn, 0 to 1, clockwise on the screen from the left.
fn turn_of(d: vec2<f32>) -> f32 {
    let m = abs(d);
    let octant = atan_of_fraction(min(m.x, m.y) / max(max(m.x, m.y), 1e-20)) / TURN;
    let quadrant = select(octant, 0.25 - octant, m.y > m.x);
    let half = select(0.5 - quadrant, quadrant, d.x < 0.0);
    return select(half, 1.0 - half, d.y > 0.0);
}

// Half the width of a line at a distance from the center: it begins as a point at `inner`.
// `random`: its random number. `cell`: distance of two lines there; lines are at most wide
// enough to reach into the next cell but one.
fn speed_line_half_width(s: SpeedLines, random: f32, at: f32, inner: f32, cell: f32) -> f32 {
    let grown = clamp((at - inner) / max(s.far - inner, 1.0), 0.0, 1.0);
    let full = s.half_width * (0.2 + 0.8 * random * random);
    return min(full * grown, max(1.1 * cell - 0.5, 0.0));
}

// Where a line lies in its cell, 0.1 to 0.9.
fn place_in_cell(random: f32) -> f32 {
    return 0.5 + 0.4 * (2.0 * random - 1.0);
}

// Fraction of a line that a dry brush leaves: streaks along the line. `d`: place along and
// across it.
fn dry_ink(s: SpeedLines, seed: u32, d: vec2<f32>) -> f32 {
#ifdef EFFECT_SPEED_LINES_DRY
    return bristles(s.dry_brush, wave(d / (s.unit * vec2(60.0, 1.6)), seed));
#else
    return 1.0;
#endif
}

// Coverage of one radial line. `u`: direction of the pixel in cells; `rho`: its distance
// from the center; `hole`: distance of the ellipse's border in that direction.
fn radial_line(s: SpeedLines, line: i32, u: f32, rho: f32, hole: f32) -> f32 {
    // Lines on both sides of the first direction are the first and the last one.
    let number = u32((line + s.count) % s.count);
    let own_hash = hash(number ^ hash(s.seed));
    let own = three(own_hash);
    // Three neighbors are about as long.
    let group = three(hash((number / 3u) ^ hash(~s.seed)));
    let inner = hole * (1.0 + 0.5 * own.y * (0.4 + 1.2 * group.x));
    let cell = TURN * rho / f32(s.count);
    let half_width = speed_line_half_width(s, own.z, rho, inner, cell);
    // Less than two cells away, 0.63 radians: the error of the sine is below 1e-5.
    let a = (u - f32(line) - place_in_cell(own.x)) * TURN / f32(s.count);
    let sine = a * (1.0 - a * a * (1.0 / 6.0 - a * a / 120.0));
    let across = rho * sine;
    return line_coverage(abs(across), half_width) * dry_ink(s, own_hash, vec2(rho, across));
}

// Coverage of one parallel line. `d`: place of the pixel along and across the lines, from
// the center.
fn parallel_line(s: SpeedLines, line: i32, d: vec2<f32>) -> f32 {
    let own_hash = hash(bitcast<u32>(line) ^ hash(s.seed));
    let own = three(own_hash);
    let other = three(hash(own_hash));
    let across = (f32(line) + place_in_cell(own.x)) * s.spacing;
    // Half axes of the ellipse along and across the lines.
    let along_axis = length(s.hole * s.axis);
    let across_axis = length(s.hole * s.axis.yx);
    let y = across / across_axis;
    let hole = along_axis * sqrt(max(1.0 - y * y, 0.0)) * (1.0 + 0.4 * other.y);
    // Beside the ellipse, lines end anywhere.
    let free = s.far * (1.8 * own.y - 1.0);
    let inner = select(free, max(free, hole), hole > 0.0);
    let at = select(d.x, -d.x, other.x < 0.5);
    let half_width = speed_line_half_width(s, own.z, at, inner, s.spacing);
    let by = d.y - across;
    return line_coverage(abs(by), half_width) * dry_ink(s, own_hash, vec2(d.x, by));
}

// Coverage of the lines at a place.
fn speed_line_coverage(s: SpeedLines, at: vec2<f32>) -> f32 {
    let d = at - s.center;
    var sum = 0.0;
    if kind_of(s) == PARALLEL {
        let turned = vec2(dot(d, s.axis), s.axis.x * d.y - s.axis.y * d.x);
        let line = i32(floor(turned.y / s.spacing));
        sum = parallel_line(s, line - 1, turned) + parallel_line(s, line, turned)
            + parallel_line(s, line + 1, turned);
    } else {
        let rho = length(d);
        let hole = rho / max(length(d / s.hole), 1e-6);
        let u = turn_of(d) * f32(s.count);
        let line = i32(floor(u));
        sum = radial_line(s, line - 1, u, rho, hole) + radial_line(s, line, u, rho, hole)
            + radial_line(s, line + 1, u, rho, hole);
    }
    return min(sum, 1.0);
}

fn speed_lines(s: SpeedLines, p: Pixel) -> Pixel {
    let coverage = speed_line_coverage(s, p.inside + 0.5) * s.opacity;
    let drawn = mix(vec4(p.color, p.alpha), vec4(s.color, 1.0), coverage);
    var out = p;
    out.color = drawn.rgb;
    out.alpha = drawn.a;
    return out;
}
