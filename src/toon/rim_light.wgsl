#define_import_path bevy_comics::toon::rim_light

// The rim of a surface of the toon material. `rim_shader.rs` sets NO_DEPTH_LOADS.

#import bevy_comics::toon::{
    bindings::toon,
    rim::{facing_rim, is_behind, rim_side},
    specular::Specular,
    surface::{Surface, cosine_over_pixel},
}

#ifdef DEPTH_RIM
#ifndef NO_DEPTH_LOADS
#import bevy_pbr::{
    mesh_view_bindings::view,
    prepass_utils::prepass_depth,
    view_transformations::depth_ndc_to_view_z,
}

// The part of a pixel whose depth in the prepass is behind the surface, over all of its samples.
// `slope` is by how much the surface recedes up to there, over its distance.
fn behind_at(pixel: vec2<f32>, view_z: f32, slope: f32) -> f32 {
    let first = view.viewport.xy;
    let at = clamp(pixel, first, first + view.viewport.zw - 1.0);
#ifdef MULTISAMPLED
    let samples = #{SAMPLES}u;
#else
    let samples = 1u;
#endif
    var behind = 0.0;
    for (var k = 0u; k < samples; k++) {
        let z = depth_ndc_to_view_z(prepass_depth(vec4(at, 0.0, 0.0), k));
        behind += is_behind(z / view_z, slope);
    }
    return behind / f32(samples);
}

// 1 where the depth prepass is behind the surface at some pixels beside it, along its normal: mixed
// between the four pixels around that place, so that the rim has no steps where its border has none.
fn beside(s: Surface) -> f32 {
    let across = (view.view_from_world * vec4(s.normal, 0.0)).xy * vec2(1.0, -1.0);
    let long = length(across);
    if long < 1e-3 {
        return 0.0;
    }
    let into = vec3(view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z);
    let recedes = vec2(dot(into, s.foot.position_x), dot(into, s.foot.position_y));
    let reach = toon.rim.pixels * s.scale;
    let slope = reach * dot(recedes, across) / (long * s.view_z);
    let place = s.pixel + across * (reach / long);
    let corner = floor(place - 0.5) + 0.5;
    let part = place - corner;
    let low = mix(behind_at(corner, s.view_z, slope), behind_at(corner + vec2(1.0, 0.0), s.view_z, slope), part.x);
    let high = mix(behind_at(corner + vec2(0.0, 1.0), s.view_z, slope), behind_at(corner + 1.0, s.view_z, slope), part.x);
    return mix(low, high, part.y);
}
#endif
#endif

// 1 where the surface turns away from the eye.
fn facing(s: Surface) -> f32 {
    let width = cosine_over_pixel(s.foot, s.to_eye);
    return facing_rim(toon.rim, dot(s.normal, s.to_eye), width);
}

fn with_rim(color: vec3<f32>, s: Surface, specular: Specular) -> vec3<f32> {
    let rim = toon.rim;
#ifdef NO_DEPTH_LOADS
    let there = facing(s);
#else ifdef DEPTH_RIM
    let there = beside(s);
#else
    let there = facing(s);
#endif
    let side = rim_side(rim, dot(s.normal, specular.source.to_light));
    return mix(color, rim.color, there * side * rim.strength);
}
