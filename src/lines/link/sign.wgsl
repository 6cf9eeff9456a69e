#define_import_path bevy_comics::lines::sign

// Whether an edge is convex or concave, and how it is drawn then.

#import bevy_comics::depth::view::texel_depth
#ifdef LIT_EDGES
#import bevy_comics::depth::normal::texel_normal
#endif
#import bevy_comics::lines::edge::EdgeInk
#import bevy_comics::lines::pass::line_pass

// A bend of the raw depth over two pixels, as a fraction of what a jump is a fraction of; and of the depth,
// what rounding may make.
const BEND: f32 = 1e-5;
const ROUNDING: f32 = 4e-7;

fn is_in_grid(at: vec2<i32>) -> bool {
    let rect = line_pass.grid.rect;
    return all(at >= rect.xy) && all(at < rect.xy + rect.zw);
}

// How the raw depth bends at a pixel: the slope behind it minus that before it; 0 at the border of
// the grid.
fn bend_at(at: vec2<i32>, step: vec2<i32>) -> f32 {
    if !is_in_grid(at - step) || !is_in_grid(at + step) {
        return 0.0;
    }
    return texel_depth(at - step, 0) - 2.0 * texel_depth(at, 0) + texel_depth(at + step, 0);
}

// Whether the edge between two neighboring pixels is convex. Raw depth is affine over a plane on the
// screen, and larger in front. Behind two planes that bound a solid, it is the smaller of both: it
// bends down over a convex edge, and up over a concave one, whatever the direction of the edge. At the
// steps of an edge that is nearly parallel to the crack's normal, it bends more along the crack. A
// step bends up and down, by about as much: the part in front ends there.
fn is_convex_edge(here: vec2<i32>, there: vec2<i32>) -> bool {
    let s = line_pass.settings;
    let across = there - here;
    let along = across.yx;
    let near = max(texel_depth(here, 0), texel_depth(there, 0));
    let least = max(BEND * (s.reference_factor * near + s.reference_constant), ROUNDING * near);
    let first = bend_at(here, across);
    let second = bend_at(there, across);
    let beside = bend_at(here, along) + bend_at(there, along);
    let bend = select(beside, first + second, abs(first + second) >= abs(beside));
    let up = max(first, second);
    let step = up > least && min(first, second) < -0.25 * up;
    return bend < -least || step;
}

// The fraction of the opacity that the light leaves of an edge.
fn edge_light(edge: EdgeInk, here: vec2<i32>, there: vec2<i32>) -> f32 {
#ifdef LIT_EDGES
    let first = texel_normal(here, 0);
    let second = texel_normal(there, 0);
    let to_light = line_pass.weight.to_light;
    let facing = max(first.w * dot(first.xyz, to_light), second.w * dot(second.xyz, to_light));
#ifdef HARD
    let lit = select(0.0, 1.0, facing > 0.1);
#else
    let lit = smoothstep(0.0, 0.2, facing);
#endif
    return mix(edge.unlit_opacity, 1.0, lit);
#else
    return 1.0;
#endif
}
