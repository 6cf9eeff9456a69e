#define_import_path bevy_comics::toon::ramp

// Tones by how much light arrives: pure functions (Lake et al. 2000).

#import bevy_comics::toon::light::edge_at
#import bevy_comics::effect::color::oklab_to_linear

// Only as many stops are read and evaluated as the ramp has.
#ifdef RAMP_STOPS
const STOPS: u32 = #{RAMP_STOPS}u;
#else
const STOPS: u32 = 8u;
#endif

struct Stop {
    // Linear light; OKLab if the ramp has a second one.
    color: vec3<f32>,
    // How much light arrives where the tone begins, 0 to 1. Stops are sorted; those that are
    // not used lie far beyond 1.
    at: f32,
    // Of the second ramp, the one without detail: OKLab, and the place of its edge.
    plain_color: vec3<f32>,
    plain_at: f32,
    // Width of the transition, in the unit of `at`; and that of the second ramp.
    softness: f32,
    plain_softness: f32,
}

struct Ramp {
    // Exponent of the light in `LightFraction`: 0 keeps nothing of its strength, 1 all.
    keep_intensity: f32,
    // The last member, since a variant of the shader declares only what it reads of it.
    stops: array<Stop, STOPS>,
}

// The stop between both ramps, at a `detail` from 0 (the second ramp) to 1.
fn mixed_stop(stop: Stop, detail: f32) -> Stop {
    var mixed = stop;
    mixed.color = max(oklab_to_linear(mix(stop.plain_color, stop.color, detail)), vec3(0.0));
    mixed.at = mix(stop.plain_at, stop.at, detail);
    mixed.softness = mix(stop.plain_softness, stop.softness, detail);
    return mixed;
}

fn mixed_ramp(ramp: Ramp, detail: f32) -> Ramp {
    var mixed = ramp;
    for (var k = 0u; k < STOPS; k++) {
        mixed.stops[k] = mixed_stop(ramp.stops[k], detail);
    }
    return mixed;
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
