// Finds the cracks that lines run along: the borders between two neighbouring pixels at
// which a surface ends, bends, or meets another object. A fragment stores the cracks to
// the east (x) and south (y) of its pixel, see Crack in edge.wgsl.
//
// Only tiles in which walk.wgsl has seen a crack are drawn; the rest of the texture is
// cleared. Without compute shaders, all pixels are drawn.

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
