#define_import_path bevy_comics::cartoon::hatch_light

// The strokes of a surface of the cartoon material.

#import bevy_comics::cartoon::hatch::{Hatch, hatch_drawing, hatch_tone}
#import bevy_comics::effect::strokes::{Surface, hatched, page_at, with_strokes}
#import bevy_pbr::mesh_view_bindings::globals

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<uniform> hatch: Hatch;

// Where strokes are drawn.
struct HatchPlace {
    // At rest, in the space of the mesh with the scale of its entity.
    rest: Surface,
    // Coordinates of the pixel.
    pixel: vec2<f32>,
}

// Coverage by strokes of a mean darkness.
fn hatch_cover(at: HatchPlace, tone: f32) -> f32 {
    var s = hatch.strokes;
    s.seed = hatch_drawing(hatch, globals.time);
#ifdef HATCH_REST
    return hatched(s, at.rest, tone);
#else
    return hatched(s, page_at(at.pixel, s.spacing), tone);
#endif
}

// The colour of a surface with its strokes. `share`: of all light, what arrives.
fn with_hatching(color: vec3<f32>, share: f32, at: HatchPlace) -> vec3<f32> {
    let tone = hatch_tone(hatch, share);
    let drawn = with_strokes(hatch.strokes, color, tone, hatch_cover(at, tone));
    return mix(color, drawn, hatch.strokes.opacity);
}
