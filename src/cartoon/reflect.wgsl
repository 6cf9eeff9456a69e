#define_import_path bevy_comics::cartoon::reflect

// What a surface of the cartoon material reflects of one light.

#import bevy_comics::cartoon::{
    bindings::cartoon,
    light::{facing, highlight},
    surface::{Arriving, Surface, cosine_over_pixel},
}

const PI: f32 = 3.14159265;

// Fraction of a light that its two shadows leave: 1 minus the stronger of them.
fn unshadowed(s: Surface, light: Arriving) -> f32 {
    let width = cosine_over_pixel(s.foot, light.to_light);
    let lit = facing(cartoon.light, dot(s.normal, light.to_light), width);
    let backface_shadow = (1.0 - lit) * cartoon.light.backface;
    let projected_shadow = (1.0 - light.lit) * cartoon.light.projected;
    return 1.0 - max(backface_shadow, projected_shadow);
}

// Highlight of a light, as a multiple of it, without the colour of the surface.
fn highlight_of(s: Surface, light: Arriving) -> f32 {
    let half_vector = normalize(light.to_highlight + s.to_eye);
    let width = cosine_over_pixel(s.foot, half_vector);
    let n_dot_h = saturate(dot(s.normal, half_vector));
    let strength = highlight(cartoon.light, s.roughness, n_dot_h, width);
    return light.shine * strength * unshadowed(s, light);
}
