// Looks for cracks, see crack.wgsl, and notes where they are: one bit for each row of a
// block of 4 x 32 pixels. CRACKS: lists the cells of 4 x 8 pixels that have them, in which
// cells.wgsl finds them. JUMPS: also notes where the depth map departs from planes, see
// MapJumps.
//
// The rules are those of crack.wgsl, without what only excludes cracks or sets their ink.
// A few blocks without cracks are noted too.

#import bevy_comics::depth::view::set_view
#import bevy_comics::lines::edge::{Lines, ends_at_sky, may_be_crease, may_be_silhouette}
#ifdef LEDGES
#import bevy_comics::lines::ledge::may_be_ledge
#endif
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{CELL_ROWS, COLUMNS, GROUP, GROUPS, ROWS}
#import bevy_comics::lines::rows::{
    Above, Borders, Columns, Found, four_columns, load_beside, load_texels, next_columns, step_row,
}
#ifdef JUMPS
#import bevy_comics::depth::view::depth_frame
#import bevy_comics::lines::jumps::{Jumps, Row, may_jump}
#endif

@group(0) @binding(10) var block_texture: texture_storage_2d<r32uint, write>;
#ifdef CRACKS
// Workgroups of cells.wgsl across and down, 1, and the number of cells.
@group(0) @binding(16) var<storage, read_write> cell_counts: array<atomic<u32>, 4>;
// Bits 0 to 15: column of blocks; bits 16 to 31: row of cells.
@group(0) @binding(17) var<storage, read_write> cells: array<u32>;
#endif

// Rows above and below a block that are read.
#ifdef CRACKS
const FIRST_ROW: i32 = -2;
const LAST_ROW: i32 = ROWS + 2;
#else
const FIRST_ROW: i32 = -1;
const LAST_ROW: i32 = ROWS;
#endif

// Whether there may be a crack at any of four borders.
fn may_be_cracks(s: Lines, at: Borders) -> bool {
    var found = vec4(false);
#ifdef SILHOUETTES
    found = may_be_silhouette(s, at.excess, max(at.here, at.there)) | ends_at_sky(at.here, at.there);
#endif
#ifdef CREASES
    found |= may_be_crease(s, at.folds);
#endif
#ifdef LEDGES
    found |= may_be_ledge(s, at.excess, max(at.here, at.there));
#endif
#ifdef OBJECT_EDGES
    found |= at.object_here != at.object_there;
#endif
#ifdef SECTIONS
    found |= at.slot_section_here != at.slot_section_there;
#endif
    return any(found);
}

#ifdef CRACKS
// Adds a cell to the list.
fn list_cell(cell: vec2<u32>) {
    let index = atomicAdd(&cell_counts[3], 1u);
    let group = index / GROUP;
    if index % GROUP == 0u {
        atomicMax(&cell_counts[0], min(group + 1u, GROUPS));
        atomicMax(&cell_counts[1], group / GROUPS + 1u);
    }
    cells[index] = cell.x | (cell.y << 16u);
}
#endif

#ifdef CLOSED_GAPS
// These rows of a block, and those in which close_gaps.wgsl may add cracks.
fn with_gaps(rows: u32) -> u32 {
    var all = rows;
    for (var i = 1; i <= line_pass.grid.gap_closing; i++) {
        all |= (all << 1u) | (all >> 1u);
    }
    return all;
}
#endif

#ifdef JUMPS
// The last two rows of a block.
struct Last {
    one: Row,
    two: Row,
    // Which of its pixels have neighbors to the west and east.
    across: vec4<f32>,
}

fn last_rows(c: Columns) -> Last {
    let none = Row(vec4(0.0), vec4(0.0), vec4(0.0));
    let last = vec4(c.last.x);
    return Last(none, none, select(vec4(0.0), vec4(1.0), (c.own > vec4(0)) & (c.own < last)));
}

// Whether the map may jump in the row above the one that was found, between rows with neighbors above and
// below (1) or not (0). Moves on to that one.
fn jumps_in(least: Jumps, last: ptr<function, Last>, found: Found, along: f32) -> bool {
    let row = Row(found.before, found.east.here, found.east.there);
    let jumps = may_jump(least, (*last).two, (*last).one, row, (*last).across, along);
    (*last).two = (*last).one;
    (*last).one = row;
    return jumps;
}
#endif

// Rows of a block: one bit a row, which leaves the word after 32 more rows.
fn with_row(rows: u32, found: bool) -> u32 {
    return (rows >> 1u) | select(0u, 0x80000000u, found);
}

// The rows with cracks to the east (x) and to the south (y), after the row `i` of a block.
fn with_cracks(rows: vec2<u32>, s: Lines, found: Found, i: i32) -> vec2<u32> {
    let east = with_row(rows.x, may_be_cracks(s, found.east));
    let south = with_row(rows.y, may_be_cracks(s, found.south));
    return vec2(select(rows.x, east, i >= 0 && i < ROWS), south);
}

// Notes the rows of the block that begins at a pixel, and lists their cells.
fn store_block(first: vec2<i32>, cracks: u32, jumps: u32) {
    var rows = cracks;
#ifdef CRACKS
    for (var cell = 0; cell < ROWS / CELL_ROWS; cell++) {
        let bits = extractBits(rows, u32(cell * CELL_ROWS), u32(CELL_ROWS));
        if bits != 0u && first.y + cell * CELL_ROWS < line_pass.grid.rect.w {
            list_cell(vec2<u32>(vec2(first.x / COLUMNS, first.y / CELL_ROWS + cell)));
        }
    }
#endif
#ifdef CLOSED_GAPS
    rows = with_gaps(rows);
#endif
    textureStore(block_texture, first / vec2(COLUMNS, ROWS), vec4(rows | jumps));
}

// Walks down two blocks side by side, which have texels in common.
@compute @workgroup_size(32)
fn walk(@builtin(global_invocation_id) id: vec3<u32>) {
    set_view(line_pass.seen);
    let s = line_pass.settings;
    let last = line_pass.grid.rect.zw - 1;
    let first = vec2<i32>(id.xy) * vec2(2 * COLUMNS, ROWS);
    if first.x > last.x {
        return;
    }
    let columns = four_columns(line_pass.grid.rect, first.x);
    let beside = next_columns(columns, first.x);
    var above: Above;
    var above_beside: Above;
    // Rows with cracks and with jumps.
    var cracks = vec2(0u);
    var cracks_beside = vec2(0u);
    var jumps = vec2(0u);
#ifdef JUMPS
    let least = Jumps(depth_frame(), line_pass.grid.jump_least, line_pass.grid.jump_radius);
    var rows = last_rows(columns);
    var rows_beside = last_rows(beside);
#endif
    for (var i = FIRST_ROW; i <= LAST_ROW; i++) {
        let y = first.y + i;
        let texels = load_texels(columns, clamp(y, 0, last.y));
        let found = step_row(&above, columns, y, texels);
        let found_beside = step_row(&above_beside, beside, y, load_beside(beside, clamp(y, 0, last.y), texels));
#ifdef JUMPS
        let along = select(0.0, 1.0, y > 1 && y <= last.y);
        let jump = jumps_in(least, &rows, found, along);
        let jump_beside = jumps_in(least, &rows_beside, found_beside, along);
        let both = vec2(with_row(jumps.x, jump), with_row(jumps.y, jump_beside));
        jumps = select(jumps, both, i >= 1 && i <= ROWS);
#endif
#ifdef CRACKS
        cracks = with_cracks(cracks, s, found, i);
        cracks_beside = with_cracks(cracks_beside, s, found_beside, i);
#endif
    }
    store_block(first, cracks.x | cracks.y, jumps.x);
    if first.x + COLUMNS <= last.x {
        store_block(first + vec2(COLUMNS, 0), cracks_beside.x | cracks_beside.y, jumps.y);
    }
}
