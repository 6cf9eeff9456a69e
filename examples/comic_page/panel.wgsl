// A panel of a comic page: a picture inside a tilted quadrilateral with a border of ink.

#import bevy_ui::ui_vertex_output::UiVertexOutput

// Two corners each, clockwise from the top left, as fractions of the node's size.
@group(1) @binding(0) var<uniform> upper: vec4<f32>;
@group(1) @binding(1) var<uniform> lower: vec4<f32>;
@group(1) @binding(2) var picture: texture_2d<f32>;
@group(1) @binding(3) var picture_sampler: sampler;

// Width of the border in physical pixels.
const INK: f32 = 4.0;

// Distance to the line through two corners, positive outside.
fn outside(at: vec2<f32>, from_corner: vec2<f32>, to_corner: vec2<f32>) -> f32 {
    let along = normalize(to_corner - from_corner);
    return dot(at - from_corner, vec2(along.y, -along.x));
}

@fragment
fn fragment(in: UiVertexOutput) -> @location(0) vec4<f32> {
    let at = in.uv * in.size;
    let a = upper.xy * in.size;
    let b = upper.zw * in.size;
    let c = lower.xy * in.size;
    let d = lower.zw * in.size;
    let edges = max(max(outside(at, a, b), outside(at, b, c)), max(outside(at, c, d), outside(at, d, a)));
    let color = textureSample(picture, picture_sampler, in.uv).rgb;
    let ink = clamp(edges + INK + 0.5, 0.0, 1.0);
    return vec4(mix(color, vec3(0.004), ink), clamp(0.5 - edges, 0.0, 1.0));
}
