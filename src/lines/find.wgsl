// Finds the cracks that lines run along: the borders between two neighbouring pixels at
// which a surface ends, bends, or meets another object.
//
// On CPU adapters a texel costs far more to load than to compare, so an invocation walks
// down four columns of 32 rows and keeps the last rows in registers: every texel is
// loaded about 1.5 times, not 25 times. Without compute shaders, a fragment finds the
// two cracks of its pixel with the same functions.

#import bevy_comics::depth::map::depth_map
#import bevy_comics::depth::view::{View, depth_frame, set_view, texel_depth}
#import bevy_comics::lines::edge::{
    CREASE, Grid, Lines, OBJECT, SILHOUETTE,
    byte, fold, fold_response, is_ridge, pack_ink, step_excess, step_response,
}
#import bevy_comics::objects::kinds_of
#ifdef NORMALS
#import bevy_comics::depth::normal::texel_normal
#endif
#ifdef OBJECT_IDS
#import bevy_comics::objects::texel_object
#endif
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif

struct FindUniform {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> find_uniform: FindUniform;
#ifndef BY_FRAGMENTS
// At every pixel the cracks to its east (x) and south (y), see Crack in edge.wgsl. The
// texture is cleared before.
@group(0) @binding(9) var crack_texture: texture_storage_2d<rg32uint, write>;
// For each block of 4 x 32 pixels, one bit for each row with a crack.
@group(0) @binding(10) var block_texture: texture_storage_2d<r32uint, write>;
#endif

const COLUMNS: i32 = 4;
const ROWS: i32 = 32;

// What lies on both sides of four cracks.
struct Sides {
    here: vec4<f32>,
    there: vec4<f32>,
    object_here: vec4<u32>,
    object_there: vec4<u32>,
    slot_here: vec4<u32>,
    slot_there: vec4<u32>,
}

// The kinds of line that four objects draw.
fn kinds_of_four(slots: vec4<u32>) -> vec4<u32> {
#ifdef OBJECT_STYLES
    return vec4(kinds_of(slots.x), kinds_of(slots.y), kinds_of(slots.z), kinds_of(slots.w));
#else
    return vec4(7u);
#endif
}

fn has(kinds: vec4<u32>, kind: u32) -> vec4<bool> {
    return (kinds & vec4(kind)) != vec4(0u);
}

// Whether the line belongs to `here`: to the object that draws this kind of line if the
// other does not, otherwise to the nearer one, otherwise to `here`.
fn owned(here_nearer: vec4<bool>, has_here: vec4<bool>, has_there: vec4<bool>) -> vec4<bool> {
    return select(here_nearer, has_here, has_here != has_there);
}

fn half_width_of(slots: vec4<u32>, s: Lines) -> vec4<f32> {
    var width = vec4(s.half_width);
#ifdef OBJECT_STYLES
    let own = vec4(
        style_of(slots.x).half_width, style_of(slots.y).half_width,
        style_of(slots.z).half_width, style_of(slots.w).half_width,
    );
    width = select(width, own * s.scale, (slots != vec4(0u)) & (own >= vec4(0.0)));
#endif
    return width;
}

// Four packed cracks; 0 where there is none. `excess` is that of step_excess; `folds`
// and `ridge` those of fold and is_ridge.
fn cracks(s: Lines, at: Sides, excess: vec4<f32>, folds: vec4<f32>, ridge: vec4<bool>) -> vec4<u32> {
    let near = max(at.here, at.there);
    let reference = s.reference_factor * near + s.reference_constant;
    let here_nearer = at.here >= at.there;
    let kinds_here = kinds_of_four(at.slot_here);
    let kinds_there = kinds_of_four(at.slot_there);
    var found = vec4(0u);
    var ink = vec4(0.0);
    var mine = here_nearer;
#ifdef SILHOUETTES
    let depth_response = step_response(excess, s.silhouette_k * reference);
    let depth_ink = smoothstep(vec4(s.silhouette_low), vec4(s.silhouette_high), depth_response);
    let draws = has(select(kinds_there, kinds_here, here_nearer), SILHOUETTE);
    let silhouette = draws & (near > vec4(0.0)) & (byte(depth_ink) > vec4(0u));
    found |= select(vec4(0u), vec4(SILHOUETTE), silhouette);
    ink = select(ink, depth_ink, silhouette);
#endif
#ifdef CREASES
    let bend_ink = smoothstep(vec4(s.crease_low), vec4(s.crease_high), fold_response(folds, s.crease_k));
    let creased_here = has(kinds_here, CREASE);
    let creased_there = has(kinds_there, CREASE);
    // Both sides of a crease meet: there is no jump in depth between them.
    let joined = excess < s.jump * reference;
    let crease = ridge & joined & (creased_here | creased_there) & (byte(bend_ink) > vec4(0u)) & (found == vec4(0u));
    found |= select(vec4(0u), vec4(CREASE), crease);
    ink = select(ink, bend_ink, crease);
    mine = select(mine, owned(here_nearer, creased_here, creased_there), crease);
#endif
#ifdef OBJECT_EDGES
    let edged_here = has(kinds_here, OBJECT);
    let edged_there = has(kinds_there, OBJECT);
    // If one object hides the other, the line belongs to the nearer one, even if that
    // has no object edges: then there is none.
    let hides = abs(at.here - at.there) > s.jump * reference;
    let object_mine = select(owned(here_nearer, edged_here, edged_there), here_nearer, hides);
    let drawn = select(edged_there, edged_here, object_mine);
    let object = (at.object_here != at.object_there) & drawn;
    found |= select(vec4(0u), vec4(OBJECT), object);
    mine = select(mine, object_mine, object);
#endif
    var opacity = vec4(1.0);
    var half_width = half_width_of(select(at.slot_there, at.slot_here, mine), s);
#ifdef FADING
    let frame = depth_frame();
    let owner = select(at.there, at.here, mine);
    let map = vec4(
        depth_map(frame, owner.x).x, depth_map(frame, owner.y).x,
        depth_map(frame, owner.z).x, depth_map(frame, owner.w).x,
    );
    opacity -= s.opacity_fade * map;
    half_width *= 1.0 - s.width_fade * map;
#endif
    let packed = found | select(vec4(0u), vec4(8u), mine) | pack_ink(ink, opacity, half_width);
    return select(vec4(0u), packed, found != vec4(0u));
}

fn depth_at(origin: vec2<i32>, x: i32, y: i32) -> f32 {
    return texel_depth(origin + vec2(x, y), 0);
}

#ifdef BY_FRAGMENTS
// Lane x is the crack to the east, lane y the one to the south.
@fragment
fn find(@builtin(position) position: vec4<f32>) -> @location(0) vec2<u32> {
    set_view(find_uniform.seen);
    let origin = find_uniform.grid.rect.xy;
    let last = find_uniform.grid.rect.zw - 1;
    let p = vec2<i32>(position.xy);
    let low = max(p - 1, vec2(0));
    let low_2 = max(p - 2, vec2(0));
    let high = min(p + 1, last);
    let high_2 = min(p + 2, last);
    let high_3 = min(p + 3, last);
    let centre = depth_at(origin, p.x, p.y);
    var at: Sides;
    at.here = vec4(centre);
    at.there = vec2(depth_at(origin, high.x, p.y), depth_at(origin, p.x, high.y)).xyxy;
    let before = vec2(depth_at(origin, low.x, p.y), depth_at(origin, p.x, low.y)).xyxy;
    let before_2 = vec2(depth_at(origin, low_2.x, p.y), depth_at(origin, p.x, low_2.y)).xyxy;
    let beyond = vec2(depth_at(origin, high_2.x, p.y), depth_at(origin, p.x, high_2.y)).xyxy;
    let beyond_2 = vec2(depth_at(origin, high_3.x, p.y), depth_at(origin, p.x, high_3.y)).xyxy;
    let excess = step_excess(before_2, before, at.here, at.there, beyond, beyond_2);
    var folds = vec4(0.0);
    var ridge = vec4(false);
#ifdef NORMALS
    let n = texel_normal(origin + p, 0);
    let e = texel_normal(origin + vec2(high.x, p.y), 0);
    let s = texel_normal(origin + vec2(p.x, high.y), 0);
    folds = vec2(fold(n, e), fold(n, s)).xyxy;
    let folds_before = vec2(
        fold(texel_normal(origin + vec2(low.x, p.y), 0), n),
        fold(texel_normal(origin + vec2(p.x, low.y), 0), n),
    ).xyxy;
    let folds_beyond = vec2(
        fold(e, texel_normal(origin + vec2(high_2.x, p.y), 0)),
        fold(s, texel_normal(origin + vec2(p.x, high_2.y), 0)),
    ).xyxy;
    ridge = is_ridge(folds_before, folds, folds_beyond);
#endif
#ifdef OBJECT_IDS
    let here = texel_object(origin + p, 0);
    let east = texel_object(origin + vec2(high.x, p.y), 0);
    let south = texel_object(origin + vec2(p.x, high.y), 0);
    at.object_here = vec4(here.x);
    at.slot_here = vec4(here.y);
    at.object_there = vec2(east.x, south.x).xyxy;
    at.slot_there = vec2(east.y, south.y).xyxy;
#endif
    return cracks(find_uniform.settings, at, excess, folds, ridge).xy;
}
#else
@compute @workgroup_size(32)
fn find(@builtin(global_invocation_id) id: vec3<u32>) {
    set_view(find_uniform.seen);
    let s = find_uniform.settings;
    let origin = find_uniform.grid.rect.xy;
    let size = find_uniform.grid.rect.zw;
    let last = size - 1;
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
    var east_1 = vec4(0u);
    var east_2 = vec4(0u);
    var east_3 = vec4(0u);
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
#ifdef OBJECT_IDS
    var object_1 = vec4(0u);
    var object_2 = vec4(0u);
    var object_3 = vec4(0u);
    var slot_1 = vec4(0u);
    var slot_2 = vec4(0u);
    var slot_3 = vec4(0u);
#endif
    var rows = 0u;
    // The cracks below a row are known three rows later.
    for (var i = -2; i < ROWS + 3; i++) {
        let y = clamp(top + i, 0, last.y);
        let a = depth_at(origin, x, y);
        let b = depth_at(origin, e1, y);
        let c = depth_at(origin, e2, y);
        let d = depth_at(origin, e3, y);
        let e = depth_at(origin, e4, y);
        let f = depth_at(origin, e5, y);
        let before = depth_at(origin, w1, y);
        let depth_0 = vec4(a, b, c, d);
        var at: Sides;
        at.here = depth_0;
        at.there = vec4(b, c, d, e);
        let excess = step_excess(
            vec4(depth_at(origin, w2, y), before, a, b), vec4(before, a, b, c), at.here,
            at.there, vec4(c, d, e, f), vec4(d, e, f, depth_at(origin, e6, y)),
        );
        var folds = vec4(0.0);
        var ridge = vec4(false);
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
#endif
#ifdef OBJECT_IDS
        let o_a = texel_object(origin + vec2(x, y), 0);
        let o_b = texel_object(origin + vec2(e1, y), 0);
        let o_c = texel_object(origin + vec2(e2, y), 0);
        let o_d = texel_object(origin + vec2(e3, y), 0);
        let o_e = texel_object(origin + vec2(e4, y), 0);
        at.object_here = vec4(o_a.x, o_b.x, o_c.x, o_d.x);
        at.object_there = vec4(o_b.x, o_c.x, o_d.x, o_e.x);
        at.slot_here = vec4(o_a.y, o_b.y, o_c.y, o_d.y);
        at.slot_there = vec4(o_b.y, o_c.y, o_d.y, o_e.y);
#endif
        let east_0 = cracks(s, at, excess, folds, ridge);

        // Between the third and the second row above the newest one.
        var below: Sides;
        below.here = depth_3;
        below.there = depth_2;
        let excess_below = step_excess(depth_5, depth_4, depth_3, depth_2, depth_1, depth_0);
        var folds_below = vec4(0.0);
        var ridge_below = vec4(false);
#ifdef NORMALS
        folds_below = folds_3;
        ridge_below = is_ridge(folds_4, folds_3, folds_2);
#endif
#ifdef OBJECT_IDS
        below.object_here = object_3;
        below.object_there = object_2;
        below.slot_here = slot_3;
        below.slot_there = slot_2;
#endif
        let south = cracks(s, below, excess_below, folds_below, ridge_below);
        let row = i - 3;
        if row >= 0 && top + row <= last.y {
            store(vec2(x, top + row), last.x, east_3, south);
            let any = (east_3 | south) != vec4(0u);
            rows |= select(0u, 1u << u32(row), any.x | any.y | any.z | any.w);
        }

        depth_5 = depth_4;
        depth_4 = depth_3;
        depth_3 = depth_2;
        depth_2 = depth_1;
        depth_1 = depth_0;
        east_3 = east_2;
        east_2 = east_1;
        east_1 = east_0;
#ifdef NORMALS
        folds_4 = folds_3;
        folds_3 = folds_2;
        folds_2 = vec4(fold(normal_a, n_a), fold(normal_b, n_b), fold(normal_c, n_c), fold(normal_d, n_d));
        normal_a = n_a;
        normal_b = n_b;
        normal_c = n_c;
        normal_d = n_d;
#endif
#ifdef OBJECT_IDS
        object_3 = object_2;
        object_2 = object_1;
        object_1 = at.object_here;
        slot_3 = slot_2;
        slot_2 = slot_1;
        slot_1 = at.slot_here;
#endif
    }
    textureStore(block_texture, vec2(x / COLUMNS, i32(id.y)), vec4(rows));
}

// Stores the cracks of four pixels in a row.
fn store(at: vec2<i32>, last: i32, east: vec4<u32>, south: vec4<u32>) {
    if (east.x | south.x) != 0u {
        textureStore(crack_texture, at, vec4(east.x, south.x, 0u, 0u));
    }
    if (east.y | south.y) != 0u && at.x + 1 <= last {
        textureStore(crack_texture, at + vec2(1, 0), vec4(east.y, south.y, 0u, 0u));
    }
    if (east.z | south.z) != 0u && at.x + 2 <= last {
        textureStore(crack_texture, at + vec2(2, 0), vec4(east.z, south.z, 0u, 0u));
    }
    if (east.w | south.w) != 0u && at.x + 3 <= last {
        textureStore(crack_texture, at + vec2(3, 0), vec4(east.w, south.w, 0u, 0u));
    }
}
#endif
