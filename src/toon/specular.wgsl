#define_import_path bevy_comics::toon::specular

// The highlights of all lights. The brightest light may draw a shape instead, see `StylizedHighlight`.

#import bevy_comics::toon::{
    bindings::toon,
    reflect::highlight_of,
    surface::{Arriving, Source, Surface},
    ambient::brightness,
}
#ifdef STYLIZED_HIGHLIGHT
#import bevy_comics::toon::stylized_highlight_light::stylized_highlight_of
#endif

struct Specular {
    // Light times pi of the highlights.
    color: vec3<f32>,
#ifdef KEY_LIGHT
    // The brightest light: its brightness, and that of the next one; what it gives where it is
    // reflected; its plain highlight; and where it comes from.
    bright: f32,
    next: f32,
    left: vec3<f32>,
    disc: f32,
    source: Source,
#endif
}

// With one light more. `color` is its light, `left` what shadows leave of it.
fn with_light(before: Specular, s: Surface, light: Arriving, color: vec3<f32>, left: f32) -> Specular {
    var sum = before;
    let disc = highlight_of(s, light, left);
#ifdef KEY_LIGHT
    let bright = brightness(light.smooth_color) * light.specular;
    if bright > sum.bright {
        sum.color += sum.left * sum.disc;
        sum.next = sum.bright;
        sum.bright = bright;
        sum.left = color;
        sum.disc = disc;
        sum.source = Source(light.to_light, light.to_highlight, light.per_distance);
#ifdef STYLIZED_HIGHLIGHT
        sum.left *= left;
        sum.disc = disc / max(left, 1e-6);
#endif
    } else {
        sum.color += color * disc;
        sum.next = max(sum.next, bright);
    }
#else
    sum.color += color * disc;
#endif
    return sum;
}

// The light of all highlights, times pi.
fn specular_of(specular: Specular, s: Surface) -> vec3<f32> {
#ifdef KEY_LIGHT
    var highlight = specular.disc;
#ifdef STYLIZED_HIGHLIGHT
    // Where another light is nearly as bright, both draw plain highlights.
    let alone = clamp(10.0 * (1.0 - specular.next / max(specular.bright, 1e-30)), 0.0, 1.0);
    if alone > 0.0 {
        highlight = mix(highlight, stylized_highlight_of(s, specular.source), alone);
    }
#endif
    return specular.color + specular.left * highlight;
#else
    return specular.color;
#endif
}
