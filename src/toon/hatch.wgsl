#define_import_path bevy_comics::toon::hatch

// Strokes on the toon material: pure functions.

#import bevy_comics::effect::color::lightness
#import bevy_comics::effect::strokes::{Strokes, Surface, darkness}

struct Hatch {
    strokes: Strokes,
    // Of the darkness.
    factor: f32,
    // Drawings per second.
    rate: f32,
    // How often the art map repeats over the texture coordinates, or over a world unit.
    repeat: f32,
    // Size of the struct: a multiple of 16 bytes.
    unused: f32,
}

// The fraction of all light that arrives, from the brightness of both.
fn arriving_fraction(arriving: f32, all: f32) -> f32 {
    return clamp(arriving / max(all, 1e-20), 0.0, 1.0);
}

// Darkness of the strokes where a fraction of all light arrives: that of a white surface.
fn hatch_tone(h: Hatch, fraction: f32) -> f32 {
    return darkness(h.strokes, lightness(vec3(fraction))) * h.factor;
}

// Number of the drawing at a time in seconds, see clock.rs.
fn hatch_drawing(h: Hatch, seconds: f32) -> u32 {
    return u32((max(seconds, 0.0) + 1e-6) * h.rate) % 65536u;
}

fn unit_or(v: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let square = dot(v, v);
    return select(other, v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}

// A surface at rest. `across` and `down`: how its place changes from pixel to pixel; `normal`: of
// any length, or 0 if the mesh has none.
fn rest_surface(place: vec3<f32>, across: vec3<f32>, down: vec3<f32>, normal: vec3<f32>) -> Surface {
    var on: Surface;
    on.place = place;
    on.across = across;
    on.down = down;
    let axis = vec3(0.0, 0.0, 1.0);
    let face = cross(unit_or(across, vec3(1.0, 0.0, 0.0)), unit_or(down, vec3(0.0, 1.0, 0.0)));
    on.normal = unit_or(normal, unit_or(face, axis));
    return on;
}
