#define_import_path bevy_comics::lines::edge

// The response of [CL] and the geometry of the lines: pure functions.

// How the lines of a view are found and inked. A multiple of 16 bytes, as uniform
// structs inside a struct have to be.
struct Lines {
    silhouette_color: vec3<f32>,
    silhouette_opacity: f32,
    crease_color: vec3<f32>,
    crease_opacity: f32,
    object_color: vec3<f32>,
    object_opacity: f32,
    // Where ink begins and is full, on the response; k of Eq. 2.
    silhouette_low: f32,
    silhouette_high: f32,
    silhouette_k: f32,
    silhouette_faithful: u32,
    crease_low: f32,
    crease_high: f32,
    crease_k: f32,
    crease_faithful: u32,
    // Physical pixels, and how many of them a logical pixel has.
    half_width: f32,
    scale: f32,
    width_fade: f32,
    opacity_fade: f32,
    // A jump is measured against factor * (largest raw depth) + constant.
    reference_factor: f32,
    reference_constant: f32,
    // How far away, in pixels, lines are looked for.
    reach: i32,
    unused: u32,
}

const SILHOUETTE: u32 = 0u;
const CREASE: u32 = 1u;
const OBJECT: u32 = 2u;

// Directions of a pixel's four sides, as bits and as numbers.
const WEST: u32 = 0u;
const EAST: u32 = 1u;
const NORTH: u32 = 2u;
const SOUTH: u32 = 3u;

// [CL] Eq. 1: A to H around x, row by row.
fn gradient(a: f32, b: f32, c: f32, d: f32, x: f32, e: f32, f: f32, g: f32, h: f32) -> f32 {
    return (abs(a - x) + 2.0 * abs(b - x) + abs(c - x) + 2.0 * abs(d - x) + 2.0 * abs(e - x)
        + abs(f - x) + 2.0 * abs(g - x) + abs(h - x)) / 8.0;
}

// [CL] Eq. 2. g: (g_min, g_max) over 3 x 3 pixels.
fn edge_response(g: vec2<f32>, k: f32) -> f32 {
    let r = (g.y - g.x) / k;
    return min(r * r, 1.0);
}

// The nine inner of 5 x 5 values, row by row, are written out: a CPU adapter
// runs the body of a loop once more than it counts.
fn gradient_at(v: ptr<function, array<f32, 25>>, i: u32, found: vec2<f32>) -> vec2<f32> {
    let g = gradient(
        (*v)[i - 6u], (*v)[i - 5u], (*v)[i - 4u],
        (*v)[i - 1u], (*v)[i], (*v)[i + 1u],
        (*v)[i + 4u], (*v)[i + 5u], (*v)[i + 6u],
    );
    return vec2(min(found.x, g), max(found.y, g));
}

// (g_min, g_max) around the middle of 5 x 5 values, row by row.
fn gradient_extremes(v: ptr<function, array<f32, 25>>) -> vec2<f32> {
    var found = vec2(1e38, 0.0);
    found = gradient_at(v, 6u, found);
    found = gradient_at(v, 7u, found);
    found = gradient_at(v, 8u, found);
    found = gradient_at(v, 11u, found);
    found = gradient_at(v, 12u, found);
    found = gradient_at(v, 13u, found);
    found = gradient_at(v, 16u, found);
    found = gradient_at(v, 17u, found);
    return gradient_at(v, 18u, found);
}

// The distance between two normals: 2 sin(angle / 2); none where either is
// missing. w: 1 for a normal, 0 for none.
fn normal_step(a: vec4<f32>, b: vec4<f32>) -> f32 {
    return length(a.xyz - b.xyz) * a.w * b.w;
}

// Eq. 1 with the distance between normals for the difference: invariant under
// rotation.
fn normal_gradient_at(v: ptr<function, array<vec4<f32>, 25>>, i: u32, found: vec2<f32>) -> vec2<f32> {
    let x = (*v)[i];
    let g = (normal_step((*v)[i - 6u], x) + 2.0 * normal_step((*v)[i - 5u], x) + normal_step((*v)[i - 4u], x)
        + 2.0 * normal_step((*v)[i - 1u], x) + 2.0 * normal_step((*v)[i + 1u], x)
        + normal_step((*v)[i + 4u], x) + 2.0 * normal_step((*v)[i + 5u], x) + normal_step((*v)[i + 6u], x)) / 8.0;
    return vec2(min(found.x, g), max(found.y, g));
}

fn normal_extremes(v: ptr<function, array<vec4<f32>, 25>>) -> vec2<f32> {
    var found = vec2(1e38, 0.0);
    found = normal_gradient_at(v, 6u, found);
    found = normal_gradient_at(v, 7u, found);
    found = normal_gradient_at(v, 8u, found);
    found = normal_gradient_at(v, 11u, found);
    found = normal_gradient_at(v, 12u, found);
    found = normal_gradient_at(v, 13u, found);
    found = normal_gradient_at(v, 16u, found);
    found = normal_gradient_at(v, 17u, found);
    return normal_gradient_at(v, 18u, found);
}

// Decaudin's crease: Eq. 1 and 2 on every component, the largest taken.
fn component_response(v: ptr<function, array<vec4<f32>, 25>>, k: f32) -> f32 {
    var low = vec3(1e38);
    var high = vec3(0.0);
    for (var y = 1u; y < 4u; y++) {
        for (var x = 1u; x < 4u; x++) {
            let i = 5u * y + x;
            let c = (*v)[i];
            var g = vec3(0.0);
            for (var n = 0u; n < 9u; n++) {
                let j = i + 5u * (n / 3u) + n % 3u - 6u;
                let weight = select(1.0, 2.0, n % 2u == 1u);
                g += weight * abs((*v)[j].xyz - c.xyz) * (*v)[j].w * c.w / 8.0;
            }
            low = min(low, g);
            high = max(high, g);
        }
    }
    let r = (high - low) / k;
    let p = min(r * r, vec3(1.0));
    return max(p.x, max(p.y, p.z));
}

// What a step down from a pixel to its neighbour has over the slopes on both
// sides of it: positive at an edge, zero or less on any plane. `before` lies
// behind the pixel, `beyond` behind the neighbour.
fn step_excess(before: f32, here: f32, there: f32, beyond: f32) -> f32 {
    return (here - there) - max(0.0, max(before - here, there - beyond));
}

// An edge runs between two pixels if the step explains the response: half of
// what a straight edge would have, at least.
fn on_edge(excess: f32, g: vec2<f32>) -> bool {
    return excess > 0.0 && excess >= 0.5 * (g.y - g.x);
}

// A fold runs between two pixels if it is the sharpest around and explains the
// response (a straight fold answers with half its step). Next to the rim of a
// surface, where a neighbour is missing, the curvature of the rim is no fold.
fn on_fold(fold: f32, around: f32, complete: f32, g: vec2<f32>) -> bool {
    return complete > 0.0 && fold >= around && fold >= g.y - g.x;
}

// What an edge's line is made of, found by detect.wgsl, read by the fused pass.
struct Edge {
    // Bits 4 * kind + side: where the pixel's lines run. Bits 12, 13: the pixel
    // itself is the line (the faithful forms).
    sides: u32,
    // Ink by kind, 0 to 1.
    ink: vec3<f32>,
    // Half the width, physical pixels.
    half_width: f32,
    // Style of the object that the line belongs to; 0: none of its own.
    slot: u32,
}

const WHOLE_SILHOUETTE: u32 = 4096u;
const WHOLE_CREASE: u32 = 8192u;

// In four words of 16 bits.
fn pack_edge(e: Edge) -> vec4<u32> {
    let ink = vec3<u32>(clamp(e.ink, vec3(0.0), vec3(1.0)) * 255.0 + 0.5);
    let width = u32(clamp(e.half_width, 0.0, 127.0) * 512.0 + 0.5);
    return vec4(e.sides, ink.x | (ink.y << 8u), width, ink.z | (e.slot << 8u));
}

fn unpack_edge(t: vec4<u32>) -> Edge {
    var e: Edge;
    e.sides = t.x;
    e.ink = vec3(f32(t.y & 255u), f32(t.y >> 8u), f32(t.w & 255u)) / 255.0;
    e.half_width = f32(t.z) / 512.0;
    e.slot = t.w >> 8u;
    return e;
}

fn side_direction(side: u32) -> vec2<f32> {
    let way = select(-1.0, 1.0, (side & 1u) == 1u);
    return select(vec2(0.0, way), vec2(way, 0.0), side < 2u);
}

// Where the middle of a line lies, from the centre of the pixel it belongs to.
// An edge runs between two pixels. Lines of an even width lie across it; those
// of an odd width lie half a pixel further in, so that both are whole pixels.
fn line_offset(side: u32, half_width: f32) -> vec2<f32> {
    let width = 2.0 * half_width;
    let odd = select(abs(width - 2.0 * round(0.5 * width)), 1.0, width < 1.0);
    return side_direction(side) * (0.5 - 0.5 * odd);
}

// How much of a pixel a line covers whose middle is this far from its centre:
// the exact share, for a line along the pixel's sides.
fn line_coverage(distance: f32, half_width: f32) -> f32 {
    return clamp(half_width + 0.5 - distance, 0.0, min(2.0 * half_width, 1.0));
}
