#define_import_path bevy_comics::composite

// What comes after the effects: the mix with the original picture, and the debug
// views.

#import bevy_comics::depth::map::{DepthFrame, EMPTY}
#import bevy_comics::effect::noise::{hash}

struct Composite {
    // Fraction of the styled picture in the mix with the original, 0 to 1.
    weight: f32,
    // Width of the part that shows the original: physical pixels from the left edge
    // of the viewport.
    split: f32,
    unused: vec2<f32>,
}

// Mixes the two pictures, or shows the original left of the split. Both are colors
// multiplied by their opacity, and the opacity. `x` is in physical pixels from the left
// edge of the viewport.
fn compare(s: Composite, original: vec4<f32>, styled: vec4<f32>, x: f32) -> vec4<f32> {
    let weight = select(s.weight, 0.0, x < s.split);
    return mix(original, styled, weight);
}

// Position of a raw depth between the ends of the range: 1 at the near end, 0 at the
// far end and where there is no geometry.
fn range_fraction(frame: DepthFrame, raw: f32) -> f32 {
    if raw == 0.0 || (frame.flags & EMPTY) != 0u {
        return 0.0;
    }
    let span = frame.near - frame.far;
    if span <= 0.0 {
        return 1.0;
    }
    return clamp((raw - frame.far) / span, 0.0, 1.0);
}

// A random color for an object id, in display codes; black for id 0 (no object).
fn object_color(id: u32) -> vec3<f32> {
    if id == 0u {
        return vec3(0.0);
    }
    let h = hash(id);
    let bytes = vec3(h & 0xffu, (h >> 8u) & 0xffu, (h >> 16u) & 0xffu);
    return 0.2 + 0.8 * vec3<f32>(bytes) / 255.0;
}

// Difference of two colors, times four; all in display codes.
fn difference(original: vec3<f32>, styled: vec3<f32>) -> vec3<f32> {
    return min(4.0 * abs(styled - original), vec3(1.0));
}
