#define_import_path bevy_comics::toon::art_map

// Strokes from a tonal art map (Praun et al. 2001), of which each texel holds the tone from which it is
// ink (Webb et al. 2002). Functions of a texture that is given.

#import bevy_comics::toon::stroke_level::stroke_level

// Width of the step from paper to ink: a few of the 256 tones of a texel.
const STEP: f32 = 0.0156;

// Ink of a texel at a tone: none at 0, all at 1.
fn ink_at(tone: f32, threshold: f32) -> f32 {
    return clamp((tone * (1.0 + STEP) - threshold) / STEP, 0.0, 1.0);
}

// How much of each plane of coordinates counts on a surface, by its normal: the one that it faces, and
// two or three where it faces between them. The sum is 1.
fn plane_weights(normal: vec3<f32>) -> vec3<f32> {
    let n = max(normal * normal - 0.2, vec3(0.0));
    let w = n * n;
    return w / max(w.x + w.y + w.z, 1e-20);
}

// The part of a tone that a plane of this weight has. The light that planes leave is multiplied.
fn plane_tone(tone: f32, weight: f32) -> f32 {
    return 1.0 - pow(max(1.0 - tone, 1e-20), weight);
}

fn texel_ink(map: texture_2d<f32>, texel: vec2<i32>, size: vec2<i32>, level: i32, tone: f32) -> f32 {
    // `texel` is less than one row or column outside.
    return ink_at(tone, textureLoad(map, (texel + size) % size, level).r);
}

// Ink at a place in a level. Ink is filtered, not thresholds, whose mean has no meaning.
fn level_ink(map: texture_2d<f32>, place: vec2<f32>, level: i32, tone: f32) -> f32 {
    let size = vec2<i32>(textureDimensions(map, level));
    let at = fract(place) * vec2<f32>(size) - 0.5;
    let corner = vec2<i32>(floor(at));
    let part = at - floor(at);
    let above = mix(
        texel_ink(map, corner, size, level, tone),
        texel_ink(map, corner + vec2(1, 0), size, level, tone),
        part.x,
    );
    let below = mix(
        texel_ink(map, corner + vec2(0, 1), size, level, tone),
        texel_ink(map, corner + vec2(1, 1), size, level, tone),
        part.x,
    );
    return mix(above, below, part.y);
}

fn last_level(map: texture_2d<f32>) -> f32 {
#ifdef NO_TEXTURE_LEVELS
    // WebGL 2 cannot ask for it: that of maps which `TonalArtMap` draws.
    let size = vec2<f32>(textureDimensions(map));
    return max(floor(log2(min(size.x, size.y))) - 4.0, 0.0);
#else
    return f32(textureNumLevels(map) - 1u);
#endif
}

// Ink at a place in repeats of the map. `right` and `down`: its changes from pixel to pixel.
fn art_ink(map: texture_2d<f32>, place: vec2<f32>, right: vec2<f32>, down: vec2<f32>, tone: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(map));
    let last = last_level(map);
    // Half a level coarser: texels are 0.7 to 1.4 pixels.
    let wanted = stroke_level(right * size, down * size) + 0.5;
    let level = clamp(wanted, 0.0, last);
    let fine = floor(level);
    var ink = level_ink(map, place, i32(fine), tone);
    if level > fine {
        ink = mix(ink, level_ink(map, place, i32(fine) + 1, tone), level - fine);
    }
    // Strokes that are smaller than the last level can show are a plain tone.
    return mix(ink, tone, clamp(wanted - last, 0.0, 1.0));
}
