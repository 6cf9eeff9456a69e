// The fused pass: reads the picture once, applies every effect, and writes the
// picture once. compose.rs replaces the lines that begin with "//@" by one entry
// for each registered effect.
//
// EARLIER_PASS: the pass draws a texture of the viewport's size, in linear light, for a later pass.
// CONTINUED: the pass starts from such a texture. See passes.rs.
// DRAWS_AUX_SCALAR: the pass draws such a texture with a number at each pixel, by an entry point of
// its own. AUX_SCALAR: the pass starts from that.
// DRAWS_BOX_STATISTICS: the pass draws means over boxes of such a texture, by its own entry point.
// INSIDE: all pixels that are drawn lie inside the viewport.
// OVERLAY: all effects draw over the picture, see AffectedArea. Then the pass starts from a
// transparent picture and returns ink that is multiplied by its opacity, and its opacity,
// which are blended over the picture.

#import bevy_comics::depth::normal::load_normal
#import bevy_comics::depth::view::{View, depth_frame, depth_pixel, inside_viewport, load_depth, pixel_depth, set_view}
#import bevy_comics::effect::color::{
    finite, finite_color, lightness, luminance, srgb_decode, srgb_encode, to_linear, to_stored,
}
#import bevy_comics::effect::box_statistics::{half_side, mean_along, packed_means}
#import bevy_comics::effect::aux_scalar::{load_aux_scalar, packed_number}
#import bevy_comics::effect::picture::load_picture
#import bevy_comics::effect::pixel::Pixel
#ifdef MASK
#import bevy_comics::composite::mask::changed_fractions
#endif
#import bevy_comics::composite::{Composite, compare, difference, object_color, range_fraction}
#import bevy_comics::lines::edge::Lines
#import bevy_comics::lines::owner_plane::owner_weights
#import bevy_comics::lines::layer_lines::{LineLayers, layer_ink}
#import bevy_comics::lines::read::{line_owner, lines_at, set_line_ink, set_line_surface, set_lines}
#import bevy_comics::objects::{load_object, unstyled_fraction}
#import bevy_comics::tones::{ToneRange, in_tone_range, set_tone_range, tone_gain}

// Holds only the settings of the effects that are drawn, in the order of the
// chain. Structs inside a uniform start at multiples of 16 bytes: the vector before each of them, which is
// not read, puts them there. An attribute would be lost where the shader is written as WGSL again, as for
// browsers.
struct Comics {
    view: View,
    composite: Composite,
#ifdef LINES
    lines_before: vec4<u32>,
    lines: Lines,
#endif
#ifdef IN_LAYERS
    planes_of_lines_before: vec4<u32>,
    layers_of_lines: LineLayers,
#endif
#ifdef TONE_RANGE
    tones_before: vec4<u32>,
    tones: ToneRange,
#endif
    //@members
}

#ifndef OVERLAY
@group(0) @binding(0) var source: texture_2d<f32>;
#endif
@group(0) @binding(1) var<uniform> comics: Comics;

// The unstyled picture at a pixel, as it is stored.
fn load_source(pixel: vec2<i32>) -> vec4<f32> {
#ifdef OVERLAY
    return vec4(0.0);
#else
    return textureLoad(source, pixel, 0);
#endif
}

// The debug view of an effect.
var<private> shown: vec3<f32>;

// A pixel as the pass finds it, without its place and depth.
fn found(pixel: vec2<i32>, stored: vec4<f32>) -> Pixel {
    var p: Pixel;
    p.original = to_linear(stored.rgb);
    p.color = p.original;
    p.alpha = clamp(finite(stored.a), 0.0, 1.0);
    p.toned = p.original;
#ifdef TONE_RANGE
    set_tone_range(comics.tones);
    p.toned = in_tone_range(vec4(p.original, p.alpha));
#endif
#ifdef AUX_SCALAR
    let before = load_aux_scalar(pixel).color;
    p.color = before.rgb;
    p.alpha = before.a;
#else ifdef CONTINUED
    let before = load_picture(pixel);
    p.color = before.rgb;
    p.alpha = before.a;
#endif
    return p;
}

// A pixel of the viewport with its place and depth.
fn placed(before: Pixel, pixel: vec2<i32>) -> Pixel {
    var p = before;
    p.inside = vec2<f32>(pixel - comics.view.viewport.xy);
    p.saturation = 1.0;
    p.print_factors = vec2(1.0);
    p.splits = 0.0;
    p.spacing = 1.0;
    p.depth = vec2(1.0, 0.0);
#ifdef MAP
    let true_depth = pixel_depth(depth_frame(), pixel);
    p.depth = select(true_depth, true_depth.yx, comics.view.flip != 0u);
#endif
    return p;
}

// A pixel after the effects that change colors.
fn colored(before: Pixel, pixel: vec2<i32>) -> Pixel {
    var p = before;
    //@colors
    return p;
}

#ifdef SURFACE_LINES
// The color of a pixel of the viewport after these effects.
fn surface_color(pixel: vec2<i32>, change: f32) -> vec3<f32> {
    var p = found(pixel, load_source(pixel));
    p.change = change;
    p.position = vec2<f32>(pixel) + 0.5;
    p = colored(placed(p, pixel), pixel);
    return p.color / max(p.alpha, 1e-3);
}
#endif

// A pixel after the effects that print its colors.
fn printed(before: Pixel, pixel: vec2<i32>) -> Pixel {
    var p = before;
    //@prints
#ifdef UNSTYLED_PRINT
    p.color = mix(p.color, p.original, unstyled_fraction(pixel));
#endif
#ifdef MASKED_PRINT
    p.color = mix(p.original, p.color, changed_fractions(pixel).x);
#endif
    return p;
}

#ifdef MASK
// A pixel of which an effect changes only a fraction.
fn changed(before: Pixel, after: Pixel, fraction: f32) -> Pixel {
    var p = after;
    p.color = mix(before.color, after.color, fraction);
    p.alpha = mix(before.alpha, after.alpha, fraction);
    return p;
}
#endif

// A pixel after all later effects.
fn inked(before: Pixel, pixel: vec2<i32>) -> Pixel {
    var p = before;
    p.colored = before.color;
#ifdef MASK
    let fractions = changed_fractions(pixel);
    var before_effect: Pixel;
#endif
    //@calls
    return p;
}

#ifdef DEBUG_VIEW
// The debug view of a pixel, in display codes.
fn view_color(p: Pixel, pixel: vec2<i32>) -> vec3<f32> {
#ifdef VIEW_DEPTH_MAP
    return vec3(clamp(p.depth.x, 0.0, 1.0));
#else ifdef VIEW_RAW_RANGE
    return vec3(range_fraction(depth_frame(), load_depth(pixel, 0)));
#else ifdef VIEW_SILHOUETTES
    return vec3(1.0 - clamp(lines_at(p.position).ink.x, 0.0, 1.0));
#else ifdef VIEW_CREASES
    return vec3(1.0 - clamp(lines_at(p.position).ink.y, 0.0, 1.0));
#else ifdef VIEW_OBJECT_IDS
    return object_color(load_object(pixel).x);
#else ifdef VIEW_SATURATION
    return vec3(p.saturation);
#else ifdef VIEW_DIFFERENCE
    return difference(srgb_encode(p.original), srgb_encode(p.color));
#else
    return shown;
#endif
}
#endif

#ifdef DRAWS_BOX_STATISTICS
// Half the side of the box around a pixel.
fn half_box(pixel: vec2<i32>) -> f32 {
    var p = found(pixel, load_source(pixel));
    p.position = vec2<f32>(pixel) + 0.5;
    p = placed(p, pixel);
    var half = 0.0;
    //@boxes
    return half_side(half);
}

@fragment
fn means(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    set_view(comics.view);
    let pixel = vec2<i32>(position.xy) + comics.view.viewport.xy;
    return packed_means(mean_along(pixel, half_box(pixel)));
}
#endif

// A pixel before the effects of the pass, without its place and depth. Of the four pixels of a quad, some may
// lie outside of the viewport or of the target: they count as its border.
fn before_effects(pixel: vec2<i32>) -> Pixel {
    var p = found(pixel, load_source(inside_viewport(pixel)));
#ifdef LIGHTNESS_CHANGE
    // Must run before any early return: derivatives need all four pixels of a quad.
#ifdef TONE_RANGE
    // What is lighter than white may be brought below it.
    p.change = tone_gain() * fwidthFine(sqrt(max(luminance(p.original), 0.0)));
#else
    p.change = fwidthFine(lightness(p.original));
#endif
#endif
    return p;
}

// A pixel after all effects of the pass.
fn after_effects(before: Pixel, pixel: vec2<i32>, place: vec2<f32>) -> Pixel {
#ifdef LINES
    set_lines(comics.lines);
#endif
    var p = before;
    p.position = place;
    p = placed(p, pixel);
#ifdef SURFACE_LINES
    set_line_surface(surface_color(line_owner(pixel), p.change));
#endif
#ifdef LAYER_INK
    let owner = depth_pixel(line_owner(pixel));
    set_line_ink(layer_ink(comics.layers_of_lines, owner_weights(comics.layers_of_lines, owner)));
#endif
    return inked(printed(colored(p, pixel), pixel), pixel);
}

// What a pass draws for a later one. Larger numbers would become infinite. Later passes read each
// pixel often: it is made finite once, here.
fn pass_color(p: Pixel) -> vec4<f32> {
    let color = clamp(finite_color(p.color), vec3(-65504.0), vec3(65504.0));
    return vec4(color, clamp(finite(p.alpha), 0.0, 1.0));
}

#ifdef DRAWS_AUX_SCALAR
// The number of a pixel.
fn number_of(p: Pixel) -> f32 {
    var number = 0.0;
    //@aux_scalars
    return number;
}

@fragment
fn with_scalar(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let place = position.xy + vec2<f32>(comics.view.viewport.xy);
    let pixel = vec2<i32>(place);
    set_view(comics.view);
    let p = after_effects(before_effects(pixel), pixel, place);
    return packed_number(pass_color(p), number_of(p));
}
#endif

@fragment
fn stylize(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
#ifdef EARLIER_PASS
    let place = position.xy + vec2<f32>(comics.view.viewport.xy);
#else
    let place = position.xy;
#endif
    let pixel = vec2<i32>(place);
    set_view(comics.view);
    var p = before_effects(pixel);
#ifndef INSIDE
    let inside = pixel - comics.view.viewport.xy;
    if any(inside < vec2(0)) || any(inside >= comics.view.viewport.zw) {
        return load_source(pixel);
    }
#endif
    p = after_effects(p, pixel, place);
#ifdef EARLIER_PASS
    return pass_color(p);
#else
#ifdef DEBUG_VIEW
    p.color = srgb_decode(view_color(p, pixel));
    p.alpha = 1.0;
#endif
    var result = vec4(p.color, p.alpha);
#ifdef COMPOSITE
    let opacity = clamp(finite(load_source(pixel).a), 0.0, 1.0);
    result = compare(comics.composite, vec4(p.original, opacity), result, p.inside.x);
#endif
    return vec4(to_stored(result.rgb), result.a);
#endif
}
