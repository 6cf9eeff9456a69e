#define_import_path bevy_comics::lines::budget

// How much of the width of lines is left where they crowd, and where it is stored how densely
// they lie: in squares of 8 pixels, and in squares of twice the size, six times over. Pure
// functions.

#import bevy_comics::lines::edge::Grid

// Pixels along the side of a square of level 0.
const SQUARE: i32 = 8;
const LAST_LEVEL: i32 = 6;

// Squares of a level across and down the grid.
fn squares(g: Grid, level: i32) -> vec2<i32> {
    let side = SQUARE << u32(level);
    return (g.rect.zw + side - 1) / side;
}

// Where a square is stored: level by level, each in rows as long as those of level 0.
fn square_index(g: Grid, level: i32, square: vec2<i32>) -> i32 {
    let all = squares(g, 0);
    // At least the sum of the rows of the levels before: all.y + all.y / 2 + ..., rounded up.
    let first = 2 * all.y - ((2 * all.y) >> u32(level)) + level;
    return (first + square.y) * all.x + square.x;
}

// The radius in pixels of the area in which lines of this width share their budget. A line that
// is alone covers half of its budget there, and two that cross all of it.
fn budget_radius(budget: f32, width: f32) -> f32 {
    return 2.0 * width / budget;
}

// A radius between those of two levels, which are two squares each: the lower of the levels, and
// the part of the next one with which a single line has the density 1 / radius.
struct Levels {
    low: i32,
    part: f32,
}

fn levels_of(radius: f32) -> Levels {
    let steps = max(radius / f32(2 * SQUARE), 1.0);
    let low = min(i32(firstLeadingBit(u32(steps))), LAST_LEVEL - 1);
    return Levels(low, min(2.0 - f32(2 << u32(low)) / steps, 1.0));
}

// The weights of four squares in a row under a tent with a radius of two squares, whose top is
// `part` of a square behind the middle of the second one.
fn tent(part: f32) -> vec4<f32> {
    return 0.5 - 0.25 * abs(vec4(-1.0, 0.0, 1.0, 2.0) - part);
}

// The factor of a line's width with which lines of this width cover `budget` of an area in which
// their length per area is `density`.
fn budget_weight(budget: f32, density: f32, width: f32) -> f32 {
    return min(budget / max(density * width, 1e-6), 1.0);
}
