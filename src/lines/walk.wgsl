// Looks for cracks, see find.wgsl, and notes where they are: one bit for each row of a
// block of 4 x 32 pixels. JUMPS: also notes where the depth map departs from planes, see
// MapJumps.
//
// On CPU adapters a texel costs far more to load than to compare, so an invocation walks
// down four columns of 32 rows and keeps the last rows in registers: every texel is
// loaded about 1.5 times, not 20 times. The rules are those of find.wgsl, without what
// only excludes cracks or sets their ink. A few blocks without cracks are noted too.

#import bevy_comics::depth::view::{View, set_view, texel_depth}
#import bevy_comics::lines::edge::{Grid, Lines, fold, is_ridge, may_be_crease, may_be_silhouette, step_excess}
#ifdef JUMPS
#import bevy_comics::depth::view::depth_frame
#import bevy_comics::lines::jumps::{Jumps, Row, may_jump}
#endif
#ifdef NORMALS
#import bevy_comics::depth::normal::texel_normal
#endif
#ifdef OBJECT_IDS
#import bevy_comics::objects::texel_object
#endif

struct WalkUniform {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> walk_uniform: WalkUniform;
@group(0) @binding(10) var block_texture: texture_storage_2d<r32uint, write>;

const COLUMNS: i32 = 4;
const ROWS: i32 = 32;

// Rows above and below a block that are read.
#ifdef CRACKS
const FIRST_ROW: i32 = -2;
const LAST_ROW: i32 = ROWS + 2;
#else
const FIRST_ROW: i32 = -1;
const LAST_ROW: i32 = ROWS;
#endif

// Whether there may be a silhouette or a crease between `here` and `there`: `excess` is
// that of step_excess, `folds` and `ridge` those of fold and is_ridge.
fn may_be_crack(s: Lines, here: vec4<f32>, there: vec4<f32>, excess: vec4<f32>, folds: vec4<f32>, ridge: vec4<bool>) -> vec4<bool> {
    var found = vec4(false);
#ifdef SILHOUETTES
    found = may_be_silhouette(s, excess, max(here, there));
#endif
#ifdef CREASES
    found |= ridge & may_be_crease(s, folds);
#endif
    return found;
}

fn depth_at(origin: vec2<i32>, x: i32, y: i32) -> f32 {
    return texel_depth(origin + vec2(x, y), 0);
}

@compute @workgroup_size(32)
fn walk(@builtin(global_invocation_id) id: vec3<u32>) {
    set_view(walk_uniform.seen);
    let s = walk_uniform.settings;
    let origin = walk_uniform.grid.rect.xy;
    let last = walk_uniform.grid.rect.zw - 1;
    let x = i32(id.x) * COLUMNS;
    let top = i32(id.y) * ROWS;
    if x > last.x {
        return;
    }
    // Columns x - 2 to x + 6, clamped.
    let w2 = max(x - 2, 0);
    let w1 = max(x - 1, 0);
    let e1 = min(x + 1, last.x);
    let e2 = min(x + 2, last.x);
    let e3 = min(x + 3, last.x);
    let e4 = min(x + 4, last.x);
    let e5 = min(x + 5, last.x);
    let e6 = min(x + 6, last.x);

    // What the four columns had in the rows above: 1 is the row above the newest one.
    var depth_1 = vec4(0.0);
    var depth_2 = vec4(0.0);
    var depth_3 = vec4(0.0);
    var depth_4 = vec4(0.0);
    var depth_5 = vec4(0.0);
#ifdef NORMALS
    var normal_a = vec4(0.0);
    var normal_b = vec4(0.0);
    var normal_c = vec4(0.0);
    var normal_d = vec4(0.0);
    // Folds between a row and the one below it.
    var folds_2 = vec4(0.0);
    var folds_3 = vec4(0.0);
    var folds_4 = vec4(0.0);
#endif
#ifdef OBJECT_EDGES
    var object_1 = vec4(0u);
    var object_2 = vec4(0u);
    var object_3 = vec4(0u);
#endif
#ifdef JUMPS
    let least = Jumps(depth_frame(), walk_uniform.grid.jump_least, walk_uniform.grid.jump_radius);
    let columns = vec4(x, e1, e2, e3);
    let across = select(vec4(0.0), vec4(1.0), (columns > vec4(0)) & (columns < vec4(last.x)));
    var row_1 = Row(vec4(0.0), vec4(0.0), vec4(0.0));
    var row_2 = row_1;
    var jump_rows = 0u;
#endif
    // One bit a row: it leaves the word after 32 more rows.
    var east_rows = 0u;
    var south_rows = 0u;
    for (var i = FIRST_ROW; i <= LAST_ROW; i++) {
        let y = clamp(top + i, 0, last.y);
        let a = depth_at(origin, x, y);
        let b = depth_at(origin, e1, y);
        let c = depth_at(origin, e2, y);
        let d = depth_at(origin, e3, y);
        let e = depth_at(origin, e4, y);
        let before = depth_at(origin, w1, y);
        let depth_0 = vec4(a, b, c, d);
        let there = vec4(b, c, d, e);
#ifdef JUMPS
        let row_0 = Row(vec4(before, a, b, c), depth_0, there);
        let y_1 = top + i - 1;
        let along = select(0.0, 1.0, y_1 > 0 && y_1 < last.y);
        let jumps = may_jump(least, row_2, row_1, row_0, across, along);
        let is_row = i >= 1 && i <= ROWS;
        jump_rows = select(jump_rows, (jump_rows >> 1u) | select(0u, 0x80000000u, jumps), is_row);
        row_2 = row_1;
        row_1 = row_0;
#endif
#ifdef CRACKS
        // Between the third and the second row above the newest one.
        var east = vec4(false);
        var south = vec4(false);
        var folds = vec4(0.0);
        var ridge = vec4(false);
        var folds_below = vec4(0.0);
        var ridge_below = vec4(false);
#ifdef NORMALS
        let n_w = texel_normal(origin + vec2(w1, y), 0);
        let n_a = texel_normal(origin + vec2(x, y), 0);
        let n_b = texel_normal(origin + vec2(e1, y), 0);
        let n_c = texel_normal(origin + vec2(e2, y), 0);
        let n_d = texel_normal(origin + vec2(e3, y), 0);
        let n_e = texel_normal(origin + vec2(e4, y), 0);
        let n_f = texel_normal(origin + vec2(e5, y), 0);
        let folds_w = vec4(fold(n_w, n_a), fold(n_a, n_b), fold(n_b, n_c), fold(n_c, n_d));
        folds = vec4(folds_w.yzw, fold(n_d, n_e));
        ridge = is_ridge(folds_w, folds, vec4(folds.yzw, fold(n_e, n_f)));
        folds_below = folds_3;
        ridge_below = is_ridge(folds_4, folds_3, folds_2);
#endif
#ifdef SILHOUETTES
        let f = depth_at(origin, e5, y);
        let excess = step_excess(
            vec4(depth_at(origin, w2, y), before, a, b), vec4(before, a, b, c), depth_0,
            there, vec4(c, d, e, f), vec4(d, e, f, depth_at(origin, e6, y)),
        );
        let excess_below = step_excess(depth_5, depth_4, depth_3, depth_2, depth_1, depth_0);
#else
        let excess = vec4(0.0);
        let excess_below = vec4(0.0);
#endif
        east = may_be_crack(s, depth_0, there, excess, folds, ridge);
        south = may_be_crack(s, depth_3, depth_2, excess_below, folds_below, ridge_below);
#ifdef OBJECT_EDGES
        let o_a = texel_object(origin + vec2(x, y), 0).x;
        let o_b = texel_object(origin + vec2(e1, y), 0).x;
        let o_c = texel_object(origin + vec2(e2, y), 0).x;
        let o_d = texel_object(origin + vec2(e3, y), 0).x;
        let o_e = texel_object(origin + vec2(e4, y), 0).x;
        let object_0 = vec4(o_a, o_b, o_c, o_d);
        east |= object_0 != vec4(o_b, o_c, o_d, o_e);
        south |= object_3 != object_2;
#endif
        let in_block = i >= 0 && i < ROWS;
        east_rows = select(east_rows, (east_rows >> 1u) | select(0u, 0x80000000u, any(east)), in_block);
        south_rows = (south_rows >> 1u) | select(0u, 0x80000000u, any(south));

        depth_5 = depth_4;
        depth_4 = depth_3;
        depth_3 = depth_2;
        depth_2 = depth_1;
        depth_1 = depth_0;
#ifdef NORMALS
        folds_4 = folds_3;
        folds_3 = folds_2;
        folds_2 = vec4(fold(normal_a, n_a), fold(normal_b, n_b), fold(normal_c, n_c), fold(normal_d, n_d));
        normal_a = n_a;
        normal_b = n_b;
        normal_c = n_c;
        normal_d = n_d;
#endif
#ifdef OBJECT_EDGES
        object_3 = object_2;
        object_2 = object_1;
        object_1 = object_0;
#endif
#endif
    }
    var rows = east_rows | south_rows;
#ifdef JUMPS
    rows |= jump_rows;
#endif
    textureStore(block_texture, vec2(x / COLUMNS, i32(id.y)), vec4(rows));
}
