// Draws the ink of the lines into a texture of the size of the viewport. Only tiles with
// a crack nearby are drawn; the rest of the texture is cleared.
//
// x, y, z: ink of silhouettes, creases and object edges, encoded; w: slot of the OutlineStyle of
// the strongest line, / 255.

#import bevy_comics::depth::view::{View, set_view}
#import bevy_comics::lines::edge::{
    CREASE, Grid, Lines, OBJECT, SILHOUETTE, encode_ink, line_coverage, line_offset, segment_distance, unpack_crack,
    unpack_width,
}
#ifdef OBJECT_STYLES
#import bevy_comics::objects::texel_object
#endif

struct DrawUniform {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> draw_uniform: DrawUniform;
@group(0) @binding(11) var crack_texture: texture_2d<u32>;
#ifndef BY_FRAGMENTS
@group(0) @binding(12) var block_texture: texture_2d<u32>;
#endif

const TILE: i32 = 16;

// Tiles are instances, row by row. Those without lines collapse into a point.
@vertex
fn tile(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4<f32> {
    let size = draw_uniform.seen.viewport.zw;
    let across = (size.x + TILE - 1) / TILE;
    let first = vec2(i32(instance) % across, i32(instance) / across) * TILE;
    if !has_cracks(first) {
        return vec4(-2.0, -2.0, 0.0, 1.0);
    }
    let corner = first + vec2(i32(vertex & 1u), i32(vertex >> 1u)) * TILE;
    let ndc = vec2<f32>(corner) / vec2<f32>(size) * 2.0 - 1.0;
    return vec4(ndc.x, -ndc.y, 0.0, 1.0);
}

#ifdef BY_FRAGMENTS
fn has_cracks(first: vec2<i32>) -> bool {
    return true;
}
#else
// Whether a tile has cracks within reach, by the blocks of 4 x 32 pixels of find.wgsl.
fn has_cracks(first: vec2<i32>) -> bool {
    let g = draw_uniform.grid;
    let low = vec2<f32>(first) * g.from_viewport.xy + g.from_viewport.zw;
    let high = vec2<f32>(first + TILE) * g.from_viewport.xy + g.from_viewport.zw;
    // One more pixel: the cracks of a pixel lie on its eastern and southern sides.
    let from_pixel = clamp(vec2<i32>(floor(low)) - g.reach - 1, vec2(0), g.rect.zw - 1);
    let to_pixel = clamp(vec2<i32>(ceil(high)) + g.reach, vec2(0), g.rect.zw - 1);
    var rows = 0u;
    for (var y = from_pixel.y >> 5u; y <= to_pixel.y >> 5u; y++) {
        let above = u32(clamp(from_pixel.y - y * 32, 0, 31));
        let below = u32(31 - clamp(to_pixel.y - y * 32, 0, 31));
        let mask = (0xffffffffu << above) & (0xffffffffu >> below);
        for (var x = from_pixel.x >> 2u; x <= to_pixel.x >> 2u; x++) {
            rows |= textureLoad(block_texture, vec2(x, y), 0).r & mask;
        }
    }
    return rows != 0u;
}
#endif

// What is known of the lines at a position.
struct Ink {
    // By kind: silhouettes, creases, object edges.
    kinds: vec3<f32>,
    strongest: f32,
    // The pixel that owns the strongest line.
    owner: vec2<i32>,
    // Two lines in different places whose borders are nearest: their middles, and the
    // distances from their borders, negative inside.
    first: vec2<f32>,
    second: vec2<f32>,
    distances: vec2<f32>,
    // The packed crack of the first, and the pixel that owns it.
    packed: u32,
    first_owner: vec2<i32>,
}

// The part of the ink that belongs to each kind, per unit of coverage.
fn ink_of(packed: u32) -> vec3<f32> {
    let crack = unpack_crack(packed);
    return crack.opacity * vec3(
        select(0.0, crack.ink, (crack.kinds & SILHOUETTE) != 0u),
        select(0.0, crack.ink, (crack.kinds & CREASE) != 0u),
        select(0.0, 1.0, (crack.kinds & OBJECT) != 0u),
    );
}

fn alphas(kinds: vec3<f32>) -> f32 {
    let s = draw_uniform.settings;
    let alpha = kinds * vec3(s.silhouette_opacity, s.crease_opacity, s.object_opacity);
    return max(alpha.x, max(alpha.y, alpha.z));
}

// Adds the line along one crack of the pixel `p`: towards the east or the south.
fn add(ink: ptr<function, Ink>, packed: u32, p: vec2<i32>, towards: vec2<i32>, at: vec2<f32>) {
    let half_width = unpack_width(packed >> 20u);
    let mine = (packed & 8u) != 0u;
    let direction = vec2<f32>(towards);
    let shift = select(1.0, -1.0, mine) * line_offset(half_width);
    let middle = vec2<f32>(p) + 0.5 + direction * (0.5 + shift);
    let away = length((middle - at) / draw_uniform.grid.from_viewport.xy);
    let exists = (packed & 7u) != 0u;
    let kinds = select(0.0, line_coverage(away, half_width), exists) * ink_of(packed);
    (*ink).kinds = max((*ink).kinds, kinds);
#ifdef OBJECT_STYLES
    let alpha = alphas(kinds);
    let owner = select(p + towards, p, mine);
    (*ink).owner = select((*ink).owner, owner, alpha > (*ink).strongest);
    (*ink).strongest = max((*ink).strongest, alpha);
#endif
    let border = select(1e6, away - half_width, exists);
    let nearest = border < (*ink).distances.x;
    // Both cracks at a corner of a line of odd width have their middle in one pixel.
    let other = distance(middle, (*ink).first) > 0.25;
    let behind = other && border < (*ink).distances.y;
    let pushed = other && nearest;
    (*ink).second = select(select((*ink).second, middle, behind), (*ink).first, pushed);
    (*ink).distances.y = select(select((*ink).distances.y, border, behind), (*ink).distances.x, pushed);
    (*ink).first = select((*ink).first, middle, nearest);
    (*ink).packed = select((*ink).packed, packed, nearest);
#ifdef OBJECT_STYLES
    (*ink).first_owner = select((*ink).first_owner, owner, nearest);
#endif
    (*ink).distances.x = min((*ink).distances.x, border);
}

// Adds both cracks of a pixel, which may lie outside of the grid.
fn add_pixel(ink: ptr<function, Ink>, p: vec2<i32>, at: vec2<f32>) {
    let last = draw_uniform.grid.rect.zw - 1;
    let inside = all(p >= vec2(0)) && all(p <= last);
    let texel = textureLoad(crack_texture, clamp(p, vec2(0), last), 0).xy;
    let packed = select(vec2(0u), texel, inside);
    add(ink, packed.x, p, vec2(1, 0), at);
    add(ink, packed.y, p, vec2(0, 1), at);
}

@fragment
fn draw(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    set_view(draw_uniform.seen);
    let g = draw_uniform.grid;
    let at = position.xy * g.from_viewport.xy + g.from_viewport.zw;
    let centre = vec2<i32>(floor(at));
    var ink: Ink;
    ink.distances = vec2(1e6);
#ifdef NARROW
    // CPU adapters execute the body of a loop once more than it iterates.
    add_pixel(&ink, centre + vec2(-1, -1), at);
    add_pixel(&ink, centre + vec2(0, -1), at);
    add_pixel(&ink, centre + vec2(1, -1), at);
    add_pixel(&ink, centre + vec2(-1, 0), at);
    add_pixel(&ink, centre, at);
    add_pixel(&ink, centre + vec2(1, 0), at);
    add_pixel(&ink, centre + vec2(-1, 1), at);
    add_pixel(&ink, centre + vec2(0, 1), at);
#else
    for (var y = -g.reach; y <= g.reach; y++) {
        for (var x = -g.reach; x <= g.reach; x++) {
            add_pixel(&ink, centre + vec2(x, y), at);
        }
    }
#endif
    // Between the middles of two neighbouring cracks, a line runs straight. Discs around
    // the middles alone would leave diagonal lines too thin.
    if ink.distances.y < 1e5 && distance(ink.first, ink.second) < 1.5 {
        let away = segment_distance(at, ink.first, ink.second) / g.from_viewport.x;
        let half_width = unpack_width(ink.packed >> 20u);
        let straight = line_coverage(away, half_width) * ink_of(ink.packed);
        ink.kinds = max(ink.kinds, straight);
#ifdef OBJECT_STYLES
        ink.owner = select(ink.owner, ink.first_owner, alphas(straight) > ink.strongest);
#endif
    }
    var slot = 0.0;
#ifdef OBJECT_STYLES
    let last = g.rect.zw - 1;
    slot = f32(texel_object(g.rect.xy + clamp(ink.owner, vec2(0), last), 0).y) / 255.0;
#endif
    return vec4(encode_ink(ink.kinds), slot);
}
