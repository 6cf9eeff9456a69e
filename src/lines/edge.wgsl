#define_import_path bevy_comics::lines::edge

// The edge response of [CL] and the geometry of lines. Pure functions.

// How the lines of a view are found and inked. Its size is a multiple of 16 bytes, as
// WGSL requires of a struct inside a uniform.
struct Lines {
    silhouette_color: vec3<f32>,
    silhouette_opacity: f32,
    crease_color: vec3<f32>,
    crease_opacity: f32,
    object_color: vec3<f32>,
    object_opacity: f32,
    // Responses at which ink begins (low) and is full (high), and k of [CL] Eq. 2.
    // Faithful: 1 for Form::Faithful.
    silhouette_low: f32,
    silhouette_high: f32,
    silhouette_k: f32,
    silhouette_faithful: u32,
    crease_low: f32,
    crease_high: f32,
    crease_k: f32,
    crease_faithful: u32,
    // Half of the line width in physical pixels; physical pixels per logical pixel.
    half_width: f32,
    scale: f32,
    // Fractions of width and opacity that are lost at D = 1.
    width_fade: f32,
    opacity_fade: f32,
    // A jump is measured against factor * (largest raw depth nearby) + constant.
    reference_factor: f32,
    reference_constant: f32,
    // Distance in physical pixels within which lines are searched around a pixel.
    reach: i32,
    unused: u32,
}

const SILHOUETTE: u32 = 0u;
const CREASE: u32 = 1u;
const OBJECT: u32 = 2u;

// The gradient at x from its eight neighbours a to h, row by row ([CL] Eq. 1).
fn gradient(a: f32, b: f32, c: f32, d: f32, x: f32, e: f32, f: f32, g: f32, h: f32) -> f32 {
    return (abs(a - x) + 2.0 * abs(b - x) + abs(c - x) + 2.0 * abs(d - x) + 2.0 * abs(e - x)
        + abs(f - x) + 2.0 * abs(g - x) + abs(h - x)) / 8.0;
}

// The edge response, 0 to 1, of g = (g_min, g_max) over 3 x 3 pixels ([CL] Eq. 2).
fn edge_response(g: vec2<f32>, k: f32) -> f32 {
    let r = (g.y - g.x) / k;
    return min(r * r, 1.0);
}

// Extends (g_min, g_max) by the gradient at index i of 5 x 5 values. The nine calls
// below are written out: CPU adapters execute the body of a loop once more than it
// iterates.
fn gradient_at(v: ptr<function, array<f32, 25>>, i: u32, found: vec2<f32>) -> vec2<f32> {
    let g = gradient(
        (*v)[i - 6u], (*v)[i - 5u], (*v)[i - 4u],
        (*v)[i - 1u], (*v)[i], (*v)[i + 1u],
        (*v)[i + 4u], (*v)[i + 5u], (*v)[i + 6u],
    );
    return vec2(min(found.x, g), max(found.y, g));
}

// (g_min, g_max) of the 3 x 3 values in the middle of 5 x 5 values, row by row.
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

// The distance between two normals: 2 sin(angle / 2). 0 if one of them is missing
// (w = 0 instead of 1).
fn normal_step(a: vec4<f32>, b: vec4<f32>) -> f32 {
    return length(a.xyz - b.xyz) * a.w * b.w;
}

// As gradient_at, with the distance between normals as difference: it does not depend
// on the axes in which normals are given.
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

// The largest of the responses of the three components of the normal (Decaudin's
// crease, [CL] Eq. 1 and 2).
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

// The step in raw depth down from a pixel (here) to its neighbour (there), minus the
// steeper of the slopes on its two sides, if that goes down too. It is positive at an
// edge, and 0 or less on a plane. `before` and `beyond` are the next pixels outwards.
fn step_excess(before: f32, here: f32, there: f32, beyond: f32) -> f32 {
    return (here - there) - max(0.0, max(before - here, there - beyond));
}

// Whether an edge runs between two pixels: the excess of their step must be at least
// half of g_max - g_min. At a straight edge it is twice that difference, at a single
// pixel that stands out 0.73 times.
fn on_edge(excess: f32, g: vec2<f32>) -> bool {
    return excess > 0.0 && excess >= 0.5 * (g.y - g.x);
}

// Whether a crease runs between two pixels, with `step` between their normals. It must
// be the largest step nearby (`around`) and at least g_max - g_min (at a straight crease
// it is twice that). `complete` is 0 where a neighbour has no normal: next to the rim of
// a surface, the curvature of the rim is not a crease.
fn on_crease(step: f32, around: f32, complete: f32, g: vec2<f32>) -> bool {
    return complete > 0.0 && step >= around && step >= g.y - g.x;
}

// The lines that belong to one pixel: written by detect.wgsl, read by read.wgsl.
struct Edge {
    // Bit 4 * kind + side: a line of this kind runs along this side. Bits 12, 13: the
    // pixel itself is the line (faithful silhouettes, faithful creases).
    sides: u32,
    // Ink of each kind, 0 to 1, before its opacity.
    ink: vec3<f32>,
    // Half of the width in physical pixels.
    half_width: f32,
    // Slot of the OutlineStyle of the object that the lines belong to; 0: it has none.
    slot: u32,
}

const WHOLE_SILHOUETTE: u32 = 4096u;
const WHOLE_CREASE: u32 = 8192u;

// An edge in four words of 16 bits.
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

// Unit vector from the centre of a pixel towards a side; y points down.
fn side_direction(side: u32) -> vec2<f32> {
    let sign = select(-1.0, 1.0, (side & 1u) == 1u);
    return select(vec2(0.0, sign), vec2(sign, 0.0), side < 2u);
}

// Offset of the middle of a line from the centre of the pixel that it belongs to, in
// pixels. The middle of a line of even width is the edge between the two pixels. With
// an odd width it is half a pixel further in, at the centre, so that the line covers
// whole pixels in both cases. In between, the offset is interpolated.
fn line_offset(side: u32, half_width: f32) -> vec2<f32> {
    let width = 2.0 * half_width;
    let odd = select(abs(width - 2.0 * round(0.5 * width)), 1.0, width < 1.0);
    return side_direction(side) * (0.5 - 0.5 * odd);
}

// The fraction of a pixel that is covered by a line whose middle is at `distance` from
// the pixel's centre. Exact for lines parallel to the pixel's sides.
fn line_coverage(distance: f32, half_width: f32) -> f32 {
    return clamp(half_width + 0.5 - distance, 0.0, min(2.0 * half_width, 1.0));
}
