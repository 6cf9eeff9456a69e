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
#import bevy_comics::lines::rows::{Above, Borders, four_columns, step_down}
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

@compute @workgroup_size(32)
fn walk(@builtin(global_invocation_id) id: vec3<u32>) {
    set_view(line_pass.seen);
    let s = line_pass.settings;
    let last = line_pass.grid.rect.zw - 1;
    let x = i32(id.x) * COLUMNS;
    let top = i32(id.y) * ROWS;
    if x > last.x {
        return;
    }
    let columns = four_columns(line_pass.grid.rect, x);
    var above: Above;
#ifdef JUMPS
    let least = Jumps(depth_frame(), line_pass.grid.jump_least, line_pass.grid.jump_radius);
    let across = select(vec4(0.0), vec4(1.0), (columns.own > vec4(0)) & (columns.own < last.xxxx));
    var row_1 = Row(vec4(0.0), vec4(0.0), vec4(0.0));
    var row_2 = row_1;
    var jump_rows = 0u;
#endif
    // One bit a row: it leaves the word after 32 more rows.
    var east_rows = 0u;
    var south_rows = 0u;
    for (var i = FIRST_ROW; i <= LAST_ROW; i++) {
        let found = step_down(&above, columns, top + i);
#ifdef JUMPS
        let row_0 = Row(found.before, found.east.here, found.east.there);
        let y_1 = top + i - 1;
        let along = select(0.0, 1.0, y_1 > 0 && y_1 < last.y);
        let jumps = may_jump(least, row_2, row_1, row_0, across, along);
        let is_row = i >= 1 && i <= ROWS;
        jump_rows = select(jump_rows, (jump_rows >> 1u) | select(0u, 0x80000000u, jumps), is_row);
        row_2 = row_1;
        row_1 = row_0;
#endif
#ifdef CRACKS
        let in_block = i >= 0 && i < ROWS;
        let east = select(0u, 0x80000000u, may_be_cracks(s, found.east));
        let south = select(0u, 0x80000000u, may_be_cracks(s, found.south));
        east_rows = select(east_rows, (east_rows >> 1u) | east, in_block);
        south_rows = (south_rows >> 1u) | south;
#endif
    }
    var rows = east_rows | south_rows;
#ifdef CRACKS
    for (var cell = 0; cell < ROWS / CELL_ROWS; cell++) {
        let bits = extractBits(rows, u32(cell * CELL_ROWS), u32(CELL_ROWS));
        if bits != 0u && top + cell * CELL_ROWS <= last.y {
            list_cell(vec2(id.x, u32(top / CELL_ROWS + cell)));
        }
    }
#endif
#ifdef CLOSED_GAPS
    rows = with_gaps(rows);
#endif
#ifdef JUMPS
    rows |= jump_rows;
#endif
    textureStore(block_texture, vec2(x / COLUMNS, i32(id.y)), vec4(rows));
}
