#define_import_path bevy_comics::effects::halftone

// Prints the picture with screens of dots or lines.

#import bevy_comics::effect::blue_noise::blue_noise_around
#import bevy_comics::effect::color::{lightness, luminance, separated}
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::effect::screen::{
    LEAST, bled_tone, cross_lines, diamond, diamond_edges, disc, disc_edges, euclidean,
    euclidean_edges, gained, grain_covers, line, paler, tinted,
}
#import bevy_comics::effect::sheet::sheet_height
#ifdef EFFECT_HALFTONE_CELLS
#import bevy_comics::effect::picture::picture_at
#endif
#ifdef EFFECT_HALFTONE_FOLLOWS
#import bevy_comics::depth::view::view
#import bevy_comics::effect::similarity::{Similarity, similarity_of}
#endif
#ifdef OBJECT_ANCHORS
#import bevy_comics::objects::{load_object, style_of}
#endif

const MODE_CMYK: u32 = 0u;
const MODE_SPOT: u32 = 1u;
const MODE_DUOTONE: u32 = 2u;
const MODE_RGB: u32 = 3u;

const SHAPE_ROUND: u32 = 0u;
const SHAPE_EUCLIDEAN: u32 = 1u;
const SHAPE_LINE: u32 = 2u;
const SHAPE_DIAMOND: u32 = 3u;
const SHAPE_CROSS: u32 = 4u;
const SHAPE_STOCHASTIC: u32 = 5u;

struct Halftone {
    // Cosines and sines of the angles of the plates (cyan, magenta, yellow, black),
    // divided by the size of a cell.
    cosines: vec4<f32>,
    sines: vec4<f32>,
    // Light that each ink takes away, in w: unused.
    cyan: vec4<f32>,
    magenta: vec4<f32>,
    yellow: vec4<f32>,
    black: vec4<f32>,
    paper: vec3<f32>,
    opacity: f32,
    // Where the screens begin: physical pixels in the render target.
    center: vec2<f32>,
    // Physical pixels: size of a cell of the screens, and of a grain.
    cell_size: f32,
    grain: f32,
    // Fraction of the screens at the near and the far end of the depth map.
    at_near: f32,
    at_far: f32,
    // Lightness from which the screens fade out.
    shadows_only_below: f32,
    black_generation: f32,
    gain: f32,
    tints: f32,
    // Lightness that is printed solid, and 1 / the difference to that of bare paper.
    solid_below: f32,
    contrast: f32,
    // Duotone: darkness at which the first ink is solid.
    pivot: f32,
    mode: u32,
    shape: u32,
    // The sheet: its number, by how many physical pixels edges are displaced at most, and places
    // on it per physical pixel.
    sheet: u32,
    ink_bleed: f32,
    sheet_scale: f32,
    // Where the sheet begins in the render target, in physical pixels.
    sheet_corner: vec2<f32>,
    // FOLLOWS: clip space from world space.
    clip_from_world: mat4x4<f32>,
}

// Where the screens of a pixel lie.
struct Screen {
    // Where they begin: physical pixels in the render target.
    center: vec2<f32>,
    // Cosine and sine of their turn, clockwise; and their size.
    turn: vec2<f32>,
    size: f32,
    // Height of the sheet under the pixel, -1 to 1.
    height: f32,
}

// The mode: compiled in by the fused pass, else that of the settings.
fn mode_of(s: Halftone) -> u32 {
#ifdef EFFECT_HALFTONE_MODE
    return #{EFFECT_HALFTONE_MODE}u;
#else
    return s.mode;
#endif
}

fn shape_of(s: Halftone) -> u32 {
#ifdef EFFECT_HALFTONE_SHAPE
    return #{EFFECT_HALFTONE_SHAPE}u;
#else
    return s.shape;
#endif
}

// Whether tones, levels or screens depend on more than the color: compiled in, see `adjusts` in
// mod.rs.
fn adjusts(s: Halftone) -> bool {
#ifdef EFFECT_HALFTONE_ADJUSTED
    let adjusted = #{EFFECT_HALFTONE_ADJUSTED}u;
    return adjusted == 1u;
#else
    return true;
#endif
}

// Whether ink runs into the valleys of a sheet.
fn spreads(s: Halftone) -> bool {
#ifdef EFFECT_HALFTONE_SPREADS
    let compiled = #{EFFECT_HALFTONE_SPREADS}u;
    return compiled == 1u;
#else
    return s.ink_bleed > 0.0;
#endif
}

// A color in linear light: lightness from `solid_below` to `bare_above` is stretched to all of it.
fn stretched(s: Halftone, color: vec3<f32>) -> vec3<f32> {
    let c = clamp(color, vec3(0.0), vec3(1.0));
    if !adjusts(s) {
        return c;
    }
    let level = clamp((sqrt(c) - s.solid_below) * s.contrast, vec3(0.0), vec3(1.0));
    return select(level * level, c, s.solid_below == 0.0 && s.contrast == 1.0);
}

fn printed_tone(s: Halftone, tone: f32) -> f32 {
    let t = clamp(tone, 0.0, 1.0);
    if !adjusts(s) {
        return t;
    }
    return gained(tinted(t, s.tints), s.gain);
}

// Tones of the plates for a color in linear light: cyan, magenta, yellow, black; in
// MODE_RGB of the lights red, green, blue.
fn plate_tones(s: Halftone, color: vec3<f32>) -> vec4<f32> {
    let c = stretched(s, color);
    let mode = mode_of(s);
    let dark = 1.0 - luminance(c);
    var tones = vec4(0.0, 0.0, 0.0, dark);
    if mode == MODE_CMYK {
        tones = separated(c, s.black_generation);
    } else if mode == MODE_DUOTONE {
        // The second ink begins where the first is solid.
        tones.x = min(dark / s.pivot, 1.0);
        tones.w = (dark - s.pivot) / (1.0 - s.pivot);
    } else if mode == MODE_RGB {
        tones = vec4(c, 0.0);
    }
    return vec4(
        printed_tone(s, tones.x), printed_tone(s, tones.y),
        printed_tone(s, tones.z), printed_tone(s, tones.w),
    );
}

// Coordinates of a place in the cells of a plate. `turn`: cosine and sine / cell size.
fn cell_at(place: vec2<f32>, turn: vec2<f32>, phase: f32) -> vec2<f32> {
    return vec2(dot(place, turn), dot(place, vec2(-turn.y, turn.x))) + phase;
}

// Square grains that are printed or not, averaged over the pixel. Each plate has its own
// part of the tile.
fn stochastic(s: Halftone, place: vec2<f32>, tone: f32, plate: i32) -> f32 {
    let half = 0.5 / s.grain;
    let low = place / s.grain - half;
    let first = floor(low);
    let f = clamp((low + 2.0 * half - first - 1.0) / (2.0 * half), vec2(0.0), vec2(1.0));
    let grains = grain_covers(tone, blue_noise_around(vec2<i32>(first), plate));
    let columns = mix(grains.xz, grains.yw, f.x);
    return mix(columns.x, columns.y, f.y);
}

// The screens on the page.
fn page_screen(s: Halftone, height: f32) -> Screen {
    return Screen(s.center, vec2(1.0, 0.0), 1.0, height);
}

// Height of the sheet under a pixel, if ink runs into its valleys.
fn height_under(s: Halftone, p: Pixel) -> f32 {
    if !spreads(s) {
        return 0.0;
    }
    return sheet_height((p.position - s.sheet_corner) * s.sheet_scale, s.sheet);
}

// Length of the edges of a shape in a cell, in cell sizes. Of grains, it is that of squares that
// are a third of a cell wide and printed at random.
fn edges(shape: u32, tone: f32) -> f32 {
    if shape == SHAPE_ROUND {
        return disc_edges(tone);
    } else if shape == SHAPE_EUCLIDEAN {
        return euclidean_edges(tone);
    } else if shape == SHAPE_LINE {
        return 2.0;
    } else if shape == SHAPE_DIAMOND {
        return diamond_edges(tone);
    } else if shape == SHAPE_CROSS {
        return 4.0 * sqrt(1.0 - tone);
    }
    return 12.0 * tone * (1.0 - tone);
}

// The tone that a screen shows at a pixel, within LEAST: edges of ink follow the sheet.
fn tone_on_sheet(s: Halftone, on: Screen, tone: f32, cell_size: f32) -> f32 {
    let t = clamp(tone, LEAST, 1.0 - LEAST);
    if !spreads(s) {
        return t;
    }
    return bled_tone(t, edges(shape_of(s), t), s.ink_bleed / cell_size, on.height);
}

// Cosine and sine of the angle of a plate, divided by the size of its cells.
fn plate_turn(s: Halftone, on: Screen, plate: i32) -> vec2<f32> {
    let own = vec2(s.cosines[plate], s.sines[plate]);
#ifdef EFFECT_HALFTONE_FOLLOWS
    let t = on.turn / on.size;
    return vec2(own.x * t.x - own.y * t.y, own.x * t.y + own.y * t.x);
#else
    return own;
#endif
}

// Coverage of a pixel by a plate (0 cyan, 1 magenta, 2 yellow, 3 black). `place`: pixels
// from where the screens begin.
fn plate_cover(s: Halftone, on: Screen, place: vec2<f32>, plate: i32, tone: f32) -> f32 {
    let cell_size = s.cell_size * on.size;
    let t = tone_on_sheet(s, on, tone, cell_size);
    let turn = plate_turn(s, on, plate);
    let at = cell_at(place, turn, plate_phase(plate));
    let sides = abs(turn);
    let shape = shape_of(s);
    var k = 0.0;
    if shape == SHAPE_ROUND {
        k = disc(at, t, cell_size);
    } else if shape == SHAPE_EUCLIDEAN {
        k = euclidean(at, t, cell_size);
    } else if shape == SHAPE_LINE {
        k = line(at.x, t, sides.x + sides.y);
    } else if shape == SHAPE_DIAMOND {
        k = diamond(at, t, cell_size);
    } else if shape == SHAPE_CROSS {
        k = cross_lines(at, t, sides.x + sides.y);
    } else {
        k = stochastic(s, place, t, plate);
    }
    return paler(k, tone);
}

// A quarter of a cell keeps black independent of the others: at 15, 75 and 45 degrees,
// the sum of the frequencies of cyan and magenta is that of black.
fn plate_phase(plate: i32) -> f32 {
    return select(0.0, 0.25, plate == 3);
}

// Fraction of the screens at a pixel, 0 (plain tones) to 1.
fn screen_amount(s: Halftone, color: vec3<f32>, depth: f32) -> f32 {
    if !adjusts(s) {
        return mix(s.at_near, s.at_far, depth);
    }
    let shade = 1.0 - smoothstep(s.shadows_only_below, s.shadows_only_below + 0.1, lightness(color));
    return mix(s.at_near, s.at_far, depth) * shade;
}

// The color of inks on paper. `k`: coverage of each plate.
fn inked(s: Halftone, k: vec4<f32>) -> vec3<f32> {
    if mode_of(s) == MODE_RGB {
        return k.xyz;
    }
    return s.paper * (1.0 - k.x * s.cyan.rgb) * (1.0 - k.y * s.magenta.rgb)
        * (1.0 - k.z * s.yellow.rgb) * (1.0 - k.w * s.black.rgb);
}

#ifdef EFFECT_HALFTONE_CELLS
// The mean color of four places in the cell of a plate that a pixel lies in; `own` where
// the background shows through.
fn cell_color(s: Halftone, on: Screen, position: vec2<f32>, own: vec3<f32>, plate: i32) -> vec3<f32> {
    let turn = plate_turn(s, on, plate);
    let cell_size = s.cell_size * on.size;
    let at = cell_at(position - on.center, turn, plate_phase(plate));
    var sum = vec3(0.0);
    for (var i = 0; i < 4; i++) {
        let e = round(at) - at + 0.5 * vec2(f32(i & 1), f32(i >> 1u)) - 0.25;
        let back = cell_size * cell_size * vec2(dot(e, vec2(turn.x, -turn.y)), dot(e, turn.yx));
        let found = picture_at(position + back);
        sum += found.rgb + (1.0 - found.a) * own;
    }
    return 0.25 * sum;
}
#endif

// The tone that a plate prints at a pixel, whose own one is `tone`.
fn tone_read(s: Halftone, on: Screen, p: Pixel, color: vec3<f32>, plate: i32, tone: f32) -> f32 {
#ifdef EFFECT_HALFTONE_CELLS
    return plate_tones(s, cell_color(s, on, p.position, color, plate))[plate];
#else
    return tone;
#endif
}

// Coverage at a place by a plate, of which `amount` is seen as dots and the rest as a plain tone.
fn screened(s: Halftone, on: Screen, place: vec2<f32>, amount: f32, plate: i32, tone: f32) -> f32 {
    return mix(tone, plate_cover(s, on, place, plate, tone), amount);
}

// Coverages at a pixel by all plates.
fn covers(s: Halftone, on: Screen, p: Pixel, color: vec3<f32>, amount: f32, tones: vec4<f32>) -> vec4<f32> {
    let mode = mode_of(s);
    let place = p.position - on.center;
    var k = vec4(0.0);
    if mode != MODE_SPOT {
        k.x = screened(s, on, place, amount, 0, tone_read(s, on, p, color, 0, tones.x));
    }
    if mode == MODE_CMYK || mode == MODE_RGB {
        k.y = screened(s, on, place, amount, 1, tone_read(s, on, p, color, 1, tones.y));
        k.z = screened(s, on, place, amount, 2, tone_read(s, on, p, color, 2, tones.z));
    }
    if mode != MODE_RGB {
        k.w = screened(s, on, place, amount, 3, tone_read(s, on, p, color, 3, tones.w));
    }
    return k;
}

#ifdef EFFECT_HALFTONE_FOLLOWS
// Where the object at a pixel is on the page. Of size 0 if screens do not follow it.
fn followed(s: Halftone, p: Pixel) -> Similarity {
    var found: Similarity;
#ifdef OBJECT_ANCHORS
    let style = style_of(load_object(vec2<i32>(p.position)).y);
    if style.anchor_size > 0.0 {
        found = similarity_of(
            s.clip_from_world, vec4<f32>(view.viewport),
            style.anchor_center, style.anchor_size, style.anchor_rotation,
        );
    }
#endif
    return found;
}

// How much of a screen of a size is seen: finer ones than the picture can show would be noise.
fn shown_amount(s: Halftone, size: f32) -> f32 {
    return select(smoothstep(1.5, 2.5, s.cell_size * size), 1.0, shape_of(s) == SHAPE_STOCHASTIC);
}

// Coverages by the plates of an object that they follow. Both octaves have the tone, so that
// their mixture has it too.
fn followed_covers(s: Halftone, p: Pixel, color: vec3<f32>, amount: f32, tones: vec4<f32>) -> vec4<f32> {
    let f = followed(s, p);
    let height = height_under(s, p);
    if f.size == 0.0 {
        return covers(s, page_screen(s, height), p, color, amount, tones);
    }
    // Grains cannot turn.
    let turns = shape_of(s) != SHAPE_STOCHASTIC;
    let turn = select(vec2(1.0, 0.0), f.turn, turns);
    let own = Screen(f.origin, turn, select(1.0, f.size, turns), height);
    let k = covers(s, own, p, color, amount * shown_amount(s, own.size), tones);
    if f.fade == 0.0 || !turns {
        return k;
    }
    let other = Screen(f.origin, turn, f.other, height);
    let fading = covers(s, other, p, color, amount * shown_amount(s, f.other), tones);
    return mix(k, fading, f.fade);
}
#endif

fn halftone(s: Halftone, p: Pixel) -> Pixel {
    var out = p;
    let color = p.color / max(p.alpha, 1e-3);
    let tones = plate_tones(s, color);
    let amount = screen_amount(s, color, p.depth.x) * p.print_factors.y;
#ifdef EFFECT_HALFTONE_FOLLOWS
    let k = followed_covers(s, p, color, amount, tones);
#else
    let k = covers(s, page_screen(s, height_under(s, p)), p, color, amount, tones);
#endif
    // Nothing is printed where the background shows through.
    out.color = mix(p.color, inked(s, k) * p.alpha, s.opacity);
    return out;
}
