//! A color wheel: the angle is the hue, the distance from the center the
//! saturation. The wheel keeps the color's HSV value.

use std::f32::consts::TAU;

use bevy_egui::egui::{
    Color32, EventFilter, Mesh, Pos2, Response, Sense, Shape, Stroke, Ui, Vec2, ecolor::Hsva, vec2,
};

/// Triangles of the disc.
const SECTORS: u32 = 48;

/// Draws the wheel of a color (hue, saturation and value, each 0 to 1). The
/// response says whether the color was changed: by the pointer, or by the arrow
/// keys while the wheel has the focus.
pub fn hue_wheel(ui: &mut Ui, hsv: &mut [f32; 3], diameter: f32) -> Response {
    let (rect, mut response) =
        ui.allocate_exact_size(Vec2::splat(diameter), Sense::click_and_drag());
    let (center, radius) = (rect.center(), 0.5 * diameter - 2.0);
    let [hue, saturation, value] = *hsv;

    let mut turned = None;
    if let Some(at) = response.interact_pointer_pos()
        && (response.dragged() || response.clicked())
    {
        turned = Some(hue_at(center, radius, at));
    }
    if response.has_focus() {
        let step = arrows(ui, &response);
        if step != Vec2::ZERO {
            turned = Some((
                (hue + step.x / 72.0).rem_euclid(1.0),
                (saturation + step.y * 0.02).clamp(0.0, 1.0),
            ));
        }
    }
    if let Some((hue, saturation)) = turned {
        *hsv = [hue, saturation, value];
        response.mark_changed();
    }

    paint(ui, &response, center, radius, *hsv);
    response
}

/// The steps of the arrow keys in this frame; right and up are positive.
fn arrows(ui: &Ui, response: &Response) -> Vec2 {
    // Otherwise the arrow keys would move the focus to another widget.
    ui.memory_mut(|memory| {
        memory.set_focus_lock_filter(
            response.id,
            EventFilter {
                horizontal_arrows: true,
                vertical_arrows: true,
                ..EventFilter::default()
            },
        );
    });
    ui.input(|input| {
        use bevy_egui::egui::Key;
        let pressed = |key| f32::from(u8::from(input.key_pressed(key)));
        vec2(
            pressed(Key::ArrowRight) - pressed(Key::ArrowLeft),
            pressed(Key::ArrowUp) - pressed(Key::ArrowDown),
        )
    })
}

/// Draws the disc, its rim, and the knob at the color's position.
fn paint(ui: &Ui, response: &Response, center: Pos2, radius: f32, hsv: [f32; 3]) {
    let [hue, saturation, value] = hsv;
    let color =
        |hue: f32, saturation: f32| Color32::from(Hsva::new(hue, saturation, value.max(0.35), 1.0));
    let mut mesh = Mesh::default();
    mesh.colored_vertex(center, color(0.0, 0.0));
    for i in 0..=SECTORS {
        let hue = i as f32 / SECTORS as f32;
        mesh.colored_vertex(place(center, radius, hue, 1.0), color(hue, 1.0));
        if i > 0 {
            mesh.add_triangle(0, i, i + 1);
        }
    }
    let painter = ui.painter();
    painter.add(Shape::mesh(mesh));
    let rim = ui.style().interact(response).fg_stroke;
    painter.circle_stroke(center, radius, rim);
    let knob = place(center, radius, hue, saturation);
    painter.circle(
        knob,
        6.0,
        Color32::from(Hsva::new(hue, saturation, value, 1.0)),
        Stroke::new(2.0, Color32::WHITE),
    );
    painter.circle_stroke(knob, 7.5, Stroke::new(1.0, Color32::BLACK));
}

/// The position of a hue and saturation on the wheel.
fn place(center: Pos2, radius: f32, hue: f32, saturation: f32) -> Pos2 {
    let (sin, cos) = (hue * TAU).sin_cos();
    center + radius * saturation * vec2(cos, -sin)
}

/// The hue and saturation at a position; outside of the wheel, at its rim.
fn hue_at(center: Pos2, radius: f32, at: Pos2) -> (f32, f32) {
    let offset = at - center;
    let hue = (-offset.y).atan2(offset.x) / TAU;
    (
        hue.rem_euclid(1.0),
        (offset.length() / radius).clamp(0.0, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_on_the_wheel_gives_its_hue_and_saturation() {
        let center = Pos2::new(100.0, 80.0);
        for (hue, saturation) in [(0.0, 1.0), (0.1, 0.5), (0.5, 0.25), (0.99, 0.9)] {
            let found = hue_at(center, 50.0, place(center, 50.0, hue, saturation));
            assert!((found.0 - hue).abs() < 1e-4, "{found:?}");
            assert!((found.1 - saturation).abs() < 1e-4, "{found:?}");
        }
        assert_eq!(hue_at(center, 50.0, Pos2::new(1e6, 80.0)), (0.0, 1.0));
    }
}
