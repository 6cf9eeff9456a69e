#define_import_path bevy_comics::effects::hatching

// Shades with strokes that lie on things: where surfaces meet families of parallel planes.
// Planes are nested: those of one level are every second one of the next.

#import bevy_comics::effect::color::lightness
#import bevy_comics::effect::nested::{Level, level_of, mark_of, noise_along, place_of, stroke_factor, stroke_start}
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::lines::edge::line_coverage
#ifdef HATCHING_ON_THINGS
#import bevy_comics::depth::map::is_background
#import bevy_comics::depth::normal::load_normal
#import bevy_comics::depth::raw::raw_depth
#import bevy_comics::depth::view::{depth_pixel, depth_texel, view}
#endif
#ifdef OBJECT_ANCHORS
#import bevy_comics::effect::similarity::rotated
#import bevy_comics::objects::{load_object, style_of}
#endif

const GROUND_PAPER: u32 = 1u;

struct Hatching {
    // World axes relative to the eye, from normalized device coordinates and the texel of the
    // depth texture.
    relative_from_clip: mat4x4<f32>,
    // Normals of the three families of planes, in the frame of the object or the world: columns.
    axes: mat3x3<f32>,
    eye: vec3<f32>,
    opacity: f32,
    ink: vec3<f32>,
    // Least distance of the planes' lines on the screen, physical pixels.
    spacing: f32,
    paper: vec3<f32>,
    // Length of a stroke, physical pixels.
    length: f32,
    // Unit vector towards the light, in world space.
    to_light: vec3<f32>,
    layers: u32,
    // Darkness of a layer before the next one begins.
    layer_darkness: f32,
    // Lightness of the darkest hatching, and from which there is none.
    shadows: f32,
    highlights: f32,
    gamma: f32,
    // Number of tones besides none; 0: all.
    levels: f32,
    breaks: f32,
    wobble: f32,
    pressure: f32,
    // Fraction of the hatching at the near and the far end of the depth map.
    near: f32,
    far: f32,
    seed: u32,
    ground: u32,
    // How far strokes turn into a plain tone where they would not continue.
    calm: f32,
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
}

// A line near a pixel. `line`: its distance in pixels, and half its width.
fn stroke(s: Hatching, line: vec2<f32>, along: vec2<f32>, level: Level, mark: u32, tone: f32) -> f32 {
    // Dark areas have straight, whole lines: they would cross.
    let free = 1.0 - tone;
    let wobble = 0.5 * s.spacing * s.wobble * free;
    let moved = line.x - wobble * noise_along(along, level.grown, 0.5, mark ^ s.seed);
    let start = stroke_start(mark, level.exponent);
    let breaks = stroke_factor(along.y + start, level.grown, s.breaks * free);
    let pressure = 1.0 + s.pressure * free * noise_along(along, level.grown, 4.0, ~mark ^ s.seed);
    return line_coverage(abs(moved), line.y * breaks * pressure);
}

// Coverage of a pixel by the lines of a family of planes. `axes`: its normal, and the other two axes
// of the frame; `number`: of the family.
fn family_cover(s: Hatching, on: Surface, axes: mat3x3<f32>, number: u32, tone: f32) -> f32 {
    let a = axes[0];
    let b = axes[1];
    let c = axes[2];
    let gradient = vec2(dot(a, on.across), dot(a, on.down));
    let change = max(length(gradient), 1e-25);
    let level = level_of(2.0 * s.spacing * change);
    // Distance of the old lines in pixels.
    let distance = level.size / change;
    let at = place_of(dot(a, on.place), dot(a, on.eye), level.size);
    let old = round(at.y);
    let fresh = round(at.y - 0.5);
    let first = i32(at.x) + i32(old);
    let second = 2 * (i32(at.x) + i32(fresh)) + 1;
    let half_width = s.spacing * tone;
    // Along the lines of a surface; of the two axes the one that changes clearly more: on the sides
    // of a box, both may change equally.
    let direction = cross(on.normal, a);
    let axis = select(b, c, abs(dot(c, direction)) > 1.1 * abs(dot(b, direction)));
    let change_along = vec2(dot(axis, on.across), dot(axis, on.down));
    let speed = abs(gradient.x * change_along.y - gradient.y * change_along.x) / change;
    let strokes = level_of(1.4 * s.length * max(speed, 1e-25));
    let along = place_of(dot(axis, on.place), dot(axis, on.eye), strokes.size);
    let old_mark = mark_of(first, level.exponent, number);
    let fresh_mark = mark_of(second, level.exponent - 1, number);
    let cover = stroke(s, vec2((at.y - old) * distance, half_width), along, strokes, old_mark, tone)
        + stroke(s, vec2((at.y - fresh - 0.5) * distance, level.grown * half_width), along, strokes, fresh_mark, tone);
    // Lines that are closer than the picture can show, or almost touch, are a plain tone.
    let shown = smoothstep(1.5, 2.5, 0.5 * distance) * (1.0 - smoothstep(0.9, 1.0, tone));
    return mix(tone, min(cover, 1.0), shown);
}

// How much of a family is seen: it has no lines where its planes are parallel to the surface.
fn family_weights(s: Hatching, normal: vec3<f32>) -> vec3<f32> {
    let n = normal * s.axes;
    return smoothstep(vec3(0.25), vec3(0.5), sqrt(max(1.0 - n * n, vec3(0.0))));
}

// The part of a layer's tone that one of its two families has.
fn shared_tone(tone: f32, weight: f32) -> f32 {
    return 1.0 - pow(max(1.0 - tone, 1e-20), weight);
}

// Coverage by a layer: its own family of planes, and another where that one has no lines. At most
// one family has none.
fn layer_cover(s: Hatching, on: Surface, g: vec3<f32>, layer: u32, tone: f32) -> f32 {
    let m = s.axes;
    var a = m[0];
    var b = m[1];
    var c = m[2];
    var share = g.x;
    var other = b;
    var other_number = 1u;
    var third = c;
    if layer == 1u {
        share = g.x * g.y;
        a = m[1];
        b = m[2];
        c = m[0];
        other = m[2];
        other_number = 2u;
        third = m[0];
    } else if layer == 2u {
        share = g.x * g.y * g.z;
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
    }
    var light = 1.0;
    if share > 0.0 {
        light = 1.0 - family_cover(s, on, mat3x3(a, b, c), layer, shared_tone(tone, share));
    }
    if share < 1.0 {
        let rest = shared_tone(tone, 1.0 - share);
        light *= 1.0 - family_cover(s, on, mat3x3(other, third, a), other_number, rest);
    }
    return 1.0 - light;
}

// Coverage by strokes of a mean darkness: layers, each up to its own darkness; the last has the
// rest.
fn hatched(s: Hatching, on: Surface, tone: f32) -> f32 {
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

// Darkness of the hatching at a lightness from 0 to 1.
fn hatching_tone(s: Hatching, light: f32) -> f32 {
    let t = 1.0 - smoothstep(s.shadows, s.highlights, light);
    let tone = select(pow(max(t, 1e-20), s.gamma), 0.0, t <= 0.0);
    if s.levels > 0.0 {
        return min(floor(tone * (s.levels + 1.0)), s.levels) / s.levels;
    }
    return tone;
}

// The colour between the strokes, so that the mean of an area stays what it was.
fn ground_color(s: Hatching, color: vec3<f32>, tone: f32) -> vec3<f32> {
    let t = min(tone, 0.9);
    return clamp((color - s.ink * t) / (1.0 - t), vec3(0.0), max(vec3(1.0), color));
}

// The surface at a place relative to the eye, in world axes. `h`: that place in homogeneous
// coordinates; `pixel`: width and height of a pixel in normalized device coordinates.
fn surface_at(m: mat4x4<f32>, h: vec4<f32>, pixel: vec2<f32>, normal: vec3<f32>) -> Surface {
    var on: Surface;
    on.place = h.xyz / h.w;
    on.normal = normal;
    let ray = normalize(m[2].xyz - on.place * m[2].w);
    // At the rim, surfaces are seen along their side.
    let towards = dot(normal, ray);
    let slope = select(-1.0, 1.0, towards > 0.0) * max(abs(towards), 0.02);
    let right = (m[0].xyz - on.place * m[0].w) / h.w * pixel.x;
    let below = (m[1].xyz - on.place * m[1].w) / h.w * pixel.y;
    on.across = right - ray * (dot(normal, right) / slope);
    on.down = below - ray * (dot(normal, below) / slope);
    return on;
}

// The surface in the frame of an object: the inverse of a rotation, given as a quaternion.
#ifdef OBJECT_ANCHORS
fn in_frame(on: Surface, centre: vec3<f32>, rotation: vec4<f32>) -> Surface {
    let back = vec4(-rotation.xyz, rotation.w);
    var moved = on;
    moved.place = rotated(back, on.place);
    moved.eye = rotated(back, on.eye - centre);
    moved.across = rotated(back, on.across);
    moved.down = rotated(back, on.down);
    moved.normal = rotated(back, on.normal);
    return moved;
}
#endif

// Whether a surface continues at a neighbour, from 1 to 0. `gap`: how far the neighbour is from where
// the surface would be, as a fraction of the largest distance of two strokes.
fn continues(gap: f32) -> f32 {
    return 1.0 - smoothstep(0.15, 0.5, gap);
}

// How much of the strokes is left, from how many of four neighbours continue the surface. At the edge
// of a large surface, two or three do.
fn strokes_left(calm: f32, neighbours: f32) -> f32 {
    return 1.0 - calm * (1.0 - smoothstep(0.75, 2.0, neighbours));
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

#ifdef HATCHING_ON_THINGS
#ifdef HATCHING_CALM
// Whether the surface at a pixel, in world axes, continues at a neighbour.
fn continues_at(s: Hatching, p: Pixel, on: Surface, offset: vec2<i32>) -> f32 {
    let corner = view.viewport.xy;
    let pixel = clamp(vec2<i32>(floor(p.position)) + offset, corner, corner + view.viewport.zw - 1);
    let at = depth_pixel(pixel);
    let d = depth_texel(at, 0);
    if is_background(raw_depth(view.raw, vec2<u32>(at), d)) {
        return 0.0;
    }
    let texel = (vec2<f32>(at - corner) + 0.5) / view.depth_scale;
    let clip = texel / vec2<f32>(view.viewport.zw) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let h = s.relative_from_clip * vec4(clip, d, 1.0);
    let away = texel - (p.inside + 0.5);
    let expected = on.place + on.across * away.x + on.down * away.y;
    let distance = 2.0 * s.spacing * max(length(on.across), length(on.down));
    return continues(length(h.xyz / h.w - expected) / max(distance, 1e-25));
}

// How much of the strokes is left at a pixel.
fn calmed(s: Hatching, p: Pixel, on: Surface) -> f32 {
    let r = i32(clamp(round(s.spacing), 2.0, 16.0));
    let beside = continues_at(s, p, on, vec2(r, 0)) + continues_at(s, p, on, vec2(-r, 0));
    let above = continues_at(s, p, on, vec2(0, r)) + continues_at(s, p, on, vec2(0, -r));
    return strokes_left(s.calm, beside + above);
}
#endif

// The surface at a pixel, in world axes; its normal is zero where there is none.
fn seen_surface(s: Hatching, p: Pixel) -> Surface {
    let pixel = vec2<i32>(floor(p.position));
    let at = depth_pixel(pixel);
    let d = depth_texel(at, 0);
    let n = load_normal(pixel);
    var on: Surface;
    if n.w == 0.0 || is_background(raw_depth(view.raw, vec2<u32>(at), d)) {
        return on;
    }
    let size = vec2<f32>(view.viewport.zw);
    let texel = (vec2<f32>(at - view.viewport.xy) + 0.5) / view.depth_scale;
    let clip = texel / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let h = s.relative_from_clip * vec4(clip, d, 1.0);
    on = surface_at(s.relative_from_clip, h, vec2(2.0, -2.0) / size, n.xyz);
    // From the middle of the texel to the middle of the pixel.
    let away = p.inside + 0.5 - texel;
    on.place += on.across * away.x + on.down * away.y;
    on.eye = s.eye;
    return on;
}

// The same in the axes of the object there, if strokes follow it.
fn anchored(on: Surface, pixel: vec2<i32>) -> Surface {
#ifdef OBJECT_ANCHORS
    let object = load_object(pixel);
    let style = style_of(object.y);
    if style.anchor_size > 0.0 {
        return in_frame(on, style.anchor_centre, style.anchor_rotation);
    }
#endif
    return on;
}
#endif

fn hatching(settings: Hatching, p: Pixel) -> Pixel {
    var out = p;
    var s = settings;
#ifdef ABSTRACTION
    s.spacing *= p.spacing;
#endif
    let color = p.color / max(p.alpha, 1e-3);
    var light = lightness(color);
#ifdef HATCHING_ON_THINGS
    let on = seen_surface(s, p);
#ifdef HATCHING_FACES
    light = 0.5 + 0.5 * clamp(dot(load_normal(vec2<i32>(floor(p.position))).xyz, s.to_light), -1.0, 1.0);
#endif
    let is_there = dot(on.normal, on.normal) > 0.0;
#else
    let on = page_at(p.position, s.spacing);
    let is_there = true;
#endif
    var cover = 0.0;
    var tone = 0.0;
    if is_there {
        tone = hatching_tone(s, light) * mix(s.near, s.far, p.depth.x) * p.prints.x;
#ifdef HATCHING_ON_THINGS
        cover = hatched(s, anchored(on, vec2<i32>(floor(p.position))), tone);
#ifdef HATCHING_CALM
        cover = mix(tone, cover, calmed(s, p, on));
#endif
#else
        cover = hatched(s, on, tone);
#endif
    }
    var ground = s.paper;
    if s.ground != GROUND_PAPER {
        ground = ground_color(s, color, tone);
    }
    // Nothing is drawn where the background shows through.
    out.color = mix(p.color, mix(ground, s.ink, cover) * p.alpha, s.opacity);
    return out;
}
