#define_import_path bevy_comics::effects::hatching

// Shades with strokes that lie on things.

#import bevy_comics::effect::color::lightness
#import bevy_comics::effect::pixel::Pixel
#import bevy_comics::effect::strokes::{Strokes, Surface, darkness, hatched, page_at, with_strokes}
#ifdef EFFECT_HATCHING_DOTS
#import bevy_comics::effect::stipple::stippled
#endif
#ifdef EFFECT_HATCHING_ON_THINGS
#import bevy_comics::depth::map::is_background
#import bevy_comics::depth::normal::load_normal
#import bevy_comics::depth::raw::raw_depth
#import bevy_comics::depth::view::{depth_pixel, depth_texel, view}
#endif
#ifdef WORLD_ORIGIN
#import bevy_comics::effect::strokes::set_eyes
#endif
#ifdef OBJECT_ANCHORS
#import bevy_comics::effect::similarity::rotated
#import bevy_comics::objects::{load_object, style_of}
#endif

struct Hatching {
    // World axes relative to the eye, from normalized device coordinates and the texel of the
    // depth texture.
    relative_from_clip: mat4x4<f32>,
    strokes: Strokes,
    eye: vec3<f32>,
    // Fraction of the hatching at the near and the far end of the depth map.
    at_near: f32,
    // Unit vector towards the light, in world space.
    to_light: vec3<f32>,
    at_far: f32,
    // How far strokes turn into a plain tone where they would not continue.
    simplify_small: f32,
    // See strokes.wgsl.
    eyes: array<vec4<i32>, 15>,
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
fn in_frame(on: Surface, center: vec3<f32>, rotation: vec4<f32>) -> Surface {
    let back = vec4(-rotation.xyz, rotation.w);
    var moved = on;
    moved.place = rotated(back, on.place);
    moved.eye = rotated(back, on.eye - center);
    moved.across = rotated(back, on.across);
    moved.down = rotated(back, on.down);
    moved.normal = rotated(back, on.normal);
#ifdef WORLD_ORIGIN
    moved.is_world = false;
#endif
    return moved;
}
#endif

// Whether a surface continues at a neighbor, from 1 to 0. `gap`: how far the neighbor is from where
// the surface would be, as a fraction of the largest distance of two strokes.
fn continues(gap: f32) -> f32 {
    return 1.0 - smoothstep(0.15, 0.5, gap);
}

// How much of the strokes is left, from how many of four neighbors continue the surface. At the edge
// of a large surface, two or three do.
fn strokes_left(simplify_small: f32, neighbors: f32) -> f32 {
    return 1.0 - simplify_small * (1.0 - smoothstep(0.75, 2.0, neighbors));
}

#ifdef EFFECT_HATCHING_ON_THINGS
#ifdef EFFECT_HATCHING_SIMPLIFY_SMALL
// Whether the surface at a pixel, in world axes, continues at a neighbor.
fn continues_at(s: Hatching, p: Pixel, on: Surface, offset: vec2<i32>) -> f32 {
    let corner = view.viewport.xy;
    let pixel = clamp(vec2<i32>(floor(p.position)) + offset, corner, corner + view.viewport.zw - 1);
    let at = depth_pixel(pixel);
    let d = depth_texel(at, 0);
    if is_background(raw_depth(view.raw, vec2<u32>(at), d)) {
        return 0.0;
    }
    let texel = (vec2<f32>(at - corner) + 0.5) / view.depth_scale + view.jitter;
    let clip = texel / vec2<f32>(view.viewport.zw) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let h = s.relative_from_clip * vec4(clip, d, 1.0);
    let away = texel - (p.inside + 0.5);
    let expected = on.place + on.across * away.x + on.down * away.y;
    let distance = 2.0 * s.strokes.spacing * max(length(on.across), length(on.down));
    return continues(length(h.xyz / h.w - expected) / max(distance, 1e-25));
}

// How much of the strokes is left at a pixel.
fn stroke_part(s: Hatching, p: Pixel, on: Surface) -> f32 {
    let r = i32(clamp(round(s.strokes.spacing), 2.0, 16.0));
    let beside = continues_at(s, p, on, vec2(r, 0)) + continues_at(s, p, on, vec2(-r, 0));
    let above = continues_at(s, p, on, vec2(0, r)) + continues_at(s, p, on, vec2(0, -r));
    return strokes_left(s.simplify_small, beside + above);
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
    let texel = (vec2<f32>(at - view.viewport.xy) + 0.5) / view.depth_scale + view.jitter;
    let clip = texel / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    let h = s.relative_from_clip * vec4(clip, d, 1.0);
    on = surface_at(s.relative_from_clip, h, vec2(2.0, -2.0) / size, n.xyz);
    // From the middle of the texel to the middle of the pixel.
    let away = p.inside + 0.5 - texel;
    on.place += on.across * away.x + on.down * away.y;
    on.eye = s.eye;
#ifdef WORLD_ORIGIN
    on.is_world = true;
#endif
    return on;
}

// The same in the axes of the object there, if strokes follow it.
fn anchored(on: Surface, pixel: vec2<i32>) -> Surface {
#ifdef OBJECT_ANCHORS
    let object = load_object(pixel);
    let style = style_of(object.y);
    if style.anchor_size > 0.0 {
        return in_frame(on, style.anchor_center, style.anchor_rotation);
    }
#endif
    return on;
}
#endif

// Coverage by marks of a mean darkness.
fn marked(s: Strokes, on: Surface, tone: f32) -> f32 {
#ifdef EFFECT_HATCHING_DOTS
    return stippled(s, on, tone);
#else
    return hatched(s, on, tone);
#endif
}

fn hatching(settings: Hatching, p: Pixel) -> Pixel {
    var out = p;
    var s = settings;
    s.strokes.spacing *= p.spacing;
    let color = p.color / max(p.alpha, 1e-3);
    var light = lightness(color);
#ifdef WORLD_ORIGIN
    set_eyes(s.eyes);
#endif
#ifdef EFFECT_HATCHING_ON_THINGS
    let on = seen_surface(s, p);
#ifdef EFFECT_HATCHING_FACES
    light = 0.5 + 0.5 * clamp(dot(load_normal(vec2<i32>(floor(p.position))).xyz, s.to_light), -1.0, 1.0);
#endif
    let is_there = dot(on.normal, on.normal) > 0.0;
#else
    let on = page_at(p.position, s.strokes.spacing);
    let is_there = true;
#endif
    var cover = 0.0;
    var tone = 0.0;
    if is_there {
        tone = darkness(s.strokes, light) * mix(s.at_near, s.at_far, p.depth.x) * p.print_factors.x;
#ifdef EFFECT_HATCHING_ON_THINGS
        cover = marked(s.strokes, anchored(on, vec2<i32>(floor(p.position))), tone);
#ifdef EFFECT_HATCHING_SIMPLIFY_SMALL
        cover = mix(tone, cover, stroke_part(s, p, on));
#endif
#else
        cover = marked(s.strokes, on, tone);
#endif
    }
    // Nothing is drawn where the background shows through.
    out.color = mix(p.color, with_strokes(s.strokes, color, tone, cover) * p.alpha, s.strokes.opacity);
    return out;
}
