#define_import_path bevy_comics::toon::stroke_level

// The mip level of a map of strokes: pure functions. `right` and `down` are the changes of a place in
// texels from pixel to pixel.

#import bevy_comics::effect::footprint::singular_values

// The level at which strokes along x have their width on the screen, which is set by the change
// across them. Ends of strokes that are seen along them are at most four times too short.
fn stroke_level(right: vec2<f32>, down: vec2<f32>) -> f32 {
    let axes = singular_values(right, down);
    let across = clamp(length(vec2(right.y, down.y)), axes.y, axes.x);
    return log2(max(max(across, 0.25 * axes.x), 1e-20));
}
