#define_import_path bevy_comics::lines::coverage

// Fractions of pixels that drawn lines cover. Pure functions.

#import bevy_comics::lines::edge::line_coverage

// The ramp of a diagonal.
const SHORTEST_RAMP: f32 = 0.70710678;

// The length of the ramp from no coverage to full coverage across a line with this direction, in
// pixels: the cosine of its angle with the nearer axis, 1 to sqrt(1/2).
fn line_ramp(along: vec2<f32>) -> f32 {
    let cosine = max(abs(along.x), abs(along.y)) * inverseSqrt(max(dot(along, along), 1e-12));
    return clamp(cosine, SHORTEST_RAMP, 1.0);
}

// The coverage by a straight line with such a ramp. In each column (of a steep line: in each row) it
// adds up to the extent of the line along the column, wherever the line lies between the pixels.
fn straight_coverage(distance: f32, half_width: f32, ramp: f32) -> f32 {
    return clamp((half_width - distance) / ramp + 0.5, 0.0, min(2.0 * half_width / ramp, 1.0));
}

// The coverage by a disc around the middle of a line whose direction is not known: no more than that
// of a straight line in any direction.
fn disc_coverage(distance: f32, half_width: f32) -> f32 {
    let steep = straight_coverage(distance, half_width, SHORTEST_RAMP);
    return min(line_coverage(distance, half_width), steep);
}

// Where a line counts no longer as beside a segment, but as beyond its end: from the segment's
// middle, in its lengths. The next part of the line begins within half a length.
const BESIDE: f32 = 0.93;
const BEYOND: f32 = 1.07;

// The coverage by the straight line from `a` to `b`, with round ends; or by a dot, if both are the
// same. Beyond an end, as beside a dot, the line counts as if it ran across the direction to the
// pixel.
fn segment_coverage(at: vec2<f32>, a: vec2<f32>, b: vec2<f32>, half_width: f32) -> f32 {
    let along = b - a;
    let square = dot(along, along);
    let t = dot(at - a, along) / max(square, 1e-12);
    let away = at - a - clamp(t, 0.0, 1.0) * along;
    let distance = length(away);
    let beside = straight_coverage(distance, half_width, line_ramp(along));
    let as_dot = min(straight_coverage(distance, half_width, line_ramp(away)), 2.0 * half_width);
    let beyond = saturate((abs(t - 0.5) - BESIDE) / (BEYOND - BESIDE));
    return mix(beside, as_dot, select(1.0, beyond, square > 0.0));
}
