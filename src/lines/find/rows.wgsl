#define_import_path bevy_comics::lines::rows

// Walks down four neighboring columns of the grid and keeps the last rows in registers.
// On CPU adapters a texel costs far more to load than to compare. With depth, normals and
// ids, a walk down 8 rows loads 8.5 texels a pixel, instead of 21. A walk down 32 rows loads 5.9,
// and beside another one 4.8.

#import bevy_comics::depth::view::{is_drawn_sky, texel_depth}
#import bevy_comics::lines::edge::{
    Departures, departures, fold, in_front_by, is_outdone, is_ridge, is_rim_ridge, step_excess,
}
#ifdef BENDS
#import bevy_comics::lines::pass::line_pass
#else ifdef HARD
#import bevy_comics::lines::pass::line_pass
#endif
#ifdef NORMALS
#import bevy_comics::depth::normal::texel_normal
#endif
#ifdef HIGHLIGHTS
#import bevy_comics::lines::hidden::highlighted_object
#else ifdef OBJECT_IDS
#import bevy_comics::objects::texel_object
#endif

// Four columns and their neighbors, clamped to the grid.
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
    // BENDS: depths of the next column to the east in the two rows above; how depth bends down, in the
    // second row above; and the bends at cracks that were found before, the last ones first.
    depths_east: vec2<f32>,
    bend_down: Bends,
    east_bends: array<Bends, 3>,
    south_bends: array<Bends, 2>,
    // Normals of the row above, by column.
    normals: array<vec4<f32>, 4>,
    folds: array<vec4<f32>, 3>,
    // HARD: how much they face owner_direction.
    facings: array<vec4<f32>, 3>,
    objects: array<vec4<u32>, 3>,
    slot_section: array<vec4<u32>, 3>,
    // Without BOUNDS: borders to the east in the two rows above.
    east: array<Borders, 2>,
}

// How much raw depth bends at four columns, and at those to the west and to the east of them; at cracks to the
// south, only at the one to the east.
struct Bends {
    own: vec4<f32>,
    west: f32,
    east: f32,
}

// The borders between four pixels (here) and their neighbors (there). Without EXCESS
// excesses are 0, without NORMALS folds are, without OBJECT_IDS objects,
// slots and sections are (see texel_object). BOUNDS: for walk.wgsl, which does not ask what only excludes
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
    // HARD: by how much more `here` faces owner_direction; and see in_front_by.
    faces_more: vec4<f32>,
    in_front: vec4<f32>,
    object_here: vec4<u32>,
    object_there: vec4<u32>,
    slot_section_here: vec4<u32>,
    slot_section_there: vec4<u32>,
    // BENDS: how much raw depth bends at the crack, at the next ones on both sides of it, or at those that meet
    // its ends at a right angle; as a fraction of what a jump is one of.
    bend: vec4<f32>,
}

// What a new row shows.
struct Found {
    // Raw depths to the west of the pixels.
    before: vec4<f32>,
    // Borders to the east: with BOUNDS in the new row, otherwise in the second row above it.
    east: Borders,
    // Borders between the third and the second row above it.
    south: Borders,
}

// The columns x + 4 to x + 7, beside those of four_columns.
fn next_columns(c: Columns, x: i32) -> Columns {
    let last = c.last.xxxx;
    return Columns(
        c.origin,
        c.last,
        c.own.zw,
        min(vec4(x + 4, x + 5, x + 6, x + 7), last),
        min(vec3(x + 8, x + 9, x + 10), last.xyz),
    );
}

// What is loaded of a row: at the columns, and the depths of those to the west and east of them. The fifth
// normal and object are those of the next column to the east.
struct Texels {
    west: vec2<f32>,
    own: vec4<f32>,
    east: vec3<f32>,
    normals: array<vec4<f32>, 5>,
    objects: array<vec2<u32>, 5>,
}

fn depth_at(c: Columns, x: i32, y: i32) -> f32 {
    return texel_depth(c.origin + vec2(x, y), 0);
}

// The texels of a row of the grid.
fn load_texels(c: Columns, y: i32) -> Texels {
    var t: Texels;
    t.west.y = depth_at(c, c.west.y, y);
    t.own = vec4(depth_at(c, c.own.x, y), depth_at(c, c.own.y, y), depth_at(c, c.own.z, y), depth_at(c, c.own.w, y));
    t.east.x = depth_at(c, c.east.x, y);
#ifdef EXCESS
    t.west.x = depth_at(c, c.west.x, y);
    t.east.y = depth_at(c, c.east.y, y);
    t.east.z = depth_at(c, c.east.z, y);
#endif
#ifdef NORMALS
    t.normals[0] = normal_at(c, c.own.x, y);
    t.normals[1] = normal_at(c, c.own.y, y);
    t.normals[2] = normal_at(c, c.own.z, y);
    t.normals[3] = normal_at(c, c.own.w, y);
    t.normals[4] = normal_at(c, c.east.x, y);
#endif
#ifdef OBJECT_IDS
    t.objects[0] = object_at(c, c.own.x, y);
    t.objects[1] = object_at(c, c.own.y, y);
    t.objects[2] = object_at(c, c.own.z, y);
    t.objects[3] = object_at(c, c.own.w, y);
    t.objects[4] = object_at(c, c.east.x, y);
#endif
    return t;
}

// The same of next_columns, of which those to the west of them have loaded a part.
fn load_beside(c: Columns, y: i32, before: Texels) -> Texels {
    var t: Texels;
    t.west = before.own.zw;
    t.own.x = before.east.x;
    t.own.w = depth_at(c, c.own.w, y);
    t.east.x = depth_at(c, c.east.x, y);
#ifdef EXCESS
    t.own.y = before.east.y;
    t.own.z = before.east.z;
    t.east.y = depth_at(c, c.east.y, y);
    t.east.z = depth_at(c, c.east.z, y);
#else
    t.own.y = depth_at(c, c.own.y, y);
    t.own.z = depth_at(c, c.own.z, y);
#endif
#ifdef NORMALS
    t.normals[0] = before.normals[4];
    t.normals[1] = normal_at(c, c.own.y, y);
    t.normals[2] = normal_at(c, c.own.z, y);
    t.normals[3] = normal_at(c, c.own.w, y);
    t.normals[4] = normal_at(c, c.east.x, y);
#endif
#ifdef OBJECT_IDS
    t.objects[0] = before.objects[4];
    t.objects[1] = object_at(c, c.own.y, y);
    t.objects[2] = object_at(c, c.own.z, y);
    t.objects[3] = object_at(c, c.own.w, y);
    t.objects[4] = object_at(c, c.east.x, y);
#endif
    return t;
}

#ifdef BENDS
// Whether a place has neighbors on both sides, as 0 or 1.
fn is_inside(at: vec4<i32>, last: i32) -> vec4<f32> {
    return select(vec4(0.0), vec4(1.0), (at > vec4(0)) & (at < vec4(last)));
}

// What a jump is a fraction of, between pixels of these raw depths.
fn reference_of(here: vec4<f32>, there: vec4<f32>) -> vec4<f32> {
    let s = line_pass.settings;
    return max(s.reference_factor * max(here, there) + s.reference_constant, vec4(1e-30));
}

// How much raw depth bends at the cracks to the east in a row. `west` and `east`: the depths beside `depth`.
fn bends_to_east(c: Columns, west: vec2<f32>, depth: vec4<f32>, east: vec3<f32>) -> Bends {
    let before = vec4(west.y, depth.xyz);
    let beyond = vec4(depth.yzw, east.x);
    let own = is_inside(c.own, c.last.x) * abs(before - 2.0 * depth + beyond);
    let beside = is_inside(vec4(c.west.y, c.east.xy, 0), c.last.x).xyz * abs(vec3(
        west.x - 2.0 * west.y + depth.x,
        depth.w - 2.0 * east.x + east.y,
        east.x - 2.0 * east.y + east.z,
    ));
    let ends = vec2(beside.x + own.x, beside.y + beside.z)
        / reference_of(vec4(west.y, east.x, 0.0, 0.0), vec4(depth.x, east.y, 0.0, 0.0)).xy;
    return Bends((own + vec4(own.yzw, beside.y)) / reference_of(depth, beyond), ends.x, ends.y);
}

// The larger bend at the cracks on both sides of every pixel, across.
fn around(bends: Bends) -> vec4<f32> {
    return max(bends.own, vec4(bends.west, bends.own.xyz));
}

// How much raw depth bends at the cracks between the two rows above the new row `row`, also in the column
// to the east.
fn bends_to_south(above: ptr<function, Above>, c: Columns, row: i32, depth: vec4<f32>, east: f32) -> Bends {
    let is_row = is_inside(vec4(row - 1), c.last.y).x;
    let here = (*above).depths[1];
    let there = (*above).depths[0];
    let here_east = (*above).depths_east.y;
    let there_east = (*above).depths_east.x;
    let before = (*above).bend_down;
    (*above).bend_down = Bends(
        is_row * abs(here - 2.0 * there + depth),
        0.0,
        is_row * abs(here_east - 2.0 * there_east + east),
    );
    (*above).depths_east = vec2(east, there_east);
    return Bends(
        (before.own + (*above).bend_down.own) / reference_of(here, there),
        0.0,
        (before.east + (*above).bend_down.east) / reference_of(vec4(here_east), vec4(there_east)).x,
    );
}
#endif

// Compares the depths of a row.
fn step_depths(above: ptr<function, Above>, c: Columns, row: i32, t: Texels, found: ptr<function, Found>) {
    let e = t.east.x;
    let depth = t.own;
    let west = t.west.y;
    (*found).before = vec4(west, depth.xyz);
    (*found).east.here = depth;
    (*found).east.there = vec4(depth.yzw, e);
    (*found).south.here = (*above).depths[2];
    (*found).south.there = (*above).depths[1];
#ifdef EXCESS
    let before_2 = vec4(t.west, depth.xy);
    let beyond = vec4(depth.zw, t.east.xy);
    let beyond_2 = vec4(depth.w, t.east);
    (*found).east.excess = step_excess(
        before_2, (*found).before, depth, (*found).east.there, beyond, beyond_2,
    );
    (*found).south.excess = step_excess(
        (*above).depths[4], (*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0], depth,
    );
#ifdef HARD
    (*found).east.in_front = in_front_by((*found).before, depth, (*found).east.there, beyond);
    (*found).south.in_front = in_front_by(
        (*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0],
    );
#endif
#ifndef BOUNDS
#ifdef SECTIONS
    (*found).east.departs = departures(
        before_2, (*found).before, depth, (*found).east.there, beyond, beyond_2,
    );
    (*found).south.departs = departures(
        (*above).depths[4], (*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0], depth,
    );
#endif
    (*found).east.outdone = is_outdone((*found).before, depth, (*found).east.there, beyond);
    (*found).south.outdone = is_outdone((*above).depths[3], (*above).depths[2], (*above).depths[1], (*above).depths[0]);
#endif
#ifdef BENDS
    let to_east = bends_to_east(c, t.west, depth, t.east);
    let to_south = bends_to_south(above, c, row, depth, e);
    // Borders to the east are those of the second row above, those to the south are above it.
    let south = (*above).south_bends;
    let down = max(to_south.own, south[0].own);
    let down_east = max(to_south.east, south[0].east);
    let across = (*above).east_bends[1];
    (*above).east[1].bend = max(
        max(around(across), vec4(across.own.yzw, across.east)),
        max(down, vec4(down.yzw, down_east)),
    );
    (*found).south.bend = max(
        max(down, south[1].own),
        max(around((*above).east_bends[2]), around(across)),
    );
    (*above).east_bends[2] = across;
    (*above).east_bends[1] = (*above).east_bends[0];
    (*above).east_bends[0] = to_east;
    (*above).south_bends[1] = south[0];
    (*above).south_bends[0] = to_south;
#endif
#endif
    (*above).depths[4] = (*above).depths[3];
    (*above).depths[3] = (*above).depths[2];
    (*above).depths[2] = (*above).depths[1];
    (*above).depths[1] = (*above).depths[0];
    (*above).depths[0] = depth;
}

#ifdef NORMALS
// The normal at a pixel of the depth texture; 0 for the sky.
fn normal_of(at: vec2<i32>) -> vec4<f32> {
#ifdef SKY_BEYOND
    if is_drawn_sky(at) {
        return vec4(0.0);
    }
#endif
    return texel_normal(at, 0);
}

fn normal_at(c: Columns, x: i32, y: i32) -> vec4<f32> {
    return normal_of(c.origin + vec2(x, y));
}

// Compares the normals of a row.
fn step_normals(above: ptr<function, Above>, c: Columns, y: i32, t: Texels, found: ptr<function, Found>) {
    let n_a = t.normals[0];
    let n_b = t.normals[1];
    let n_c = t.normals[2];
    let n_d = t.normals[3];
    let n_e = t.normals[4];
    let folds = vec4(fold(n_a, n_b), fold(n_b, n_c), fold(n_c, n_d), fold(n_d, n_e));
    (*found).east.folds = folds;
    (*found).south.folds = (*above).folds[1];
#ifdef HARD
    let direction = line_pass.settings.owner_direction;
    let facings = vec4(
        dot(n_a.xyz, direction), dot(n_b.xyz, direction), dot(n_c.xyz, direction), dot(n_d.xyz, direction),
    );
    (*found).east.faces_more = facings - vec4(facings.yzw, dot(n_e.xyz, direction));
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
// The object at a pixel of the depth texture, and its slot and section.
fn object_of(at: vec2<i32>) -> vec2<u32> {
#ifdef HIGHLIGHTS
    return highlighted_object(at, texel_depth(at, 0));
#else
#ifdef SKY_BEYOND
    if is_drawn_sky(at) {
        return vec2(0u);
    }
#endif
    return texel_object(at, 0);
#endif
}

fn object_at(c: Columns, x: i32, y: i32) -> vec2<u32> {
    return object_of(c.origin + vec2(x, y));
}

// Compares the objects of a row, and their slots and sections.
fn step_objects(above: ptr<function, Above>, t: Texels, found: ptr<function, Found>) {
    let o_a = t.objects[0];
    let o_b = t.objects[1];
    let o_c = t.objects[2];
    let o_d = t.objects[3];
    let o_e = t.objects[4];
    (*found).east.object_here = vec4(o_a.x, o_b.x, o_c.x, o_d.x);
    (*found).east.object_there = vec4(o_b.x, o_c.x, o_d.x, o_e.x);
    (*found).east.slot_section_here = vec4(o_a.y, o_b.y, o_c.y, o_d.y);
    (*found).east.slot_section_there = vec4(o_b.y, o_c.y, o_d.y, o_e.y);
    (*found).south.object_here = (*above).objects[2];
    (*found).south.object_there = (*above).objects[1];
    (*found).south.slot_section_here = (*above).slot_section[2];
    (*found).south.slot_section_there = (*above).slot_section[1];
    (*above).objects[2] = (*above).objects[1];
    (*above).objects[1] = (*above).objects[0];
    (*above).objects[0] = (*found).east.object_here;
    (*above).slot_section[2] = (*above).slot_section[1];
    (*above).slot_section[1] = (*above).slot_section[0];
    (*above).slot_section[0] = (*found).east.slot_section_here;
}
#endif

// Reads the row `row` of the columns, clamped to the grid.
fn step_down(above: ptr<function, Above>, c: Columns, row: i32) -> Found {
    return step_row(above, c, row, load_texels(c, clamp(row, 0, c.last.y)));
}

// The same of a row that is loaded.
fn step_row(above: ptr<function, Above>, c: Columns, row: i32, t: Texels) -> Found {
    var found: Found;
    step_depths(above, c, row, t, &found);
#ifdef NORMALS
    step_normals(above, c, clamp(row, 0, c.last.y), t, &found);
#endif
#ifdef OBJECT_IDS
    step_objects(above, t, &found);
#endif
#ifndef BOUNDS
    // How depth bends beside the cracks of the new row is known with the next two.
    let newest = found.east;
    found.east = (*above).east[1];
    (*above).east[1] = (*above).east[0];
    (*above).east[0] = newest;
#endif
    return found;
}
