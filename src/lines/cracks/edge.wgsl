#define_import_path bevy_comics::lines::edge

// The edge response of [CL] and the geometry of lines. Pure functions.

// How convex or concave creases are drawn, see EdgeStyle. `source`: EDGE_INK or EDGE_SURFACE, otherwise
// they are like other creases.
struct EdgeInk {
    color: vec3<f32>,
    source: u32,
    lighten: f32,
    saturate: f32,
    // Factors of width and opacity, and of the opacity where the edge is not lit.
    width: f32,
    opacity: f32,
    unlit_opacity: f32,
    unused: vec3<f32>,
}

const EDGE_INK: u32 = 1u;
const EDGE_SURFACE: u32 = 2u;

// How the lines of a view are found and inked.
struct Lines {
    silhouette_color: vec3<f32>,
    silhouette_opacity: f32,
    crease_color: vec3<f32>,
    crease_opacity: f32,
    object_color: vec3<f32>,
    object_opacity: f32,
    // Responses at which ink begins (low) and is full (high), and k of [CL] Eq. 2.
    // Faithful: 1 for Equations::Faithful.
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
    // A step above this multiple of the reference separates two surfaces that do not
    // meet: no crease runs there.
    jump: f32,
    // 1 where weak edges have less ink, and less width; otherwise 0.
    ink_part: f32,
    width_part: f32,
    // Responses from which cracks are certain: weaker ones only continue lines.
    silhouette_limit: f32,
    crease_limit: f32,
    // Of lines in the color of surfaces: factors of luminance and of the distance from gray.
    surface_darken: f32,
    surface_saturate: f32,
    // 1 where borders of sections that were found in all meshes count; otherwise 0.
    found_sections: u32,
    // 1 where folds of normals are creases; otherwise 0.
    normal_creases: u32,
    // How much raw depth bends at least at a fold of 90 degrees, as a fraction of what a jump is one of; see
    // DepthProjection::least_bend.
    bend: f32,
    // HARD: of two surfaces of which none hides the other, the line belongs to the one that faces this direction
    // of the world more.
    owner_direction: vec3<f32>,
    convex: EdgeInk,
    concave: EdgeInk,
}

// The grid that lines are found on: the pixels of the depth texture.
struct Grid {
    // Origin and size in the depth texture: x, y, width, height.
    rect: vec4<i32>,
    // Position in the grid of a position in the viewport, both in pixels from their top
    // left corners: xy * position + zw.
    from_viewport: vec4<f32>,
    // Pixels within which cracks are searched around a pixel.
    reach: i32,
    // Pixels around a crack or jump that may have ink.
    inked: i32,
    // MapJumps: the least departure of the depth map, and the distance in whole pixels.
    jump_least: f32,
    jump_radius: f32,
    // Words of 32 pixels across the grid and down it, see planes.wgsl.
    words: vec2<i32>,
    // Cracks that a line continues along weak edges.
    steps: i32,
    // Pieces of line of fewer cracks are left out.
    min_length: i32,
    // Gaps of at most this many cracks are closed.
    gap_closing: i32,
    // Frames that lines stay where their edges have become weak.
    hold_frames: i32,
    // Size of the grid of the last frame, if lines stay.
    past_size: vec2<i32>,
    // Pixels by which loose ends are extended.
    overshoot: f32,
}

// The edge response, 0 to 1, of g = (g_min, g_max) over 3 x 3 pixels ([CL] Eq. 2).
fn edge_response(g: vec2<f32>, k: f32) -> f32 {
    let r = (g.y - g.x) / k;
    return min(r * r, 1.0);
}

// Extends (g_min, g_max) by the gradient at index i of 5 x 5 values, from the eight values
// around it ([CL] Eq. 1). The nine calls below are written out: CPU adapters execute the
// body of a loop once more than it iterates.
fn gradient_at(v: ptr<function, array<f32, 25>>, i: u32, found: vec2<f32>) -> vec2<f32> {
    let x = (*v)[i];
    let g = (abs((*v)[i - 6u] - x) + 2.0 * abs((*v)[i - 5u] - x) + abs((*v)[i - 4u] - x)
        + 2.0 * abs((*v)[i - 1u] - x) + 2.0 * abs((*v)[i + 1u] - x)
        + abs((*v)[i + 4u] - x) + 2.0 * abs((*v)[i + 5u] - x) + abs((*v)[i + 6u] - x)) / 8.0;
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

// The functions below compute four places at once: a vector holds the values of four
// neighboring columns, or of four unrelated places.

// The step between the raw depths of two neighbors (here, there), minus the steeper of
// the slopes that lead up to it and away from it. It is positive at an edge, and 0 or
// less on a plane. A slope counts only if it persists over two pixels: a single step
// next to this one is another edge, not a slope. `before_2`, `before` and `beyond`,
// `beyond_2` are the next pixels on both sides.
fn step_excess(
    before_2: vec4<f32>, before: vec4<f32>, here: vec4<f32>,
    there: vec4<f32>, beyond: vec4<f32>, beyond_2: vec4<f32>,
) -> vec4<f32> {
    let step = here - there;
    let down = select(vec4(-1.0), vec4(1.0), step >= vec4(0.0));
    let near_slope = min(down * (before - here), down * (before_2 - before));
    let far_slope = min(down * (there - beyond), down * (beyond - beyond_2));
    return abs(step) - max(vec4(0.0), max(near_slope, far_slope));
}

// How the depths of six pixels in a row depart from a plane in their middle, beyond four times what
// they bend beside it: 0 or less on planes and curves.
struct Departures {
    // The step between the two in the middle; and the largest of those on both sides of it and of those
    // over two pixels, the middle and one beside it, as at a face that is about a pixel wide.
    step: vec4<f32>,
    beside: vec4<f32>,
    // How much the slope changes between them.
    turn: vec4<f32>,
}

// A step makes two bends in opposite directions.
fn step_of(bend: vec4<f32>, next: vec4<f32>) -> vec4<f32> {
    let opposite = (bend > vec4(0.0)) != (next > vec4(0.0));
    return select(vec4(0.0), min(abs(bend), abs(next)), opposite);
}

fn departures(
    before_2: vec4<f32>, before: vec4<f32>, here: vec4<f32>,
    there: vec4<f32>, beyond: vec4<f32>, beyond_2: vec4<f32>,
) -> Departures {
    let bend_0 = (before_2 - before) - (before - here);
    let bend_1 = (before - here) - (here - there);
    let bend_2 = (here - there) - (there - beyond);
    let bend_3 = (there - beyond) - (beyond - beyond_2);
    let outer = 4.0 * min(abs(bend_0), abs(bend_3));
    let beside = max(
        step_of(bend_0, bend_1) - 4.0 * min(abs(bend_2), abs(bend_3)),
        step_of(bend_2, bend_3) - 4.0 * min(abs(bend_0), abs(bend_1)),
    );
    let wide = max(step_of(bend_0, bend_2) - 4.0 * abs(bend_3), step_of(bend_1, bend_3) - 4.0 * abs(bend_0));
    return Departures(step_of(bend_1, bend_2) - outer, max(beside, wide), abs(bend_1 + bend_2) - outer);
}

// The step on the other side of one beside a larger step, as a fraction of it, from which
// the surface is curved: 0.41 and more next to the rim of a cylinder, less next to that of a
// mesh with flat sides, and about 0 between flat layers.
const CURVED: f32 = 0.1;

// Twice the raw depth by which the plane of `before` and `here` is in front of that of `there` and
// `beyond`, if both are parallel.
fn in_front_by(before: vec4<f32>, here: vec4<f32>, there: vec4<f32>, beyond: vec4<f32>) -> vec4<f32> {
    return 3.0 * (here - there) - before + beyond;
}

// Whether the step from `here` to `there` is part of a curve that ends in a larger step
// directly beside it. Just inside the rim of a curved surface, depth falls so steeply that
// one or two steps there would be silhouettes too.
fn is_outdone(before: vec4<f32>, here: vec4<f32>, there: vec4<f32>, beyond: vec4<f32>) -> vec4<bool> {
    let step = here - there;
    let down = select(vec4(-1.0), vec4(1.0), step >= vec4(0.0));
    let near_step = down * (before - here);
    let far_step = down * (there - beyond);
    return (max(near_step, far_step) > abs(step)) & (min(near_step, far_step) >= CURVED * abs(step));
}

// Response to the excess of a step ([CL] Eq. 2, with half of the excess in place of
// g_max - g_min: both are the same along a straight edge).
fn step_response(excess: vec4<f32>, k: vec4<f32>) -> vec4<f32> {
    let r = 0.5 * max(excess, vec4(0.0)) / max(k, vec4(1e-30));
    return min(r * r, vec4(1.0));
}

// Whether a surface ends in front of the sky. That is a step, however close to the far plane it is:
// the sky is no surface there.
fn ends_at_sky(here: vec4<f32>, there: vec4<f32>) -> vec4<bool> {
    return (min(here, there) <= vec4(0.0)) & (max(here, there) > vec4(0.0));
}

// Whether a raw depth is that of a surface in front of another one. `jump`: the difference that
// separates two surfaces.
fn is_in_front(d: f32, other: f32, jump: f32) -> bool {
    return d > other + jump;
}

// The squared distance of two normals; -1 if one of them is missing (w = 0 instead of
// 1). Half of the distance is the sine of half of the angle.
fn fold(a: vec4<f32>, b: vec4<f32>) -> f32 {
    let d = a.xyz - b.xyz;
    return select(-1.0, dot(d, d), a.w * b.w > 0.0);
}

// Response to folds.
fn fold_response(folds: vec4<f32>, k: f32) -> vec4<f32> {
    return clamp(folds * (0.25 / (k * k)), vec4(0.0), vec4(1.0));
}

// Whether a fold is the sharpest of three in a row. With a missing normal nearby it is
// none: next to the rim of a surface, the curvature of the rim is not a crease.
fn is_ridge(before: vec4<f32>, folds: vec4<f32>, beyond: vec4<f32>) -> vec4<bool> {
    let complete = (before >= vec4(0.0)) & (folds > vec4(0.0)) & (beyond >= vec4(0.0));
    return complete & (folds >= before) & (folds >= beyond);
}

// The fold of 60 degrees.
const SHARP: f32 = 1.0;

// The same at the rim of a surface, where one of the normals is missing: a crease may go on
// to the rim. The rim's own curvature bends less, unless the surface is a few pixels wide.
fn is_rim_ridge(before: vec4<f32>, folds: vec4<f32>, beyond: vec4<f32>) -> vec4<bool> {
    let one_missing = (before >= vec4(0.0)) != (beyond >= vec4(0.0));
    return one_missing & (folds >= vec4(SHARP)) & (folds >= max(before, beyond));
}

// Of the ramp of the ink from low to high, the part whose ink is 0 after rounding to eight
// bits: smoothstep of it is less than 0.5 / 255.
const INVISIBLE: f32 = 0.0257;
// Bounds are this much lower than the response at which ink is visible, so that rounding
// leaves out no ink.
const BELOW: f32 = 0.999;

// The excess of a step from which it may have ink, as a fraction of what a jump is one of: at the
// response from which ink is visible, without the division of step_response.
fn least_silhouette(s: Lines) -> f32 {
    return BELOW * 2.0 * s.silhouette_k * sqrt(mix(s.silhouette_low, s.silhouette_high, INVISIBLE));
}

// Whether the excess of a step may have ink. It is true for every step whose ink is not 0
// after rounding, and for few others. `near` is the larger of both raw depths.
fn may_be_silhouette(s: Lines, excess: vec4<f32>, near: vec4<f32>) -> vec4<bool> {
    let least = least_silhouette(s);
    return (excess > least * (s.reference_factor * near + s.reference_constant)) & (near > vec4(0.0));
}

// The same for folds of creases.
fn may_be_crease(s: Lines, folds: vec4<f32>) -> vec4<bool> {
    let least = mix(s.crease_low, s.crease_high, INVISIBLE);
    return folds > vec4(BELOW * 4.0 * s.crease_k * s.crease_k * least);
}

// How much raw depth bends at least at a fold that may be a crease, as a fraction of what a jump is
// one of: in proportion to the tangent of half of its angle.
fn least_crease_bend(s: Lines) -> f32 {
    let least = s.crease_k * s.crease_k * mix(s.crease_low, s.crease_high, INVISIBLE);
    let squared = min(least, 0.99);
    return s.bend * sqrt(squared / (1.0 - squared));
}

// A crack is the border between two neighboring pixels: `here`, and `there` to the east
// or south of it. It is packed into 32 bits:
//   bits 0 to 2: a silhouette, a crease, an object edge runs along it; settled, see settle.wgsl, both
//   a silhouette and a crease: a convex crease with a style of its own;
//   bit 3: the line belongs to `here`, otherwise to `there`;
//   bits 4 to 11: ink of the silhouette or crease; 12 to 19: opacity after fading;
//   bits 20 to 31: half width, see pack_width.
struct Crack {
    // Bits as in ObjectStyle::kinds. A crack has no silhouette and crease at once.
    kinds: u32,
    owner_here: bool,
    // Ink of the silhouette or crease, 0 to 1.
    ink: f32,
    // Fraction of the opacity that is left after fading.
    opacity: f32,
    // Half of the width in physical pixels.
    half_width: f32,
}

// Half of the smallest width of a line in physical pixels: a thinner one is fainter.
const THINNEST: f32 = 0.3;

// Signs of creases, if convex and concave ones differ; 0 for none.
const CONCAVE: i32 = 1;
const CONVEX: i32 = 2;

const SILHOUETTE: u32 = 1u;
const CREASE: u32 = 2u;
const OBJECT: u32 = 4u;

// 0 to 1 as a byte. Odd tenths (0.1, 0.3, ...) are half way between two bytes: they are rounded
// down, whatever the last bits are.
fn byte(x: vec4<f32>) -> vec4<u32> {
    return vec4<u32>(clamp(x, vec4(0.0), vec4(1.0)) * 255.0 + 0.499);
}

// A half width of up to 31 physical pixels in 12 bits: a float of 3 bits of exponent and
// 9 of mantissa. 1/8 is added, so that the smallest of these floats stands for 0. Eighths
// of a pixel are exact; the largest error is 1/1024 of the width. Products with simple factors are
// often half way between two of these floats: they are rounded down, whatever the last bits are.
fn pack_width(half_width: vec4<f32>) -> vec4<u32> {
    let bits = bitcast<vec4<u32>>(clamp(half_width, vec4(0.0), vec4(31.0)) + 0.125);
    return ((bits + vec4(0x1ff0u)) >> vec4(14u)) - vec4(124u << 9u);
}

fn unpack_width(packed: u32) -> f32 {
    return bitcast<f32>((packed + (124u << 9u)) << 14u) - 0.125;
}

// The bits above `kinds` and `owner_here` of four cracks.
fn pack_ink(ink: vec4<f32>, opacity: vec4<f32>, half_width: vec4<f32>) -> vec4<u32> {
    return (byte(ink) << vec4(4u)) | (byte(opacity) << vec4(12u)) | (pack_width(half_width) << vec4(20u));
}

fn unpack_crack(packed: u32) -> Crack {
    return Crack(
        packed & 7u,
        (packed & 8u) != 0u,
        f32((packed >> 4u) & 255u) * (1.0 / 255.0),
        f32((packed >> 12u) & 255u) * (1.0 / 255.0),
        unpack_width(packed >> 20u),
    );
}

// Whether a settled crack has a silhouette, or a convex crease with a style of its own.
fn is_silhouette(packed: u32) -> bool {
    return (packed & (SILHOUETTE | CREASE)) == SILHOUETTE;
}

fn is_convex(packed: u32) -> bool {
    return (packed & (SILHOUETTE | CREASE)) == (SILHOUETTE | CREASE);
}

// Ink of a packed crack by kind, after fading: silhouettes, creases, object edges.
fn ink_of(packed: u32) -> vec3<f32> {
    let crack = unpack_crack(packed);
    return crack.opacity * vec3(
        select(0.0, crack.ink, is_silhouette(packed)),
        select(0.0, crack.ink, (crack.kinds & CREASE) != 0u),
        select(0.0, 1.0, (crack.kinds & OBJECT) != 0u),
    );
}

// The largest opacity of the kinds with this ink.
fn largest_opacity(s: Lines, kinds: vec3<f32>) -> f32 {
    let alpha = kinds * vec3(s.silhouette_opacity, s.crease_opacity, s.object_opacity);
    return max(alpha.x, max(alpha.y, alpha.z));
}

// The opacity of the line along a packed crack.
fn crack_opacity(s: Lines, packed: u32) -> f32 {
    return largest_opacity(s, ink_of(packed));
}

// The middle of the line near a crack, in pixels from the center of the crack's pixel.
// `across`: the unit vector from the pixel to the crack; `bend`: see line_bend in bend.wgsl;
// `shifts`: see line_offset.
fn line_middle(packed: u32, across: vec2<f32>, bend: vec2<f32>, shifts: bool) -> vec2<f32> {
    let to_owner = select(0.0, select(1.0, -1.0, (packed & 8u) != 0u), shifts);
    let normal = (across - bend.y * across.yx) * inverseSqrt(1.0 + bend.y * bend.y);
    return (0.5 + bend.x) * across + to_owner * line_offset(unpack_width(packed >> 20u)) * normal;
}

// The pixel that owns a crack, from the crack's own pixel: `south`: the crack is to its south,
// else to its east.
fn owner_step(packed: u32, south: bool) -> vec2<i32> {
    return select(select(vec2(1, 0), vec2(0, 1), south), vec2(0), (packed & 8u) != 0u);
}

// From the pixel that owns a crack to the next one inside.
fn inward_step(packed: u32, south: bool) -> vec2<i32> {
    return select(vec2(1, 0), vec2(0, 1), south) * select(1, -1, (packed & 8u) != 0u);
}

// The row of a packed middle, in 512ths of a pixel.
fn middle_row(packed: u32) -> f32 {
    return f32(packed >> 16u) / 512.0 - 64.0;
}

// Packs the middle of a line into 32 bits: from the center of a pixel, -2 to 2 pixels across
// and -64 to 64 down, in 512ths of a pixel (bits 0 to 10, and 16 to 31). `owner`: from that
// pixel to the one that owns the line; across it is 0 or 1 (bit 11), and down it is stored from
// the row of the middle (bits 12 to 14). `south`: the crack is to the south of its pixel (bit 15).
fn pack_middle(middle: vec2<f32>, owner: vec2<i32>, south: bool) -> u32 {
    let place = vec2<u32>(round(clamp(middle + vec2(2.0, 64.0), vec2(0.0), vec2(3.99, 127.0)) * 512.0));
    let packed = place.x | (u32(owner.x & 1) << 11u) | select(0u, 0x8000u, south) | (place.y << 16u);
    let down = owner.y - i32(floor(middle_row(packed) + 0.5));
    return packed | (u32(clamp(down + 3, 0, 7)) << 12u);
}

fn unpack_middle(packed: u32) -> vec2<f32> {
    return vec2(f32(packed & 0x7ffu) / 512.0 - 2.0, middle_row(packed));
}

// From the pixel that pack_middle was given to the one that owns the line.
fn unpack_owner(packed: u32) -> vec2<i32> {
    let down = i32((packed >> 12u) & 7u) - 3;
    return vec2(i32((packed >> 11u) & 1u), i32(floor(middle_row(packed) + 0.5)) + down);
}

// Distance from the middle of a line to the crack that it runs along, towards its
// owner, in pixels. The middle of a line of even width is the crack. With an odd width
// it is half a pixel further in, at the center of the owner, so that the line covers
// whole pixels in both cases. In between, the distance is interpolated.
fn line_offset(half_width: f32) -> f32 {
    let width = 2.0 * half_width;
    let odd = select(abs(width - 2.0 * round(0.5 * width)), 1.0, width < 1.0);
    return 0.5 * odd;
}

// Whether two middles of lines are in different places: more than about 1/4 pixel apart.
// No two middles are at this distance, so that rounding does not decide.
fn is_apart(a: vec2<f32>, b: vec2<f32>) -> bool {
    let apart = a - b;
    return dot(apart, apart) > 0.07;
}

// Ink as it is stored: steps are finest where little light is left. Larger ink is
// stored as a larger value.
fn encode_ink(ink: vec3<f32>) -> vec3<f32> {
    return 1.0 - sqrt(1.0 - clamp(ink, vec3(0.0), vec3(1.0)));
}

fn decode_ink(stored: vec3<f32>) -> vec3<f32> {
    return 1.0 - (1.0 - stored) * (1.0 - stored);
}

// The fraction of a pixel that is covered by a line whose middle is at `distance` from
// the pixel's center. Exact for lines parallel to the pixel's sides.
fn line_coverage(distance: f32, half_width: f32) -> f32 {
    return clamp(half_width + 0.5 - distance, 0.0, min(2.0 * half_width, 1.0));
}
