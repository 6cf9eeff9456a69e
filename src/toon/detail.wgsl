#define_import_path bevy_comics::toon::detail

// How much detail a place has, 1 all and 0 none: the second axis of a ramp (Barla, Thollot and
// Markosian 2006). Pure functions.

struct Detail {
    // Depth and focus: the distance, the reciprocal of the logarithm of the ratio, and the
    // logarithm of 1 + clear.
    distance: f32,
    per_log: f32,
    clear: f32,
    // Exponent of rims and highlights, or the detail itself.
    number: f32,
}

// All of it up to a distance, none from a multiple of it on. `z` is the distance along the view
// axis.
fn detail_by_depth(d: Detail, z: f32) -> f32 {
    return clamp(1.0 - log(max(z / d.distance, 1e-9)) * d.per_log, 0.0, 1.0);
}

// All of it near a distance, none at a multiple and at a fraction of it.
fn detail_in_focus(d: Detail, z: f32) -> f32 {
    let away = abs(log(max(z / d.distance, 1e-9)));
    return 1.0 - clamp((away - d.clear) * d.per_log, 0.0, 1.0);
}

// All of it where a surface faces the eye, none at its rim. `cosine` is that between normal and
// eye.
fn detail_of_rim(d: Detail, cosine: f32) -> f32 {
    return min(pow(max(abs(cosine), 1e-6), d.number), 1.0);
}

// All of it in the middle of a reflection. `cosine` is that between the reflected light and the
// eye.
fn detail_of_highlight(d: Detail, cosine: f32) -> f32 {
    return min(pow(max(cosine, 1e-6), d.number), 1.0);
}
