#define_import_path bevy_comics::toon::light_fraction

// One ramp over the fraction of all light that arrives: `RampMode::LightFraction`.

#import bevy_comics::toon::{
    bindings::toon,
    ramp_light::{angle_of, detail_of, full_tone, ramp_of, shadow_strength, tone_at, toned},
    reflect::PI,
    surface::{Arriving, Surface},
    ambient::brightness,
}
#import bevy_pbr::mesh_view_bindings::view

struct Sum {
    // Light times pi before shadows, without rings.
    color: vec3<f32>,
    // Brightness of `color`, and of the same light in rings.
    bright: f32,
    ringed: f32,
    // Brightness of what arrives of the light, without the two lights below, and its change
    // over a pixel.
    arriving: f32,
    width: f32,
    // The two strongest lights with the border of a shadow in this pixel: brightness, and how
    // much of the light arrives.
    first: vec2<f32>,
    second: vec2<f32>,
#ifdef RAMP_DETAIL
    // Detail of the ramp, times the brightness of the lights.
    detail: f32,
#endif
}

fn add(sum: ptr<function, Sum>, s: Surface, light: Arriving, left: f32) {
    let ringed = light.color * light.diffuse;
    let color = light.smooth_color * light.diffuse;
    let bright = max(brightness(color), 0.0);
    let angle = angle_of(s, light);
    (*sum).color += color;
    (*sum).ringed += max(brightness(ringed), 0.0);
    (*sum).bright += bright;
    (*sum).width += bright * angle.y;
#ifdef RAMP_DETAIL
    (*sum).detail += bright * detail_of(s, light.to_light);
#endif
    var part = vec2(bright * max(angle.x, 0.0), light.lit);
    if part.y > 0.0 && part.y < 1.0 {
        if part.x > (*sum).first.x {
            let weaker = (*sum).first;
            (*sum).first = part;
            part = weaker;
        }
        if part.x > (*sum).second.x {
            let weaker = (*sum).second;
            (*sum).second = part;
            part = weaker;
        }
    }
    (*sum).arriving += part.x * part.y;
}

// The tone of the fraction. A border of a shadow mixes the tones on its sides.
fn tone_of_fraction(sum: Sum) -> vec3<f32> {
    let whole = 1.0 / max(sum.bright, 1e-30);
#ifdef RAMP_DETAIL
    let detail = sum.detail * whole;
#else
    let detail = 1.0;
#endif
    let ramp = ramp_of(detail);
    let fraction = sum.arriving * whole;
    let width = sum.width * whole;
    let a = sum.first.x * whole;
    let b = sum.second.x * whole;
    var color = tone_at(ramp, fraction, width);
    if a > 0.0 {
        color = mix(color, tone_at(ramp, fraction + a, width), sum.first.y);
    }
    if b > 0.0 {
        let beside = mix(
            tone_at(ramp, fraction + b, width),
            tone_at(ramp, fraction + a + b, width),
            sum.first.y,
        );
        color = mix(color, beside, sum.second.y);
    }
    let strength = shadow_strength();
    if strength >= 1.0 {
        return color;
    }
    return mix(full_tone(ramp), color, strength);
}

fn reflected(sum: Sum, base: vec3<f32>, around: vec3<f32>, specular: vec3<f32>) -> vec3<f32> {
    let direct = view.exposure * sum.color / PI;
    let even = view.exposure * around;
    // All light has the brightness 1, times what is kept of its own, which falls off in rings.
    let evenly = brightness(even);
    let all = max(brightness(direct) + evenly, 1e-7);
    let ringed = max(view.exposure * sum.ringed / PI + evenly, 1e-7);
    let strength = pow(ringed, toon.ramp.keep_intensity) / all;
    let colors = toned(base, tone_of_fraction(sum), direct, even);
    return strength * (colors + view.exposure * specular / PI);
}
