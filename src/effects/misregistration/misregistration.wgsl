#define_import_path bevy_comics::effects::misregistration

// Prints the plates of cyan, magenta, yellow and black ink out of register.

#import bevy_comics::effect::color::separated
#import bevy_comics::effect::picture::picture_at
#import bevy_comics::effect::pixel::Pixel

struct Misregistration {
    // By how much each plate is moved, in physical pixels to the right and down.
    cyan: vec2<f32>,
    magenta: vec2<f32>,
    yellow: vec2<f32>,
    black: vec2<f32>,
    black_generation: f32,
    unused: f32,
    unused_too: vec2<f32>,
}

// The light that plates of ideal inks leave.
fn overprinted(tones: vec4<f32>) -> vec3<f32> {
    return (1.0 - tones.xyz) * (1.0 - tones.w);
}

// Tones of the plates of the picture at a position; those of `own` where the background
// shows through.
fn tones_at(s: Misregistration, position: vec2<f32>, own: vec3<f32>) -> vec4<f32> {
    let found = picture_at(position);
    let color = found.rgb + (1.0 - found.a) * own;
    return separated(clamp(color, vec3(0.0), vec3(1.0)), s.black_generation);
}

// The tone of the black plate, which is read at the pixel itself where it is not moved.
fn black_at(s: Misregistration, position: vec2<f32>, own: vec3<f32>) -> f32 {
#ifdef EFFECT_MISREGISTRATION_BLACK_STAYS
    return separated(clamp(own, vec3(0.0), vec3(1.0)), s.black_generation).w;
#else
    return tones_at(s, position, own).w;
#endif
}

fn misregistration(s: Misregistration, p: Pixel) -> Pixel {
    var out = p;
    let own = p.color / max(p.alpha, 1e-3);
    let tones = vec4(
        tones_at(s, p.position - s.cyan, own).x,
        tones_at(s, p.position - s.magenta, own).y,
        tones_at(s, p.position - s.yellow, own).z,
        black_at(s, p.position - s.black, own),
    );
    out.color = overprinted(tones) * p.alpha;
    return out;
}
