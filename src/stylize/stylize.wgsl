// The fused pass: one read of the picture, one write, every style in between.

#import bevy_comics::stylize::bindings::{comics, source}
#import bevy_comics::finish::{compare, difference, object_color, range_share}
#ifdef VIEW_OBJECT_IDS
#import bevy_comics::stylize::bindings::{load_object}
#endif
#ifdef VIEW_RAW_RANGE
#import bevy_comics::stylize::bindings::{load_depth}
#endif
#ifdef EDGES
#import bevy_comics::stylize::lines::{draw_lines, lines_at, total_ink}
#endif
#ifdef DEPTH
#import bevy_comics::stylize::bindings::{depth_frame}
#endif
#ifdef DEPTH
#import bevy_comics::stylize::taps::{contour, pixel_depth, slope}
#endif
#import bevy_comics::styles::color::{finite_color, linear_to_oklab, oklab_to_linear, srgb_decode, srgb_encode}
#import bevy_comics::styles::desaturation::{desaturate, saturation_left}
#import bevy_comics::styles::colorization::{colorize}
#import bevy_comics::styles::contours::{draw_contour}
#import bevy_comics::styles::black_flats::{dark_area, fill, steep_area}
#import bevy_comics::styles::tone_bands::{lightness, tone_bands}
#import bevy_comics::styles::sketch::{add_stroke, draw_sketch, pen_pressure, stray}

// The picture is display-referred. The styles take linear light.
fn to_linear(stored: vec3<f32>) -> vec3<f32> {
    let c = finite_color(stored);
#ifdef STORED_SRGB
    return srgb_decode(c);
#else ifdef STORED_OKLAB
    return oklab_to_linear(c);
#else
    return c;
#endif
}

fn to_stored(linear: vec3<f32>) -> vec3<f32> {
#ifdef STORED_SRGB
    return srgb_encode(linear);
#else ifdef STORED_OKLAB
    return linear_to_oklab(linear);
#else
    return linear;
#endif
}

@fragment
fn stylize(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    // At the border of an odd target there are pixels that exist only for their
    // neighbours' derivatives.
    let last = vec2<i32>(textureDimensions(source)) - 1;
    let stored = textureLoad(source, min(pixel, last), 0);
    var linear = to_linear(stored.rgb);
#ifdef TONE_BANDS
    // Derivatives want every pixel, so this comes before any is sent away.
    let change = fwidthFine(lightness(linear));
#endif
    let inside = pixel - comics.viewport.xy;
    if any(inside < vec2(0)) || any(inside >= comics.viewport.zw) {
        return stored;
    }
    // Modes are compiled in, where they are known: see has() in map.wgsl.
#ifdef TONE_BANDS
    var bands = comics.tone_bands;
#ifdef MODES
    bands.faithful = #{TONE_BANDS_FAITHFUL}u;
#endif
    linear = tone_bands(bands, linear, change);
#endif
#ifdef VIEW_TONE_BANDS
    let banded = linear;
#endif

    // x: 0 near, 1 far; y: its complement.
    var depth = vec2(1.0, 0.0);
#ifdef DEPTH
    let frame = depth_frame();
    let true_depth = pixel_depth(frame, pixel);
    depth = select(true_depth, true_depth.yx, comics.flip != 0u);
#endif

    var saturation = 1.0;
#ifdef DESATURATION
    var grey = comics.desaturation;
#ifdef MODES
    grey.curve = #{DESATURATION_CURVE}u;
    grey.faithful = #{DESATURATION_FAITHFUL}u;
#endif
    saturation = saturation_left(grey, depth.y);
    linear = desaturate(grey, linear, saturation);
#endif
#ifdef COLORIZATION
    var tint = comics.colorization;
#ifdef MODES
    tint.mode = #{COLORIZATION_MODE}u;
    tint.faithful = #{COLORIZATION_FAITHFUL}u;
#endif
    linear = colorize(tint, linear, depth.x, depth.y, saturation);
#endif
#ifdef BLACK_FLATS
    var flats = dark_area(comics.black_flats, to_linear(stored.rgb), depth.y);
#ifdef STEEP_FLATS
    flats = max(flats, steep_area(comics.black_flats, slope(frame, pixel)));
#endif
    linear = fill(comics.black_flats, linear, flats);
#endif
#ifdef CONTOURS
    var contours = comics.contours;
#ifdef MODES
    contours.operator_kind = #{CONTOUR_OPERATOR}u;
    contours.faithful = #{CONTOUR_FAITHFUL}u;
#endif
    let line = contour(contours, frame, pixel);
    linear = draw_contour(contours, linear, line.x, line.y);
#endif
#ifdef SKETCH
    var inked = 0.0;
    for (var stroke = 0u; stroke < comics.sketch.strokes; stroke++) {
        let at = position.xy + stray(comics.sketch, vec2<f32>(inside), stroke);
        inked = add_stroke(inked, total_ink(lines_at(at)) * pen_pressure(comics.sketch, vec2<f32>(inside), stroke));
    }
    let drawing = draw_sketch(comics.sketch, linear, inked);
#ifdef SKETCH_FADES
    let below = draw_lines(linear, lines_at(position.xy));
    linear = mix(mix(linear, below, comics.sketch.lines_below), drawing, comics.sketch.amount);
#else
    linear = drawing;
#endif
#else ifdef EDGES
    linear = draw_lines(linear, lines_at(position.xy));
#endif
#ifdef VIEW_DEPTH_MAP
    linear = srgb_decode(vec3(clamp(depth.x, 0.0, 1.0)));
#else ifdef VIEW_RAW_RANGE
    linear = srgb_decode(vec3(range_share(frame, load_depth(pixel, 0))));
#else ifdef VIEW_SILHOUETTES
#ifdef EDGES
    linear = srgb_decode(vec3(1.0 - clamp(lines_at(position.xy).ink.x, 0.0, 1.0)));
#endif
#else ifdef VIEW_CREASES
#ifdef EDGES
    linear = srgb_decode(vec3(1.0 - clamp(lines_at(position.xy).ink.y, 0.0, 1.0)));
#endif
#else ifdef VIEW_OBJECT_IDS
    linear = srgb_decode(object_color(load_object(pixel).x));
#else ifdef VIEW_TONE_BANDS
    linear = srgb_decode(vec3(clamp(lightness(banded), 0.0, 1.0)));
#else ifdef VIEW_SATURATION
    linear = srgb_decode(vec3(saturation));
#else ifdef VIEW_DIFFERENCE
    linear = srgb_decode(difference(srgb_encode(to_linear(stored.rgb)), srgb_encode(linear)));
#endif
#ifdef FINISH
    linear = compare(comics.finish, to_linear(stored.rgb), linear, f32(inside.x));
#endif
    return vec4(to_stored(linear), stored.a);
}
