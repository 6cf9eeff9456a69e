// The cartoon material in the forward pass. The outlines are drawn later ([CL] 2.3,
// Eq. 5).

#import bevy_pbr::{
    clustered_forward as clustering,
    decal::clustered::apply_decals,
    forward_io::{FragmentOutput, VertexOutput},
    mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT,
    mesh_view_bindings as view_bindings,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, main_pass_post_lighting_processing},
    pbr_types::{PbrInput, STANDARD_MATERIAL_FLAGS_UNLIT_BIT},
}
#ifdef VISIBILITY_RANGE_DITHER
#import bevy_pbr::pbr_functions::visibility_range_dither
#endif
#import bevy_comics::cartoon::{
    bindings::cartoon,
    indirect::{ambient, light_around},
    lamps::{clustered_light, directional_light, rect_light_at},
    reflect::PI,
    surface::{Arriving, Footprint, Surface},
}
#ifdef RAMP_PER_LIGHT
#import bevy_comics::cartoon::per_light::{Sum, add, reflected}
#else ifdef RAMP_SHARE
#import bevy_comics::cartoon::share::{Sum, add, reflected}
#else ifdef RAMP_BRIGHTEST
#import bevy_comics::cartoon::brightest::{Sum, add, reflected}
#else
#import bevy_comics::cartoon::two_shades::{Sum, add, reflected}
#endif

// Sum over the light sources.
fn add_lamps(
    sum: ptr<function, Sum>,
    s: Surface,
    ranges: clustering::ClusterableObjectIndexRanges,
) {
    for (var i = 0u; i < view_bindings::lights.n_directional_lights; i++) {
        add(sum, s, directional_light(i, s));
    }
    let end = ranges.first_reflection_probe_index_offset;
    for (var i = ranges.first_point_light_index_offset; i < end; i++) {
        let id = clustering::get_clusterable_object_id(i);
        let is_spot = i >= ranges.first_spot_light_index_offset;
        add(sum, s, clustered_light(id, is_spot, s, cartoon.light));
    }
    for (var i = 0u; i < view_bindings::lights.n_rect_lights; i++) {
        add(sum, s, rect_light_at(i, s, cartoon.light));
    }
}

fn surface_of(in: PbrInput, foot: Footprint) -> Surface {
    var s: Surface;
    s.position = in.world_position.xyz;
    s.normal = in.N;
    s.mesh_normal = in.world_normal;
    s.to_eye = in.V;
    s.foot = foot;
    s.roughness = in.material.perceptual_roughness;
    s.pixel = in.frag_coord.xy;
    s.view_z = dot(vec4(
        view_bindings::view.view_from_world[0].z,
        view_bindings::view.view_from_world[1].z,
        view_bindings::view.view_from_world[2].z,
        view_bindings::view.view_from_world[3].z,
    ), in.world_position);
    s.receives = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u && cartoon.light.projected > 0.0;
    return s;
}

fn cartoon_light(in: PbrInput, foot: Footprint) -> vec3<f32> {
    let s = surface_of(in, foot);
    let cluster = clustering::view_fragment_cluster_index(s.pixel, s.view_z, in.is_orthographic);
    var ranges = clustering::unpack_clusterable_object_index_ranges(cluster);
    // Light from all around. Its brighter side is one more light, without highlight.
    let around = light_around(s, cartoon.light, &ranges);
    var brighter: Arriving;
    brighter.color = around.more * in.diffuse_occlusion * PI;
    brighter.smooth_color = brighter.color;
    brighter.to_light = around.direction;
    brighter.to_highlight = around.direction;
    brighter.lit = 1.0;
    brighter.diffuse = 1.0;
    var even = (around.shade + ambient()) * in.diffuse_occlusion;
#ifdef LIGHTMAP
    even += in.lightmap_light;
#endif

    var sum: Sum;
    add_lamps(&sum, s, ranges);
    add(&sum, s, brighter);
    let base = in.material.base_color;
    // Colour of the highlight: the base colour of a metal; otherwise white at the
    // default reflectance of 0.5.
    let tint = mix(min(2.0 * in.material.reflectance, vec3(1.0)), base.rgb, in.material.metallic);
    let emissive = in.material.emissive;
    return reflected(sum, base.rgb, tint, even)
        + emissive.rgb * base.a * mix(1.0, view_bindings::view.exposure, emissive.a);
}

@fragment
fn fragment(vertex_output: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var in = vertex_output;
#ifdef VISIBILITY_RANGE_DITHER
    visibility_range_dither(in.position, in.visibility_range_dither);
#endif
    var pbr = pbr_input_from_standard_material(in, is_front);
    // Must be computed before alpha_discard: derivatives need all pixels.
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
