#define_import_path bevy_comics::lines::listed

// The cells that walk.wgsl has listed, one for each invocation.

#import bevy_comics::lines::planes::{CELL_ROWS, COLUMNS, GROUP, GROUPS}

@group(0) @binding(16) var<storage> cell_counts: array<u32, 4>;
@group(0) @binding(17) var<storage> cells: array<u32>;

// The first pixel of the cell of an invocation: its index in a workgroup, and the
// workgroup. Negative if there is none.
fn listed_cell(group: vec3<u32>, place: u32) -> vec2<i32> {
    let index = (group.y * GROUPS + group.x) * GROUP + place;
    if index >= cell_counts[3] {
        return vec2(-1);
    }
    let cell = cells[index];
    return vec2(i32(cell & 0xffffu) * COLUMNS, i32(cell >> 16u) * CELL_ROWS);
}
