// Writes depth, object and normal of a transparent mesh where it is opaque enough. The vertex
// shader is that of the depth prepass.

#import bevy_pbr::prepass_io::VertexOutput
#ifdef ALPHA_CUTOFF
#import bevy_pbr::{mesh_bindings::mesh, mesh_view_bindings::view, pbr_bindings, pbr_types}
#import bevy_render::bindless::{bindless_samplers_filtering, bindless_textures_2d}
#ifdef BINDLESS
#import bevy_pbr::pbr_bindings::material_indices
#endif
#endif

// Id, slot, unused, and the bits of the least alpha.
@group(1) @binding(0) var<storage, read> objects: array<vec4<u32>>;

struct Surface {
    @location(0) object: vec2<u32>,
    @location(1) normal: vec4<f32>,
}

#ifdef ALPHA_CUTOFF
// The engine's StandardMaterial.
fn material_of(instance: u32) -> pbr_types::StandardMaterial {
#ifdef BINDLESS
    let slot = mesh[instance].material_and_lightmap_bind_group_slot & 0xffffu;
    return pbr_bindings::material_array[material_indices[slot].material];
#else
    return pbr_bindings::material;
#endif
}

#ifdef VERTEX_UVS
// Alpha of the base color texture.
fn texture_alpha(at: vec2<f32>, instance: u32) -> f32 {
#ifdef BINDLESS
    let slot = mesh[instance].material_and_lightmap_bind_group_slot & 0xffffu;
    return textureSampleBias(
        bindless_textures_2d[material_indices[slot].base_color_texture],
        bindless_samplers_filtering[material_indices[slot].base_color_sampler],
        at,
        view.mip_bias,
    ).a;
#else
    return textureSampleBias(
        pbr_bindings::base_color_texture, pbr_bindings::base_color_sampler, at, view.mip_bias,
    ).a;
#endif
}

// The coordinates of the base color texture, without the transform of the material.
fn base_uv(in: VertexOutput) -> vec2<f32> {
#ifdef VERTEX_UVS_B
#ifdef STANDARD_MATERIAL_BASE_COLOR_UV_B
    return in.uv_b;
#endif
#endif
#ifdef VERTEX_UVS_A
    return in.uv;
#else
    return vec2(0.0);
#endif
}
#endif

// Alpha of the mesh at a pixel, as the main pass has it.
fn surface_alpha(in: VertexOutput, material: pbr_types::StandardMaterial) -> f32 {
    var alpha = material.base_color.a;
#ifdef VERTEX_UVS
    let at = (material.uv_transform * vec3(base_uv(in), 1.0)).xy;
    if (material.flags & pbr_types::STANDARD_MATERIAL_FLAGS_BASE_COLOR_TEXTURE_BIT) != 0u {
        alpha *= texture_alpha(at, in.instance_index);
    }
#endif
#ifdef VERTEX_COLORS
    alpha *= in.color.a;
#endif
    return alpha;
}
#endif

@fragment
fn surface(in: VertexOutput, @builtin(front_facing) is_front: bool) -> Surface {
    let object = objects[min(in.instance_index, arrayLength(&objects) - 1u)];
    // -1: the back of a material that is lit from both sides.
    var side = 1.0;
#ifdef ALPHA_CUTOFF
    let material = material_of(in.instance_index);
    if surface_alpha(in, material) < bitcast<f32>(object.w) {
        discard;
    }
    let flags = material.flags;
    let lit = (flags & pbr_types::STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u;
    let double_sided = (flags & pbr_types::STANDARD_MATERIAL_FLAGS_DOUBLE_SIDED_BIT) != 0u;
    side = select(1.0, -1.0, lit && double_sided && !is_front);
#endif
    var normal = vec3(0.0);
#ifdef NORMAL_PREPASS
    normal = side * in.world_normal;
#endif
    return Surface(object.xy, vec4(0.5 * normal + 0.5, 1.0));
}
