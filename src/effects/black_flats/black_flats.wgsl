#define_import_path bevy_comics::effects::black_flats

// Fills steep slopes and dark areas with solid ink ([CS] 3.2, Figure 4).

#import bevy_comics::effect::color::{largest, srgb_encode}
#import bevy_comics::effect::pixel::Pixel
#ifdef EFFECT_BLACK_FLATS_STEEP
#import bevy_comics::depth::view::{depth_frame, map_slope}
#endif

struct BlackFlats {
    color: vec3<f32>,
    opacity: f32,
    // Prewitt response at which the fill begins, and at which it is complete.
    slope_low: f32,
    slope_high: f32,
    // HSV value, in display codes, below which an area is filled.
    value: f32,
    // Half the width of the transition, as a fraction of the threshold.
    softness: f32,
    // Fraction of the value threshold that is lost at the far end of the depth map.
    depth_weight: f32,
    // Rows of the viewport / 512: converts a response per pixel to that of a map
    // with 512 rows.
    slope_scale: f32,
}

// Coverage of dark areas, 0 to 1. `linear` is the unstyled color, `l` the
// complement of the depth map.
fn dark_area(s: BlackFlats, linear: vec3<f32>, l: f32) -> f32 {
    let threshold = s.value * mix(1.0, l, s.depth_weight);
    if threshold <= 0.0 {
        return 0.0;
    }
    let value = srgb_encode(vec3(largest(linear))).r;
    let low = threshold * (1.0 - s.softness);
    let high = threshold * (1.0 + s.softness);
    return 1.0 - smoothstep(low, high, value);
}

// Coverage of steep slopes, 0 to 1. `prewitt` is the response per pixel.
fn steep_area(s: BlackFlats, prewitt: f32) -> f32 {
    return smoothstep(s.slope_low, s.slope_high, prewitt * s.slope_scale);
}

// Fills what is there: a background that shows through stays as it is. `picture` is a
// color multiplied by its opacity, and the opacity.
fn fill(s: BlackFlats, picture: vec4<f32>, coverage: f32) -> vec3<f32> {
    return mix(picture.rgb, s.color * picture.a, clamp(coverage * s.opacity, 0.0, 1.0));
}

fn black_flats(s: BlackFlats, p: Pixel) -> Pixel {
    var out = p;
    var flats = dark_area(s, p.toned, p.depth.y);
#ifdef EFFECT_BLACK_FLATS_STEEP
    flats = max(flats, steep_area(s, map_slope(depth_frame(), vec2<i32>(p.position))));
#endif
    out.color = fill(s, vec4(p.color, p.alpha), flats);
    return out;
}
