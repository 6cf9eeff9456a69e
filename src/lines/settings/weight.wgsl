#define_import_path bevy_comics::lines::weight

// How wide a line is at a crack: factors of its width. Pure functions.

#import bevy_comics::depth::map::{DepthFrame, EMPTY, ORTHOGRAPHIC, has, is_background}
#import bevy_comics::lines::edge::{OBJECT, SILHOUETTE, THINNEST, byte, pack_width, unpack_crack}

struct Weight {
    // Factors by kind: silhouettes in front of the sky or of other objects, and in front of
    // the same object; creases; object edges.
    outer: f32,
    inner: f32,
    crease: f32,
    object: f32,
    // Unit vector towards the light, in world space.
    to_light: vec3<f32>,
    shade: f32,
    // Unit vector along the edge of the nib, in the picture (y down).
    nib_edge: vec2<f32>,
    nib_roundness: f32,
    lit: f32,
    perspective: f32,
    // Cracks over which a line becomes thinner towards a loose end.
    taper: f32,
    // Fraction of an area that lines may cover, and the least radius of such an area in pixels of the
    // viewport.
    budget: f32,
    least_radius: f32,
}

// The factor of a crack with these kinds. `outer`: there is sky or another object behind it.
fn kind_weight(w: Weight, kinds: u32, outer: bool) -> f32 {
    if (kinds & SILHOUETTE) != 0u {
        return select(w.inner, w.outer, outer);
    }
    return select(w.crease, w.object, (kinds & OBJECT) != 0u);
}

// `facing`: the cosine of the angle between the owner's normal and the light.
fn light_weight(w: Weight, facing: f32) -> f32 {
    return 1.0 + w.shade * smoothstep(-0.3, 0.3, -facing) - w.lit * smoothstep(-0.1, 0.6, facing);
}

// The most by which perspective multiplies a width, and the least.
const NEAREST: f32 = 2.0;
const FARTHEST: f32 = 0.125;

// `d`: the raw depth of the owner. Distance is compared with the middle of the map's range.
fn perspective_weight(w: Weight, f: DepthFrame, d: f32) -> f32 {
    if has(f, ORTHOGRAPHIC) || has(f, EMPTY) || is_background(d) {
        return 1.0;
    }
    // Distances, up to a factor.
    let near = 1.0 / max(f.near + f.offset, 1e-30);
    let far = 1.0 / max(f.far + f.offset, 1e-30);
    let own = 1.0 / max(d + f.offset, 1e-30);
    let ratio = 0.5 * (near / own + far / own);
    return pow(clamp(ratio, FARTHEST, NEAREST), w.perspective);
}

// `along`: the unit vector along the line, in the picture.
fn nib_weight(w: Weight, along: vec2<f32>) -> f32 {
    let across = along.x * w.nib_edge.y - along.y * w.nib_edge.x;
    return length(vec2(across, w.nib_roundness * dot(along, w.nib_edge)));
}

// `cracks`: those between the crack and the loose end of its line.
fn taper_weight(w: Weight, cracks: f32) -> f32 {
    return smoothstep(0.0, max(w.taper, 1e-3), cracks + 0.5);
}

// A packed crack whose width is multiplied by a factor, and its opacity by another. A line
// that would be thinner than any line is fainter instead. 0 if nothing is left of it.
fn weighted_crack(packed: u32, factor: f32, opacity_factor: f32) -> u32 {
    let crack = unpack_crack(packed);
    let thinnest = min(crack.half_width, THINNEST);
    let half_width = crack.half_width * factor;
    let opacity = crack.opacity * opacity_factor * min(half_width / max(thinnest, 1e-3), 1.0);
    let stored = byte(vec4(opacity)).x;
    let bits = (packed & 0xfffu) | (stored << 12u) | (pack_width(vec4(max(half_width, thinnest))).x << 20u);
    return select(bits, 0u, stored == 0u);
}
