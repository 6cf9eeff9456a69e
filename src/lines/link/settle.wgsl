// Completes the cracks of the cells: leaves out those that are not part of a line, finds how
// the lines of the others run straight through the steps of pixels, and how wide they are.

#import bevy_comics::lines::bend::{end_sign, line_bend, pack_bend, unpack_bend}
#import bevy_comics::lines::chain::{along_crack, cracks_to_end, first_corner, last_corner, stairs_bend}
#import bevy_comics::lines::edge::{CREASE, Grid, SILHOUETTE}
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{
    CELL_ROWS, COLUMNS, FOUND_EAST, FOUND_SOUTH, LEDGE_EAST, LEDGE_SOUTH, LINKED_EAST,
    LINKED_SOUTH,
}
#import bevy_comics::lines::read_planes::{corner_rows, cracks_from, load_column}
#ifdef DEPTH
#import bevy_comics::depth::view::{set_view, texel_depth}
#ifdef MIDDLE_DEPTH
#import bevy_comics::depth::view::middle_depth
#endif
#endif
#ifdef FOLDS
#import bevy_comics::lines::fold::{Fold, fold_bend}
#endif
#ifdef CLOSED_GAPS
#import bevy_comics::lines::gaps::source_of
#endif
#ifdef RIMS
#import bevy_comics::lines::rim::with_rim
#endif
#ifdef WEIGHT
#import bevy_comics::depth::map::is_background
#import bevy_comics::depth::view::depth_frame
#import bevy_comics::lines::weight::{kind_weight, light_weight, nib_weight, perspective_weight}
#import bevy_comics::lines::weight::{taper_weight, weighted_crack}
#ifdef BUDGET
#import bevy_comics::lines::budget::{
    SQUARE, budget_radius, budget_weight, levels_of, square_index, squares, tent,
}
#import bevy_comics::lines::edge::unpack_width
#endif
#ifdef FOG
#import bevy_comics::lines::fog::{fog_distance, fog_fraction}
#endif
#import bevy_comics::lines::fade::fade_factor
#import bevy_comics::lines::layer_lines::layer_factors
#import bevy_comics::lines::owner_plane::{object_at, owner_weights}
#ifdef EDGE_STYLES
#import bevy_comics::lines::edge::OBJECT
#import bevy_comics::lines::sign::{edge_light, is_convex_edge}
#endif
#import bevy_comics::lines::simplification::crease_factor
#ifdef LIGHT_WEIGHT
#import bevy_comics::depth::normal::texel_normal
#endif
#ifdef OBJECT_IDS
#import bevy_comics::objects::texel_object
#endif
#ifdef WIDTH_MAP
#import bevy_comics::objects::texel_width
#endif
#endif

@group(0) @binding(18) var<storage, read_write> crack_words: array<vec2<u32>>;
#ifdef SMOOTH
@group(0) @binding(22) var<storage, read_write> bend_words: array<u32>;
#endif

#ifdef BUDGET
// See density.wgsl.
@group(0) @binding(33) var<storage> densities: array<f32>;
#endif

#ifdef SMOOTH
// How the line along a crack leaves it: by its run. A run of one or two cracks says little:
// then by the stairs that it is a part of.
fn bend_of(crack: vec3<i32>, seen: vec2<u32>, signs: vec2<f32>) -> vec2<f32> {
    let bend = line_bend(seen, signs);
    if seen.x + seen.y > 3u {
        return bend;
    }
    return stairs_bend(line_pass.grid, crack, bend);
}

// The run of a crack, see line_bend: its cracks up to this one and from this one on, and the signs of
// its ends.
struct Run {
    seen: vec2<u32>,
    signs: vec2<f32>,
}

fn run_of(g: Grid, crack: vec3<i32>) -> Run {
    let along = vec2<i32>(along_crack(crack));
    let before = countLeadingZeros(~cracks_from(g, vec3(crack.xy - 31 * along, crack.z)));
    let after = countTrailingZeros(~cracks_from(g, crack));
    let single = before + after == 2u;
    // The cracks across the run at its two ends.
    let first = vec3(crack.xy - i32(before) * along - along.yx, 1 - crack.z);
    let last = vec3(crack.xy + (i32(after) - 1) * along - along.yx, 1 - crack.z);
    let signs = vec2(end_sign(cracks_from(g, first), single), end_sign(cracks_from(g, last), single));
    return Run(vec2(before, after), signs);
}
#endif

#ifdef FOLDS
// Whether another line runs through the pixels that fold_around reads, or along the crack, at
// most three pixels away. The line of the crack itself goes on at most one pixel further in the
// next row.
fn is_fold_crossed(g: Grid, crack: vec3<i32>) -> bool {
    let p = crack.xy;
    // Corners of a column, four bits each: 1, 4 and 8 are the cracks above, to the left and to the right.
    if crack.z == 1 {
        let above = corner_rows(g, p.x + 1, p.y - 2) & 0x0544u;
        let below = corner_rows(g, p.x + 1, p.y + 2) & 0x0454u;
        return (above | below | (corner_rows(g, p.x, p.y) & 0x1001u)) != 0u;
    }
    let west = corner_rows(g, p.x, p.y) & 0x54u;
    let east = corner_rows(g, p.x + 2, p.y) & 0x98u;
    let beyond = corner_rows(g, p.x - 2, p.y) | corner_rows(g, p.x - 1, p.y)
        | corner_rows(g, p.x + 3, p.y) | corner_rows(g, p.x + 4, p.y);
    return (west | east | (beyond & 0x10u)) != 0u;
}

// The depths around a crack, which must be two pixels away from the border of the grid.
fn fold_around(crack: vec3<i32>) -> Fold {
    let across = select(vec2(1, 0), vec2(0, 1), crack.z == 1);
    let along = across.yx;
    let here = line_pass.grid.rect.xy + crack.xy;
    let first = here - across;
    let last = here + 2 * across;
    return Fold(
        vec4(texel_depth(first, 0), texel_depth(here, 0), texel_depth(here + across, 0), texel_depth(last, 0)),
        texel_depth(first - along, 0),
        texel_depth(first + along, 0),
        texel_depth(last - along, 0),
        texel_depth(last + along, 0),
    );
}

// A packed bend of the line along a crease: where its two sides meet. `otherwise` where
// they do not say.
fn crease_bend(g: Grid, crack: vec3<i32>, otherwise: u32) -> u32 {
    let across = select(vec2(1, 0), vec2(0, 1), crack.z == 1);
    let low = crack.xy - 1;
    let high = crack.xy + 1 + across;
    if any(low < vec2(0)) || any(high >= g.rect.zw) || is_fold_crossed(g, crack) {
        return otherwise;
    }
    let s = line_pass.settings;
    let fold = fold_around(crack);
    let near = max(fold.across.y, fold.across.z);
    let jump = s.jump * (s.reference_factor * near + s.reference_constant);
    return pack_bend(fold_bend(fold, jump, unpack_bend(otherwise)));
}
#endif

#ifdef WEIGHT
// Whether the sky or another object lies behind the owner of a crack.
fn is_outer(owner: vec2<i32>, beyond: vec2<i32>) -> bool {
    let sky = is_background(texel_depth(beyond, 0));
#ifdef OBJECT_IDS
    return sky || texel_object(owner, 0).x != texel_object(beyond, 0).x;
#else
    return sky;
#endif
}

#ifdef SURFACE_WEIGHT
// The factor of the light, times that of the width that was drawn beside the object ids. Of a
// silhouette: the mean over the pixels around the crack, three along it and two on both sides,
// so that it changes gradually along the line; what lies behind a jump in depth does not
// count, because the line belongs to the surface in front. Of other lines: the mean over both
// sides. `here` and `there`: the pixels of the crack in the depth texture.
fn surface_weight(here: vec2<i32>, there: vec2<i32>, crack: vec3<i32>, silhouette: bool) -> f32 {
    let s = line_pass.settings;
    let rect = line_pass.grid.rect;
    let along = vec2<i32>(along_crack(crack));
    let near = max(texel_depth(here, 0), texel_depth(there, 0));
    let least = near - s.jump * (s.reference_factor * near + s.reference_constant);
    // Sums of the factors of the light and of the width, and what they are sums of.
    var sums = vec2(0.0);
    var counts = vec2(0.0);
    for (var i = 0; i < 12; i++) {
        let at = here + (i % 3 - 1) * along + (i / 3 - 1) * (there - here);
        let inside = all(at >= rect.xy) && all(at < rect.xy + rect.zw);
        let pixel = clamp(at, rect.xy, rect.xy + rect.zw - 1);
        let beside = all(pixel == here) || all(pixel == there);
        let seen = inside && (silhouette || beside) && texel_depth(pixel, 0) >= least;
#ifdef LIGHT_WEIGHT
        let w = line_pass.weight;
        let n = texel_normal(pixel, 0);
        let lit = seen && n.w > 0.0;
        sums.x += select(0.0, light_weight(w, dot(n.xyz, w.to_light)), lit);
        counts.x += select(0.0, 1.0, lit);
#endif
#ifdef WIDTH_MAP
        sums.y += select(0.0, texel_width(pixel, 0), seen);
        counts.y += select(0.0, 1.0, seen);
#endif
    }
    let factors = select(vec2(1.0), sums / max(counts, vec2(1.0)), counts > vec2(0.0));
    return factors.x * factors.y;
}
#endif

#ifdef BUDGET
// The middle of the cell in pixels of the grid; a radius, and the density of lines within it.
var<private> middle_of_cell: vec2<f32>;
var<private> known_radius: f32;
var<private> known_density: f32;

// The density around the cell, in 1 / pixels of the grid, with a radius of two squares of a
// level. Beyond the grid, lines are as dense as at its border.
fn density_at(g: Grid, level: i32) -> f32 {
    let last = squares(g, level) - 1;
    let place = middle_of_cell / f32(SQUARE << u32(level)) - 0.5;
    let second = floor(place);
    let across = tent(place.x - second.x);
    let down = tent(place.y - second.y);
    var sum = 0.0;
    for (var i = 0; i < 16; i++) {
        let step = vec2(i & 3, i >> 2u);
        let square = clamp(vec2<i32>(second) + step - 1, vec2(0), last);
        sum += across[step.x] * down[step.y] * densities[square_index(g, level, square)];
    }
    return sum;
}

// The factor of a line's width in pixels of the viewport.
fn crowd_weight(g: Grid, width: f32) -> f32 {
    let budget = line_pass.weight.budget;
    let scale = g.from_viewport.x;
    let radius = scale * max(budget_radius(budget, width), line_pass.weight.least_radius);
    // Most lines of a cell have the same width.
    if radius != known_radius {
        let levels = levels_of(radius);
        known_radius = radius;
        known_density = density_at(g, levels.low);
        if levels.part > 0.0 {
            known_density = mix(known_density, density_at(g, levels.low + 1), levels.part);
        }
    }
    return budget_weight(budget, scale * known_density, width);
}
#endif

// A packed crack as wide and as strong as it is to be. `bend`: how its line leaves it.
fn weighed(crack: vec3<i32>, packed: u32, bend: u32) -> u32 {
    if packed == 0u {
        return 0u;
    }
    let g = line_pass.grid;
    let w = line_pass.weight;
    var source = crack;
#ifdef CLOSED_GAPS
    source = source_of(g, crack);
#endif
    let here = g.rect.xy + source.xy;
    let there = here + select(vec2(1, 0), vec2(0, 1), crack.z == 1);
    let owner = select(there, here, (packed & 8u) != 0u);
    var factor = 1.0;
#ifdef KIND_WEIGHT
    factor *= kind_weight(w, packed, is_outer(owner, here + there - owner));
#endif
#ifdef SURFACE_WEIGHT
    factor *= surface_weight(here, there, source, (packed & SILHOUETTE) != 0u);
#endif
#ifdef PERSPECTIVE_WEIGHT
    factor *= perspective_weight(w, depth_frame(), texel_depth(owner, 0));
#endif
#ifdef NIB_WEIGHT
    let along = along_crack(crack);
    factor *= nib_weight(w, normalize(along + unpack_bend(bend).y * along.yx));
#endif
#ifdef TAPER_WEIGHT
    // A line that overshoots tapers to the end of its stroke.
    let most = i32(ceil(max(w.taper, g.overshoot)));
    let back = cracks_to_end(g, crack, first_corner(crack), most);
    let on = cracks_to_end(g, crack, last_corner(crack), most);
    let stroke = min(g.overshoot, f32(back + on + 1));
    factor *= taper_weight(w, f32(min(back, on)) + stroke);
#endif
    var sign = 0u;
    var opacity = 1.0;
#ifdef EDGE_STYLES
    if (packed & (CREASE | OBJECT)) == CREASE {
        var edge = line_pass.settings.concave;
        if is_convex_edge(here, there) {
            edge = line_pass.settings.convex;
            sign = SILHOUETTE;
        }
        factor *= edge.width;
        opacity = edge.opacity * edge_light(edge, here, there);
    }
#endif
#ifdef BUDGET
    let width = 2.0 * unpack_width(packed >> 20u) * factor;
    factor *= crowd_weight(g, width);
#endif
    var fog = 0.0;
#ifdef FOG
    let at = (vec2<f32>(owner - g.rect.xy) + 0.5) / vec2<f32>(g.rect.zw);
    let position = (at * 2.0 - 1.0) * vec2(1.0, -1.0);
    fog = fog_fraction(line_pass.fog, fog_distance(line_pass.fog, position, texel_depth(owner, 0)));
#endif
    var left = vec2(factor, opacity * (1.0 - fog));
#ifdef DISTANCE_FADE
#ifdef MIDDLE_DEPTH
    let middle = middle_depth();
#else
    let middle = texel_depth(g.rect.xy + g.rect.zw / 2, 0);
#endif
    left *= fade_factor(line_pass.fade, texel_depth(owner, 0), middle);
#endif
#ifdef IN_LAYERS
    left *= layer_factors(line_pass.layers, owner_weights(line_pass.layers, owner));
#endif
#ifdef SIMPLIFIED_CREASES
    let fainter = crease_factor(line_pass.simplification, texel_depth(owner, 0), object_at(owner));
    left.y *= select(1.0, fainter, (packed & CREASE) != 0u);
#endif
    let weighted = weighted_crack(packed, left.x, left.y);
    return weighted | select(0u, sign, weighted != 0u);
}
#endif

// Whether a crack is in a piece of line of fewer cracks than Grid::min_length. Pieces that meet
// others, or that go on outside of the grid, are none.
fn is_too_short(g: Grid, crack: vec3<i32>) -> bool {
    let most = g.min_length - 1;
    let back = cracks_to_end(g, crack, first_corner(crack), most);
    return back < most && back + cracks_to_end(g, crack, last_corner(crack), most - back) < most;
}

#ifdef SMOOTH
// How the line along a crack leaves it, packed. `kept`: whether it is one; `packed`: what the crack is.
fn packed_bend(g: Grid, crack: vec3<i32>, run: Run, kept: bool, packed: u32) -> u32 {
    var bend = 0x8080u;
    if kept {
        bend = pack_bend(bend_of(crack, run.seen, run.signs));
    }
#ifdef FOLDS
    if (packed & CREASE) != 0u {
        bend = crease_bend(g, crack, bend);
    }
#endif
    return bend;
}
#endif

// Leaves out a crack that is not part of a line; bends the line of the others, and sets its width.
// `linked`: whether it was linked; `beside`: for a crack to the south, whether that to the east of
// its pixel is settled already.
fn settle_crack(g: Grid, crack: vec3<i32>, linked: bool, beside: bool) {
    var searched = linked && g.min_length > 1;
#ifdef SMOOTH
    let run = run_of(g, crack);
    // A run of as many cracks is no short piece.
    searched = searched && i32(run.seen.x + run.seen.y) <= g.min_length;
#endif
    var kept = linked;
    if searched {
        kept = !is_too_short(g, crack);
    }
    let at = crack.y * g.rect.z + crack.x;
    var bend = 0x8080u;
#ifdef EDITS
    var packed = select(0u, crack_words[at][crack.z], kept);
#ifdef RIMS
    packed = with_rim(crack, packed);
#endif
#endif
#ifdef SMOOTH
#ifdef FOLDS
    bend = packed_bend(g, crack, run, kept, packed);
#else
    bend = packed_bend(g, crack, run, kept, 0u);
#endif
    let other = select(0x80808080u, bend_words[at], beside);
    bend_words[at] = insertBits(other, bend, 16u * u32(crack.z), 16u);
#endif
#ifdef WEIGHT
    packed = weighed(crack, packed, bend);
#endif
#ifdef EDITS
    crack_words[at][crack.z] = packed;
#else
    if !kept {
        crack_words[at][crack.z] = 0u;
    }
#endif
}

// A plane's bits of a cell: eight rows of each of four columns.
fn cell_bits(g: Grid, plane: i32, cell: vec2<i32>) -> u32 {
    var bits = 0u;
    for (var column = 0; column < COLUMNS; column++) {
        let rows = load_column(g, plane, cell.x + column, cell.y >> 5u) >> u32(cell.y & 31);
        bits = insertBits(bits, rows, u32(column * CELL_ROWS), u32(CELL_ROWS));
    }
    return bits;
}

// Settles the cracks of a cell, one after the other. On CPU adapters, several cells are settled at once, until
// that with the most cracks is.
fn settle_cell(g: Grid, cell: vec2<i32>) {
    let linked_east = cell_bits(g, LINKED_EAST, cell);
    let linked_south = cell_bits(g, LINKED_SOUTH, cell);
    var east = cell_bits(g, FOUND_EAST, cell);
    var south = cell_bits(g, FOUND_SOUTH, cell);
#ifdef LEDGES
    east |= cell_bits(g, LEDGE_EAST, cell);
    south |= cell_bits(g, LEDGE_SOUTH, cell);
#endif
#ifdef CLOSED_GAPS
    east |= linked_east;
    south |= linked_south;
#endif
    let all_east = east;
    while (east | south) != 0u {
        let is_east = east != 0u;
        let left = select(south, east, is_east);
        let place = firstTrailingBit(left);
        east = select(east, east & (east - 1u), is_east);
        south = select(south & (south - 1u), south, is_east);
        let pixel = cell + vec2<i32>(vec2(place / u32(CELL_ROWS), place % u32(CELL_ROWS)));
        let linked = (select(linked_south, linked_east, is_east) >> place) & 1u;
        let beside = !is_east && ((all_east >> place) & 1u) != 0u;
        settle_crack(g, vec3(pixel, select(1, 0, is_east)), linked != 0u, beside);
    }
}

@compute @workgroup_size(32)
fn settle(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    if cell.x < 0 {
        return;
    }
#ifdef DEPTH
    set_view(line_pass.seen);
#endif
    let g = line_pass.grid;
#ifdef BUDGET
    middle_of_cell = vec2<f32>(cell) + 0.5 * vec2(f32(COLUMNS), f32(CELL_ROWS));
    known_radius = -1.0;
#endif
    settle_cell(g, cell);
}
