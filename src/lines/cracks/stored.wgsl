#define_import_path bevy_comics::lines::stored

// Reads the cracks of a pixel of the grid: the only module that declares binding 11.

#import bevy_comics::lines::bend::unpack_bend
#import bevy_comics::lines::edge::{Grid, is_silhouette, line_middle}

#ifdef BLOCKS
@group(0) @binding(11) var<storage> crack_words: array<vec2<u32>>;
#ifdef SMOOTH
@group(0) @binding(19) var<storage> bend_words: array<u32>;
#endif
#else
@group(0) @binding(11) var crack_texture: texture_2d<u32>;
#endif

// The cracks to the east (x) and south (y) of a pixel, see Crack in edge.wgsl.
fn load_cracks(g: Grid, p: vec2<i32>) -> vec2<u32> {
#ifdef BLOCKS
    return crack_words[p.y * g.rect.z + p.x];
#else
    return textureLoad(crack_texture, p, 0).xy;
#endif
}

// How their lines leave them, see bend.wgsl: the lower half of the word is the crack to
// the east.
fn load_bends(g: Grid, p: vec2<i32>) -> u32 {
#ifdef SMOOTH
    return bend_words[p.y * g.rect.z + p.x];
#else
    return 0x80808080u;
#endif
}

// The middle of the line near a crack, in pixels from the center of the crack's pixel.
// `across`: the unit vector to the crack; `bend`: half of a word of load_bends.
fn stored_middle(packed: u32, across: vec2<f32>, bend: u32) -> vec2<f32> {
#ifdef VARIED
    // The middle of a line whose width changes is always the crack: the offset depends on the
    // width.
    let shifts = false;
#else ifdef SMOOTH
    // Along a fold, the pixel that owns the line changes at every step.
    let shifts = is_silhouette(packed);
#else
    let shifts = true;
#endif
    return line_middle(packed, across, unpack_bend(bend), shifts);
}
