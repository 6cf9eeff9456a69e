//! Reference of `toon/stylized_highlight.wgsl`.

use std::f64::consts::{FRAC_PI_2, PI};

use bevy::math::{DVec2, DVec3};
use bevy_comics::toon::{HighlightShape, StylizedHighlight};

/// Two unit vectors in the tangent plane, the first towards `right`.
pub fn frame_along(normal: DVec3, right: DVec3) -> [DVec3; 2] {
    let along = right.reject_from(normal).normalize();
    [along, normal.cross(along)]
}

/// Tangent of the angle between normal and half vector at which the highlight falls to `edge` of
/// its peak, found by bisection; 0 if it does not.
pub fn stylized_highlight_radius(edge: f64, perceptual_roughness: f64) -> f64 {
    let roughness = (perceptual_roughness * perceptual_roughness).max(0.002);
    let is_lit = |cosine: f64| super::light::highlight_fraction(roughness, cosine) > edge;
    if is_lit(0.0) {
        return 0.0;
    }
    let (mut dark, mut lit) = (FRAC_PI_2, 0.0f64);
    for _ in 0..80 {
        let middle = 0.5 * (dark + lit);
        *if is_lit(middle.cos()) {
            &mut lit
        } else {
            &mut dark
        } = middle;
    }
    lit.tan()
}

fn place_of([right, up]: [DVec3; 2], normal: DVec3, half_vector: DVec3) -> DVec2 {
    let along = half_vector.dot(normal).max(1e-4);
    -DVec2::new(half_vector.dot(right), half_vector.dot(up)) / along
}

/// Distance from the border of a shape whose radius is 1.
fn shape_distance(g: &StylizedHighlight, y: DVec2) -> f64 {
    let (bar, square) = (f64::from(g.bar), f64::from(g.square));
    let rounded_box = || {
        let corner = 0.5 * (1.0 - square);
        let beyond = y.abs() - (1.0 - corner);
        beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0) - corner
    };
    match g.shape {
        HighlightShape::Square => rounded_box(),
        HighlightShape::Window => {
            let from_bars = y.abs().min_element() - 0.5 * bar;
            rounded_box().max(-from_bars)
        }
        HighlightShape::Crescent => {
            let hole = (y - DVec2::new(2.0 * bar, 0.0)).length() - 1.0;
            (y.length() - 1.0).max(-hole)
        }
        HighlightShape::Star => {
            // The sector between a tip and a corner that the place is in, of all of them.
            let half = PI / f64::from(g.points);
            let angle = y.x.atan2(y.y);
            let from_tip = |k: u32| {
                let from = angle - 2.0 * half * f64::from(k);
                from.sin().atan2(from.cos()).abs()
            };
            let nearest = (0..g.points).map(from_tip).fold(f64::INFINITY, f64::min);
            let place = y.length() * DVec2::from_angle(nearest);
            let side = bar * DVec2::from_angle(half) - DVec2::X;
            (place - DVec2::X).perp_dot(side) / side.length()
        }
        HighlightShape::Streak => {
            let end = 1.0 - bar;
            DVec2::new(y.x - y.x.clamp(-end, end), y.y).length() - bar
        }
        _ => {
            let power = 2.0 + 6.0 * square;
            y.abs().powf(power).element_sum().powf(power.recip()) - 1.0
        }
    }
}

fn turn(g: &StylizedHighlight) -> DVec2 {
    DVec2::from_angle(f64::from(g.rotation).to_radians())
}

fn center(g: &StylizedHighlight, radius: f64) -> DVec2 {
    (g.offset.as_dvec2() * radius).clamp_length_max(2.0)
}

/// Distance of a place in the plane of half vectors from the border of the shape, in units of its
/// radius.
fn planar_distance(g: &StylizedHighlight, radius: f64, place: DVec2) -> f64 {
    let turn = turn(g);
    let turned = DVec2::new(turn.x, -turn.y).rotate(place - center(g, radius));
    let y = turned / (g.scale.as_dvec2() * f64::from(g.size) * radius);
    let split = g.split.as_dvec2();
    let y = DVec2::select(split.cmpgt(DVec2::ZERO), y.abs() - split, y);
    shape_distance(g, y)
}

/// The half vector after the paper's five changes.
fn moved(g: &StylizedHighlight, [du, dv]: [DVec3; 2], radius: f64, half_vector: DVec3) -> DVec3 {
    let turn = turn(g);
    let right = turn.x * du + turn.y * dv;
    let up = turn.x * dv - turn.y * du;
    let mut h = half_vector;
    for (axis, scale) in [(right, g.scale.x), (up, g.scale.y)] {
        let shrink = 1.0 - 1.0 / f64::from(scale);
        h = (h - shrink * h.dot(axis) * axis).normalize();
    }
    let center = center(g, radius);
    h = (h + center.x * du + center.y * dv).normalize();
    let side = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
    let apart = g.split.as_dvec2() * radius * DVec2::new(side(h.dot(right)), side(h.dot(up)));
    h = (h - apart.x * right - apart.y * up).normalize();
    // The smaller angle to an axis.
    let (x, y) = (h.dot(right), h.dot(up));
    let angle = (x.abs().min(1.0).acos()).min(y.abs().min(1.0).acos());
    let pull = f64::from(g.square) * (2.0 * angle).sin().powi(g.sharpness as i32);
    (h - pull * x * right - pull * y * up).normalize()
}

/// The same distance at a normal, for shapes in the plane and for those of the paper.
pub fn distance(
    g: &StylizedHighlight,
    frame: [DVec3; 2],
    radius: f64,
    normal: DVec3,
    half_vector: DVec3,
) -> f64 {
    match g.shape {
        HighlightShape::Faithful => {
            let h = moved(g, frame, radius, half_vector);
            place_of(frame, normal, h).length() / (f64::from(g.size) * radius) - 1.0
        }
        _ => planar_distance(g, radius, place_of(frame, normal, half_vector)),
    }
}
