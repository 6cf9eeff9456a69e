#define_import_path bevy_comics::toon::contact

// Contact shadows, marched through the depth prepass as the engine does, but without its
// noise: each pixel steps at the same places, so that the shadow is flat and stands still.

// The light that is left where a march found a surface, or none: 0 or 1. `penetration`: how deep behind
// that surface, in parts of its thickness. The engine's shadow fades over the second half of the
// thickness; this one ends in the middle of the fade.
fn contact_left(found: bool, penetration: f32) -> f32 {
    return select(1.0, step(0.75, penetration), found);
}

#ifdef CONTACT_SHADOWS
#ifdef DEPTH_PREPASS
#import bevy_pbr::{
    mesh_view_bindings as view_bindings,
    raymarch,
    view_transformations::position_world_to_ndc,
}

// 1 where no surface is close by in the direction of a light, else 0. What lies deeper behind the surface
// of the prepass than three quarters of `ContactShadows::thickness` does not count.
fn contact_shadow(position: vec3<f32>, to_light: vec3<f32>) -> f32 {
    let settings = view_bindings::contact_shadows_settings;
    if settings.linear_steps == 0u {
        return 1.0;
    }
    let size = vec2<f32>(textureDimensions(view_bindings::depth_prepass_texture));
    var march = raymarch::depth_ray_march_new_from_depth(size);
    raymarch::depth_ray_march_from_cs(&march, position_world_to_ndc(position));
    raymarch::depth_ray_march_to_ws(&march, position + to_light * settings.length);
    march.linear_steps = settings.linear_steps;
    march.depth_thickness_linear_z = settings.thickness;
    march.march_behind_surfaces = true;
    march.jitter = 0.5;
    let found = raymarch::depth_ray_march_march(&march);
    return contact_left(found.hit, found.hit_penetration_frac);
}
#endif
#endif
