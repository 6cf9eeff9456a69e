//! The box around a picked object, drawn over the view by the panel. The game's own outlines
//! of selected objects stay as they are.

use bevy::prelude::*;
use bevy_egui::egui::{self, Color32, Pos2, Stroke, Ui};

use super::{super::Widgets, pick::corners};

/// Draws the box of an object in the views of these cameras, below the panel.
pub fn highlight(
    ui: &Ui,
    world: &World,
    cameras: &[Entity],
    object: Entity,
    widgets: &mut Widgets,
) {
    let Some(corners) = corners(world, object) else {
        return;
    };
    let zoom = ui.ctx().zoom_factor();
    let place = |at: Vec2| Pos2::new(at.x, at.y) / zoom;
    for camera in cameras {
        let Some((clip_from_world, viewport)) = projection(world, *camera) else {
            continue;
        };
        let area = egui::Rect::from_min_max(place(viewport.min), place(viewport.max));
        let painter = ui.painter().with_clip_rect(area);
        let lines = edges(&corners, clip_from_world, viewport);
        for (color, width) in [(Color32::from_black_alpha(160), 4.0), (LIGHT, 1.5)] {
            for [a, b] in &lines {
                let ends = [place(*a), place(*b)];
                painter.line_segment(ends, Stroke::new(width, color));
            }
        }
        if let Some(around) = around(&lines) {
            let Rect { min, max } = around.intersect(viewport);
            let rect = [min.x, min.y, max.x, max.y];
            widgets.rects.insert("object.highlight".into(), rect);
        }
    }
}

const LIGHT: Color32 = Color32::from_rgb(120, 220, 255);

/// From the world to clip space, and the viewport in logical pixels of the window.
fn projection(world: &World, camera: Entity) -> Option<(Mat4, Rect)> {
    let camera = world.get_entity(camera).ok()?;
    let view = camera.get::<Camera>()?;
    let world_from_view = camera.get::<GlobalTransform>()?.to_matrix();
    let clip_from_world = view.clip_from_view() * world_from_view.inverse();
    Some((clip_from_world, view.logical_viewport_rect()?))
}

/// The rectangle around lines.
fn around(lines: &[[Vec2; 2]]) -> Option<Rect> {
    let each = lines.iter().map(|[a, b]| Rect::from_corners(*a, *b));
    each.reduce(|a, b| a.union(b))
}

/// The edges of a box in the window, as far as they are in front of the camera. Corners whose
/// numbers differ in one bit share an edge.
fn edges(corners: &[Vec3; 8], clip_from_world: Mat4, viewport: Rect) -> Vec<[Vec2; 2]> {
    let corners = corners.map(|corner| clip_from_world * corner.extend(1.0));
    let mut lines = Vec::new();
    for from in 0..8 {
        for bit in [1, 2, 4] {
            if from & bit == 0
                && let Some(ends) = in_front(corners[from], corners[from | bit])
            {
                lines.push(ends.map(|end| in_window(end, viewport)));
            }
        }
    }
    lines
}

/// The part of a line that is in front of the eye, in clip space.
fn in_front(a: Vec4, b: Vec4) -> Option<[Vec4; 2]> {
    const NEAREST: f32 = 1e-4;
    if !(a.is_finite() && b.is_finite()) {
        return None;
    }
    let cut = |a: Vec4, b: Vec4| a.lerp(b, (NEAREST - a.w) / (b.w - a.w));
    match (a.w >= NEAREST, b.w >= NEAREST) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, cut(a, b)]),
        (false, true) => Some([cut(b, a), b]),
        (false, false) => None,
    }
}

/// A point of clip space in the window.
fn in_window(at: Vec4, viewport: Rect) -> Vec2 {
    let ndc = Vec2::new(at.x, -at.y) / at.w;
    // Far outside, numbers of the toolkit lose their precision.
    let far = Vec2::splat(100.0);
    viewport.min + viewport.size() * (0.5 + 0.5 * ndc).clamp(-far, far)
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEWPORT: Rect = Rect {
        min: Vec2::new(100.0, 0.0),
        max: Vec2::new(300.0, 100.0),
    };

    /// A box with these bounds.
    fn cube(low: Vec3, high: Vec3) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let side = |bit: usize, axis: usize| if i & bit == 0 { low } else { high }[axis];
            Vec3::new(side(1, 0), side(2, 1), side(4, 2))
        })
    }

    #[test]
    fn a_box_has_twelve_edges_where_the_camera_shows_it() {
        // Two units wide and one high at any distance.
        let clip = Mat4::orthographic_rh(-2.0, 2.0, -1.0, 1.0, 0.0, 10.0);
        let lines = edges(
            &cube(Vec3::new(-1.0, -0.5, -3.0), Vec3::new(1.0, 0.5, -2.0)),
            clip,
            VIEWPORT,
        );
        assert_eq!(lines.len(), 12);
        let around = around(&lines).expect("lines");
        assert!(
            around.min.distance(Vec2::new(150.0, 25.0)) < 1e-3,
            "{around:?}"
        );
        assert!(
            around.max.distance(Vec2::new(250.0, 75.0)) < 1e-3,
            "{around:?}"
        );
    }

    /// The camera is in the box: what is behind it is cut off, and the rest is where it was.
    #[test]
    fn edges_behind_the_camera_are_cut() {
        let clip = Mat4::perspective_infinite_reverse_rh(1.5, 2.0, 0.1);
        let lines = edges(&cube(Vec3::splat(-1.0), Vec3::splat(1.0)), clip, VIEWPORT);
        // Four edges in front, and the front halves of four.
        assert_eq!(lines.len(), 8);
        assert!(lines.iter().flatten().all(|at| at.is_finite()));
        let behind = edges(
            &cube(Vec3::new(-1.0, -1.0, 2.0), Vec3::new(1.0, 1.0, 3.0)),
            clip,
            VIEWPORT,
        );
        assert!(behind.is_empty());
        let none = edges(&[Vec3::NAN; 8], clip, VIEWPORT);
        assert!(none.is_empty());
    }
}
