#define_import_path bevy_comics::toon::per_light

// A ramp for each light: `RampMode::PerLight`.

#import bevy_comics::toon::{
    ramp_light::{angle_of, detail_of, tone_of},
    reflect::PI,
    surface::{Arriving, Surface},
    ambient::brightness,
}
#import bevy_pbr::mesh_view_bindings::view

struct Sum {
    // Light times pi in its tones.
    color: vec3<f32>,
#ifdef RAMP_ABSOLUTE
    // The brightness of the light without them; and tones, times the brightness of their lights.
    bright: f32,
    tones: vec3<f32>,
#endif
}

fn add(sum: ptr<function, Sum>, s: Surface, light: Arriving, left: f32) {
    let angle = angle_of(s, light);
    let tone = tone_of(angle, light.lit, detail_of(s, light.to_light));
    let color = light.color * light.diffuse;
    (*sum).color += color * tone;
#ifdef RAMP_ABSOLUTE
    let bright = max(brightness(color), 0.0);
    (*sum).bright += bright;
    (*sum).tones += bright * tone;
#endif
}

fn reflected(sum: Sum, base: vec3<f32>, around: vec3<f32>, specular: vec3<f32>) -> vec3<f32> {
#ifdef RAMP_ABSOLUTE
    let shade = tone_of(vec2(0.0), 1.0, 1.0);
    let tone = select(shade, sum.tones / max(sum.bright, 1e-30), sum.bright > 0.0);
    let colors = sum.color / PI + tone * around;
#else
    let colors = base * (sum.color / PI + around);
#endif
    return view.exposure * (colors + specular / PI);
}
