// Finds the cracks that lines run along, in the cells that walk.wgsl has listed; the rest
// of the texture is cleared. A texel has the cracks to the east (x) and south (y) of its
// pixel.

#import bevy_comics::depth::view::{View, set_view}
#import bevy_comics::lines::crack::cracks
#import bevy_comics::lines::edge::{Grid, Lines}
#import bevy_comics::lines::rows::{
    Above, CELL_ROWS, COLUMNS, GROUP, GROUPS, four_columns, step_down,
}

struct CellUniform {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> cell_uniform: CellUniform;
// See walk.wgsl.
@group(0) @binding(16) var<storage> cell_counts: array<u32, 4>;
@group(0) @binding(17) var<storage> cells: array<u32>;
@group(0) @binding(18) var crack_texture: texture_storage_2d<rg32uint, write>;

@compute @workgroup_size(32)
fn find_in_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let index = (group.y * GROUPS + group.x) * GROUP + place;
    if index >= cell_counts[3] {
        return;
    }
    set_view(cell_uniform.seen);
    let s = cell_uniform.settings;
    let last = cell_uniform.grid.rect.zw - 1;
    let x = i32(cells[index] & 0xffffu) * COLUMNS;
    let top = i32(cells[index] >> 16u) * CELL_ROWS;
    let columns = four_columns(cell_uniform.grid.rect, x);
    var above: Above;
    // Cracks to the east in the rows above: 1 is the row above the newest one.
    var east_1 = vec4(0u);
    var east_2 = vec4(0u);
    var east_3 = vec4(0u);
    for (var i = -2; i <= CELL_ROWS + 2; i++) {
        let found = step_down(&above, columns, top + i);
        let east = cracks(s, found.east);
        let south = cracks(s, found.south);
        let y = top + i - 3;
        if i >= 3 && y <= last.y {
            textureStore(crack_texture, vec2(x, y), vec4(east_3.x, south.x, 0u, 0u));
            if x < last.x {
                textureStore(crack_texture, vec2(x + 1, y), vec4(east_3.y, south.y, 0u, 0u));
            }
            if x + 1 < last.x {
                textureStore(crack_texture, vec2(x + 2, y), vec4(east_3.z, south.z, 0u, 0u));
            }
            if x + 2 < last.x {
                textureStore(crack_texture, vec2(x + 3, y), vec4(east_3.w, south.w, 0u, 0u));
            }
        }
        east_3 = east_2;
        east_2 = east_1;
        east_1 = east;
    }
}
