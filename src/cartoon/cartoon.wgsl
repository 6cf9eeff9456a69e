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
    indirect::{ambient, light_around},
    lamps::{clustered_light, directional_light, rect_light_at},
    light::{CartoonLight, facing, highlight},
    surface::{Arriving, Footprint, Surface, cosine_over_pixel},
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> cartoon: CartoonLight;

// Light that a surface reflects, before exposure. `color` is the light without the base
// colour of the surface, times pi; `shine` has the highlights, times pi.
struct Reflected {
    color: vec3<f32>,
    shine: vec3<f32>,
}

// Strength of the highlight of a light.
fn highlight_of(s: Surface, roughness: f32, to_highlight: vec3<f32>) -> f32 {
    let half_vector = normalize(to_highlight + s.to_eye);
    let width = cosine_over_pixel(s.foot, half_vector);
    return highlight(cartoon, roughness, saturate(dot(s.normal, half_vector)), width);
}

// Fraction of a light that its two shadows leave: 1 minus the stronger of them.
fn unshadowed(s: Surface, light: Arriving) -> f32 {
    let width = cosine_over_pixel(s.foot, light.to_light);
    let lit = facing(cartoon, dot(s.normal, light.to_light), width);
    let backface_shadow = (1.0 - lit) * cartoon.backface;
    let projected_shadow = (1.0 - light.lit) * cartoon.projected;
    return 1.0 - max(backface_shadow, projected_shadow);
}

fn add_light(sum: ptr<function, Reflected>, s: Surface, roughness: f32, light: Arriving) {
    let color = light.color * unshadowed(s, light);
    (*sum).color += color * light.diffuse;
    (*sum).shine += color * highlight_of(s, roughness, light.to_highlight);
}

// Sum over the light sources.
fn direct_light(s: Surface, roughness: f32, ranges: clustering::ClusterableObjectIndexRanges) -> Reflected {
    var sum = Reflected(vec3(0.0), vec3(0.0));
    for (var i = 0u; i < view_bindings::lights.n_directional_lights; i++) {
        add_light(&sum, s, roughness, directional_light(i, s));
    }
    for (var i = ranges.first_point_light_index_offset; i < ranges.first_reflection_probe_index_offset; i++) {
        let id = clustering::get_clusterable_object_id(i);
        let is_spot = i >= ranges.first_spot_light_index_offset;
        add_light(&sum, s, roughness, clustered_light(id, is_spot, s, cartoon));
    }
    for (var i = 0u; i < view_bindings::lights.n_rect_lights; i++) {
        add_light(&sum, s, roughness, rect_light_at(i, s, cartoon));
    }
    return sum;
}

fn surface_of(in: PbrInput, foot: Footprint) -> Surface {
    var s: Surface;
    s.position = in.world_position.xyz;
    s.normal = in.N;
    s.mesh_normal = in.world_normal;
    s.to_eye = in.V;
    s.foot = foot;
    s.pixel = in.frag_coord.xy;
    s.view_z = dot(vec4(
        view_bindings::view.view_from_world[0].z,
        view_bindings::view.view_from_world[1].z,
        view_bindings::view.view_from_world[2].z,
        view_bindings::view.view_from_world[3].z,
    ), in.world_position);
    s.receives = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u && cartoon.projected > 0.0;
    return s;
}

fn cartoon_light(in: PbrInput, foot: Footprint) -> vec3<f32> {
    let s = surface_of(in, foot);
    let cluster = clustering::view_fragment_cluster_index(s.pixel, s.view_z, in.is_orthographic);
    var ranges = clustering::unpack_clusterable_object_index_ranges(cluster);
    let direct = direct_light(s, in.material.perceptual_roughness, ranges);

    // Light from all around. Its brighter side is one more light, without highlight.
    let around = light_around(s, cartoon, &ranges);
    var brighter: Arriving;
    brighter.color = around.more;
    brighter.to_light = around.direction;
    brighter.lit = 1.0;
    var indirect = (around.shade + brighter.color * unshadowed(s, brighter) + ambient()) * in.diffuse_occlusion;
#ifdef LIGHTMAP
    indirect += in.lightmap_light;
#endif

    // As the standard material, whose diffuse reflection is k_d / pi.
    let base = in.material.base_color;
    // Colour of the highlight: the base colour of a metal; otherwise white at the
    // default reflectance of 0.5.
    let tint = mix(min(2.0 * in.material.reflectance, vec3(1.0)), base.rgb, in.material.metallic);
    let reflected = (base.rgb * direct.color + tint * direct.shine) / 3.14159265 + base.rgb * indirect;
    let exposure = view_bindings::view.exposure;
    let emissive = in.material.emissive;
    return exposure * reflected + emissive.rgb * base.a * mix(1.0, exposure, emissive.a);
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
