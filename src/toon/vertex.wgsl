// The engine's vertex shader of meshes (bevy_pbr/src/render/mesh.wgsl), with more outputs: where a
// vertex was before morphing and skinning, for strokes on surfaces; its normal on a simpler form; the
// visible range of the view; the scale of lengths in it.

#import bevy_pbr::{
    forward_io::Vertex,
    mesh_bindings::mesh,
    mesh_functions,
    morph::{morph_normal, morph_position, morph_tangent},
    skinning,
    view_transformations::position_world_to_clip,
}
#ifdef PROXY_SMOOTHED
#import bevy_comics::toon::octahedral::octahedral
#else ifdef PROXY_NORMAL
#import bevy_comics::toon::{bindings::toon, proxy::proxy_normal}
#endif
#ifdef DETAIL_VISIBLE
#import bevy_comics::toon::view_range::range_of_view
#endif
#ifdef VIEW_SCALE
#import bevy_comics::toon::view_range::scale_of_view
#endif

// `VertexOutput` of bevy_pbr::forward_io, and more.
struct MoreOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) world_position: vec4<f32>,
    @location(1) world_normal: vec3<f32>,
#ifdef VERTEX_UVS_A
    @location(2) uv: vec2<f32>,
#endif
#ifdef VERTEX_UVS_B
    @location(3) uv_b: vec2<f32>,
#endif
#ifdef VERTEX_TANGENTS
    @location(4) world_tangent: vec4<f32>,
#endif
#ifdef VERTEX_COLORS
    @location(5) color: vec4<f32>,
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    @location(6) @interpolate(flat) instance_index: u32,
#endif
#ifdef VISIBILITY_RANGE_DITHER
    @location(7) @interpolate(flat) visibility_range_dither: i32,
#endif
#ifdef HATCH_REST
    // Position and normal of the mesh at rest, with the scale of its entity. The normal is not of
    // unit length; it is 0 if the mesh has none.
    @location(8) rest_place: vec3<f32>,
    @location(9) rest_normal: vec3<f32>,
#endif
#ifdef PROXY_NORMAL
    // In world space. That of an ellipsoid is not of unit length: so it is linear over a triangle.
    @location(10) other_normal: vec3<f32>,
#endif
#ifdef DETAIL_VISIBLE
    // `ViewRange` of bevy_comics::toon::visible.
    @location(11) @interpolate(flat) range_ends: vec4<f32>,
    @location(12) @interpolate(flat) range_scale: vec4<f32>,
#endif
#ifdef VIEW_SCALE
    @location(13) @interpolate(flat) view_scale: f32,
#endif
}

#ifdef MORPH_TARGETS
fn morphed(at_rest: Vertex, instance: u32) -> Vertex {
    var moved = at_rest;
    let index = at_rest.index - mesh[instance].first_vertex_index;
    let count = bevy_pbr::morph::layer_count(instance);
    for (var i = 0u; i < count; i++) {
        let weight = bevy_pbr::morph::weight_at(i, instance);
        if weight == 0.0 {
            continue;
        }
        moved.position += weight * morph_position(index, i, instance);
#ifdef VERTEX_NORMALS
        moved.normal += weight * morph_normal(index, i, instance);
#endif
#ifdef VERTEX_TANGENTS
        moved.tangent += vec4(weight * morph_tangent(index, i, instance), 0.0);
#endif
    }
    return moved;
}
#endif

#ifdef VERTEX_NORMALS
// A normal of the mesh in world space.
fn normal_in_world(normal: vec3<f32>, world_from_local: mat4x4<f32>, instance: u32) -> vec3<f32> {
#ifdef SKINNED
    return skinning::skin_normals(world_from_local, normal);
#else
    return mesh_functions::mesh_normal_local_to_world(normal, instance);
#endif
}
#endif

#ifndef PROXY_SMOOTHED
#ifdef PROXY_NORMAL
// The normal of an ellipsoid or a cylinder in the space of the entity. Fragments could not find it:
// matrices of meshes are in storage buffers, which not all adapters read for the pixels beside a
// triangle, and derivatives need these.
fn solid_normal(place: vec4<f32>, instance: u32) -> vec3<f32> {
    let from_world = mesh_functions::get_local_from_world(instance);
    let normal = proxy_normal(toon.proxy, (from_world * place).xyz);
    return normal * mat3x3(from_world[0].xyz, from_world[1].xyz, from_world[2].xyz);
}
#endif
#endif

#ifdef HATCH_REST
fn with_rest(without: MoreOutput, at_rest: Vertex, own: mat4x4<f32>) -> MoreOutput {
    var out = without;
    let scale = vec3(length(own[0].xyz), length(own[1].xyz), length(own[2].xyz));
    out.rest_place = at_rest.position * scale;
#ifdef VERTEX_NORMALS
    out.rest_normal = at_rest.normal / max(scale / max(scale.x, max(scale.y, scale.z)), vec3(1e-6));
#endif
    return out;
}
#endif

// The engine's code reads the instance from the entry point's argument, not from a copy: DirectX 12
// needs that.
@vertex
fn vertex(
    at_rest: Vertex,
#ifdef PROXY_SMOOTHED
    @location(8) smoothed: vec2<f32>,
#endif
) -> MoreOutput {
    var out: MoreOutput;
#ifdef MORPH_TARGETS
    let moved = morphed(at_rest, at_rest.instance_index);
#else
    let moved = at_rest;
#endif
    let own = mesh_functions::get_world_from_local(at_rest.instance_index);
#ifdef SKINNED
    let world_from_local = skinning::skin_model(moved.joint_indices, moved.joint_weights, at_rest.instance_index);
#else
    let world_from_local = own;
#endif
    out.world_position = mesh_functions::mesh_position_local_to_world(world_from_local, vec4<f32>(moved.position, 1.0));
    out.position = position_world_to_clip(out.world_position.xyz);
#ifdef VERTEX_NORMALS
    out.world_normal = normal_in_world(moved.normal, world_from_local, at_rest.instance_index);
#endif
#ifdef PROXY_SMOOTHED
    // Morph targets add to it what they add to the mesh's normal.
    let form = octahedral(smoothed) + (moved.normal - at_rest.normal);
    out.other_normal = normal_in_world(form, world_from_local, at_rest.instance_index);
#else ifdef PROXY_NORMAL
    out.other_normal = solid_normal(out.world_position, at_rest.instance_index);
#endif
#ifdef HATCH_REST
    out = with_rest(out, at_rest, own);
#endif
#ifdef DETAIL_VISIBLE
    let range = range_of_view();
    out.range_ends = range.ends;
    out.range_scale = range.scale;
#endif
#ifdef VIEW_SCALE
    out.view_scale = scale_of_view();
#endif
#ifdef VERTEX_UVS_A
    out.uv = moved.uv;
#endif
#ifdef VERTEX_UVS_B
    out.uv_b = moved.uv_b;
#endif
#ifdef VERTEX_TANGENTS
    out.world_tangent = mesh_functions::mesh_tangent_local_to_world(
        world_from_local, moved.tangent, at_rest.instance_index,
    );
#endif
#ifdef VERTEX_COLORS
    out.color = moved.color;
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = at_rest.instance_index;
#endif
#ifdef VISIBILITY_RANGE_DITHER
    out.visibility_range_dither = mesh_functions::get_visibility_range_dither_level(at_rest.instance_index, own[3]);
#endif
    return out;
}
