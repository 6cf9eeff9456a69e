#define_import_path bevy_comics::cartoon::stroke_level

// The mip level of a map of strokes: pure functions. `right` and `down` are the changes of a place in
// texels from pixel to pixel.

// The singular values of the change, the larger first: the long and the short axis of what a pixel
// covers (Ewins et al. 1998). The smaller one is found from the product of both: as a difference it
// would have no correct digit where the axes differ much.
fn singular_values(right: vec2<f32>, down: vec2<f32>) -> vec2<f32> {
    let sum = dot(right, right) + dot(down, down);
    let area = abs(right.x * down.y - right.y * down.x);
    let root = sqrt(max((sum - 2.0 * area) * (sum + 2.0 * area), 0.0));
    let large = sqrt(0.5 * (sum + root));
    return vec2(large, area / max(large, 1e-30));
}

// The level at which strokes along x have their width on the screen, which is set by the change
// across them. Ends of strokes that are seen along them are at most four times too short.
fn stroke_level(right: vec2<f32>, down: vec2<f32>) -> f32 {
    let axes = singular_values(right, down);
    let across = clamp(length(vec2(right.y, down.y)), axes.y, axes.x);
    return log2(max(max(across, 0.25 * axes.x), 1e-20));
}
