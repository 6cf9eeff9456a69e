// The toon material in the forward pass. The outlines are drawn later ([CL] 2.3,
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
#import bevy_comics::toon::{
    bindings::toon,
    indirect::{ambient, light_around},
    lights::{clustered_light, directional_light, rect_light_at},
    reflect::{PI, unshadowed},
    specular::{Specular, specular_of, with_light},
    surface::{Arriving, Footprint, Surface, bias_of},
}
#ifdef THRESHOLD_MAP
#import bevy_pbr::pbr_bindings::base_color_sampler
#endif
#ifdef RAMP_PER_LIGHT
#import bevy_comics::toon::per_light::{Sum, add, reflected}
#else ifdef RAMP_LIGHT_FRACTION
#import bevy_comics::toon::light_fraction::{Sum, add, reflected}
#else ifdef RAMP_BRIGHTEST
#import bevy_comics::toon::brightest::{Sum, add, reflected}
#else
#import bevy_comics::toon::two_shades::{Sum, add, reflected}
#endif

#ifdef DETAIL_DEPTH
#import bevy_comics::toon::detail::detail_by_depth
#endif
#ifdef DETAIL_FOCUS
#import bevy_comics::toon::detail::detail_in_focus
#endif
#ifdef DETAIL_RIM
#import bevy_comics::toon::detail::detail_of_rim
#endif
#ifdef DETAIL_VISIBLE
#import bevy_comics::toon::visible::{ViewRange, detail_in_range}
#endif
#ifdef RIM
#import bevy_comics::toon::rim_light::with_rim
#endif
#ifdef HATCHED
#import bevy_comics::toon::{
    hatch::{arriving_fraction, rest_surface},
    hatch_light::{HatchPlace, with_hatching},
    ambient::brightness,
}
#endif

#ifdef PROXY
#import bevy_pbr::pbr_types::STANDARD_MATERIAL_FLAGS_DOUBLE_SIDED_BIT
#import bevy_comics::toon::proxy::{between, proxy_amount, unit_or_none}
#endif

#ifdef THRESHOLD_MAP
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var threshold_map: texture_2d<f32>;

// The bias that the map gives, read as the base color is. All pixels must run it: the mip level is
// found with derivatives.
fn mapped_bias(pbr: PbrInput, in: VertexOutput) -> f32 {
#ifdef STANDARD_MATERIAL_BASE_COLOR_UV_B
    let uv = in.uv_b;
#else
    let uv = in.uv;
#endif
    let at = (pbr.material.uv_transform * vec3(uv, 1.0)).xy;
    let mip_bias = view_bindings::view.mip_bias;
    return bias_of(textureSampleBias(threshold_map, base_color_sampler, at, mip_bias).r);
}
#endif

// What all lights give.
struct Lit {
    sum: Sum,
    specular: Specular,
#ifdef HATCHED
    // As if all of the light arrived.
    whole: Sum,
#endif
}

#ifdef HATCHED
// With all of a light more, as where a surface faces it.
fn with_whole(sum: Sum, s: Surface, light: Arriving) -> Sum {
    var all = sum;
    var towards = s;
    towards.bias = 2.0;
    towards.foot.bias = vec2(0.0);
    var bare = light;
    bare.lit = 1.0;
    add(&all, towards, bare, 1.0);
    return all;
}
#endif

// With one light source more.
fn lit_by(lit: Lit, s: Surface, light: Arriving) -> Lit {
    var sum = lit.sum;
    let left = unshadowed(s, light);
    add(&sum, s, light, left);
#ifdef RAMP_LIGHT_FRACTION
    let color = light.smooth_color;
#else
    let color = light.color;
#endif
    var next = lit;
    next.sum = sum;
    next.specular = with_light(lit.specular, s, light, color, left);
#ifdef HATCHED
    next.whole = with_whole(lit.whole, s, light);
#endif
    return next;
}

// Sum over the light sources.
fn add_lights(
    lit: ptr<function, Lit>,
    s: Surface,
    ranges: clustering::ClusterableObjectIndexRanges,
) {
    for (var i = 0u; i < view_bindings::lights.n_directional_lights; i++) {
        *lit = lit_by(*lit, s, directional_light(i, s));
    }
    let spots = ranges.first_spot_light_index_offset;
    for (var i = ranges.first_point_light_index_offset; i < spots; i++) {
        let id = clustering::get_clusterable_object_id(i);
        *lit = lit_by(*lit, s, clustered_light(id, false, s, toon.light));
    }
    for (var i = spots; i < ranges.first_reflection_probe_index_offset; i++) {
        let id = clustering::get_clusterable_object_id(i);
        *lit = lit_by(*lit, s, clustered_light(id, true, s, toon.light));
    }
    for (var i = 0u; i < view_bindings::lights.n_rect_lights; i++) {
        *lit = lit_by(*lit, s, rect_light_at(i, s, toon.light));
    }
}

// How much detail of its ramp a surface shows.
fn detail_at(s: Surface) -> f32 {
#ifdef DETAIL_DEPTH
    return detail_by_depth(toon.detail, -s.view_z);
#else ifdef DETAIL_FOCUS
    return detail_in_focus(toon.detail, -s.view_z);
#else ifdef DETAIL_RIM
    return detail_of_rim(toon.detail, dot(s.normal, s.to_eye));
#else
    return toon.detail.number;
#endif
}

// What vertices and the threshold map say of a surface; 0 where they say nothing.
struct OwnData {
    tangent: vec3<f32>,
    bias: f32,
#ifdef DETAIL_VISIBLE
    range: ViewRange,
#endif
#ifdef VIEW_SCALE
    scale: f32,
#endif
#ifdef HATCHED
    hatch: HatchPlace,
#endif
}

fn surface_of(in: PbrInput, foot: Footprint, own: OwnData) -> Surface {
    var s: Surface;
    s.position = in.world_position.xyz;
    s.normal = in.N;
    s.mesh_normal = in.world_normal;
    s.to_eye = in.V;
    s.foot = foot;
    s.roughness = in.material.perceptual_roughness;
    s.pixel = in.frag_coord.xy;
    s.view_z = view_z_of(in.world_position);
    let to_eye = view_bindings::view.world_position - s.position;
    s.per_eye_distance = select(inverseSqrt(max(dot(to_eye, to_eye), 1e-8)), 0.0, in.is_orthographic);
    s.tangent = own.tangent;
    s.bias = own.bias;
#ifdef VIEW_SCALE
    s.scale = own.scale;
#endif
#ifdef DETAIL_VISIBLE
    s.detail = detail_in_range(own.range, in.frag_coord.z, -s.view_z);
#else
    s.detail = detail_at(s);
#endif
    s.receives = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u && toon.light.cast_shadow > 0.0;
    return s;
}

fn toon_light(in: PbrInput, foot: Footprint, own: OwnData) -> vec3<f32> {
    let s = surface_of(in, foot, own);
    let cluster = clustering::view_fragment_cluster_index(s.pixel, s.view_z, in.is_orthographic);
    var ranges = clustering::unpack_clusterable_object_index_ranges(cluster);
    // Light from all around. Its brighter side is one more light, without highlight.
    let around = light_around(s, toon.light, &ranges);
    var even = (around.shade + ambient()) * in.diffuse_occlusion;
#ifdef LIGHTMAP
    even += in.lightmap_light;
#endif

    var lit: Lit;
    add_lights(&lit, s, ranges);
#ifdef ENVIRONMENT
    var brighter: Arriving;
    brighter.color = around.more * in.diffuse_occlusion * PI;
    brighter.smooth_color = brighter.color;
    brighter.to_light = around.direction;
    brighter.to_highlight = around.direction;
    brighter.lit = 1.0;
    brighter.diffuse = 1.0;
    var sum = lit.sum;
    add(&sum, s, brighter, unshadowed(s, brighter));
    lit.sum = sum;
#ifdef HATCHED
    lit.whole = with_whole(lit.whole, s, brighter);
#endif
#endif
    let base = in.material.base_color;
    // Color of the highlight: the base color of a metal; otherwise white at the
    // default reflectance of 0.5.
    let tint = mix(min(2.0 * in.material.reflectance, vec3(1.0)), base.rgb, in.material.metallic);
    var color = reflected(lit.sum, base.rgb, even, tint * specular_of(lit.specular, s));
#ifdef HATCHED
    let arriving = brightness(reflected(lit.sum, vec3(1.0), even, vec3(0.0)));
    let all = brightness(reflected(lit.whole, vec3(1.0), even, vec3(0.0)));
    color = with_hatching(color, arriving_fraction(arriving, all), own.hatch);
#endif
#ifdef RIM
    color = with_rim(color, s, lit.specular);
#endif
    let emissive = in.material.emissive;
    return color + emissive.rgb * base.a * mix(1.0, view_bindings::view.exposure, emissive.a);
}

// Distance along the view axis, negative.
fn view_z_of(world_position: vec4<f32>) -> f32 {
    return dot(vec4(
        view_bindings::view.view_from_world[0].z,
        view_bindings::view.view_from_world[1].z,
        view_bindings::view.view_from_world[2].z,
        view_bindings::view.view_from_world[3].z,
    ), world_position);
}

// Outputs of the vertex shader besides `VertexOutput` of the engine, see vertex.wgsl.
struct MoreInput {
    @builtin(front_facing) is_front: bool,
#ifdef HATCH_REST
    @location(8) rest_place: vec3<f32>,
    @location(9) rest_normal: vec3<f32>,
#endif
#ifdef PROXY_NORMAL
    @location(10) other_normal: vec3<f32>,
#endif
#ifdef DETAIL_VISIBLE
    @location(11) @interpolate(flat) range_ends: vec4<f32>,
    @location(12) @interpolate(flat) range_scale: vec4<f32>,
#endif
#ifdef VIEW_SCALE
    @location(13) @interpolate(flat) view_scale: f32,
#endif
}

#ifdef PROXY
// The normal between that of the mesh and that of the form.
fn shaded_normal(pbr: PbrInput, more: MoreInput) -> vec3<f32> {
#ifdef PROXY_NORMAL
    var other = unit_or_none(more.other_normal);
#else
    let other = vec3(0.0, 1.0, 0.0);
#endif
#ifdef PROXY_SMOOTHED
    // Of a surface with two sides, that of the side that is seen.
    let sided = (pbr.material.flags & STANDARD_MATERIAL_FLAGS_DOUBLE_SIDED_BIT) != 0u;
    other = select(other, -other, sided && !more.is_front);
#endif
    return between(pbr.N, other, proxy_amount(toon.proxy, -view_z_of(pbr.world_position)));
}
#endif

// Both functions need all pixels: derivatives.
fn footprint_of(pbr: PbrInput) -> Footprint {
    var foot: Footprint;
    foot.position_x = dpdx(pbr.world_position.xyz);
    foot.position_y = dpdy(pbr.world_position.xyz);
    foot.normal_x = dpdx(pbr.N);
    foot.normal_y = dpdy(pbr.N);
    return foot;
}

fn own_data(pbr: PbrInput, in: VertexOutput, more: MoreInput) -> OwnData {
    var own: OwnData;
#ifdef VERTEX_TANGENTS
    own.tangent = in.world_tangent.xyz;
#endif
#ifdef VERTEX_THRESHOLD
    own.bias = bias_of(in.color.a);
#endif
#ifdef THRESHOLD_MAP
    own.bias += mapped_bias(pbr, in);
#endif
#ifdef DETAIL_VISIBLE
    own.range = ViewRange(more.range_ends, more.range_scale);
#endif
#ifdef VIEW_SCALE
    own.scale = more.view_scale;
#endif
#ifdef HATCHED
    own.hatch.scale = more.view_scale;
    own.hatch.pixel = in.position.xy;
#ifdef VERTEX_UVS_A
    own.hatch.uv = in.uv;
    own.hatch.right = dpdx(in.uv);
    own.hatch.down = dpdy(in.uv);
#endif
#endif
#ifdef HATCH_REST
    let place = more.rest_place;
    own.hatch.rest = rest_surface(place, dpdx(place), dpdy(place), more.rest_normal);
#endif
    return own;
}

@fragment
fn fragment(vertex_output: VertexOutput, more: MoreInput) -> FragmentOutput {
    var in = vertex_output;
#ifdef VISIBILITY_RANGE_DITHER
    visibility_range_dither(in.position, in.visibility_range_dither);
#endif
    var pbr = pbr_input_from_standard_material(in, more.is_front);
#ifdef PROXY
    pbr.N = shaded_normal(pbr, more);
#endif
    // Must be computed before alpha_discard: derivatives need all pixels.
    var foot = footprint_of(pbr);
    let own = own_data(pbr, in, more);
#ifdef THRESHOLD
    foot.bias = vec2(dpdx(own.bias), dpdy(own.bias));
#endif
    pbr.material.base_color = alpha_discard(pbr.material, pbr.material.base_color);
    apply_decals(&pbr);

    var out: FragmentOutput;
    // Not in a branch: browsers cannot know that all pixels would take the same one, and shadows take
    // derivatives.
    let light = toon_light(pbr, foot, own);
    let is_unlit = (pbr.material.flags & STANDARD_MATERIAL_FLAGS_UNLIT_BIT) != 0u;
    let base = pbr.material.base_color;
    out.color = vec4(select(light, base.rgb, is_unlit), base.a);
    out.color = main_pass_post_lighting_processing(pbr, out.color);
    return out;
}
