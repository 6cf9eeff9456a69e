#define_import_path bevy_comics::lines::read

// Reads the lines that the service has found: the only module that declares bindings 4
// (edges) and 5 (flood) for the fused pass. An entry point calls set_lines() first, with
// the settings of its own uniform.

#import bevy_comics::depth::view::inside_viewport
#import bevy_comics::lines::edge::{
    WHOLE_CREASE, WHOLE_SILHOUETTE, Edge, Lines, line_coverage, line_offset, unpack_edge,
}
#ifdef OBJECT_STYLES
#import bevy_comics::objects::style_of
#endif

var<private> lines_drawn: Lines;

fn set_lines(lines: Lines) {
    lines_drawn = lines;
}

#ifdef LINES
// The packed Edge of every pixel, see edge.wgsl.
@group(0) @binding(4) var edge_texture: texture_2d<u32>;
#ifdef FLOOD
// The nearest line of every pixel, see flood.wgsl.
@group(0) @binding(5) var flood_texture: texture_2d<u32>;
#endif

// Ink at a position, 0 to 1: x silhouettes, y creases, z object edges. For each, the
// slot of the OutlineStyle of the object that the line belongs to (0: none).
struct Found {
    ink: vec3<f32>,
    slots: vec3<u32>,
}

// Adds the ink at a position, in pixels, of the lines that belong to the pixel `owner`.
fn add_edge(lines: ptr<function, Found>, edge: Edge, owner: vec2<i32>, at: vec2<f32>) {
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
// Adds the lines of the pixel that owns the line nearest to `pixel`. It adds all sides
// of that pixel, because at a corner two lines are equally near.
fn add_flooded(lines: ptr<function, Found>, pixel: vec2<i32>, at: vec2<f32>) {
    let seed = textureLoad(flood_texture, pixel, 0);
    if seed.w != 0u {
        let owner = vec2<i32>(seed.xy);
        add_edge(lines, unpack_edge(textureLoad(edge_texture, owner, 0)), owner, at);
    }
}
#endif

// The lines at a position in physical pixels from the target's top left corner.
fn lines_at(at: vec2<f32>) -> Found {
    let pixel = inside_viewport(vec2<i32>(floor(at)));
    let own = unpack_edge(textureLoad(edge_texture, pixel, 0));
    var lines: Found;
    // In the faithful forms the pixel itself is the line.
    lines.ink = own.ink * vec3(
        select(0.0, 1.0, (own.sides & WHOLE_SILHOUETTE) != 0u),
        select(0.0, 1.0, (own.sides & WHOLE_CREASE) != 0u),
        0.0,
    );
    lines.slots = vec3(own.slot);
#ifdef FLOOD
#ifdef LINES_ANYWHERE
    // Positions between pixels: the nearest lines of the four pixels around.
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
    let reach = lines_drawn.reach;
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

// The colour of a line: that of the OutlineStyle in `slot`, if it has one, else `color`.
fn own_color(slot: u32, color: vec3<f32>) -> vec3<f32> {
#ifdef OBJECT_STYLES
    if slot != 0u {
        let own = style_of(slot);
        return select(color, own.color, own.has_color > 0.0);
    }
#endif
    return color;
}

// Draws the line of largest opacity over the picture, in linear light ([CL] Eq. 5 takes
// the maximum). If opacities differ by at most 0.01, a silhouette goes before an object
// edge, and an object edge before a crease.
fn draw_lines(linear: vec3<f32>, lines: Found) -> vec3<f32> {
    let s = lines_drawn;
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

// Ink of all kinds together, 0 to 1: the maximum ([CL] Eq. 5).
fn total_ink(lines: Found) -> f32 {
    let s = lines_drawn;
    return max(lines.ink.x * s.silhouette_opacity, max(lines.ink.y * s.crease_opacity, lines.ink.z * s.object_opacity));
}
#endif
