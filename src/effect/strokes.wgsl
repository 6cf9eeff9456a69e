#define_import_path bevy_comics::effect::strokes

// Strokes that lie on surfaces, where these meet families of parallel planes. Planes are nested:
// those of one level are every second one of the next. For the effect `Hatching` and the toon
// material.

#import bevy_comics::effect::nested::{
    Level, Place, TAPER, level_of, mark_of, noise_along, place_of, stroke_factor, stroke_start,
}
#ifdef WORLD_ORIGIN
#import bevy_comics::effect::nested::{place_of_split, split}
#endif
#import bevy_comics::lines::edge::line_coverage

const GROUND_PAPER: u32 = 1u;

struct Strokes {
    // Normals of the three families of planes, in the frame of the object or the world: columns.
    axes: mat3x3<f32>,
    ink: vec3<f32>,
    opacity: f32,
    paper: vec3<f32>,
    // Least distance of the planes' lines on the screen, physical pixels.
    spacing: f32,
    // Length of a stroke, physical pixels.
    length: f32,
    layers: u32,
    // Darkness of a layer before the next one begins.
    layer_darkness: f32,
    // Lightness of the darkest hatching, and from which there is none.
    solid_below: f32,
    bare_above: f32,
    gamma: f32,
    // Number of tones besides none; 0: all.
    levels: f32,
    breaks: f32,
    wobble: f32,
    pressure: f32,
    seed: u32,
    ground: u32,
}

// A place on a surface, in the frame that the strokes are fixed to.
struct Surface {
    // From the eye, and the eye itself.
    place: vec3<f32>,
    eye: vec3<f32>,
    // How the place changes from pixel to pixel.
    across: vec3<f32>,
    down: vec3<f32>,
    normal: vec3<f32>,
#ifdef WORLD_ORIGIN
    // Whether the frame is the world. Then `eyes` are the coordinates of the eye.
    is_world: bool,
#endif
}

#ifdef WORLD_ORIGIN
// Coordinates of the eye in the true world along the directions of marks, see strokes.rs: two in each.
var<private> eyes: array<vec4<i32>, 15>;

fn set_eyes(values: array<vec4<i32>, 15>) {
    eyes = values;
}
#endif

// The place of a surface along a direction, which has a number in strokes.rs.
fn place_along(on: Surface, direction: vec3<f32>, number: u32, level: Level) -> Place {
#ifdef WORLD_ORIGIN
    let two = eyes[number / 2u];
    let of_world = select(two.xy, two.zw, number % 2u == 1u);
    let eye = select(split(dot(direction, on.eye)), of_world, on.is_world);
    return place_of_split(dot(direction, on.place), eye, level);
#else
    return place_of(dot(direction, on.place), dot(direction, on.eye), level.size);
#endif
}

// How far a stroke reaches from its line at most, in pixels. `line`: see stroke.
fn stroke_reach(s: Strokes, line: vec2<f32>, tone: f32) -> f32 {
    let free = 1.0 - tone;
    let widest = line.y * (1.0 + s.pressure * free) / (1.0 - TAPER * s.breaks * free);
    return widest + 0.5 * s.spacing * s.wobble * free + 0.5;
}

// A line near a pixel. `line`: its distance in pixels, and half its width.
fn stroke(s: Strokes, line: vec2<f32>, along: Place, level: Level, mark: u32, tone: f32) -> f32 {
    // Dark areas have straight, whole lines: they would cross.
    let free = 1.0 - tone;
    let wobble = 0.5 * s.spacing * s.wobble * free;
    let moved = line.x - wobble * noise_along(along, level, -1, mark ^ s.seed);
    let start = stroke_start(mark, level.exponent);
    let breaks = stroke_factor(along.at + start, level.grown, s.breaks * free);
    let pressure = 1.0 + s.pressure * free * noise_along(along, level, 2, ~mark ^ s.seed);
    return line_coverage(abs(moved), line.y * breaks * pressure);
}

// Coverage of a pixel by the lines of a family of planes. `axes`: its normal, and the other two axes
// of the frame; `numbers`: of these directions; `number`: of the family.
fn family_cover(
    s: Strokes,
    on: Surface,
    axes: mat3x3<f32>,
    numbers: vec3<u32>,
    number: u32,
    tone: f32,
) -> f32 {
    let a = axes[0];
    let b = axes[1];
    let c = axes[2];
    let gradient = vec2(dot(a, on.across), dot(a, on.down));
    let change = max(length(gradient), 1e-25);
    let level = level_of(2.0 * s.spacing * change);
    // Distance of the old lines in pixels.
    let distance = level.size / change;
    let at = place_along(on, a, numbers.x, level);
    let old = round(at.at);
    let fresh = round(at.at - 0.5);
    let first = at.number + i32(old);
    let second = 2 * (at.number + i32(fresh)) + 1;
    let half_width = s.spacing * tone;
    // Along the lines of a surface; of the two axes the one that changes clearly more: on the sides
    // of a box, both may change equally.
    let direction = cross(on.normal, a);
    let is_third = abs(dot(c, direction)) > 1.1 * abs(dot(b, direction));
    let axis = select(b, c, is_third);
    let change_along = vec2(dot(axis, on.across), dot(axis, on.down));
    let speed = abs(gradient.x * change_along.y - gradient.y * change_along.x) / change;
    let strokes = level_of(1.4 * s.length * max(speed, 1e-25));
    let along = place_along(on, axis, select(numbers.y, numbers.z, is_third), strokes);
    let old_mark = mark_of(first, level.exponent, number);
    let fresh_mark = mark_of(second, level.exponent - 1, number);
    let old_line = vec2((at.at - old) * distance, half_width);
    let fresh_line = vec2((at.at - fresh - 0.5) * distance, level.grown * half_width);
    // The line whose edge is nearer, and the other one where it reaches the pixel.
    let is_old = abs(old_line.x) - old_line.y <= abs(fresh_line.x) - fresh_line.y;
    let nearer = select(fresh_line, old_line, is_old);
    let other = select(old_line, fresh_line, is_old);
    var cover = stroke(s, nearer, along, strokes, select(fresh_mark, old_mark, is_old), tone);
    if abs(other.x) < stroke_reach(s, other, tone) {
        cover += stroke(s, other, along, strokes, select(old_mark, fresh_mark, is_old), tone);
    }
    // Lines that are closer than the picture can show, or almost touch, are a plain tone.
    let shown = smoothstep(1.5, 2.5, 0.5 * distance) * (1.0 - smoothstep(0.9, 1.0, tone));
    return mix(tone, min(cover, 1.0), shown);
}

// How much of a family is seen: it has no lines where its planes are parallel to the surface.
fn family_weights(s: Strokes, normal: vec3<f32>) -> vec3<f32> {
    let n = normal * s.axes;
    return smoothstep(vec3(0.25), vec3(0.5), sqrt(max(1.0 - n * n, vec3(0.0))));
}

// The part of a layer's tone that one of its two families has.
fn shared_tone(tone: f32, weight: f32) -> f32 {
    return 1.0 - pow(max(1.0 - tone, 1e-20), weight);
}

// Coverage by a layer: its own family of planes, and another where that one has no lines. At most
// one family has none.
fn layer_cover(s: Strokes, on: Surface, g: vec3<f32>, layer: u32, tone: f32) -> f32 {
    let m = s.axes;
    var a = m[0];
    var b = m[1];
    var c = m[2];
    var fraction = g.x;
    var other = b;
    var other_number = 1u;
    var third = c;
    let numbers = vec3(layer, (layer + 1u) % 3u, (layer + 2u) % 3u);
    var other_numbers = numbers.yzx;
    if layer == 1u {
        fraction = g.x * g.y;
        a = m[1];
        b = m[2];
        c = m[0];
        other = m[2];
        other_number = 2u;
        third = m[0];
    } else if layer == 2u {
        fraction = g.x * g.y * g.z;
        a = m[2];
        b = m[0];
        c = m[1];
        // Between the two families of the other layers.
        let no_x = g.x < min(g.y, g.z);
        let no_y = g.y < min(g.x, g.z);
        let one = select(m[0], m[1], no_x);
        let two = select(select(m[1], m[2], no_y), m[2], no_x);
        other = (one + two) * 0.70710678;
        third = (one - two) * 0.70710678;
        other_number = 3u;
        let pair = select(select(0u, 1u, no_y), 2u, no_x);
        other_numbers = vec3(3u + 2u * pair, 4u + 2u * pair, 2u);
    }
    var light = 1.0;
    if fraction > 0.0 {
        let own = shared_tone(tone, fraction);
        light = 1.0 - family_cover(s, on, mat3x3(a, b, c), numbers, layer, own);
    }
    if fraction < 1.0 {
        let rest = shared_tone(tone, 1.0 - fraction);
        let axes = mat3x3(other, third, a);
        light *= 1.0 - family_cover(s, on, axes, other_numbers, other_number, rest);
    }
    return 1.0 - light;
}

// Coverage by strokes of a mean darkness: layers, each up to its own darkness; the last has the
// rest.
fn hatched(s: Strokes, on: Surface, tone: f32) -> f32 {
    let g = family_weights(s, on.normal);
    var left = clamp(tone, 0.0, 1.0);
    var light = 1.0;
    for (var layer = 0u; layer < s.layers; layer++) {
        if left <= 0.0 {
            break;
        }
        var own = min(left, s.layer_darkness);
        if layer + 1u == s.layers {
            own = left;
        }
        light *= 1.0 - layer_cover(s, on, g, layer, own);
        left = max(1.0 - (1.0 - left) / (1.0 - min(own, 0.999999)), 0.0);
    }
    return 1.0 - light;
}

// Darkness of strokes at a lightness from 0 to 1.
fn darkness(s: Strokes, light: f32) -> f32 {
    // 1 - smoothstep, but exact near 0, where a power below 1 shows what 1 - x rounds off.
    let u = clamp((s.bare_above - light) / (s.bare_above - s.solid_below), 0.0, 1.0);
    let t = u * u * (3.0 - 2.0 * u);
    let tone = select(pow(max(t, 1e-20), s.gamma), 0.0, t <= 0.0);
    if s.levels > 0.0 {
        return min(floor(tone * (s.levels + 1.0)), s.levels) / s.levels;
    }
    return tone;
}

// The color between the strokes, so that the mean of an area stays what it was.
fn ground_color(s: Strokes, color: vec3<f32>, tone: f32) -> vec3<f32> {
    let t = min(tone, 0.9);
    return clamp((color - s.ink * t) / (1.0 - t), vec3(0.0), max(vec3(1.0), color));
}

// The color of a surface that is covered by strokes.
fn with_strokes(s: Strokes, color: vec3<f32>, tone: f32, cover: f32) -> vec3<f32> {
    var ground = s.paper;
    if s.ground != GROUND_PAPER {
        ground = ground_color(s, color, tone);
    }
    return mix(ground, s.ink, cover);
}

// The page at a place in pixels. Its unit is the distance of lines.
fn page_at(place: vec2<f32>, spacing: f32) -> Surface {
    var on: Surface;
    let unit = 0.5 / spacing;
    on.place = vec3(place * unit, 0.0);
    on.across = vec3(unit, 0.0, 0.0);
    on.down = vec3(0.0, unit, 0.0);
    on.normal = vec3(0.0, 0.0, 1.0);
    return on;
}
