#define_import_path bevy_comics::toon::reflect

// What a surface of the toon material reflects of one light.

#import bevy_comics::toon::{
    bindings::toon,
    light::{facing, highlight},
    surface::{Arriving, Surface, biased_cosine, biased_over_pixel, cosine_over_pixel, half_way},
}

const PI: f32 = 3.14159265;

// Fraction of a light that its two shadows leave: 1 minus the stronger of them.
fn unshadowed(s: Surface, light: Arriving) -> f32 {
    let width = biased_over_pixel(s, light.to_light);
    let lit = facing(toon.light, biased_cosine(s, light.to_light), width);
    let form_shadow = (1.0 - lit) * toon.light.form_shadow;
    let cast_shadow = (1.0 - light.lit) * toon.light.cast_shadow;
    return 1.0 - max(form_shadow, cast_shadow);
}

// Highlight of a light, as a multiple of it, without the color of the surface. `left` is what
// shadows leave of the light.
fn highlight_of(s: Surface, light: Arriving, left: f32) -> f32 {
    let most = light.specular * left;
    if min(most, toon.light.highlight) <= 0.0 {
        return 0.0;
    }
    let half_vector = half_way(light.to_highlight, s.to_eye);
    let width = cosine_over_pixel(s.foot, half_vector);
    let n_dot_h = saturate(dot(s.normal, half_vector));
    return most * highlight(toon.light, s.roughness, n_dot_h, width);
}
