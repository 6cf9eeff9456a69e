#define_import_path bevy_comics::stylize::lines

// Reads the lines that the outlines' passes have found.

#ifdef EDGES
#import bevy_comics::stylize::bindings::{comics, edge_texture}
#ifdef FLOOD
#import bevy_comics::stylize::bindings::{flood_texture}
#endif
#ifdef OBJECT_STYLES
#import bevy_comics::stylize::bindings::{object_styles}
#endif
#import bevy_comics::styles::outlines::{
    WHOLE_CREASE, WHOLE_SILHOUETTE, Edge, line_coverage, line_offset, unpack_edge,
}

// Ink at a place, by kind, and the style slots of the objects it belongs to.
struct Lines {
    ink: vec3<f32>,
    slots: vec3<u32>,
}

fn inside_viewport(pixel: vec2<i32>) -> vec2<i32> {
    let first = comics.viewport.xy;
    return clamp(pixel, first, first + comics.viewport.zw - 1);
}

// The lines of one pixel's edge, seen from a place.
fn add_edge(lines: ptr<function, Lines>, edge: Edge, owner: vec2<i32>, at: vec2<f32>) {
    let centre = vec2<f32>(owner) + 0.5;
    for (var side = 0u; side < 4u; side++) {
        let runs = vec3<u32>(edge.sides >> side, edge.sides >> (4u + side), edge.sides >> (8u + side)) & vec3(1u);
        if any(runs != vec3(0u)) {
            let line = centre + line_offset(side, edge.half_width);
            let covered = line_coverage(distance(line, at), edge.half_width);
            let ink = edge.ink * vec3<f32>(runs) * covered;
            (*lines).slots = select((*lines).slots, vec3(edge.slot), ink > (*lines).ink);
            (*lines).ink = max((*lines).ink, ink);
        }
    }
}

#ifdef FLOOD
// The lines of the pixel whose line is nearest to this one. All sides of it: at
// a corner two lines are as near.
fn add_flooded(lines: ptr<function, Lines>, pixel: vec2<i32>, at: vec2<f32>) {
    let seed = textureLoad(flood_texture, pixel, 0);
    if seed.w != 0u {
        let owner = vec2<i32>(seed.xy);
        add_edge(lines, unpack_edge(textureLoad(edge_texture, owner, 0)), owner, at);
    }
}
#endif

// The lines at a place in pixels.
fn lines_at(at: vec2<f32>) -> Lines {
    let pixel = inside_viewport(vec2<i32>(floor(at)));
    let own = unpack_edge(textureLoad(edge_texture, pixel, 0));
    var lines: Lines;
    // The faithful forms: the pixel is the line.
    lines.ink = own.ink * vec3(
        select(0.0, 1.0, (own.sides & WHOLE_SILHOUETTE) != 0u),
        select(0.0, 1.0, (own.sides & WHOLE_CREASE) != 0u),
        0.0,
    );
    lines.slots = vec3(own.slot);
#ifdef FLOOD
#ifdef SKETCH
    // A stroke runs between pixels: the lines that all four around it know.
    let corner = vec2<i32>(floor(at - 0.5));
    for (var i = 0; i < 4; i++) {
        add_flooded(&lines, inside_viewport(corner + vec2(i & 1, i >> 1u)), at);
    }
#else
    add_flooded(&lines, pixel, at);
#endif
#else
#ifdef LINE_REACH
    let reach = #{LINE_REACH}i;
#else
    let reach = comics.outlines.reach;
#endif
    let side = 2 * reach + 1;
    for (var i = 0; i < side * side; i++) {
        let owner = inside_viewport(pixel + vec2(i % side, i / side) - reach);
        let texel = textureLoad(edge_texture, owner, 0);
        if (texel.x & 0xfffu) != 0u {
            add_edge(&lines, unpack_edge(texel), owner, at);
        }
    }
#endif
    return lines;
}

fn own_color(slot: u32, color: vec3<f32>) -> vec3<f32> {
#ifdef OBJECT_STYLES
    if slot != 0u {
        let own = object_styles[min(slot, arrayLength(&object_styles) - 1u)];
        return select(color, own.color, own.has_color > 0.0);
    }
#endif
    return color;
}

// Ink over the picture: the strongest line alone (Eq. 5 takes the maximum), and
// of equals, within a hundredth, the silhouette, then the object edge.
fn draw_lines(linear: vec3<f32>, lines: Lines) -> vec3<f32> {
    let s = comics.outlines;
    let alpha = lines.ink * vec3(s.silhouette_opacity, s.crease_opacity, s.object_opacity);
    var slot = lines.slots.x;
    var color = s.silhouette_color;
    var strongest = alpha.x;
    if alpha.z > strongest + 0.01 {
        slot = lines.slots.z;
        color = s.object_color;
        strongest = alpha.z;
    }
    if alpha.y > strongest + 0.01 {
        slot = lines.slots.y;
        color = s.crease_color;
        strongest = alpha.y;
    }
    return mix(linear, own_color(slot, color), strongest);
}

// All kinds together, as a sketch draws them (Eq. 5).
fn total_ink(lines: Lines) -> f32 {
    let s = comics.outlines;
    return max(lines.ink.x * s.silhouette_opacity, max(lines.ink.y * s.crease_opacity, lines.ink.z * s.object_opacity));
}
#endif
