#define_import_path bevy_comics::cartoon::per_light

// A ramp for each light: `RampMode::PerLight`.

#import bevy_comics::cartoon::{
    ramp_light::{angle_of, tone_of},
    reflect::{PI, highlight_of},
    surface::{Arriving, Surface},
    surroundings::brightness,
}
#import bevy_pbr::mesh_view_bindings::view

struct Sum {
    // Light times pi in its tones, and the brightness of the light without them.
    color: vec3<f32>,
    bright: f32,
    // Tones, times the brightness of their lights.
    tones: vec3<f32>,
    shine: vec3<f32>,
}

fn add(sum: ptr<function, Sum>, s: Surface, light: Arriving) {
    let angle = angle_of(s, light);
    let tone = tone_of(angle.x, angle.y, light.lit);
    let color = light.color * light.diffuse;
    let bright = max(brightness(color), 0.0);
    (*sum).color += color * tone;
    (*sum).bright += bright;
    (*sum).tones += bright * tone;
    (*sum).shine += light.color * highlight_of(s, light);
}

fn reflected(sum: Sum, base: vec3<f32>, tint: vec3<f32>, around: vec3<f32>) -> vec3<f32> {
#ifdef RAMP_ABSOLUTE
    let tone = select(tone_of(0.0, 0.0, 1.0), sum.tones / max(sum.bright, 1e-30), sum.bright > 0.0);
    let colors = sum.color / PI + tone * around;
#else
    let colors = base * (sum.color / PI + around);
#endif
    return view.exposure * (colors + tint * sum.shine / PI);
}
