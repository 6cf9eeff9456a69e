#define_import_path bevy_comics::cartoon::ramp

// Tones by how much light arrives: pure functions (Lake et al. 2000).

#import bevy_comics::cartoon::light::edge_at

const STOPS: u32 = 8u;

struct Stop {
    // Linear light.
    color: vec3<f32>,
    // How much light arrives where the tone begins, 0 to 1. Stops are sorted; those that are
    // not used lie far beyond 1.
    at: f32,
    // Width of the transition, in the same unit.
    softness: f32,
}

struct Ramp {
    stops: array<Stop, 8>,
    // Exponent of the light in `Share`: 0 keeps nothing of its strength, 1 all.
    keep_intensity: f32,
}

// The tone where `arriving` of the light arrives, 0 to 1. `width` is its change over a
// pixel. The first stop has no edge: its tone is what lies below all others.
fn tone(ramp: Ramp, arriving: f32, width: f32) -> vec3<f32> {
    var color = ramp.stops[0].color;
    for (var k = 1u; k < STOPS; k++) {
        let stop = ramp.stops[k];
        color = mix(color, stop.color, edge_at(stop.at, arriving, max(stop.softness, width)));
    }
    return color;
}

// The same, with a part of the light in the shadow of something else: `lit` is 1 where it
// arrives. The border of a shadow is a mixture of the tones on its two sides; no other tone
// is drawn along it.
fn shadowed_tone(ramp: Ramp, arriving: f32, width: f32, lit: f32) -> vec3<f32> {
    // The highest edge: 0 where the tone is that of the first stop.
    var edge = 0.0;
    for (var k = 1u; k < STOPS; k++) {
        let stop = ramp.stops[k];
        edge = max(edge, edge_at(stop.at, arriving, max(stop.softness, width)));
    }
    // Where an edge and the border of a shadow meet in a pixel, the darker one counts.
    let kept = min(lit, edge) / max(edge, 1e-9);
    return mix(ramp.stops[0].color, tone(ramp, arriving, width), kept);
}
