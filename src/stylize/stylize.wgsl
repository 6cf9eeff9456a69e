// The fused pass: one read of the picture, one write, every style in between.

#import bevy_comics::stylize::bindings
#import bevy_comics::stylize::taps
#import bevy_comics::depth::map
#import bevy_comics::styles::color
#import bevy_comics::styles::desaturation
#import bevy_comics::styles::colorization
#import bevy_comics::styles::contours
#import bevy_comics::styles::black_flats

// The picture is display-referred. The styles take linear light.
fn to_linear(stored: vec3<f32>) -> vec3<f32> {
    let c = color::finite_color(stored);
#ifdef STORED_SRGB
    return color::srgb_decode(c);
#else ifdef STORED_OKLAB
    return color::oklab_to_linear(c);
#else
    return c;
#endif
}

fn to_stored(linear: vec3<f32>) -> vec3<f32> {
#ifdef STORED_SRGB
    return color::srgb_encode(linear);
#else ifdef STORED_OKLAB
    return color::linear_to_oklab(linear);
#else
    return linear;
#endif
}

@fragment
fn stylize(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(position.xy);
    let stored = textureLoad(bindings::source, pixel, 0);
    let inside = pixel - bindings::comics.viewport.xy;
    if any(inside < vec2(0)) || any(inside >= bindings::comics.viewport.zw) {
        return stored;
    }
    var linear = to_linear(stored.rgb);

    // x: 0 near, 1 far; y: its complement.
    var depth = vec2(1.0, 0.0);
#ifdef DEPTH
    let frame = bindings::depth_frame();
    let true_depth = taps::pixel_depth(frame, pixel);
    depth = select(true_depth, true_depth.yx, bindings::comics.flip != 0u);
#endif

    var saturation = 1.0;
#ifdef DESATURATION
    saturation = desaturation::saturation_left(bindings::comics.desaturation, depth.y);
    linear = desaturation::desaturate(bindings::comics.desaturation, linear, saturation);
#endif
#ifdef COLORIZATION
    linear = colorization::colorize(bindings::comics.colorization, linear, depth.x, depth.y, saturation);
#endif
#ifdef BLACK_FLATS
    var flats = black_flats::dark_area(bindings::comics.black_flats, to_linear(stored.rgb), depth.y);
#ifdef STEEP_FLATS
    flats = max(flats, black_flats::steep_area(bindings::comics.black_flats, taps::slope(frame, pixel)));
#endif
    linear = black_flats::fill(bindings::comics.black_flats, linear, flats);
#endif
#ifdef CONTOURS
    let line = taps::contour(bindings::comics.contours, frame, pixel);
    linear = contours::draw_contour(bindings::comics.contours, linear, line.x, line.y);
#endif
    return vec4(to_stored(linear), stored.a);
}
