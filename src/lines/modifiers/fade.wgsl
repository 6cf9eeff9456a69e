#define_import_path bevy_comics::lines::fade

// How much of a line is left where its surface is away from a distance. Pure functions.

#import bevy_comics::depth::map::is_background

struct LineFade {
    // Distance along the view's axis from the raw depth d: x / (d + y), in an orthographic view
    // x + y d.
    axis: vec2<f32>,
    // The distance at which lines are whole, unless it is that of the middle of the view.
    distance: f32,
    at_center: u32,
    // Orthographic views: the length that distances are measured in; 0 in perspective.
    reference: f32,
    clear: f32,
    steepness: f32,
    // The fraction of a line that is lost far from there.
    amount: f32,
}

// Natural logarithm of the distance at a raw depth; in an orthographic view the distance, in
// reference lengths.
fn fade_coordinate(f: LineFade, raw: f32) -> f32 {
    if f.reference > 0.0 {
        return (f.axis.x + f.axis.y * raw) / f.reference;
    }
    return log(clamp(f.axis.x / max(raw + f.axis.y, 1e-30), 1e-9, 1e30));
}

// The fraction of a line's width and opacity that is left. `raw`, `middle`: the raw depths of
// its surface and of the middle of the view.
fn fade_factor(f: LineFade, raw: f32, middle: f32) -> f32 {
    var whole_at = fade_coordinate(f, middle);
    if f.at_center == 0u {
        whole_at = select(log(f.distance), f.distance / f.reference, f.reference > 0.0);
    }
    let sky = is_background(raw);
    let looks_at_sky = f.at_center == 1u && is_background(middle);
    if sky || looks_at_sky {
        return select(1.0 - f.amount, 1.0, sky && looks_at_sky);
    }
    let apart = abs(fade_coordinate(f, raw) - whole_at);
    return 1.0 - f.amount * smoothstep(0.0, 1.0, (apart - f.clear) * f.steepness);
}
