// Finds the loose ends of lines, in the cells that walk.wgsl has listed, and lists the strokes
// that extend them. Closed lines have no end, nor have lines that meet others or leave the grid.

#ifdef CLOSED_GAPS
#import bevy_comics::lines::gaps::source_of
#endif
#import bevy_comics::lines::chain::{first_corner, last_corner, next_crack, other_corner}
#import bevy_comics::lines::edge::{Grid, inward_step, owner_step}
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::overshoot::{DIRECTING, end_direction, is_straight}
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{COLUMNS, LINKED_EAST, LINKED_SOUTH}
#import bevy_comics::lines::read_planes::column_window
#import bevy_comics::lines::stored::{load_bends, load_cracks, stored_middle}

struct Stroke {
    // From the end of the line to that of the stroke, in pixels of the grid.
    segment: vec4<f32>,
    // The packed crack at the end of the line; the pixel that owns it, and the next one inside,
    // 16 bits for x and y each; 0.
    line: vec4<u32>,
}

struct Strokes {
    // The arguments of an indirect draw: vertices, instances, two zeros; then the number of
    // loose ends, and three zeros.
    arguments: array<atomic<u32>, 8>,
    list: array<Stroke>,
}

@group(0) @binding(30) var<storage, read_write> strokes: Strokes;

const ROWS_ABOVE: i32 = 12;

fn packed_at(g: Grid, crack: vec3<i32>) -> u32 {
    let cracks = load_cracks(g, crack.xy);
    return select(cracks.x, cracks.y, crack.z == 1);
}

// The middle of the line near a crack, in pixels of the grid.
fn middle_at(g: Grid, crack: vec3<i32>, packed: u32) -> vec2<f32> {
    let bends = load_bends(g, crack.xy);
    let across = select(vec2(1.0, 0.0), vec2(0.0, 1.0), crack.z == 1);
    return vec2<f32>(crack.xy) + 0.5 + stored_middle(packed, across, bends >> u32(16 * crack.z));
}

fn two_shorts(p: vec2<i32>) -> u32 {
    return u32(p.x & 0xffff) | (u32(p.y & 0xffff) << 16u);
}

// Lists the stroke beyond a loose end. It is at most as long as the line.
fn extend(g: Grid, crack: vec3<i32>, corner: vec2<i32>) {
    let packed = packed_at(g, crack);
    let at_border = any(corner <= vec2(0)) || any(corner >= g.rect.zw);
    if packed == 0u || at_border {
        return;
    }
    var middles: array<vec2<f32>, DIRECTING>;
    middles[0] = middle_at(g, crack, packed);
    var directing = 1;
    var length = 1;
    var behind = other_corner(crack, corner);
    var next = crack;
    let most = max(DIRECTING, i32(ceil(g.overshoot)));
    for (var i = 1; i < most; i++) {
        next = next_crack(g, next, behind);
        if next.z < 0 {
            break;
        }
        let here = packed_at(g, next);
        if here == 0u {
            break;
        }
        length = i + 1;
        behind = other_corner(next, behind);
        if directing == i && i < DIRECTING {
            middles[i] = middle_at(g, next, here);
            directing += select(0, 1, i < 3 || is_straight(&middles, i));
        }
    }
    var direction = end_direction(&middles, directing);
    if dot(direction, direction) < 1e-6 {
        direction = vec2<f32>(corner - other_corner(crack, corner));
    }
    let tip = middles[0] + min(g.overshoot, f32(length)) * normalize(direction);
    list_stroke(g, crack, packed, vec4(middles[0], tip));
}

fn list_stroke(g: Grid, crack: vec3<i32>, packed: u32, segment: vec4<f32>) {
    var source = crack;
#ifdef CLOSED_GAPS
    source = source_of(g, crack);
#endif
    let south = crack.z == 1;
    let owner = source.xy + owner_step(packed, south);
    let index = atomicAdd(&strokes.arguments[4], 1u);
    let room = arrayLength(&strokes.list);
    atomicMax(&strokes.arguments[1], min(index + 1u, room));
    if index < room {
        let inside = owner + inward_step(packed, south);
        strokes.list[index] = Stroke(segment, vec4(packed, two_shorts(owner), two_shorts(inside), 0u));
    }
}

// Extends the cracks of a column of a cell that are marked: `back`: at their first corner, `on`:
// at their last.
fn extend_rows(g: Grid, first: vec2<i32>, side: i32, back: u32, on: u32) {
    var rows = back | on;
    while rows != 0u {
        let row = firstTrailingBit(rows);
        rows &= rows - 1u;
        let crack = vec3(first.x, first.y + i32(row), side);
        if ((back >> row) & 1u) != 0u {
            extend(g, crack, first_corner(crack));
        }
        if ((on >> row) & 1u) != 0u {
            extend(g, crack, last_corner(crack));
        }
    }
}

// The rows of a cell in a window.
fn own_rows(window: u32) -> u32 {
    return (window >> u32(ROWS_ABOVE)) & 0xffu;
}

@compute @workgroup_size(32)
fn ends(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    if cell.x < 0 {
        return;
    }
    let g = line_pass.grid;
    let top = cell.y - ROWS_ABOVE;
    for (var column = 0; column < COLUMNS; column++) {
        let first = cell + vec2(column, 0);
        let e = column_window(g, LINKED_EAST, first.x, top);
        let s = column_window(g, LINKED_SOUTH, first.x, top);
        if own_rows(e | s) == 0u {
            continue;
        }
        let beside = column_window(g, LINKED_SOUTH, first.x + 1, top);
        let before = column_window(g, LINKED_EAST, first.x - 1, top);
        let behind = column_window(g, LINKED_SOUTH, first.x - 1, top);
        // A crack to the east ends above and below, one to the south to the left and right.
        let above = e & ~((e << 1u) | (s << 1u) | (beside << 1u));
        let below = e & ~((e >> 1u) | s | beside);
        let left = s & ~(behind | before | (before >> 1u));
        let right = s & ~(beside | e | (e >> 1u));
        extend_rows(g, first, 0, own_rows(above), own_rows(below));
        extend_rows(g, first, 1, own_rows(left), own_rows(right));
    }
}
