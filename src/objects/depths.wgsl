#define_import_path bevy_comics::objects::depths

// The depth of every object in the depth map: that of its center, for all of its pixels. One
// invocation for each object, once per view and frame.

#import bevy_comics::depth::map::{DepthFrame, depth_map}
#import bevy_comics::depth::view::{View, depth_frame, set_view}

// Changes of D up to this are ignored, and near the eye up to this fraction of D: on a linear map
// of a large landscape, all that matters may be in the first hundredth.
const HYSTERESIS: f32 = 0.03;
const HYSTERESIS_FRACTION: f32 = 0.15;

// Objects that extend over less of D than this have one depth; from the second number on, every
// pixel is its own.
const WHOLE: f32 = 0.25;
const DIVIDED: f32 = 0.4;

// A box in world space, along its axes.
struct Bounds {
    center: vec3<f32>,
    id: u32,
    half: vec3<f32>,
    // 0: it had the id before; 1: the id is new; 2: there is no depth, because several objects have
    // the id, or the object has no box.
    state: u32,
    // A factor of the simplification by distance, and what is added.
    simplification: vec2<f32>,
    unused_pair: vec2<f32>,
}

struct Eye {
    position: vec3<f32>,
    orthographic: u32,
    forward: vec3<f32>,
    // 1: depths of the frames before are not used.
    resets: u32,
    // Distance along the view's axis from raw depth d: x / (d + y), under an orthographic
    // projection x + y * d.
    axis: vec2<f32>,
    spare: vec2<f32>,
    view: View,
}

@group(0) @binding(0) var<uniform> eye: Eye;
@group(0) @binding(1) var<storage, read> objects: array<Bounds>;
// By id: D of the center, plus 1; how much of each pixel follows it; and its
// simplification. 0: unknown.
@group(0) @binding(2) var<storage, read_write> depths: array<vec4<f32>>;

// Raw depth at a distance along the view's axis; 1 behind the eye.
fn raw_depth_at(axis: vec2<f32>, orthographic: bool, distance: f32) -> f32 {
    if orthographic {
        return clamp((distance - axis.x) / axis.y, 0.0, 1.0);
    }
    if !(distance > 0.0) {
        return 1.0;
    }
    return clamp(axis.x / distance - axis.y, 0.0, 1.0);
}

// D of the center of an object, and how much its pixels follow it. `distance`: of the center,
// `reach`: of its nearest and farthest point from there, along the view's axis.
fn depth_of_object(frame: DepthFrame, axis: vec2<f32>, orthographic: bool, distance: f32, reach: f32) -> vec2<f32> {
    let near = depth_map(frame, raw_depth_at(axis, orthographic, distance - reach)).x;
    let center = depth_map(frame, raw_depth_at(axis, orthographic, distance)).x;
    let far = depth_map(frame, raw_depth_at(axis, orthographic, distance + reach)).x;
    return vec2(center, 1.0 - smoothstep(WHOLE, DIVIDED, far - near));
}

// The depth that is kept of an object that moves.
fn kept_depth(before: f32, now: f32) -> f32 {
    let ignored = min(HYSTERESIS, HYSTERESIS_FRACTION * now);
    return clamp(before, now - ignored, now + ignored);
}

@compute @workgroup_size(64)
fn object_depth(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&objects) {
        return;
    }
    set_view(eye.view);
    let bounds = objects[id.x];
    if bounds.id == 0u {
        // No object: the table stays 0 for pixels that show none.
        return;
    }
    let distance = dot(eye.forward, bounds.center - eye.position);
    let reach = dot(abs(eye.forward), bounds.half);
    let found = depth_of_object(depth_frame(), eye.axis, eye.orthographic != 0u, distance, reach);
    let at = min(bounds.id, arrayLength(&depths) - 1u);
    let before = depths[at].x;
    if bounds.state == 2u {
        depths[at] = vec4(0.0);
        return;
    }
    let is_new = before == 0.0 || bounds.state == 1u || eye.resets != 0u;
    let d = select(kept_depth(before - 1.0, found.x), found.x, is_new);
    depths[at] = vec4(d + 1.0, found.y, bounds.simplification);
}
