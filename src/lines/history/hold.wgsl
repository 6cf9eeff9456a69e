// Keeps lines where the last frames had them: a found crack that no line has reached becomes a
// part of one if it was one at most Grid::hold_frames frames ago (hysteresis in time), or if one a
// pixel further across was, which has gone. Cracks that are kept do not continue lines, so that
// lines do not creep along weak edges. In a still view there is nothing to keep. The grid of the last
// frame may have another size.
//
// MOTION: the place in the last frame is that of the nearer surface, to whole pixels.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::holds::{hold_shift, hold_word, next_hold, past_pixel}
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{
    CELL_ROWS, COLUMNS, FOUND_EAST, FOUND_SOUTH, LINKED_EAST, LINKED_SOUTH, column_word, row_word,
}
#ifdef MOTION
#import bevy_comics::depth::view::{set_view, texel_depth}

// The engine's motion vectors: by how much each pixel of the grid has moved, in parts of the
// viewport.
@group(0) @binding(24) var motion_texture: texture_2d<f32>;
#endif

@group(0) @binding(21) var<storage, read_write> linked: array<atomic<u32>>;
// Frames for which cracks are held: in the last frame, and in this one.
@group(0) @binding(28) var<storage> past_holds: array<u32>;
@group(0) @binding(29) var<storage, read_write> holds: array<u32>;

// The hold of a crack of the last frame's grid; 0 outside of it.
fn past_hold(g: Grid, crack: vec3<i32>) -> u32 {
    let size = g.past_size;
    let inside = all(crack.xy >= vec2(0)) && all(crack.xy < size);
    let p = clamp(crack, vec3(0), vec3(size - 1, 1));
    let hold = (past_holds[hold_word(size.x, p.xy)] >> hold_shift(p)) & 15u;
    return select(0u, hold, inside);
}

// Whether a crack is found in this frame.
fn is_found(g: Grid, crack: vec3<i32>) -> bool {
    let inside = all(crack.xy >= vec2(0)) && all(crack.xy < g.rect.zw);
    let p = clamp(crack.xy, vec2(0), g.rect.zw - 1);
    let plane = select(FOUND_EAST, FOUND_SOUTH, crack.z == 1);
    let word = atomicLoad(&linked[column_word(g, plane, p.x, p.y >> 5u)]);
    return inside && ((word >> u32(p.y & 31)) & 1u) != 0u;
}

// The longest hold in the last frame of a crack, and of those beside it that have gone.
fn hold_around(g: Grid, crack: vec3<i32>) -> u32 {
    let across = select(vec2(1, 0), vec2(0, 1), crack.z == 1);
    let past_size = vec2<f32>(g.past_size);
    var moved = vec2(0.0);
#ifdef MOTION
    let here = g.rect.xy + crack.xy;
    let there = here + across;
    let owner = select(there, here, texel_depth(here, 0) >= texel_depth(there, 0));
    moved = textureLoad(motion_texture, owner, 0).xy * past_size;
#endif
    let from_pixel = past_pixel(crack, past_size / vec2<f32>(g.rect.zw), moved);
    var hold = past_hold(g, vec3(from_pixel, crack.z));
    if !is_found(g, vec3(crack.xy - across, crack.z)) {
        hold = max(hold, past_hold(g, vec3(from_pixel - across, crack.z)));
    }
    if !is_found(g, vec3(crack.xy + across, crack.z)) {
        hold = max(hold, past_hold(g, vec3(from_pixel + across, crack.z)));
    }
    return hold;
}

// Adds the cracks of a cell's column that are kept to the lines. `rows`: the holds of each row.
fn hold_column(g: Grid, first: vec2<i32>, side: i32, rows: ptr<function, array<u32, CELL_ROWS>>) {
    let band = first.y >> 5u;
    let from_top = u32(first.y & 31);
    let plane = column_word(g, select(LINKED_EAST, LINKED_SOUTH, side == 1), first.x, band);
    let all_found = column_word(g, select(FOUND_EAST, FOUND_SOUTH, side == 1), first.x, band);
    let lines = atomicLoad(&linked[plane]) >> from_top;
    var found = (atomicLoad(&linked[all_found]) >> from_top) & 0xffu;
    var kept = 0u;
    while found != 0u {
        let row = firstTrailingBit(found);
        found &= found - 1u;
        let crack = vec3(first.x, first.y + i32(row), side);
        let is_line = ((lines >> row) & 1u) != 0u;
        var past = 0u;
        if !is_line {
            past = hold_around(g, crack);
        }
        let hold = next_hold(is_line, past, u32(g.hold_frames));
        (*rows)[row] |= hold << hold_shift(crack);
        if past > 0u {
            kept |= 1u << row;
            if side == 1 {
                atomicOr(&linked[row_word(g, crack.x >> 5u, crack.y)], 1u << u32(crack.x & 31));
            }
        }
    }
    if kept != 0u {
        atomicOr(&linked[plane], kept << from_top);
    }
}

@compute @workgroup_size(32)
fn hold_lines(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    if cell.x < 0 {
        return;
    }
#ifdef MOTION
    set_view(line_pass.seen);
#endif
    let g = line_pass.grid;
    var rows: array<u32, CELL_ROWS>;
    for (var i = 0; i < COLUMNS; i++) {
        let first = cell + vec2(i, 0);
        if first.x < g.rect.z {
            hold_column(g, first, 0, &rows);
            hold_column(g, first, 1, &rows);
        }
    }
    for (var row = 0; row < CELL_ROWS; row++) {
        if cell.y + row < g.rect.w {
            holds[hold_word(g.rect.z, cell + vec2(0, row))] = rows[row];
        }
    }
}
