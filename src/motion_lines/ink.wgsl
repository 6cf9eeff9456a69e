// Ribbons along paths, with the same width at every distance.

#import bevy_pbr::{
    forward_io::Vertex,
    mesh_functions::{get_world_from_local, mesh_position_local_to_world},
    mesh_view_bindings::view,
    view_transformations::position_world_to_clip,
}
#import bevy_comics::motion_lines::ribbon::{coverage, direction_on_screen, moved_across}
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
    // Physical pixels from the middle of the ribbon, and half of its width, both times w, and w: divided,
    // they are interpolated on the screen. OpenGL ES has no attribute for that.
    @location(0) across: vec3<f32>,
}

// Keeps what is behind the eye from turning the sign of what is interpolated.
const LEAST_W: f32 = 1e-6;

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
    let along = direction_on_screen(at, beside, size);
    let half_width = ink.half_width * v.uv.y;
    let across = v.uv.x * (half_width + 1.0);
    var out: Drawn;
    out.position = moved_across(at, along, across, size);
    out.across = vec3(across, half_width, 1.0) * max(at.w, LEAST_W);
    return out;
}

@fragment
fn fragment(in: Drawn) -> @location(0) vec4<f32> {
    var color = ink.color;
    let across = in.across.xy / in.across.z;
    color.a *= coverage(across.x, across.y);
#ifdef TONEMAP_IN_SHADER
    color = tone_mapping(color, view.color_grading);
#endif
    return color;
}
