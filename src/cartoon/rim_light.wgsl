#define_import_path bevy_comics::cartoon::rim_light

// The rim of a surface of the cartoon material.

#ifdef DEPTH_RIM
#ifdef MULTISAMPLED
#import bevy_pbr::mesh_view_bindings::depth_prepass_texture
#endif
#import bevy_pbr::{
    mesh_view_bindings::view,
    prepass_utils::prepass_depth,
    view_transformations::depth_ndc_to_view_z,
}
#endif
#import bevy_comics::cartoon::{
    bindings::cartoon,
    light_rim::{facing_rim, is_behind, rim_side, sharper},
    shine::Shine,
    surface::{Surface, cosine_over_pixel},
}

#ifdef DEPTH_RIM
// How much of a pixel of the depth prepass is behind the surface, which recedes by `slope` of its
// distance up to there.
fn behind_at(s: Surface, pixel: vec2<f32>, slope: f32) -> f32 {
    let at = clamp(pixel, view.viewport.xy, view.viewport.xy + view.viewport.zw - 1.0);
#ifdef MULTISAMPLED
    let samples = textureNumSamples(depth_prepass_texture);
#else
    let samples = 1u;
#endif
    var behind = 0.0;
    for (var k = 0u; k < samples; k++) {
        let z = depth_ndc_to_view_z(prepass_depth(vec4(at, 0.0, 0.0), k));
        behind += is_behind(z / s.view_z, slope);
    }
    return behind / f32(samples);
}

// 1 where the depth prepass is behind the surface at a distance in pixels, along the normal of the
// mesh: a normal map would make the rim ragged.
fn beside(s: Surface) -> f32 {
    let across = (view.view_from_world * vec4(s.mesh_normal, 0.0)).xy * vec2(1.0, -1.0);
    let long = length(across);
    if long < 1e-3 {
        return 0.0;
    }
    let into = vec3(view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z);
    let recedes = vec2(dot(into, s.foot.position_x), dot(into, s.foot.position_y));
    let slope = cartoon.rim.pixels * dot(recedes, across) / (long * s.view_z);
    // Between the four pixels around the place, so that the border is anti-aliased.
    let place = s.pixel + across * (cartoon.rim.pixels / long) - 0.5;
    let corner = floor(place);
    let part = place - corner;
    let above = mix(behind_at(s, corner, slope), behind_at(s, corner + vec2(1.0, 0.0), slope), part.x);
    let below = mix(
        behind_at(s, corner + vec2(0.0, 1.0), slope),
        behind_at(s, corner + vec2(1.0, 1.0), slope),
        part.x,
    );
    return sharper(mix(above, below, part.y));
}
#endif

fn with_rim(color: vec3<f32>, s: Surface, shine: Shine) -> vec3<f32> {
    let rim = cartoon.rim;
#ifdef DEPTH_RIM
    let there = beside(s);
#else
    let width = cosine_over_pixel(s.foot, s.to_eye);
    let there = facing_rim(rim, dot(s.normal, s.to_eye), width);
#endif
    let side = rim_side(rim, dot(s.normal, shine.source.to_light));
    return mix(color, rim.color, there * side * rim.strength);
}
