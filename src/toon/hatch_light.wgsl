#define_import_path bevy_comics::toon::hatch_light

// The strokes of a surface of the toon material.

#import bevy_comics::toon::hatch::{Hatch, hatch_drawing, hatch_tone}
#import bevy_comics::effect::strokes::{Surface, hatched, page_at, with_strokes}
#import bevy_pbr::mesh_view_bindings::globals
#ifdef HATCH_DOTS
#import bevy_comics::effect::stipple::stippled
#endif
#ifdef HATCH_ART_MAP
#import bevy_comics::toon::art_map::{art_ink, plane_tone, plane_weights}
#endif

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<uniform> hatch: Hatch;
#ifdef HATCH_ART_MAP
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var art_map: texture_2d<f32>;
#endif

// Where strokes are drawn.
struct HatchPlace {
    // At rest, in the space of the mesh with the scale of its entity.
    rest: Surface,
    // Coordinates of the pixel, and pixels per unit of the lengths of strokes.
    pixel: vec2<f32>,
    scale: f32,
    // Texture coordinates, and how they change from pixel to pixel.
    uv: vec2<f32>,
    right: vec2<f32>,
    down: vec2<f32>,
}

#ifdef HATCH_ART_MAP
// Ink of the map at coordinates, of a plane that has a part of a tone, in strokes of this size.
fn map_ink(at: vec2<f32>, right: vec2<f32>, down: vec2<f32>, scale: f32, tone: f32) -> f32 {
    if tone <= 0.0 {
        return 0.0;
    }
    let repeat = hatch.repeat;
    let step = repeat * scale;
    return art_ink(art_map, at * repeat, right * step, down * step, tone);
}

// Coverage by strokes of a mean darkness, from the map.
fn map_cover(at: HatchPlace, tone: f32) -> f32 {
#ifdef HATCH_REST
    let on = at.rest;
    let w = plane_weights(on.normal);
    let x = map_ink(on.place.zy, on.across.zy, on.down.zy, at.scale, plane_tone(tone, w.x));
    let y = map_ink(on.place.xz, on.across.xz, on.down.xz, at.scale, plane_tone(tone, w.y));
    let z = map_ink(on.place.xy, on.across.xy, on.down.xy, at.scale, plane_tone(tone, w.z));
    return 1.0 - (1.0 - x) * (1.0 - y) * (1.0 - z);
#else
    return map_ink(at.uv, at.right, at.down, at.scale, tone);
#endif
}
#endif

// Coverage by strokes of a mean darkness.
fn hatch_cover(at: HatchPlace, tone: f32) -> f32 {
#ifdef HATCH_ART_MAP
    return map_cover(at, tone);
#else
    var s = hatch.strokes;
    s.seed = hatch_drawing(hatch, globals.time);
    s.spacing *= at.scale;
    s.length *= at.scale;
#ifdef HATCH_REST
    let on = at.rest;
#else
    let on = page_at(at.pixel, s.spacing);
#endif
#ifdef HATCH_DOTS
    return stippled(s, on, tone);
#else
    return hatched(s, on, tone);
#endif
#endif
}

// The color of a surface with its strokes. `fraction`: of all light, what arrives.
fn with_hatching(color: vec3<f32>, fraction: f32, at: HatchPlace) -> vec3<f32> {
    let tone = hatch_tone(hatch, fraction);
    let drawn = with_strokes(hatch.strokes, color, tone, hatch_cover(at, tone));
    return mix(color, drawn, hatch.strokes.opacity);
}
