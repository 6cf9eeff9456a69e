#define_import_path bevy_comics::effect::footprint

// What a pixel covers of a surface: pure functions. `right` and `down` are the changes of a place from
// pixel to pixel.

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
