// Finds the nearest line of every pixel by jump flooding (Rong and Tan 2006). Each step
// reads the nearest lines known to nine pixels, `stride` pixels apart; strides are halved
// from step to step. Distance is measured to the border of a line, so that a thin line
// does not hide a wide one.
//
// A texel describes a line by the pixel that owns it, its half width in 1/512 pixel, and
// the side that it runs along: (x, y, half width, side + 4). w is 0 if there is none.

#import bevy_comics::depth::view::View
#import bevy_comics::lines::edge::{Lines, line_offset, unpack_edge}

struct FloodUniform {
    seen: View,
    settings: Lines,
}

@group(0) @binding(1) var<uniform> flood_uniform: FloodUniform;
#ifdef FIRST
@group(0) @binding(4) var edge_texture: texture_2d<u32>;
#else
@group(0) @binding(5) var flood_texture: texture_2d<u32>;
#endif

// Distance in pixels from a position to the border of a line; negative inside of it.
fn border_distance(seed: vec4<u32>, at: vec2<f32>) -> f32 {
    let half_width = f32(seed.z) / 512.0;
    let line = vec2<f32>(seed.xy) + 0.5 + line_offset(seed.w & 3u, half_width);
    return distance(line, at) - half_width;
}

// The stride of a step is the index of the instance that is drawn. This needs neither
// immediate data nor a uniform for each step.
struct Flood {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) stride: i32,
}

@vertex
fn flood_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) stride: u32) -> Flood {
    let uv = vec2<f32>(f32(vertex >> 1u), f32(vertex & 1u)) * 2.0;
    return Flood(vec4(uv * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0), i32(stride));
}

@fragment
fn flood(in: Flood) -> @location(0) vec4<u32> {
    let pixel = vec2<i32>(in.position.xy);
    let first = flood_uniform.seen.viewport.xy;
    let last = first + flood_uniform.seen.viewport.zw - 1;
    var best = vec4(0u);
    if any(pixel < first) || any(pixel > last) {
        return best;
    }
    let centre = vec2<f32>(pixel) + 0.5;
    var nearest = 1e30;
#ifdef FIRST
    // Lines of the pixel itself and of its four neighbours.
    for (var i = 0; i < 5; i++) {
        let offset = select(vec2(0, 0), vec2(select(0, i * 2 - 3, i < 3), select(0, i * 2 - 7, i > 2)), i > 0);
        let at = clamp(pixel + offset, first, last);
        let texel = textureLoad(edge_texture, at, 0);
        let edge = unpack_edge(texel);
        let sides = (edge.sides | (edge.sides >> 4u) | (edge.sides >> 8u)) & 15u;
        for (var side = 0u; side < 4u; side++) {
            let seed = vec4(vec2<u32>(at), texel.z, side + 4u);
            let d = border_distance(seed, centre);
            if ((sides >> side) & 1u) != 0u && d < nearest {
                nearest = d;
                best = seed;
            }
        }
    }
#else
    for (var i = 0; i < 9; i++) {
        let at = clamp(pixel + vec2(i % 3, i / 3) * in.stride - in.stride, first, last);
        let seed = textureLoad(flood_texture, at, 0);
        let d = border_distance(seed, centre);
        if seed.w != 0u && d < nearest {
            nearest = d;
            best = seed;
        }
    }
#endif
    return best;
}
