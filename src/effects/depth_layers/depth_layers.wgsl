#define_import_path bevy_comics::effects::depth_layers

// Gives the foreground, the middle distance and the background colors of their own (after
// Sauvaget and Boyer 2008).

#import bevy_comics::depth::map::{depth_map, layer_weights}
#import bevy_comics::depth::view::{depth_frame, load_depth, sample_count, view}
#import bevy_comics::effect::color::{banded, in_gamut, linear_to_oklab, oklab_to_linear, srgb_encode}
#import bevy_comics::effect::pixel::Pixel
#ifdef DEPTH_BORDERS
#import bevy_comics::depth::view::depth_borders
#endif
#ifdef OBJECT_DEPTHS
#import bevy_comics::objects::whole_depth
#endif

// How a layer changes OKLab colors: lightness to `contrast` times it plus `shift`, chroma to
// `chroma` times it plus `tint`.
struct LayerColors {
    tint: vec2<f32>,
    chroma: f32,
    contrast: f32,
    shift: f32,
    // Number of tones; below 1: all.
    bands: f32,
    // Factors of hatching, and of screens.
    print_factors: vec2<f32>,
}

struct DepthLayers {
    foreground: LayerColors,
    middle: LayerColors,
    background: LayerColors,
    // D at the border between near and middle, and between middle and far.
    borders: vec2<f32>,
    // Width of both borders in D.
    softness: f32,
    amount: f32,
}

// The lightness of a layer. `change`: of the lightness, over a pixel.
fn layer_lightness(s: LayerColors, lightness: f32, change: f32) -> f32 {
    var tone = lightness;
#ifdef EFFECT_DEPTH_LAYERS_BANDS
    if s.bands >= 2.0 {
        tone = banded(s.bands, lightness, change);
    } else if s.bands >= 1.0 {
        tone = 0.5;
    }
#endif
    return s.contrast * tone + s.shift;
}

// The color with these fractions of the layers. `change`: of the square root of the picture's
// luminance, over a pixel.
fn layers_color(s: DepthLayers, linear: vec3<f32>, w: vec3<f32>, change: f32) -> vec3<f32> {
    let lab = linear_to_oklab(linear);
    // Lightness is the cube root of luminance for grays: the square root to the power of 2/3.
    let lab_change = change * 0.6666667 * inverseSqrt(max(lab.x, 1e-3));
    let tones = vec3(
        layer_lightness(s.foreground, lab.x, lab_change),
        layer_lightness(s.middle, lab.x, lab_change),
        layer_lightness(s.background, lab.x, lab_change),
    );
    let kept = dot(w, vec3(s.foreground.chroma, s.middle.chroma, s.background.chroma));
    let tint = w.x * s.foreground.tint + w.y * s.middle.tint + w.z * s.background.tint;
    let changed = vec3(clamp(dot(w, tones), 0.0, max(lab.x, 1.0)), kept * lab.yz + tint);
    let mixed = mix(lab, changed, s.amount);
    return in_gamut(oklab_to_linear(mixed), mixed.x, linear);
}

// D at the borders of the layers.
fn borders_of(s: DepthLayers) -> vec2<f32> {
#ifdef DEPTH_BORDERS
    let found = depth_borders(depth_frame());
    return select(found, s.borders, found.x < 0.0);
#else
    return s.borders;
#endif
}

// D by which a sample of a pixel is in a layer: that of its object, if this is treated as a whole.
fn layer_depth(pixel: vec2<i32>, sample: i32, d: f32) -> f32 {
#ifdef EFFECT_DEPTH_LAYERS_OBJECTS
#ifdef OBJECT_DEPTHS
    return whole_depth(pixel, sample, d);
#else
    return d;
#endif
#else
    return d;
#endif
}

// Fractions of the layers at a pixel: the mean over its samples, because its color is their
// mean too.
fn pixel_weights(s: DepthLayers, p: Pixel) -> vec3<f32> {
    let borders = borders_of(s);
    let pixel = vec2<i32>(floor(p.position));
    var w = vec3(0.0);
#ifdef MULTISAMPLED
    let frame = depth_frame();
    let samples = sample_count();
    for (var i = 0; i < samples; i++) {
        let d = depth_map(frame, load_depth(pixel, i)).x;
        w += layer_weights(borders, s.softness, layer_depth(pixel, i, d));
    }
    w /= f32(samples);
#else
    let d = select(p.depth.x, p.depth.y, view.flip != 0u);
    w = layer_weights(borders, s.softness, layer_depth(pixel, 0, d));
#endif
    return select(w, w.zyx, view.flip != 0u);
}

fn depth_layers(s: DepthLayers, p: Pixel) -> Pixel {
    var out = p;
    // The lightness of what is seen, not of what is left of it at the edge of an object.
    let opacity = max(p.alpha, 1e-3);
    let w = pixel_weights(s, p);
    out.color = layers_color(s, p.color / opacity, w, p.change) * p.alpha;
    let print_factors = w.x * s.foreground.print_factors
        + w.y * s.middle.print_factors
        + w.z * s.background.print_factors;
    out.print_factors = p.print_factors * mix(vec2(1.0), print_factors, s.amount);
    return out;
}

// The debug view, in display codes: near red, middle yellow, far blue.
fn depth_layers_view(s: DepthLayers, p: Pixel) -> vec3<f32> {
    let w = pixel_weights(s, p);
    return srgb_encode(w.x * vec3(0.6, 0.06, 0.02) + w.y * vec3(0.8, 0.6, 0.1) + w.z * vec3(0.03, 0.15, 0.5));
}
