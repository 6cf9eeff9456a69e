// Draws the ink of the lines into a texture of the size of the viewport. Only tiles with
// a crack nearby are drawn; the rest of the texture is cleared.
//
// x, y, z: ink of silhouettes, creases and object edges, encoded; w: slot of the OutlineStyle of
// the strongest line, / 255.

#import bevy_comics::depth::view::set_view
#ifdef BOIL
#import bevy_comics::lines::boil::boiled
#endif
#import bevy_comics::lines::coverage::{disc_coverage, segment_coverage}
#import bevy_comics::lines::edge::{
    CONCAVE, CONVEX, OBJECT, encode_ink, ink_of, inward_step, is_apart, is_convex, largest_opacity, owner_step,
    unpack_middle, unpack_owner, unpack_width,
}
#ifdef CLOSED_GAPS
#import bevy_comics::lines::gaps::source_of
#endif
#import bevy_comics::lines::pass::line_pass
#ifdef INK_BLEED
#import bevy_comics::lines::sheet::{height_under, spread_width}
#endif
#ifdef STREAKS
#import bevy_comics::lines::sheet::dry_ink
#endif
#ifdef OBJECT_STYLES
#import bevy_comics::objects::texel_slot
#endif
#ifdef BLOCKS
#ifdef COLUMNS
#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::blocks::{BLOCK_HEIGHT, BLOCK_WIDTH, crack_rows}
#else ifdef NEIGHBORS
#import bevy_comics::lines::near::{near_cracks, near_step}
#else
#import bevy_comics::lines::read_planes::inked_rows
#endif
#endif
#ifndef COLUMNS
#import bevy_comics::lines::stored::{load_bends, load_cracks, stored_middle}
#endif

#ifdef COLUMNS
// The best two cracks of each pixel's column, see columns.wgsl.
@group(0) @binding(13) var column_texture: texture_2d<u32>;
#endif

struct Drawn {
    @location(0) ink: vec4<f32>,
#ifdef SURFACE
    // x, y: from the pixel to the one that owns the strongest line, in pixels of the viewport;
    // z: the sign of the crease, see edge.wgsl.
    @location(1) owner: vec4<i32>,
#endif
}

// What is known of the lines at a position.
struct Ink {
    // By kind: silhouettes, creases, object edges.
    kinds: vec3<f32>,
    // EDGE_STYLES: that of convex creases, and of the others.
    convex: f32,
    concave: f32,
    strongest: f32,
    // The pixel that owns the strongest line. CLOSED_GAPS: and its crack, as in chain.wgsl.
    owner: vec2<i32>,
    crack: vec3<i32>,
    // Two lines in different places whose borders are nearest: their middles, and the
    // distances from their borders, negative inside.
    first: vec2<f32>,
    second: vec2<f32>,
    distances: vec2<f32>,
    // The packed crack of the first, the pixel that owns it, and from there to the next one
    // behind the crack; and where the crack is.
    packed: u32,
    first_owner: vec2<i32>,
    first_crack: vec3<i32>,
    inward: vec2<i32>,
}

// Pixels of the viewport per pixel of the grid.
var<private> viewport_scale: vec2<f32>;

#ifdef INK_BLEED
// Height of the sheet under the pixel.
var<private> height: f32;
#endif

// The half width of a line at the pixel.
fn width_here(half_width: f32) -> f32 {
#ifdef INK_BLEED
    return spread_width(line_pass.sheet, half_width, height);
#else
    return half_width;
#endif
}

fn alphas(kinds: vec3<f32>) -> f32 {
    return largest_opacity(line_pass.settings, kinds);
}

// The pixel that owns a line, and whether its crack is to the south of its pixel.
struct Owner {
    pixel: vec2<i32>,
    south: bool,
}

fn add_kinds(ink: ptr<function, Ink>, packed: u32, kinds: vec3<f32>) {
    (*ink).kinds = max((*ink).kinds, kinds);
#ifdef EDGE_STYLES
    // Edges between objects have no sign.
    let crease = select(kinds.y, 0.0, (packed & OBJECT) != 0u);
    (*ink).convex = max((*ink).convex, select(0.0, crease, is_convex(packed)));
    (*ink).concave = max((*ink).concave, select(crease, 0.0, is_convex(packed)));
#endif
}

// Adds the ink of a line that covers a part of the pixel.
fn add_ink(ink: ptr<function, Ink>, packed: u32, covered: f32, owner: Owner) {
    let kinds = covered * ink_of(packed);
    add_kinds(ink, packed, kinds);
#ifdef OWNERS
    let alpha = alphas(kinds);
    let stronger = alpha > (*ink).strongest;
    (*ink).owner = select((*ink).owner, owner.pixel, stronger);
    (*ink).strongest = max((*ink).strongest, alpha);
#ifdef CLOSED_GAPS
    (*ink).crack = select((*ink).crack, crack_of(packed, owner), stronger);
#endif
#endif
}

// A crack, as in chain.wgsl.
fn crack_of(packed: u32, owner: Owner) -> vec3<i32> {
    return vec3(owner.pixel - owner_step(packed, owner.south), select(0, 1, owner.south));
}

// Adds the line along a crack.
fn add(ink: ptr<function, Ink>, packed: u32, middle: vec2<f32>, owner: Owner, at: vec2<f32>) {
    let half_width = unpack_width(packed >> 20u);
    let away = length((middle - at) * viewport_scale);
    let exists = (packed & 7u) != 0u;
    add_ink(ink, packed, disc_coverage(away, width_here(half_width)), owner);
    let border = select(1e6, away - half_width, exists);
    let nearest = border < (*ink).distances.x;
    follow(ink, middle, border);
    (*ink).packed = select((*ink).packed, packed, nearest);
#ifdef OWNERS
    (*ink).first_owner = select((*ink).first_owner, owner.pixel, nearest);
#ifdef CLOSED_GAPS
    (*ink).first_crack = select((*ink).first_crack, crack_of(packed, owner), nearest);
#endif
#ifdef INWARD
    (*ink).inward = select((*ink).inward, inward_step(packed, owner.south), nearest);
#endif
#endif
}

// Keeps the two lines whose borders are nearest.
fn follow(ink: ptr<function, Ink>, middle: vec2<f32>, border: f32) {
    let nearest = border < (*ink).distances.x;
    // Both cracks at a corner of a line of odd width have their middle in one pixel.
    let other = is_apart(middle, (*ink).first);
    let behind = other && border < (*ink).distances.y;
    let pushed = other && nearest;
    (*ink).second = select(select((*ink).second, middle, behind), (*ink).first, pushed);
    (*ink).distances.y = select(select((*ink).distances.y, border, behind), (*ink).distances.x, pushed);
    (*ink).first = select((*ink).first, middle, nearest);
    (*ink).distances.x = min((*ink).distances.x, border);
}

#ifndef COLUMNS
// Adds both cracks of a pixel, which may lie outside of the grid.
fn add_pixel(ink: ptr<function, Ink>, p: vec2<i32>, at: vec2<f32>) {
    let last = line_pass.grid.rect.zw - 1;
    let inside = all(p >= vec2(0)) && all(p <= last);
    let stored = clamp(p, vec2(0), last);
    let packed = select(vec2(0u), load_cracks(line_pass.grid, stored), inside);
    let bends = load_bends(line_pass.grid, stored);
    add_crack(ink, packed.x, p, vec2(1, 0), bends, at);
    add_crack(ink, packed.y, p, vec2(0, 1), bends >> 16u, at);
}

// Adds the crack of the pixel `p` that is `towards` the east or the south.
fn add_crack(ink: ptr<function, Ink>, packed: u32, p: vec2<i32>, towards: vec2<i32>, bend: u32, at: vec2<f32>) {
    let middle = vec2<f32>(p) + 0.5 + stored_middle(packed, vec2<f32>(towards), bend);
    let south = towards.y == 1;
    add(ink, packed, middle, Owner(p + owner_step(packed, south), south), at);
}
#endif

#ifdef COLUMNS
// Adds the best two cracks of a column of pixels, `p`.
fn add_column(ink: ptr<function, Ink>, p: vec2<i32>, at: vec2<f32>) {
    let last = line_pass.grid.rect.zw - 1;
    let inside = p.x >= 0 && p.x <= last.x;
    let texel = textureLoad(column_texture, vec2(clamp(p.x, 0, last.x), p.y), 0);
    let stored = select(vec4(0u), texel, inside);
    let first = vec2<f32>(p) + 0.5 + unpack_middle(stored.y);
    let second = vec2<f32>(p) + 0.5 + unpack_middle(stored.w);
    add(ink, stored.x, first, Owner(p + unpack_owner(stored.y), (stored.y & 0x8000u) != 0u), at);
    add(ink, stored.z, second, Owner(p + unpack_owner(stored.w), (stored.w & 0x8000u) != 0u), at);
}

#ifdef BLOCKS
// Whether columns.wgsl may have found cracks for the row `y` of pixels in a column of blocks.
fn has_columns(g: Grid, block: i32, y: i32) -> bool {
    let first = max(y - g.reach - 1, 0);
    let last = min(y + g.reach, g.rect.w - 1);
    var rows = 0u;
    for (var row = first / BLOCK_HEIGHT; row <= last / BLOCK_HEIGHT; row++) {
        rows |= crack_rows(vec2(block, row), first, last);
    }
    return rows != 0u;
}

// Adds the columns of a row of pixels. Blocks without cracks nearby are left out.
fn add_columns(ink: ptr<function, Ink>, center: vec2<i32>, at: vec2<f32>) {
    let g = line_pass.grid;
    let y = clamp(center.y, 0, g.rect.w - 1);
    let first = max(center.x - g.reach - 1, 0) / BLOCK_WIDTH;
    let last = min(center.x + g.reach, g.rect.z - 1) / BLOCK_WIDTH;
    // One bit for each block; lines reach less than 32 blocks far.
    var blocks = 0u;
    for (var block = first; block <= last; block++) {
        blocks |= select(0u, 1u << u32(block - first), has_columns(g, block, y));
    }
    while blocks != 0u {
        let x = (first + i32(firstTrailingBit(blocks))) * BLOCK_WIDTH;
        blocks &= blocks - 1u;
        add_column(ink, vec2(x, y), at);
        add_column(ink, vec2(x + 1, y), at);
        add_column(ink, vec2(x + 2, y), at);
        add_column(ink, vec2(x + 3, y), at);
    }
}
#endif
#endif

#ifdef BLOCKS
#ifdef NEIGHBORS
// Adds the crack of a bit of near_cracks.
fn add_near(ink: ptr<function, Ink>, center: vec2<i32>, bit: u32, at: vec2<f32>) {
    let south = (bit & 1u) != 0u;
    let p = center + vec2(near_step((bit >> 1u) & 3u), near_step(bit >> 3u));
    let cracks = load_cracks(line_pass.grid, p);
    let bends = load_bends(line_pass.grid, p);
    let packed = select(cracks.x, cracks.y, south);
    add_crack(ink, packed, p, select(vec2(1, 0), vec2(0, 1), south), select(bends, bends >> 16u, south), at);
}
#else ifndef COLUMNS
// Adds the pixels of a column within reach of a position that have cracks with ink.
fn add_inked(ink: ptr<function, Ink>, x: i32, y: i32, at: vec2<f32>) {
    let g = line_pass.grid;
    let last = y + g.reach;
    for (var first = y - g.reach; first <= last; first += 32) {
        let inked = inked_rows(g, x, first, min(first + 31, last));
        var rows = inked.x | inked.y;
        while rows != 0u {
            add_pixel(ink, vec2(x, first + i32(firstTrailingBit(rows))), at);
            rows &= rows - 1u;
        }
    }
}
#endif
#endif

// Adds the lines near a position of the grid.
fn search(ink: ptr<function, Ink>, center: vec2<i32>, at: vec2<f32>) {
    let g = line_pass.grid;
#ifdef BLOCKS
#ifdef NEIGHBORS
    var near = near_cracks(g, center);
    while near != 0u {
        add_near(ink, center, firstTrailingBit(near), at);
        near &= near - 1u;
    }
#else ifdef COLUMNS
    add_columns(ink, center, at);
#else
    for (var x = center.x - g.reach; x <= center.x + g.reach; x++) {
        add_inked(ink, x, center.y, at);
    }
#endif
#else ifdef NEIGHBORS
    // CPU adapters execute the body of a loop once more than it iterates.
    add_pixel(ink, center + vec2(-1, -1), at);
    add_pixel(ink, center + vec2(0, -1), at);
    add_pixel(ink, center + vec2(1, -1), at);
    add_pixel(ink, center + vec2(-1, 0), at);
    add_pixel(ink, center, at);
    add_pixel(ink, center + vec2(1, 0), at);
    add_pixel(ink, center + vec2(-1, 1), at);
    add_pixel(ink, center + vec2(0, 1), at);
#ifdef SMOOTH
    // Lines leave their cracks by up to half a pixel.
    add_pixel(ink, center + vec2(1, 1), at);
    add_pixel(ink, center + vec2(-1, -2), at);
    add_pixel(ink, center + vec2(0, -2), at);
    add_pixel(ink, center + vec2(1, -2), at);
    add_pixel(ink, center + vec2(-2, -1), at);
    add_pixel(ink, center + vec2(-2, 0), at);
    add_pixel(ink, center + vec2(-2, 1), at);
#endif
#else ifdef COLUMNS
    for (var x = -g.reach - 1; x <= g.reach; x++) {
        add_column(ink, vec2(center.x + x, clamp(center.y, 0, g.rect.w - 1)), at);
    }
#else
    for (var y = -g.reach; y <= g.reach; y++) {
        for (var x = -g.reach; x <= g.reach; x++) {
            add_pixel(ink, center + vec2(x, y), at);
        }
    }
#endif
}

#ifdef HARD
// The packed crack to the east of a pixel, or to its south; 0 if there is none.
fn crack_beside(p: vec2<i32>, south: bool) -> u32 {
    let g = line_pass.grid;
    if any(p < vec2(0)) || any(p >= g.rect.zw) {
        return 0u;
    }
#ifdef BLOCKS
    let inked = inked_rows(g, p.x, p.y, p.y);
    if select(inked.x, inked.y, south) == 0u {
        return 0u;
    }
#endif
    let cracks = load_cracks(g, p);
    return select(cracks.x, cracks.y, south);
}

// Adds the line along the side `towards` of a pixel that is `away` pixels from this one, if it
// belongs to that pixel and is wide enough.
fn add_side(ink: ptr<function, Ink>, center: vec2<i32>, towards: vec2<i32>, away: i32) {
    let pixel = center + away * towards;
    let south = towards.y != 0;
    let packed = crack_beside(pixel + min(towards, vec2(0)), south);
    let is_own = all(owner_step(packed, south) == max(-towards, vec2(0)));
    let width = max(i32(round(2.0 * unpack_width(packed >> 20u))), 1);
    add_ink(ink, packed, select(0.0, 1.0, is_own && away < width), Owner(pixel, south));
}

// Adds the lines along the four sides of a pixel, and those that are wider than the pixels
// between.
fn add_sides(ink: ptr<function, Ink>, center: vec2<i32>) {
    for (var away = 0; away < line_pass.grid.reach; away++) {
        add_side(ink, center, vec2(1, 0), away);
        add_side(ink, center, vec2(-1, 0), away);
        add_side(ink, center, vec2(0, 1), away);
        add_side(ink, center, vec2(0, -1), away);
    }
}
#endif

#ifdef SURFACE
// From the pixel that owns a line to one whose samples all belong to its surface: the next one
// across the line. A crack alone says too little: at the steps of a line that is nearly
// horizontal, cracks are vertical, and the next pixel lies along the line.
fn inward_of(ink: Ink) -> vec2<i32> {
#ifdef INWARD
    let along = ink.second - ink.first;
    let across = vec2(-along.y, along.x);
    let size = max(abs(across.x), abs(across.y));
    let side = dot(across, vec2<f32>(ink.inward));
    let is_known = ink.distances.y < 1e5 && size < 1.45 && abs(side) > 0.1 * size;
    return select(ink.inward, vec2<i32>(round(across / max(size, 1e-3) * sign(side))), is_known);
#else
    return vec2(0);
#endif
}
#endif

@fragment
fn draw(@builtin(position) position: vec4<f32>) -> Drawn {
    set_view(line_pass.seen);
#ifdef INK_BLEED
    height = height_under(line_pass.sheet, position.xy);
#endif
    let g = line_pass.grid;
    viewport_scale = 1.0 / g.from_viewport.xy;
    var place = position.xy;
#ifdef BOIL
    place = boiled(line_pass.boil, place);
#endif
    let at = place * g.from_viewport.xy + g.from_viewport.zw;
    let center = vec2<i32>(floor(at));
    var ink: Ink;
    ink.distances = vec2(1e6);
#ifdef HARD
    add_sides(&ink, center);
#else
    search(&ink, center, at);
#endif
    // Between the middles of two neighboring cracks, a line runs straight. Discs around
    // the middles alone would leave diagonal lines too thin.
    let continues = ink.distances.y < 1e5 && distance(ink.first, ink.second) < 1.45;
    if ink.distances.x < 1e5 {
        let first = ink.first * viewport_scale;
        let second = select(ink.first, ink.second, continues) * viewport_scale;
        let half_width = unpack_width(ink.packed >> 20u);
        let covered = segment_coverage(at * viewport_scale, first, second, width_here(half_width));
        let straight = covered * ink_of(ink.packed);
        add_kinds(&ink, ink.packed, straight);
#ifdef OWNERS
        let stronger = alphas(straight) > ink.strongest;
        ink.owner = select(ink.owner, ink.first_owner, stronger);
        ink.crack = select(ink.crack, ink.first_crack, stronger);
        ink.strongest = max(ink.strongest, alphas(straight));
#endif
#ifdef STREAKS
        if continues {
            ink.kinds *= dry_ink(line_pass.sheet, position.xy, second - first, half_width);
        }
#endif
    }
#ifdef CLOSED_GAPS
    // The owner of a line in a gap is that of the crack that it continues.
    ink.owner += source_of(g, ink.crack).xy - ink.crack.xy;
#endif
    var slot = 0.0;
#ifdef OBJECT_STYLES
    let corner = g.rect.zw - 1;
    slot = f32(texel_slot(g.rect.xy + clamp(ink.owner, vec2(0), corner), 0)) / 255.0;
#endif
    var drawn: Drawn;
    drawn.ink = vec4(encode_ink(ink.kinds), slot);
#ifdef SURFACE
    // From the middle of the pixel that owns the line.
    let owner = (vec2<f32>(ink.owner + inward_of(ink)) + 0.5 - g.from_viewport.zw) * viewport_scale;
    let away = vec2<i32>(floor(owner)) - vec2<i32>(position.xy);
    var sign = 0;
#ifdef EDGE_STYLES
    // Dark lines go before highlights.
    sign = select(select(0, CONCAVE, ink.concave > 0.0), CONVEX, ink.convex > ink.concave + 0.01);
#endif
    let offset = select(vec2(0), clamp(away, vec2(-127), vec2(127)), ink.strongest > 0.0);
    drawn.owner = vec4(offset, sign, 0);
#endif
    return drawn;
}
