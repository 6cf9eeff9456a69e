#define_import_path bevy_comics::cartoon::rim_light

// The rim of a surface of the cartoon material.

#ifdef DEPTH_RIM
#import bevy_pbr::{
    mesh_view_bindings::view,
    prepass_utils::prepass_depth,
    view_transformations::depth_ndc_to_view_z,
}
#endif
#import bevy_comics::cartoon::{
    bindings::cartoon,
    light_rim::{facing_rim, is_behind, rim_side},
    shine::Shine,
    surface::{Surface, cosine_over_pixel},
}

#ifdef DEPTH_RIM
// 1 where the depth prepass is behind the surface at some pixels beside it, along its normal.
fn beside(s: Surface) -> f32 {
    let across = (view.view_from_world * vec4(s.normal, 0.0)).xy * vec2(1.0, -1.0);
    let long = length(across);
    if long < 1e-3 {
        return 0.0;
    }
    let size = view.viewport.zw;
    let into = vec3(view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z);
    let recedes = vec2(dot(into, s.foot.position_x), dot(into, s.foot.position_y));
    let slope = dot(recedes, across) / (long * s.view_z);
    var behind = 0.0;
    // Four places along the last pixel, whose mean is anti-aliased where the border is slanted.
    for (var k = 0; k < 4; k++) {
        let reach = cartoon.rim.pixels + 0.25 * f32(k) - 0.375;
        let at = clamp(s.pixel + across * (reach / long), view.viewport.xy, view.viewport.xy + size - 1.0);
        let z = depth_ndc_to_view_z(prepass_depth(vec4(at, 0.0, 0.0), 0u));
        behind += 0.25 * is_behind(z / s.view_z, slope * reach);
    }
    return behind;
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
