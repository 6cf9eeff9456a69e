// Finds the faithful lines and writes their ink, in the format of draw.wgsl:
// the pixels that respond are the line ([CL] Eq. 1 and 2 over 5 x 5 pixels).

#import bevy_comics::depth::map::{depth_map, is_background}
#import bevy_comics::depth::view::{depth_frame, set_view, texel_depth}
#import bevy_comics::lines::edge::{component_response, edge_response, encode_ink, gradient_extremes}
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::objects::kinds_of
#ifdef NORMALS
#import bevy_comics::depth::normal::texel_normal
#endif
#ifdef OBJECT_STYLES
#import bevy_comics::objects::{style_of, texel_slot}
#endif

// Raw depth at a pixel of the grid. Outside of it, depth is extrapolated by point reflection
// at the border. This continues a plane, so that the border is not an edge.
fn depth_at(pixel: vec2<i32>) -> f32 {
    let rect = line_pass.grid.rect;
    let last = rect.zw - 1;
    let border = clamp(pixel, vec2(0), last);
    let d = texel_depth(rect.xy + border, 0);
    if all(border == pixel) {
        return d;
    }
    let mirror = clamp(2 * border - pixel, vec2(0), last);
    return max(2.0 * d - texel_depth(rect.xy + mirror, 0), 0.0);
}

#ifdef FAITHFUL_CREASES
// (normal, 1) at index i of the 5 x 5 window around a pixel; w is 0 where there is no
// normal. Positions outside of the grid are clamped to its border.
fn normal_at(pixel: vec2<i32>, i: i32, depths: ptr<function, array<f32, 25>>) -> vec4<f32> {
    let rect = line_pass.grid.rect;
    let at = clamp(pixel + vec2(i % 5, i / 5) - 2, vec2(0), rect.zw - 1);
    let inside = at - pixel + 2;
    let sky = is_background((*depths)[5 * inside.y + inside.x]);
    return texel_normal(rect.xy + at, 0) * vec4(1.0, 1.0, 1.0, select(1.0, 0.0, sky));
}
#endif

@fragment
fn faithful(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    set_view(line_pass.seen);
    let s = line_pass.settings;
    let g = line_pass.grid;
    let at = floor(position.xy * g.from_viewport.xy + g.from_viewport.zw);
    let pixel = clamp(vec2<i32>(at), vec2(0), g.rect.zw - 1);
    var depths: array<f32, 25>;
    for (var i = 0; i < 25; i++) {
        depths[i] = depth_at(pixel + vec2(i % 5, i / 5) - 2);
    }
    var slot = 0u;
#ifdef OBJECT_STYLES
    slot = texel_slot(g.rect.xy + pixel, 0);
#endif
    let kinds = kinds_of(slot);
    var ink = vec2(0.0);
#ifdef FAITHFUL_SILHOUETTES
    let p = edge_response(gradient_extremes(&depths), s.silhouette_k);
    ink.x = smoothstep(s.silhouette_low, s.silhouette_high, p) * f32(kinds & 1u);
#endif
#ifdef FAITHFUL_CREASES
    var normals: array<vec4<f32>, 25>;
    for (var i = 0; i < 25; i++) {
        normals[i] = normal_at(pixel, i, &depths);
    }
    let q = component_response(&normals, s.crease_k);
    ink.y = smoothstep(s.crease_low, s.crease_high, q) * f32((kinds >> 1u) & 1u);
#endif
#ifdef FADING
    ink *= 1.0 - s.opacity_fade * depth_map(depth_frame(), depths[12]).x;
#endif
#ifdef OBJECT_STYLES
    ink *= style_of(slot).opacity;
#endif
    // Where there is no ink, the slot is that of a measured line, if there is one.
    let own = select(0.0, f32(slot) / 255.0, any(ink > vec2(0.0)));
    return vec4(encode_ink(vec3(ink, 0.0)), own);
}
