#define_import_path bevy_comics::effects::sketch

// Draws the outlines as ink on paper ([CL] 3.2, Figure 8).

#import bevy_comics::effect::noise::wave
#import bevy_comics::effect::pixel::Pixel
#ifdef LINES
#import bevy_comics::lines::read::{draw_lines, lines_at, total_ink}
#endif

struct Sketch {
    paper: vec3<f32>,
    wash: f32,
    ink: vec3<f32>,
    gamma: f32,
    // Largest displacement of a stroke per axis, and the spacing of the noise that
    // displaces it; physical pixels.
    jitter: f32,
    wavelength: f32,
    // Variation of the ink along a stroke, 0 to 1.
    pressure: f32,
    strokes: u32,
    // Number of the drawing: seeds the noise, and increases `rate` times a second.
    drawing: u32,
    // Opacity of the drawing over the picture.
    amount: f32,
    // 1: the picture below the drawing shows the outlines; 0: it does not.
    lines_below: f32,
}

// Displacement of a stroke at a place; both in physical pixels.
fn stray(s: Sketch, at: vec2<f32>, stroke: u32) -> vec2<f32> {
    let seed = s.drawing * 16u + stroke * 4u;
    let p = at / s.wavelength;
    return s.jitter * vec2(wave(p, seed), wave(p, seed + 1u));
}

// Pressure of the pen at a place, from 1 - s.pressure to 1.
fn pen_pressure(s: Sketch, at: vec2<f32>, stroke: u32) -> f32 {
    let n = wave(at / s.wavelength * 1.7, s.drawing * 16u + stroke * 4u + 2u);
    return 1.0 - s.pressure * (0.5 + 0.5 * n);
}

// Ink after one more stroke over the ink that is already there, both 0 to 1.
fn add_stroke(inked: f32, stroke: f32) -> f32 {
    return 1.0 - (1.0 - inked) * (1.0 - clamp(stroke, 0.0, 1.0));
}

// Draws ink on paper, in linear light. The paper is opaque; where there is no picture,
// it is blank. `picture` is a color multiplied by its opacity, and the opacity; `inked`
// is the coverage of the ink, 0 to 1.
fn draw_sketch(s: Sketch, picture: vec4<f32>, inked: f32) -> vec3<f32> {
    let ground = mix(s.paper, s.paper * (picture.rgb + (1.0 - picture.a)), s.wash);
    let ink = select(pow(max(inked, 1e-30), s.gamma), 0.0, inked <= 0.0);
    return mix(ground, s.ink, clamp(ink, 0.0, 1.0));
}

#ifdef LINES
fn sketch(s: Sketch, p: Pixel) -> Pixel {
    var out = p;
    var inked = 0.0;
#ifndef WITHOUT_LINES
    for (var stroke = 0u; stroke < s.strokes; stroke++) {
        let at = p.position + stray(s, p.inside, stroke);
        inked = add_stroke(inked, total_ink(lines_at(at)) * pen_pressure(s, p.inside, stroke));
    }
#endif
    let picture = vec4(p.color, p.alpha);
    var drawing = vec4(draw_sketch(s, picture, inked), 1.0);
#ifdef EFFECT_SKETCH_FADES
    let below = draw_lines(picture, lines_at(p.position));
    drawing = mix(mix(picture, below, s.lines_below), drawing, s.amount);
#endif
    out.color = drawing.rgb;
    out.alpha = drawing.a;
    return out;
}
#endif
