#define_import_path bevy_comics::lines::ledge

// Which steps may be ledges: faces that are seen so obliquely that they are thinner than a pixel.
// Pure functions.

#import bevy_comics::lines::edge::Lines

// A step above this fraction of the one that separates two surfaces may be a ledge.
const LEDGE: f32 = 0.05;

// Whether the excess of a step is that of a ledge, or more. `near` is the larger of both raw
// depths.
fn may_be_ledge(s: Lines, excess: vec4<f32>, near: vec4<f32>) -> vec4<bool> {
    let reference = s.reference_factor * near + s.reference_constant;
    return (excess > LEDGE * s.jump * reference) & (near > vec4(0.0));
}
