#define_import_path bevy_comics::effects::black_flats

// Areas of solid ink: steep slopes and deep shadows ([CS] 3.2, Figure 4).

#import bevy_comics::effect::color::{largest, srgb_encode}
#import bevy_comics::effect::pixel::Pixel
#ifdef BLACK_FLATS_STEEP
#import bevy_comics::depth::view::{depth_frame, map_slope}
#endif

struct BlackFlats {
    color: vec3<f32>,
    opacity: f32,
    // Prewitt response above which a slope is filled, and where it is full.
    slope_low: f32,
    slope_high: f32,
    // Display value below which an area is filled, and the width of its edge.
    value: f32,
    softness: f32,
    // 1: the value threshold shrinks to nothing at the far end of the depth map.
    depth_weight: f32,
    // The response is measured as on a map of 512 rows.
    slope_scale: f32,
}

// How dark an area is, against the threshold on V of the display code.
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

fn steep_area(s: BlackFlats, prewitt: f32) -> f32 {
    return smoothstep(s.slope_low, s.slope_high, prewitt * s.slope_scale);
}

fn fill(s: BlackFlats, linear: vec3<f32>, coverage: f32) -> vec3<f32> {
    return mix(linear, s.color, clamp(coverage * s.opacity, 0.0, 1.0));
}

fn black_flats(s: BlackFlats, p: Pixel) -> Pixel {
    var out = p;
    var flats = dark_area(s, p.original, p.depth.y);
#ifdef BLACK_FLATS_STEEP
    flats = max(flats, steep_area(s, map_slope(depth_frame(), vec2<i32>(p.position))));
#endif
    out.color = fill(s, p.color, flats);
    return out;
}
