#define_import_path bevy_comics::finish

// What comes after the styles: the mix with the original, and the views that
// show what the styles are made of.

#import bevy_comics::depth::map::{DepthFrame, EMPTY}
#import bevy_comics::effect::noise::{hash}

struct Finish {
    // How much of the style is seen.
    weight: f32,
    // Pixels of the viewport, from the left, that show the original.
    split: f32,
    unused: vec2<f32>,
}

// The styled picture as far as it is seen, `x` pixels from the left edge.
fn compare(s: Finish, original: vec3<f32>, styled: vec3<f32>, x: f32) -> vec3<f32> {
    let seen = select(s.weight, 0.0, x < s.split);
    return mix(original, styled, seen);
}

// Raw depth between the ends of the range: 1 near, 0 far, and 0 where there is
// nothing.
fn range_share(frame: DepthFrame, raw: f32) -> f32 {
    if raw == 0.0 || (frame.flags & EMPTY) != 0u {
        return 0.0;
    }
    let span = frame.near - frame.far;
    if span <= 0.0 {
        return 1.0;
    }
    return clamp((raw - frame.far) / span, 0.0, 1.0);
}

// A colour for an object, in display codes; black for none.
fn object_color(id: u32) -> vec3<f32> {
    if id == 0u {
        return vec3(0.0);
    }
    let h = hash(id);
    let bytes = vec3(h & 0xffu, (h >> 8u) & 0xffu, (h >> 16u) & 0xffu);
    return 0.2 + 0.8 * vec3<f32>(bytes) / 255.0;
}

// How far two pictures are apart, both in display codes.
fn difference(original: vec3<f32>, styled: vec3<f32>) -> vec3<f32> {
    return min(4.0 * abs(styled - original), vec3(1.0));
}
