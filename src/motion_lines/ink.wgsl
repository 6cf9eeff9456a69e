// Ribbons along paths, with the same width at every distance.

#import bevy_pbr::{
    forward_io::Vertex,
    mesh_functions::{get_world_from_local, mesh_position_local_to_world},
    mesh_view_bindings::view,
    view_transformations::position_world_to_clip,
}
#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

struct Ink {
    color: vec4<f32>,
    // Half of the widest width, in physical pixels.
    half_width: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> ink: Ink;

struct Drawn {
    @builtin(position) position: vec4<f32>,
    // Physical pixels from the middle of the ribbon, and half of its width.
    @location(0) @interpolate(linear) across: vec2<f32>,
}

// The ribbon is wider than its line by a pixel on each side, for its soft edge.
@vertex
fn vertex(v: Vertex) -> Drawn {
    let world_from_local = get_world_from_local(v.instance_index);
    let world = mesh_position_local_to_world(world_from_local, vec4(v.position, 1.0)).xyz;
    let at = position_world_to_clip(world);
    // A point a little farther along the path: a hundredth of the distance to the eye, so that it
    // is in front of the eye too.
    let beside = position_world_to_clip(world + v.normal * 0.01 * abs(at.w));
    let size = view.viewport.zw;
    let step = (beside.xy / beside.w - at.xy / at.w) * size;
    let long = length(step);
    // Seen from the end, a path has no direction.
    let along = select(vec2(1.0, 0.0), step / long, long > 1e-6);
    let half_width = ink.half_width * v.uv.y;
    let across = v.uv.x * (half_width + 1.0);
    var out: Drawn;
    out.position = at;
    // Two units of the clip space are the whole picture.
    let off = vec2(-along.y, along.x) * across * 2.0 / size * at.w;
    out.position.x += off.x;
    out.position.y += off.y;
    out.across = vec2(across, half_width);
    return out;
}

// What a line of a width covers of a pixel at a distance from its middle.
fn coverage(distance: f32, half_width: f32) -> f32 {
    // A line that is thinner than a pixel is paler, not thinner.
    let shown = max(half_width, 0.5);
    return clamp(shown + 0.5 - abs(distance), 0.0, 1.0) * min(2.0 * half_width, 1.0);
}

@fragment
fn fragment(in: Drawn) -> @location(0) vec4<f32> {
    var color = ink.color;
    color.a *= coverage(in.across.x, in.across.y);
#ifdef TONEMAP_IN_SHADER
    color = tone_mapping(color, view.color_grading);
#endif
    return color;
}
