#define_import_path bevy_comics::objects::widths

// The factor of the width of the lines of an object, at a pixel of the pass that draws ids.

#import bevy_comics::objects::pressure::{
    Frame, Pressure, frame_scale, place_on_object, pressure_factor, stored_factor,
}
#import bevy_pbr::mesh_bindings::mesh
#import bevy_pbr::mesh_view_bindings::view

@group(1) @binding(2) var<uniform> pressure: Pressure;

// `vertex_factor`: that of the mesh's vertices; `id`: that of the object.
fn line_width(world: vec4<f32>, instance: u32, id: u32, vertex_factor: f32) -> f32 {
    var factor = clamp(vertex_factor, 0.0, 2.0);
    if pressure.amount > 0.0 {
        // Rows of the matrix.
        let m = mesh[instance].world_from_local;
        let frame = Frame(
            vec3(m[0].w, m[1].w, m[2].w),
            vec3(m[0].x, m[1].x, m[2].x),
            vec3(m[0].y, m[1].y, m[2].y),
            vec3(m[0].z, m[1].z, m[2].z),
        );
        let w = (view.clip_from_world * world).w;
        let per_unit = 0.5 * view.viewport.w * abs(view.clip_from_view[1].y) / max(w, 1e-20);
        let place = place_on_object(frame, world.xyz);
        factor *= pressure_factor(pressure, place, per_unit * frame_scale(frame), id);
    }
    return stored_factor(factor);
}
