#define_import_path bevy_comics::lines::overshoot

// Strokes that extend lines beyond their loose ends. Pure functions.

#import bevy_comics::lines::edge::THINNEST
#import bevy_comics::lines::weight::{Weight, taper_weight}

// Cracks of a line that say in which direction it ends.
const DIRECTING: i32 = 16;

// Whether the middles 0 to n of cracks in a row are on a line that is nearly straight.
fn is_straight(middles: ptr<function, array<vec2<f32>, DIRECTING>>, n: i32) -> bool {
    let chord = (*middles)[n] - (*middles)[0];
    let half_way = (*middles)[n / 2] - (*middles)[0];
    let away = chord.x * half_way.y - chord.y * half_way.x;
    return away * away <= 0.49 * dot(chord, chord);
}

// The direction in which a line leaves the first of its middles, away from the others: that of
// the parabola through them (least squares). Its length means nothing; 0 for a single middle.
fn end_direction(middles: ptr<function, array<vec2<f32>, DIRECTING>>, count: i32) -> vec2<f32> {
    let n = f32(count);
    var linear = vec2(0.0);
    var quadratic = vec2(0.0);
    let mean_square = (n * n - 1.0) / 12.0;
    for (var i = 0; i < count; i++) {
        let u = f32(i) - 0.5 * (n - 1.0);
        linear += u * (*middles)[i];
        quadratic += (u * u - mean_square) * (*middles)[i];
    }
    // Both sums over the sums of the squares of their factors, times n (n^2 - 1) / 12.
    let bend = quadratic * 15.0 / max(n * n - 4.0, 1.0);
    return select((n - 1.0) * bend - linear, -linear, count < 3);
}

// Half the width of a stroke, and the factor of its ink, at a distance from its beginning; it
// tapers to its end. `length`: of the stroke; both in cracks. `half_width`: at its beginning.
fn stroke_width(w: Weight, half_width: f32, length: f32, away: f32) -> vec2<f32> {
    let whole = taper_weight(w, length);
    let part = taper_weight(w, max(length - away, 0.0)) / max(whole, 1e-6);
    let thinnest = min(half_width, THINNEST);
    let thinner = half_width * min(part, 1.0);
    return vec2(max(thinner, thinnest), min(thinner / max(thinnest, 1e-3), 1.0));
}
