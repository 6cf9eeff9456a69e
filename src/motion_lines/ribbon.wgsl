#define_import_path bevy_comics::motion_lines::ribbon

// Ribbons along paths: pure functions.

// Unit vector along a path on the screen, between two places in clip space. `size` is that of the
// picture in pixels.
fn direction_on_screen(at: vec4<f32>, beside: vec4<f32>, size: vec2<f32>) -> vec2<f32> {
    let step = (beside.xy / beside.w - at.xy / at.w) * size;
    let long = length(step);
    // Seen from the end, or in the plane of the eye, a path has no direction.
    return select(vec2(1.0, 0.0), step / long, long > 1e-6 && long < 1e30);
}

// A place in clip space moved by `across` pixels to the left of a direction on the screen.
fn moved_across(at: vec4<f32>, along: vec2<f32>, across: f32, size: vec2<f32>) -> vec4<f32> {
    // Two units of the clip space are the whole picture.
    let off = vec2(-along.y, along.x) * across * 2.0 / size * at.w;
    return vec4(at.xy + off, at.zw);
}

// What a line of a width covers of a pixel at a distance from its middle.
fn coverage(distance: f32, half_width: f32) -> f32 {
    // A line that is thinner than a pixel is paler, not thinner.
    let shown = max(half_width, 0.5);
    return clamp(shown + 0.5 - abs(distance), 0.0, 1.0) * min(2.0 * half_width, 1.0);
}
