#define_import_path bevy_comics::lines::rows

// Walks down four neighbouring columns of the grid and keeps the last rows in registers.
// On CPU adapters a texel costs far more to load than to compare. With depth, normals and
// ids, a walk down 32 rows loads 6 texels a pixel, and one down 8 rows 8.5, instead of 21.

#import bevy_comics::depth::view::{is_drawn_sky, texel_depth}
#import bevy_comics::lines::edge::{
    Departures, departures, facing, fold, is_outdone, is_ridge, is_rim_ridge, step_excess,
}
#ifdef NORMALS
#import bevy_comics::depth::normal::texel_normal
#endif
#ifdef MARKS
#import bevy_comics::lines::hidden::marked_object
#else ifdef OBJECT_IDS
#import bevy_comics::objects::texel_object
#endif

// Four columns and their neighbours, clamped to the grid.
struct Columns {
    // Of the grid in the depth texture.
    origin: vec2<i32>,
    last: vec2<i32>,
    west: vec2<i32>,
    own: vec4<i32>,
    east: vec3<i32>,
}

// The columns x to x + 3 of a grid: `rect` is its origin and size.
fn four_columns(rect: vec4<i32>, x: i32) -> Columns {
    let last = rect.zw - 1;
    return Columns(
        rect.xy,
        last,
        clamp(vec2(x - 2, x - 1), vec2(0), last.xx),
        min(vec4(x, x + 1, x + 2, x + 3), last.xxxx),
        min(vec3(x + 4, x + 5, x + 6), last.xxx),
    );
}

// What the columns had in the rows above: depths[0] in the row above the new one,
// depths[1] in the row above that. folds[0] are between these two rows.
struct Above {
    depths: array<vec4<f32>, 5>,
    // Normals of the row above, by column.
    normals: array<vec4<f32>, 4>,
    folds: array<vec4<f32>, 3>,
    // HARD: see facing.
    facings: array<vec4<f32>, 3>,
    objects: array<vec4<u32>, 3>,
    marks: array<vec4<u32>, 3>,
}

// The borders between four pixels (here) and their neighbours (there). Without EXCESS
// excesses are 0, without NORMALS folds are, without OBJECT_IDS objects and
// marks are (see texel_object). BOUNDS: for walk.wgsl, which does not ask what only excludes
// cracks; `outdone`, `departs`, `ridge` and `rim` are
// not set.
struct Borders {
    here: vec4<f32>,
    there: vec4<f32>,
    excess: vec4<f32>,
    outdone: vec4<bool>,
    // SECTIONS.
    departs: Departures,
    folds: vec4<f32>,
    ridge: vec4<bool>,
    rim: vec4<bool>,
    // HARD: by how much more `here` faces the direction of lines that hide nothing.
    faces_more: vec4<f32>,
    object_here: vec4<u32>,
    object_there: vec4<u32>,
    marks_here: vec4<u32>,
    marks_there: vec4<u32>,
}

// What a new row shows.
struct Found {
    // Raw depths to the west of the pixels.
    before: vec4<f32>,
    // Borders to the east in the new row.
    east: Borders,
    // Borders between the third and the second row above it.
    south: Borders,
}

fn depth_at(c: Columns, x: i32, y: i32) -> f32 {
    return texel_depth(c.origin + vec2(x, y), 0);
}

// Reads the depths of a row.
fn step_depths(above: ptr<function, Above>, c: Columns, y: i32, found: ptr<function, Found>) {
    let e = depth_at(c, c.east.x, y);
    let depth = vec4(depth_at(c, c.own.x, y), depth_at(c, c.own.y, y), depth_at(c, c.own.z, y), depth_at(c, c.own.w, y));
    let west = depth_at(c, c.west.y, y);
    (*found).before = vec4(west, depth.xyz);
    (*found).east.here = depth;
    (*found).east.there = vec4(depth.yzw, e);
    (*found).south.here = (*above).depths[2];
    (*found).south.there = (*above).depths[1];
#ifdef EXCESS
    let f = depth_at(c, c.east.y, y);
    (*found).east.excess = step_excess(
        vec4(depth_at(c, c.west.x, y), west, depth.xy), (*found).before, depth,
        (*found).east.there, vec4(depth.zw, e, f), vec4(depth.w, e, f, depth_at(c, c.east.z, y)),
    );
    (*found).south.excess = step_excess(
        (*above).depths[4], (*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0], depth,
    );
#ifndef BOUNDS
#ifdef SECTIONS
    (*found).east.departs = departures(
        vec4(depth_at(c, c.west.x, y), west, depth.xy), (*found).before, depth,
        (*found).east.there, vec4(depth.zw, e, f), vec4(depth.w, e, f, depth_at(c, c.east.z, y)),
    );
    (*found).south.departs = departures(
        (*above).depths[4], (*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0], depth,
    );
#endif
    (*found).east.outdone = is_outdone((*found).before, depth, (*found).east.there, vec4(depth.zw, e, f));
    (*found).south.outdone = is_outdone((*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0]);
#endif
#endif
    (*above).depths[4] = (*above).depths[3];
    (*above).depths[3] = (*above).depths[2];
    (*above).depths[2] = (*above).depths[1];
    (*above).depths[1] = (*above).depths[0];
    (*above).depths[0] = depth;
}

#ifdef NORMALS
fn normal_at(c: Columns, x: i32, y: i32) -> vec4<f32> {
    let at = c.origin + vec2(x, y);
#ifdef SKY_BEYOND
    if is_drawn_sky(at) {
        return vec4(0.0);
    }
#endif
    return texel_normal(at, 0);
}

// Reads the normals of a row.
fn step_normals(above: ptr<function, Above>, c: Columns, y: i32, found: ptr<function, Found>) {
    let n_a = normal_at(c, c.own.x, y);
    let n_b = normal_at(c, c.own.y, y);
    let n_c = normal_at(c, c.own.z, y);
    let n_d = normal_at(c, c.own.w, y);
    let n_e = normal_at(c, c.east.x, y);
    let folds = vec4(fold(n_a, n_b), fold(n_b, n_c), fold(n_c, n_d), fold(n_d, n_e));
    (*found).east.folds = folds;
    (*found).south.folds = (*above).folds[1];
#ifdef HARD
    let facings = vec4(facing(n_a), facing(n_b), facing(n_c), facing(n_d));
    (*found).east.faces_more = facings - vec4(facings.yzw, facing(n_e));
    (*found).south.faces_more = (*above).facings[2] - (*above).facings[1];
    (*above).facings[2] = (*above).facings[1];
    (*above).facings[1] = (*above).facings[0];
    (*above).facings[0] = facings;
#endif
#ifndef BOUNDS
    let before = vec4(fold(normal_at(c, c.west.y, y), n_a), folds.xyz);
    let beyond = vec4(folds.yzw, fold(n_e, normal_at(c, c.east.y, y)));
    (*found).east.ridge = is_ridge(before, folds, beyond);
    (*found).east.rim = is_rim_ridge(before, folds, beyond);
    (*found).south.ridge = is_ridge((*above).folds[2], (*above).folds[1], (*above).folds[0]);
    (*found).south.rim = is_rim_ridge((*above).folds[2], (*above).folds[1], (*above).folds[0]);
#endif
    (*above).folds[2] = (*above).folds[1];
    (*above).folds[1] = (*above).folds[0];
    (*above).folds[0] = vec4(
        fold((*above).normals[0], n_a), fold((*above).normals[1], n_b),
        fold((*above).normals[2], n_c), fold((*above).normals[3], n_d),
    );
    (*above).normals[0] = n_a;
    (*above).normals[1] = n_b;
    (*above).normals[2] = n_c;
    (*above).normals[3] = n_d;
}
#endif

#ifdef OBJECT_IDS
// The object at a pixel and its marks.
fn object_at(c: Columns, x: i32, y: i32) -> vec2<u32> {
    let at = c.origin + vec2(x, y);
#ifdef MARKS
    return marked_object(at, texel_depth(at, 0));
#else
#ifdef SKY_BEYOND
    if is_drawn_sky(at) {
        return vec2(0u);
    }
#endif
    return texel_object(at, 0);
#endif
}

// Reads the objects of a row and their marks.
fn step_objects(above: ptr<function, Above>, c: Columns, y: i32, found: ptr<function, Found>) {
    let o_a = object_at(c, c.own.x, y);
    let o_b = object_at(c, c.own.y, y);
    let o_c = object_at(c, c.own.z, y);
    let o_d = object_at(c, c.own.w, y);
    let o_e = object_at(c, c.east.x, y);
    (*found).east.object_here = vec4(o_a.x, o_b.x, o_c.x, o_d.x);
    (*found).east.object_there = vec4(o_b.x, o_c.x, o_d.x, o_e.x);
    (*found).east.marks_here = vec4(o_a.y, o_b.y, o_c.y, o_d.y);
    (*found).east.marks_there = vec4(o_b.y, o_c.y, o_d.y, o_e.y);
    (*found).south.object_here = (*above).objects[2];
    (*found).south.object_there = (*above).objects[1];
    (*found).south.marks_here = (*above).marks[2];
    (*found).south.marks_there = (*above).marks[1];
    (*above).objects[2] = (*above).objects[1];
    (*above).objects[1] = (*above).objects[0];
    (*above).objects[0] = (*found).east.object_here;
    (*above).marks[2] = (*above).marks[1];
    (*above).marks[1] = (*above).marks[0];
    (*above).marks[0] = (*found).east.marks_here;
}
#endif

// Reads the row `row` of the columns, clamped to the grid.
fn step_down(above: ptr<function, Above>, c: Columns, row: i32) -> Found {
    let y = clamp(row, 0, c.last.y);
    var found: Found;
    step_depths(above, c, y, &found);
#ifdef NORMALS
    step_normals(above, c, y, &found);
#endif
#ifdef OBJECT_IDS
    step_objects(above, c, y, &found);
#endif
    return found;
}
