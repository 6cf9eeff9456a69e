// Finds the cracks that lines run along on devices without compute shaders: the same as
// cells.wgsl finds. A fragment stores the cracks to the east (x) and south (y) of its
// pixel.

#import bevy_comics::depth::view::{set_view, texel_depth}
#import bevy_comics::lines::crack::cracks
#import bevy_comics::lines::edge::{
    departures, fold, in_front_by, is_outdone, is_ridge, is_rim_ridge, step_excess,
}
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::rows::Borders
#ifdef NORMALS
#import bevy_comics::lines::rows::normal_of
#endif
#ifdef OBJECT_IDS
#import bevy_comics::lines::rows::object_of
#endif

fn depth_at(origin: vec2<i32>, x: i32, y: i32) -> f32 {
    return texel_depth(origin + vec2(x, y), 0);
}

#ifdef BENDS
// How much raw depth bends at the three cracks in the middle of six pixels in a row, of which the third is at
// this place between 0 and `last`; as fractions of what a jump is one of.
fn bends(at: i32, last: i32, d: array<f32, 6>) -> vec3<f32> {
    let s = line_pass.settings;
    let places = vec4(at - 1, at, at + 1, at + 2);
    let before = vec4(d[0], d[1], d[2], d[3]);
    let here = vec4(d[1], d[2], d[3], d[4]);
    let bend = abs(before - 2.0 * here + vec4(d[2], d[3], d[4], d[5]));
    let all = select(vec4(0.0), bend, (places > vec4(0)) & (places < vec4(last)));
    let near = max(here.xyz, here.yzw);
    return (all.xyz + all.yzw) / max(s.reference_factor * near + s.reference_constant, vec3(1e-30));
}

// The larger of the first two.
fn around(bends: vec3<f32>) -> f32 {
    return max(bends.x, bends.y);
}
#endif

// Lane x is the crack to the east, lane y the one to the south.
@fragment
fn find(@builtin(position) position: vec4<f32>) -> @location(0) vec2<u32> {
    set_view(line_pass.seen);
    let origin = line_pass.grid.rect.xy;
    let last = line_pass.grid.rect.zw - 1;
    let p = vec2<i32>(position.xy);
    let low = max(p - 1, vec2(0));
    let low_2 = max(p - 2, vec2(0));
    let high = min(p + 1, last);
    let high_2 = min(p + 2, last);
    let high_3 = min(p + 3, last);
    let center = depth_at(origin, p.x, p.y);
    var at: Borders;
    at.here = vec4(center);
    at.there = vec2(depth_at(origin, high.x, p.y), depth_at(origin, p.x, high.y)).xyxy;
    let before = vec2(depth_at(origin, low.x, p.y), depth_at(origin, p.x, low.y)).xyxy;
    let before_2 = vec2(depth_at(origin, low_2.x, p.y), depth_at(origin, p.x, low_2.y)).xyxy;
    let beyond = vec2(depth_at(origin, high_2.x, p.y), depth_at(origin, p.x, high_2.y)).xyxy;
    let beyond_2 = vec2(depth_at(origin, high_3.x, p.y), depth_at(origin, p.x, high_3.y)).xyxy;
    at.excess = step_excess(before_2, before, at.here, at.there, beyond, beyond_2);
    at.outdone = is_outdone(before, at.here, at.there, beyond);
#ifdef HARD
    at.in_front = in_front_by(before, at.here, at.there, beyond);
#endif
#ifdef SECTIONS
    at.departs = departures(before_2, before, at.here, at.there, beyond, beyond_2);
#endif
#ifdef BENDS
    let south_east = depth_at(origin, high.x, high.y);
    let across = bends(p.x, last.x, array(before_2.x, before.x, center, at.there.x, beyond.x, beyond_2.x));
    let down = bends(p.y, last.y, array(before_2.y, before.y, center, at.there.y, beyond.y, beyond_2.y));
    // The third bends of these are not used.
    let across_south = bends(p.x, last.x, array(
        depth_at(origin, low_2.x, high.y), depth_at(origin, low.x, high.y), at.there.y,
        south_east, depth_at(origin, high_2.x, high.y), 0.0,
    ));
    let down_east = bends(p.y, last.y, array(
        depth_at(origin, high.x, low_2.y), depth_at(origin, high.x, low.y), at.there.x,
        south_east, depth_at(origin, high.x, high_2.y), 0.0,
    ));
    let beside = max(around(across), around(down));
    at.bend = max(
        vec2(beside),
        vec2(max(across.z, around(down_east)), max(down.z, around(across_south))),
    ).xyxy;
#endif
#ifdef NORMALS
    let n = normal_of(origin + p);
    let e = normal_of(origin + vec2(high.x, p.y));
    let s = normal_of(origin + vec2(p.x, high.y));
    at.folds = vec2(fold(n, e), fold(n, s)).xyxy;
#ifdef HARD
    let direction = line_pass.settings.owner_direction;
    at.faces_more = dot(n.xyz, direction) - vec2(dot(e.xyz, direction), dot(s.xyz, direction)).xyxy;
#endif
    let folds_before = vec2(
        fold(normal_of(origin + vec2(low.x, p.y)), n),
        fold(normal_of(origin + vec2(p.x, low.y)), n),
    ).xyxy;
    let folds_beyond = vec2(
        fold(e, normal_of(origin + vec2(high_2.x, p.y))),
        fold(s, normal_of(origin + vec2(p.x, high_2.y))),
    ).xyxy;
    at.ridge = is_ridge(folds_before, at.folds, folds_beyond);
    at.rim = is_rim_ridge(folds_before, at.folds, folds_beyond);
#endif
#ifdef OBJECT_IDS
    let here = object_of(origin + p);
    let east = object_of(origin + vec2(high.x, p.y));
    let south = object_of(origin + vec2(p.x, high.y));
    at.object_here = vec4(here.x);
    at.slot_section_here = vec4(here.y);
    at.object_there = vec2(east.x, south.x).xyxy;
    at.slot_section_there = vec2(east.y, south.y).xyxy;
#endif
    return cracks(line_pass.settings, at).packed.xy;
}
