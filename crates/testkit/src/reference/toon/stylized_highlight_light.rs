//! Reference of `toon/stylized_highlight_light.wgsl`.

use bevy::math::DVec3;
use bevy_comics::{
    ToonLight,
    toon::{HighlightFrame, HighlightShape, StylizedHighlight},
};

use super::super::stylized_highlight;
use super::surface::{Arriving, Surface, half_way};

/// Change of the unit vector towards a place at a distance, by a movement away from it: that part of
/// the movement that is across.
pub fn swing(to: DVec3, movement: DVec3, per_distance: f64) -> DVec3 {
    -movement.reject_from(to) * per_distance
}

/// The frame that a sign is drawn in at a normal. `camera`: the directions to its right and up.
pub fn frame_of(
    sign: &StylizedHighlight,
    camera: [DVec3; 2],
    tangent: DVec3,
    normal: DVec3,
    to_light: DVec3,
) -> [DVec3; 2] {
    let [right, up] = camera;
    let (along, other) = match sign.frame {
        HighlightFrame::Light => (to_light, right),
        HighlightFrame::Tangent => (tangent, right),
        HighlightFrame::World => (DVec3::Y.cross(normal), right),
        _ => (right, up),
    };
    let first = match along.reject_from(normal).length_squared() < 1e-4 {
        true => other,
        false => along,
    };
    stylized_highlight::frame_along(normal.to_array(), first.to_array()).map(DVec3::from_array)
}

/// Distances of a surface from the border of the sign: at a pixel, one to the right and one below.
pub fn distances(light: &ToonLight, camera: [DVec3; 2], s: &Surface, lamp: &Arriving) -> [f64; 3] {
    let sign = light.stylized_highlight.as_ref().expect("a sign");
    let radius =
        stylized_highlight::stylized_highlight_radius(f64::from(light.highlight_edge), s.roughness);
    let at = |movement: DVec3, turn: DVec3| {
        let normal = (s.normal + turn).normalize();
        let light = lamp.to_highlight + swing(lamp.to_highlight, movement, lamp.per_distance);
        let eye = s.to_eye + swing(s.to_eye, movement, s.per_eye_distance);
        let half = half_way(light, eye).to_array();
        let frame = frame_of(sign, camera, s.tangent, normal, lamp.to_light);
        let (frame, normal) = (frame.map(|v| v.to_array()), normal.to_array());
        match sign.shape {
            HighlightShape::Faithful => {
                stylized_highlight::faithful_distance(sign, frame, radius, normal, half)
            }
            _ => stylized_highlight::sign_distance(
                sign,
                radius,
                stylized_highlight::place_of(frame, normal, half),
            ),
        }
    };
    [
        at(DVec3::ZERO, DVec3::ZERO),
        at(s.foot.position[0], s.foot.normal[0]),
        at(s.foot.position[1], s.foot.normal[1]),
    ]
}

/// Strength of the sign of a light, without shadows.
pub fn sign_of(light: &ToonLight, camera: [DVec3; 2], s: &Surface, lamp: &Arriving) -> f64 {
    let radius =
        stylized_highlight::stylized_highlight_radius(f64::from(light.highlight_edge), s.roughness);
    let polish = (1.0 - 1.4 * s.roughness).max(0.0);
    if radius <= 0.0 || s.normal.dot(lamp.to_highlight) <= 0.0 {
        return 0.0;
    }
    let sign = light.stylized_highlight.as_ref().expect("a sign");
    let [here, beside, below] = distances(light, camera, s, lamp);
    let covered = stylized_highlight::stylized_highlight_coverage(sign, here, beside, below);
    f64::from(light.highlight) * polish * polish * covered
}
