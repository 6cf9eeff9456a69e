#define_import_path bevy_comics::cartoon::contact

// Contact shadows, marched through the depth prepass as the engine does, but without its
// noise: each pixel steps at the same places, so that the shadow is flat and stands still.

#import bevy_comics::cartoon::surface::Surface
#ifdef CONTACT_SHADOWS
#ifdef DEPTH_PREPASS
#import bevy_pbr::{
    mesh_view_bindings as view_bindings,
    raymarch,
    view_transformations::position_world_to_ndc,
}
#endif
#endif

// Four places in a pixel, of which no two are in the same row or column of a grid of 4 x 4. Those of
// the first half are opposite.
const PLACES: array<vec2<f32>, 4> = array(
    vec2(-0.125, -0.375), vec2(0.125, 0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125),
);

// The place of the surface at an offset in pixels.
fn place_at(s: Surface, offset: vec2<f32>) -> vec3<f32> {
    return s.position + offset.x * s.foot.position_x + offset.y * s.foot.position_y;
}

// What a surface leaves of a light that is this deep behind it, as a fraction of
// `ContactShadows::thickness`: nothing up to the half.
fn left_at(depth: f32) -> f32 {
    return clamp(2.0 * depth - 1.0, 0.0, 1.0);
}

#ifdef CONTACT_SHADOWS
#ifdef DEPTH_PREPASS
// What surfaces close by leave of a light at a place.
fn left_of_light(place: vec3<f32>, to_light: vec3<f32>) -> f32 {
    let settings = view_bindings::contact_shadows_settings;
    let size = vec2<f32>(textureDimensions(view_bindings::depth_prepass_texture));
    var march = raymarch::depth_ray_march_new_from_depth(size);
    raymarch::depth_ray_march_from_cs(&march, position_world_to_ndc(place));
    raymarch::depth_ray_march_to_ws(&march, place + to_light * settings.length);
    march.linear_steps = settings.linear_steps;
    march.depth_thickness_linear_z = settings.thickness;
    march.march_behind_surfaces = true;
    // The last step is at the end. Else the shadow would end elsewhere in each pixel, because the
    // number of steps depends on the length of the ray in pixels.
    march.jitter = 1.0;
    let found = raymarch::depth_ray_march_march(&march);
    return select(1.0, left_at(found.hit_penetration_frac), found.hit);
}

// 1 where no surface is close by in the direction of a light, else 0: the mean over a pixel, from two
// places, or from four if these differ.
fn contact_shadow(s: Surface, to_light: vec3<f32>) -> f32 {
    if view_bindings::contact_shadows_settings.linear_steps == 0u {
        return 1.0;
    }
    let first = left_of_light(place_at(s, PLACES[0]), to_light);
    let second = left_of_light(place_at(s, PLACES[1]), to_light);
    if first == second {
        return first;
    }
    let third = left_of_light(place_at(s, PLACES[2]), to_light);
    let fourth = left_of_light(place_at(s, PLACES[3]), to_light);
    return 0.25 * (first + second + third + fourth);
}
#endif
#endif
