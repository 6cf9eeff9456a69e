// A speech balloon with a tail, or the burst of a shout.

#import bevy_ui::ui_vertex_output::UiVertexOutput

// Middle and half size of the body, as fractions of the node's size.
@group(1) @binding(0) var<uniform> body: vec4<f32>;
// Tip of the tail in the same fractions, half the width of its root in pixels, and number of spikes.
@group(1) @binding(1) var<uniform> tail: vec4<f32>;

// Width of the line in physical pixels.
const INK: f32 = 3.0;

// Distance to the body, which is squarer than an ellipse; positive outside.
fn body_distance(at: vec2<f32>, half_size: vec2<f32>, spikes: f32) -> f32 {
    let power = 2.6;
    let around = atan2(at.y / half_size.y, at.x / half_size.x);
    let wave = abs(fract(around * spikes / 6.2831853) * 2.0 - 1.0);
    let size = half_size * select(1.0, 0.76 + 0.24 * wave, spikes > 0.0);
    let part = abs(at) / size;
    let value = pow(part.x, power) + pow(part.y, power);
    let slope = power * pow(part, vec2(power - 1.0)) / size;
    return (value - 1.0) / max(length(slope), 1e-4);
}

// Distance to a triangle (Quilez, 2D distance functions).
fn triangle_distance(p: vec2<f32>, a: vec2<f32>, b: vec2<f32>, c: vec2<f32>) -> f32 {
    let e0 = b - a; let e1 = c - b; let e2 = a - c;
    let v0 = p - a; let v1 = p - b; let v2 = p - c;
    let q0 = v0 - e0 * clamp(dot(v0, e0) / dot(e0, e0), 0.0, 1.0);
    let q1 = v1 - e1 * clamp(dot(v1, e1) / dot(e1, e1), 0.0, 1.0);
    let q2 = v2 - e2 * clamp(dot(v2, e2) / dot(e2, e2), 0.0, 1.0);
    let s = sign(e0.x * e2.y - e0.y * e2.x);
    let near = min(min(
        vec2(dot(q0, q0), s * (v0.x * e0.y - v0.y * e0.x)),
        vec2(dot(q1, q1), s * (v1.x * e1.y - v1.y * e1.x))),
        vec2(dot(q2, q2), s * (v2.x * e2.y - v2.y * e2.x)));
    return -sqrt(near.x) * sign(near.y);
}

@fragment
fn fragment(in: UiVertexOutput) -> @location(0) vec4<f32> {
    let middle = body.xy * in.size;
    let at = in.uv * in.size - middle;
    let half_size = body.zw * in.size;
    let tip = tail.xy * in.size - middle;
    var edge = body_distance(at, half_size, tail.w);
    if tail.z > 0.0 {
        let root = normalize(vec2(-tip.y, tip.x)) * tail.z;
        edge = min(edge, triangle_distance(at, root, tip, -root));
    }
    let ink = clamp(edge + INK + 0.5, 0.0, 1.0);
    return vec4(mix(vec3(1.0), vec3(0.004), ink), clamp(0.5 - edge, 0.0, 1.0));
}
