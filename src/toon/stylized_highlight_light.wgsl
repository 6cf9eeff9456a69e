#define_import_path bevy_comics::toon::stylized_highlight_light

// The stylized highlight that a surface shows of a light.

#import bevy_pbr::mesh_view_bindings::view
#import bevy_comics::toon::{
    bindings::toon,
    stylized_highlight::{Frame, frame_along, stylized_highlight_coverage, stylized_highlight_distance, stylized_highlight_radius},
    surface::{Source, Surface, half_way},
}

// The frame of a normal, by `StylizedHighlight::frame`.
fn frame_of(s: Surface, normal: vec3<f32>, to_light: vec3<f32>) -> Frame {
    let camera_right = view.world_from_view[0].xyz;
    let camera_up = view.world_from_view[1].xyz;
#ifdef STYLIZED_HIGHLIGHT_LIGHT
    return frame_along(normal, to_light, camera_right);
#else ifdef STYLIZED_HIGHLIGHT_TANGENT
    return frame_along(normal, s.tangent, camera_right);
#else ifdef STYLIZED_HIGHLIGHT_WORLD
    return frame_along(normal, cross(vec3(0.0, 1.0, 0.0), normal), camera_right);
#else
    return frame_along(normal, camera_right, camera_up);
#endif
}

// Change of a unit vector towards something, over a movement of the surface.
fn swing(to: vec3<f32>, movement: vec3<f32>, per_distance: f32) -> vec3<f32> {
    return (to * dot(to, movement) - movement) * per_distance;
}

// Distance of the surface from the border of the shape, after a movement by `movement` and a turn
// of the normal by `turn`.
fn distance_at(
    s: Surface,
    radius: f32,
    source: Source,
    movement: vec3<f32>,
    turn: vec3<f32>,
) -> f32 {
    let normal = normalize(s.normal + turn);
    let to = source.to_highlight;
    let light = to + swing(to, movement, source.per_distance);
    let eye = s.to_eye + swing(s.to_eye, movement, s.per_eye_distance);
    let half_vector = half_way(light, eye);
    let frame = frame_of(s, normal, source.to_light);
    return stylized_highlight_distance(toon.stylized_highlight, frame, radius, normal, half_vector);
}

// Strength of the highlight, without shadows.
fn stylized_highlight_of(s: Surface, source: Source) -> f32 {
    let radius = stylized_highlight_radius(toon.light.highlight_edge, s.roughness);
    let polish = max(1.0 - 1.4 * s.roughness, 0.0);
    if radius <= 0.0 || polish <= 0.0 || dot(s.normal, source.to_highlight) <= 0.0 {
        return 0.0;
    }
    let none = vec3(0.0);
    let here = distance_at(s, radius, source, none, none);
    let beside = distance_at(s, radius, source, s.foot.position_x, s.foot.normal_x);
    let below = distance_at(s, radius, source, s.foot.position_y, s.foot.normal_y);
    let covered = stylized_highlight_coverage(toon.stylized_highlight, here, beside, below);
    return toon.light.highlight * polish * polish * covered;
}
