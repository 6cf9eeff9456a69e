#define_import_path bevy_comics::lines::jumps

// Bounds for MapJumps: whether the depth map may depart from planes. Pure functions.

#import bevy_comics::depth::map::{DepthFrame, LOGARITHMIC, ORTHOGRAPHIC, depth_step, has}
#import bevy_comics::lines::edge::BELOW

// MapJumps in a depth map; the radius in whole pixels.
struct Jumps {
    frame: DepthFrame,
    least: f32,
    radius: f32,
}

// Three neighboring columns of a row: the columns west of four pixels, the pixels, and
// the columns east of them.
struct Row {
    w: vec4<f32>,
    c: vec4<f32>,
    e: vec4<f32>,
}

// The smallest depth that is no sky.
const LEAST_DEPTH: f32 = 1.1754944e-38;

// Whether the depth map may jump at a pixel of raw depth `c`. `bend`: the largest second
// difference of raw depth through it; `slope`: the largest difference to a neighbor.
//
// At distance r, a second difference is at most r^2 times the largest between neighbors.
// As a difference of D it is largest at the end of the window where D is steepest, which
// is at most 2 r - 1 pixels away.
fn departs(j: Jumps, c: f32, bend: f32, slope: f32) -> bool {
    let f = j.frame;
    let r = j.radius;
    let jump = r * r * bend;
    let away = (2.0 * r - 1.0) * slope + jump - bend;
    var step: f32;
    if has(f, ORTHOGRAPHIC) && has(f, LOGARITHMIC) {
        let nearest = clamp(c + away, f.far, f.near);
        step = depth_step(f, nearest - jump, nearest);
    } else {
        let farthest = clamp(c - away, f.far, f.near);
        step = depth_step(f, farthest, farthest + jump);
    }
    // Also true if a depth is not a number.
    return !(step < j.least * BELOW);
}

// The same for four pixels. `across` and `along`: whether a pixel has neighbors to the
// west and east, and to the north and south. Beside the sky there is always a jump.
fn may_jump(j: Jumps, north: Row, here: Row, south: Row, across: vec4<f32>, along: f32) -> bool {
    let c = here.c;
    let twice = 2.0 * c;
    let level = across * abs(here.w + here.e - twice);
    let upright = along * abs(north.c + south.c - twice);
    let diagonal = across * along * max(abs(north.w + south.e - twice), abs(north.e + south.w - twice));
    let bend = max(max(level, upright), diagonal);
    let least = min(
        min(min(north.w, north.c), min(north.e, here.w)),
        min(min(here.e, south.w), min(south.c, south.e)),
    );
    let most = max(
        max(max(north.w, north.c), max(north.e, here.w)),
        max(max(here.e, south.w), max(south.c, south.e)),
    );
    let slope = max(most - c, c - least);
    let beside_sky = (min(least, c) < vec4(LEAST_DEPTH)) & (max(most, c) >= vec4(LEAST_DEPTH));
    return any(beside_sky)
        || departs(j, c.x, bend.x, slope.x)
        || departs(j, c.y, bend.y, slope.y)
        || departs(j, c.z, bend.z, slope.z)
        || departs(j, c.w, bend.w, slope.w);
}
