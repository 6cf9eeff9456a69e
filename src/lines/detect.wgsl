// Finds the outlines. For every pixel it writes an Edge: which sides have a line that
// belongs to this pixel, of which kind, with how much ink, and how wide.

#import bevy_comics::depth::map::{depth_map, is_background}
#import bevy_comics::depth::view::{View, depth_frame, load_depth, set_view, view}
#import bevy_comics::lines::edge::{
    CREASE, OBJECT, SILHOUETTE, Edge, Lines, WHOLE_CREASE, WHOLE_SILHOUETTE,
    component_response, edge_response, gradient_extremes, normal_extremes, normal_step, on_crease, on_edge,
    pack_edge, step_excess,
}
#import bevy_comics::objects::kinds_of
#ifdef NORMALS
#import bevy_comics::depth::normal::load_normal
#endif
#ifdef OBJECT_IDS
#import bevy_comics::objects::load_object
#endif
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif

struct DetectUniform {
    seen: View,
    settings: Lines,
}

@group(0) @binding(1) var<uniform> detect_uniform: DetectUniform;

// Raw depth at a pixel. Outside of the viewport it is extrapolated by point reflection
// at the border. This continues a plane, so that the border is not an edge.
fn depth_at(pixel: vec2<i32>) -> f32 {
    let first = view.viewport.xy;
    let last = first + view.viewport.zw - 1;
    let border = clamp(pixel, first, last);
    let d = load_depth(border, 0);
    if all(border == pixel) {
        return d;
    }
    let mirror = clamp(2 * border - pixel, first, last);
    return max(2.0 * d - load_depth(mirror, 0), 0.0);
}

#ifdef CREASES
// (normal, 1) at index i of the 5 x 5 window around a pixel; w is 0 where there is no
// normal. Positions outside of the viewport are clamped to its border.
fn normal_at(pixel: vec2<i32>, i: i32, depths: ptr<function, array<f32, 25>>) -> vec4<f32> {
    let first = view.viewport.xy;
    let at = clamp(pixel + vec2(i % 5, i / 5) - 2, first, first + view.viewport.zw - 1);
    let inside = at - pixel + 2;
    let sky = is_background((*depths)[5 * inside.y + inside.x]);
    return load_normal(at) * vec4(1.0, 1.0, 1.0, select(1.0, 0.0, sky));
}
#endif

// Index difference in a 5 x 5 window to the neighbour at a side.
fn side_step(side: u32) -> i32 {
    return select(5, 1, side < 2u) * select(-1, 1, (side & 1u) == 1u);
}

// Whether the line between two pixels belongs to this one. It belongs to the pixel
// whose object draws this kind of line if the other's does not, otherwise to the nearer
// one, otherwise to the one to the west or north. Both pixels come to opposite results.
fn owns(here: f32, there: f32, has_here: bool, has_there: bool, side: u32) -> bool {
    if has_here != has_there {
        return has_here;
    }
    if here != there {
        return here > there;
    }
    return (side & 1u) == 1u;
}

@fragment
fn detect(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    set_view(detect_uniform.seen);
    let pixel = vec2<i32>(position.xy);
    let inside = pixel - view.viewport.xy;
    if any(inside < vec2(0)) || any(inside >= view.viewport.zw) {
        return vec4(0u);
    }
    var s = detect_uniform.settings;
    // The forms are compiled in, for the same reason as the flags in has() of map.wgsl.
#ifdef FORMS
    s.silhouette_faithful = #{SILHOUETTE_FAITHFUL}u;
    s.crease_faithful = #{CREASE_FAITHFUL}u;
#endif
    var depths: array<f32, 25>;
    var nearest = 0.0;
    for (var i = 0; i < 25; i++) {
        let d = depth_at(pixel + vec2(i % 5, i / 5) - 2);
        depths[i] = d;
        nearest = max(nearest, d);
    }
    let here = depths[12];
    if nearest <= 0.0 {
        return vec4(0u);
    }

    var edge: Edge;
    // Sides at the border of the viewport have no lines.
    let rim = view.viewport.zw - 1;
    var open = array<bool, 4>(inside.x > 0, inside.x != rim.x, inside.y > 0, inside.y != rim.y);
    var slot = 0u;
    var others = array<u32, 4>(0u, 0u, 0u, 0u);
#ifdef OBJECT_IDS
    let object = load_object(pixel);
    slot = object.y;
    var differs = array<bool, 4>(false, false, false, false);
    for (var side = 0u; side < 4u; side++) {
        if open[side] {
            let step = select(vec2(0, 1), vec2(1, 0), side < 2u) * select(-1, 1, (side & 1u) == 1u);
            let other = load_object(pixel + step);
            others[side] = other.y;
            differs[side] = other.x != object.x;
        }
    }
#endif
    let kinds = kinds_of(slot);
    edge.slot = slot;

    let reference = s.reference_factor * nearest + s.reference_constant;
    // The difference in raw depth from which one surface hides another, instead of
    // meeting it.
    let jump = 2.0 * s.silhouette_k * reference;
#ifdef SILHOUETTES
    let g = gradient_extremes(&depths);
    if s.silhouette_faithful != 0u {
        let p = edge_response(g, s.silhouette_k);
        edge.ink.x = smoothstep(s.silhouette_low, s.silhouette_high, p) * f32(kinds & 1u);
        edge.sides |= WHOLE_SILHOUETTE;
    } else if (kinds & 1u) != 0u {
        for (var side = 0u; side < 4u; side++) {
            let step = side_step(side);
            let excess = step_excess(depths[12 - step], here, depths[12 + step], depths[12 + 2 * step]);
            // Eq. 2 for the excess of this step instead of g_max - g_min: the same along
            // a straight edge, and steadier where the edge is a staircase of pixels.
            let p = edge_response(vec2(0.0, 0.5 * excess), s.silhouette_k * reference);
            let ink = smoothstep(s.silhouette_low, s.silhouette_high, p);
            if open[side] && ink > 0.0 && on_edge(excess, g) {
                edge.ink.x = max(edge.ink.x, ink);
                edge.sides |= 1u << (4u * SILHOUETTE + side);
            }
        }
    }
#endif
#ifdef CREASES
    var normals: array<vec4<f32>, 25>;
    for (var i = 0; i < 25; i++) {
        normals[i] = normal_at(pixel, i, &depths);
    }
    if s.crease_faithful != 0u {
        let p = component_response(&normals, s.crease_k);
        edge.ink.y = smoothstep(s.crease_low, s.crease_high, p) * f32((kinds >> 1u) & 1u);
        edge.sides |= WHOLE_CREASE;
    } else {
        let gn = normal_extremes(&normals);
        for (var side = 0u; side < 4u; side++) {
            let step = side_step(side);
            let n = normals[12 + step];
            let turn = normal_step(normals[12], n);
            let p = edge_response(vec2(0.0, 0.5 * turn), s.crease_k);
            let ink = smoothstep(s.crease_low, s.crease_high, p);
            if !open[side] || ink <= 0.0 || (kinds & 2u) == 0u {
                continue;
            }
            let before = normals[12 - step];
            let beyond = normals[12 + 2 * step];
            let around = max(normal_step(before, normals[12]), normal_step(n, beyond));
            let there = depths[12 + step];
            // Both sides of a crease meet: there is no jump in depth between them.
            let joined = abs(step_excess(depths[12 - step], here, there, depths[12 + 2 * step])) < jump
                && abs(step_excess(depths[12 + 2 * step], there, here, depths[12 - step])) < jump;
            let mine = owns(here, there, true, (kinds_of(others[side]) & 2u) != 0u, side);
            if joined && mine && on_crease(turn, around, before.w * beyond.w, gn) {
                edge.ink.y = max(edge.ink.y, ink);
                edge.sides |= 1u << (4u * CREASE + side);
            }
        }
    }
#endif
#ifdef OBJECT_EDGES
    edge.ink.z = 1.0;
    for (var side = 0u; side < 4u; side++) {
        let there = depths[12 + side_step(side)];
        let has_there = (kinds_of(others[side]) & 4u) != 0u;
        // If one object hides the other, the line belongs to the nearer one, even if
        // that has no object edges: then there is none.
        let hides = abs(here - there) > jump;
        let mine = select(
            owns(here, there, (kinds & 4u) != 0u, has_there, side),
            here > there,
            hides,
        );
        if differs[side] && mine && (kinds & 4u) != 0u {
            edge.sides |= 1u << (4u * OBJECT + side);
        }
    }
#endif
    if (edge.sides & 0x3fffu) == 0u {
        return vec4(0u);
    }
#ifdef FADING
    let depth = depth_map(depth_frame(), here).x;
    edge.ink *= 1.0 - s.opacity_fade * depth;
#endif
    edge.half_width = s.half_width;
#ifdef OBJECT_STYLES
    if slot != 0u {
        let own = style_of(slot).half_width;
        edge.half_width = select(edge.half_width, own * s.scale, own >= 0.0);
    }
#endif
#ifdef FADING
    edge.half_width *= 1.0 - s.width_fade * depth;
#endif
    return pack_edge(edge);
}
