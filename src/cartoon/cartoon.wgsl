// The cartoon material in the forward pass. The outlines are drawn later ([CL] 2.3,
// Eq. 5).

#import bevy_pbr::{
    clustered_forward as clustering,
    decal::clustered::apply_decals,
    forward_io::{FragmentOutput, VertexOutput},
    mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT,
    mesh_view_bindings as view_bindings,
    mesh_view_types,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, main_pass_post_lighting_processing},
    pbr_types::{PbrInput, STANDARD_MATERIAL_FLAGS_UNLIT_BIT},
    shadows,
}
#ifdef VISIBILITY_RANGE_DITHER
#import bevy_pbr::pbr_functions::visibility_range_dither
#endif
#import bevy_comics::cartoon::light::{
    CartoonLight, cone, facing, flat_falloff, highlight, sharpen, slope_over_pixel,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> cartoon: CartoonLight;

// Screen-space derivatives of world position and normal. Must be computed before
// alpha_discard.
struct Footprint {
    position_x: vec3<f32>,
    position_y: vec3<f32>,
    normal_x: vec3<f32>,
    normal_y: vec3<f32>,
}

// k_d + specular of one light. Does not depend on shadows.
fn reflected(in: PbrInput, foot: Footprint, to_light: vec3<f32>) -> vec3<f32> {
    let base = in.material.base_color.rgb;
    let metallic = in.material.metallic;
    let half_vector = normalize(to_light + in.V);
    let width = abs(dot(foot.normal_x, half_vector)) + abs(dot(foot.normal_y, half_vector));
    let shine = highlight(cartoon, in.material.perceptual_roughness, saturate(dot(in.N, half_vector)), width);
    // Colour of the highlight: the base colour of a metal; otherwise white at the
    // default reflectance of 0.5.
    let tint = mix(min(2.0 * in.material.reflectance, vec3(1.0)), base, metallic);
    return base + shine * tint;
}

// Fraction of a light that arrives: 1 minus the stronger of its two shadows.
// `projected` is the value of the shadow map, 1 where the light arrives.
fn unshadowed(in: PbrInput, foot: Footprint, to_light: vec3<f32>, projected: f32) -> f32 {
    let width = abs(dot(foot.normal_x, to_light)) + abs(dot(foot.normal_y, to_light));
    let lit = facing(cartoon, dot(in.N, to_light), width);
    let backface_shadow = (1.0 - lit) * cartoon.backface;
    let projected_shadow = (1.0 - projected) * cartoon.projected;
    return 1.0 - max(backface_shadow, projected_shadow);
}

const DIRECTIONAL: u32 = 0u;
const POINT: u32 = 1u;
const SPOT: u32 = 2u;

// The shadow map of a light of this `kind` at a place, 1 where the light arrives.
fn shadow_at(kind: u32, id: u32, in: PbrInput, at: vec3<f32>, view_z: f32) -> f32 {
    let place = vec4(at, 1.0);
    let pixel = in.frag_coord.xy;
    if kind == DIRECTIONAL {
        return shadows::fetch_directional_shadow(id, place, in.world_normal, view_z, pixel);
    }
    if kind == POINT {
        return shadows::fetch_point_shadow(id, place, in.world_normal, pixel);
    }
    let near = view_bindings::clustered_lights.data[id].shadow_map_near_z;
    return shadows::fetch_spot_shadow(id, place, in.world_normal, near, pixel);
}

// The same with a hard edge.
fn hard_shadow(kind: u32, id: u32, in: PbrInput, foot: Footprint, view_z: f32) -> f32 {
    let at = in.world_position.xyz;
    let shadow = shadow_at(kind, id, in, at, view_z);
    if shadow <= 0.0 || shadow >= 1.0 {
        return shadow;
    }
    return sharpen(shadow, slope_over_pixel(
        shadow,
        shadow_at(kind, id, in, at + foot.position_x, view_z),
        shadow_at(kind, id, in, at + foot.position_y, view_z),
    ));
}

// Fraction of a spot light that its cone lets through. `pixel`: the size of a pixel over
// the distance from the light.
fn spot_cone(id: u32, to_light: vec3<f32>, pixel: f32) -> f32 {
    let light = &view_bindings::clustered_lights.data[id];
    var axis = vec3((*light).light_custom_data.x, 0.0, (*light).light_custom_data.y);
    axis.y = sqrt(max(0.0, 1.0 - axis.x * axis.x - axis.z * axis.z));
    if ((*light).flags & mesh_view_types::POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE) != 0u {
        axis.y = -axis.y;
    }
    let inside = dot(-axis, to_light) * (*light).light_custom_data.z + (*light).light_custom_data.w;
    return cone(inside, pixel * (*light).light_custom_data.z);
}

// Light of a directional light that a surface reflects.
fn directional_light(id: u32, in: PbrInput, foot: Footprint, view_z: f32, receives: bool) -> vec3<f32> {
    let light = &view_bindings::lights.directional_lights[id];
    let to_light = (*light).direction_to_light.xyz;
    var shadow = 1.0;
    if receives && ((*light).flags & mesh_view_types::DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
        shadow = hard_shadow(DIRECTIONAL, id, in, foot, view_z);
    }
    return (*light).color.rgb * unshadowed(in, foot, to_light, shadow) * reflected(in, foot, to_light);
}

// Light of a point light or spot light that a surface reflects.
fn clustered_light(id: u32, is_spot: bool, in: PbrInput, foot: Footprint, view_z: f32, receives: bool) -> vec3<f32> {
    let light = &view_bindings::clustered_lights.data[id];
    let offset = (*light).position_radius.xyz - in.world_position.xyz;
    let to_light = normalize(offset);
    // Luminous intensity. Times the falloff, it is the illuminance of a surface
    // that faces the light.
    var color = (*light).color_inverse_square_range.rgb;
    let brightest = max(color.r, max(color.g, color.b)) * view_bindings::view.exposure;
    let pixel = length(foot.position_x) + length(foot.position_y);
    color *= flat_falloff(cartoon, dot(offset, offset), (*light).color_inverse_square_range.w, brightest, pixel);
    if is_spot {
        color *= spot_cone(id, to_light, pixel * inverseSqrt(dot(offset, offset)));
    }
    var shadow = 1.0;
    if receives && ((*light).flags & mesh_view_types::POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
        shadow = hard_shadow(select(POINT, SPOT, is_spot), id, in, foot, view_z);
    }
    return color * unshadowed(in, foot, to_light, shadow) * reflected(in, foot, to_light);
}

fn cartoon_light(in: PbrInput, foot: Footprint) -> vec3<f32> {
    let receives = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u && cartoon.projected > 0.0;
    let view_z = dot(vec4(
        view_bindings::view.view_from_world[0].z,
        view_bindings::view.view_from_world[1].z,
        view_bindings::view.view_from_world[2].z,
        view_bindings::view.view_from_world[3].z,
    ), in.world_position);
    var light_sum = vec3(0.0);
    for (var i = 0u; i < view_bindings::lights.n_directional_lights; i++) {
        light_sum += directional_light(i, in, foot, view_z, receives);
    }
    let cluster = clustering::view_fragment_cluster_index(in.frag_coord.xy, view_z, in.is_orthographic);
    let ranges = clustering::unpack_clusterable_object_index_ranges(cluster);
    for (var i = ranges.first_point_light_index_offset; i < ranges.first_reflection_probe_index_offset; i++) {
        let id = clustering::get_clusterable_object_id(i);
        light_sum += clustered_light(id, i >= ranges.first_spot_light_index_offset, in, foot, view_z, receives);
    }

    // As the standard material, whose diffuse reflection is k_d / pi.
    let direct = light_sum / 3.14159265;
    let base = in.material.base_color.rgb;
    var indirect = view_bindings::lights.ambient_color.rgb * base * in.diffuse_occlusion;
#ifdef LIGHTMAP
    indirect += in.lightmap_light * base;
#endif
    let exposure = view_bindings::view.exposure;
    let emissive = in.material.emissive;
    return exposure * (direct + indirect) + emissive.rgb * mix(1.0, exposure, emissive.a);
}

@fragment
fn fragment(vertex_output: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var in = vertex_output;
#ifdef VISIBILITY_RANGE_DITHER
    visibility_range_dither(in.position, in.visibility_range_dither);
#endif
    var pbr = pbr_input_from_standard_material(in, is_front);
    var foot: Footprint;
    foot.position_x = dpdx(pbr.world_position.xyz);
    foot.position_y = dpdy(pbr.world_position.xyz);
    foot.normal_x = dpdx(pbr.N);
    foot.normal_y = dpdy(pbr.N);
    pbr.material.base_color = alpha_discard(pbr.material, pbr.material.base_color);
    apply_decals(&pbr);

    var out: FragmentOutput;
    if (pbr.material.flags & STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u {
        out.color = vec4(cartoon_light(pbr, foot), pbr.material.base_color.a);
    } else {
        out.color = pbr.material.base_color;
    }
    out.color = main_pass_post_lighting_processing(pbr, out.color);
    return out;
}
