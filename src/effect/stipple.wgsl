#define_import_path bevy_comics::effect::stipple

// Dots of one size that lie on surfaces, as many as the tone asks for. They are the nodes of nested
// square lattices in the plane of coordinates that a surface faces. A node keeps its place and its
// random number at every level, so zooming in adds dots between those that are there. For the
// effect `Hatching` and the toon material.

#import bevy_comics::effect::footprint::singular_values
#import bevy_comics::effect::nested::{Level, level_of, mark_of_node}
#import bevy_comics::effect::strokes::{Strokes, Surface, place_along, shared_tone}

const PI: f32 = 3.14159265;
// Layers of dots, each with a lattice of its own. What they leave is a plain tone.
const LAYERS: u32 = 5u;
// The tone at which dots of one size touch while the level changes: then a new dot is 0.866
// of the distance of the old ones from its neighbors.
const TOUCHING: f32 = 0.589;

// Darkness of a layer at which the next one begins.
fn dots_layer_darkness(s: Strokes) -> f32 {
    return clamp(s.layer_darkness, 0.3, 0.5);
}

// Radius of all dots in pixels. At the darkness of a full layer, they are `spacing` apart.
fn dot_radius(s: Strokes) -> f32 {
    return s.spacing * sqrt(dots_layer_darkness(s) / PI);
}

// Coverage of a pixel by a disc of a plane. `away`: of the pixel from the middle; `wide`: the longest
// change of a place over a pixel. The mean over a plane is exact: the linear edge of one pixel adds
// a 24th of the squared changes to the squared radius, which is taken off before.
fn disc_coverage(away: vec2<f32>, right: vec2<f32>, down: vec2<f32>, wide: f32, radius: f32) -> f32 {
    let edge = (dot(right, right) + dot(down, down)) / 24.0;
    let square = radius * radius;
    let drawn = max(sqrt(max(square - edge, 0.0)), 0.5 * wide);
    let distance = max(length(away), 1e-20);
    let change = max(length(vec2(dot(right, away), dot(down, away))) / distance, 1e-20);
    let strength = min(square / max(drawn * drawn + edge, 1e-30), 1.0);
    return strength * clamp(0.5 + (drawn - distance) / change, 0.0, 1.0);
}

// A lattice of dots near a pixel. Lengths are in units of the distance of its finest nodes.
struct Lattice {
    // The change of a place over a pixel, and the longest one.
    right: vec2<f32>,
    down: vec2<f32>,
    wide: f32,
    // Radius of a dot, how much areas vary, and how far the middle of a dot may be from its node, less the
    // dot's radius.
    radius: f32,
    spread: f32,
    room: f32,
    // How many of the three new dots for each old one have grown.
    grown: f32,
    exponent: i32,
    seed: u32,
}

// Coverage by the dot of a node. `away`: of the pixel from the node.
fn node_cover(s: Strokes, l: Lattice, node: vec2<i32>, away: vec2<f32>) -> f32 {
    let odd = vec2(node.x & 1, node.y & 1);
    // The new dot in the middle of four old ones is the first to grow.
    let turn = select(f32(1 + odd.y), 0.0, odd.x + odd.y == 2);
    let fraction = select(clamp(l.grown - turn, 0.0, 1.0), 1.0, odd.x + odd.y == 0);
    let mark = mark_of_node(node, l.exponent, l.seed);
    // Three numbers from -1 to 1. Places are in the square inside the circle of the farthest.
    let random = vec3(f32(mark & 1023u), f32((mark >> 10u) & 1023u), f32(mark >> 20u));
    let number = random * vec3(2.0 / 1023.0, 2.0 / 1023.0, 2.0 / 4095.0) - 1.0;
    let full = l.radius * sqrt(1.0 + l.spread * number.z);
    let most = max(l.room - max(full, 0.5 * l.wide), 0.0);
    let stray = most * s.wobble * 0.70710678 * number.xy;
    return disc_coverage(away - stray, l.right, l.down, l.wide, full * sqrt(fraction));
}

// Coverage by the dots of a lattice. `u`, `v`: two axes of its plane, at right angles; `seed`: also half of
// the number of `u` in strokes.rs.
fn lattice_cover(s: Strokes, on: Surface, u: vec3<f32>, v: vec3<f32>, seed: u32, tone: f32) -> f32 {
    if tone <= 0.0 {
        return 0.0;
    }
    let across = vec2(dot(u, on.across), dot(v, on.across));
    let below = vec2(dot(u, on.down), dot(v, on.down));
    let axes = singular_values(across, below);
    // Side of a square as large as what a pixel covers, in units of the plane.
    let pixel = sqrt(max(axes.x * axes.y, 1e-36));
    // Distance of dots on the screen, and their level: of old dots, and of those that grow.
    let distance = dot_radius(s) * sqrt(PI / tone);
    let level = level_of(distance * pixel);
    let fine = 0.5 * level.size;
    let finest = Level(level.exponent - 1, fine, 0.0);
    let at_u = place_along(on, u, 2u * seed, finest);
    let at_v = place_along(on, v, 2u * seed + 1u, finest);
    let cell = floor(vec2(at_u.at, at_v.at));
    let at = vec2(at_u.at, at_v.at) - cell;
    let node = vec2(at_u.number + i32(cell.x), at_v.number + i32(cell.y));
    var l: Lattice;
    l.right = across / fine;
    l.down = below / fine;
    l.wide = axes.x / fine;
    l.radius = dot_radius(s) * pixel / fine;
    // Areas vary and dots stray as far as they do not meet.
    l.spread = min(0.6 * s.pressure, TOUCHING / tone - 1.0);
    let free = 0.5 * distance * pixel / fine;
    l.room = min(0.866 * free, free - 0.5 * l.wide);
    l.grown = (level.grown + 1.0) * (level.grown + 1.0) - 1.0;
    l.exponent = finest.exponent;
    l.seed = seed ^ s.seed;
    let cover = node_cover(s, l, node, at)
        + node_cover(s, l, node + vec2(1, 0), at - vec2(1.0, 0.0))
        + node_cover(s, l, node + vec2(0, 1), at - vec2(0.0, 1.0))
        + node_cover(s, l, node + vec2(1, 1), at - 1.0);
    // Dots that are closer than the picture can show, along what a pixel covers, are a plain tone.
    let shown = smoothstep(2.0, 2.8, distance * pixel / max(axes.x, 1e-30));
    return mix(tone, min(cover, 1.0), shown);
}

// How much of the planes across the axes is seen: of the one that the surface faces most, and of
// others that it faces almost as much.
fn facing_weights(s: Strokes, normal: vec3<f32>) -> vec3<f32> {
    let n = abs(normal * s.axes);
    let w = max(n - max(n.x, max(n.y, n.z)) + 0.15, vec3(0.0));
    return w / max(w.x + w.y + w.z, 1e-6);
}

// Coverage by a layer of dots.
fn dots_cover(s: Strokes, on: Surface, w: vec3<f32>, layer: u32, tone: f32) -> f32 {
    // No rows of dots are upright, or parallel to those of another layer.
    let angle = 0.35 + 0.6 * f32(layer);
    let turn = vec2(cos(angle), sin(angle));
    var axes = s.axes;
    var light = 1.0;
    for (var plane = 0u; plane < 3u; plane++) {
        if w[plane] <= 0.0 {
            continue;
        }
        let a = axes[(plane + 1u) % 3u];
        let b = axes[(plane + 2u) % 3u];
        let u = a * turn.x + b * turn.y;
        let v = b * turn.x - a * turn.y;
        light *= 1.0 - lattice_cover(s, on, u, v, 3u * layer + plane, shared_tone(tone, w[plane]));
    }
    return 1.0 - light;
}

// Coverage by dots of a mean darkness: layers, each up to its own darkness.
fn stippled(s: Strokes, on: Surface, tone: f32) -> f32 {
    let w = facing_weights(s, on.normal);
    let most = dots_layer_darkness(s);
    var left = clamp(tone, 0.0, 1.0);
    var light = 1.0;
    for (var layer = 0u; layer < LAYERS; layer++) {
        if left <= 0.0 {
            break;
        }
        let own = min(left, most);
        light *= 1.0 - dots_cover(s, on, w, layer, own);
        left = max(1.0 - (1.0 - left) / (1.0 - own), 0.0);
    }
    return 1.0 - light * (1.0 - left);
}
