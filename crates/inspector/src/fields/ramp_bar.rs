//! The tones of a ramp as a bar, and the place of a new one.

use bevy::prelude::*;
use bevy_egui::egui::{Color32, Rect, Sense, Ui, pos2, vec2};

use super::{
    super::{Widgets, note},
    Setting,
};
use bevy_comics::toon::{Ramp, RampStop};

const HEIGHT: f32 = 18.0;

/// Draws the tones of a list of stops, from shade to light. Draws nothing for other lists.
pub(super) fn show(
    ui: &mut Ui,
    value: &dyn PartialReflect,
    setting: &Setting,
    widgets: &mut Widgets,
) {
    let Some(stops) = value.try_downcast_ref::<Vec<RampStop>>() else {
        return;
    };
    let stops = Ramp::new(stops.iter().copied()).sanitized().stops;
    let width = (ui.available_width() - 8.0).clamp(60.0, 400.0);
    let (bar, response) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::hover());
    note(widgets, format!("{}.bar", setting.path), &response);
    response.on_hover_text("The tones from no light, on the left, to all light, on the right");
    let painter = ui.painter();
    let columns = width as usize;
    for column in 0..columns {
        let [left, right] = [column, column + 1].map(|c| bar.left() + c as f32);
        let at = (column as f32 + 0.5) / columns as f32;
        let [r, g, b] = tone(&stops, at).to_srgba().to_u8_array_no_alpha();
        let area = Rect::from_min_max(pos2(left, bar.top()), pos2(right, bar.bottom() - 5.0));
        painter.rect_filled(area, 0.0, Color32::from_rgb(r, g, b));
    }
    let mark = ui.visuals().text_color();
    for stop in &stops {
        let x = bar.left() + stop.at * width;
        let line = [pos2(x, bar.bottom() - 5.0), pos2(x, bar.bottom())];
        painter.line_segment(line, (2.0, mark));
    }
}

/// The tone at a place of a ramp, as `ramp.wgsl` has it for a surface of one color. `stops`:
/// sorted.
fn tone(stops: &[RampStop], at: f32) -> Color {
    let first = stops.first().copied().unwrap_or_default();
    let mut tone = LinearRgba::from(first.color);
    for stop in &stops[1.min(stops.len())..] {
        let edge = ((at - stop.at) / stop.softness.max(1e-3) + 0.5).clamp(0.0, 1.0);
        let smooth = edge * edge * (3.0 - 2.0 * edge);
        tone = tone.mix(&LinearRgba::from(stop.color), smooth);
    }
    tone.into()
}

/// A stop in the middle of the widest gap of a list of stops, with the tone that is there; `None`
/// for other lists.
pub(super) fn new_stop(list: &dyn PartialReflect) -> Option<RampStop> {
    let stops = list.try_downcast_ref::<Vec<RampStop>>()?;
    let stops = Ramp::new(stops.iter().copied()).sanitized().stops;
    let ends = stops.iter().skip(1).map(|stop| stop.at).chain([1.0]);
    let gaps = stops.iter().map(|stop| stop.at).zip(ends);
    let (low, high) = gaps.max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))?;
    let at = 0.5 * (low + high);
    Some(RampStop::new(at, tone(&stops, at)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_has_the_tones_of_the_stops() {
        let stops = [
            RampStop::new(0.0, Color::BLACK),
            RampStop::new(0.25, Color::linear_rgb(1.0, 0.0, 0.0)),
            RampStop::new(0.7, Color::WHITE).soft(0.2),
        ];
        let at = |at| LinearRgba::from(tone(&stops, at));
        assert_eq!(at(0.2), LinearRgba::BLACK);
        assert_eq!(at(0.3), LinearRgba::RED);
        assert_eq!(at(0.59), LinearRgba::RED);
        assert_eq!(at(0.81), LinearRgba::WHITE);
        // Half way through the soft edge.
        assert!((at(0.7).green - 0.5).abs() < 1e-5);
        assert!((at(0.65).green - 0.15625).abs() < 1e-5);
    }

    #[test]
    fn a_new_stop_is_in_the_widest_gap() {
        let at = |stops: Vec<RampStop>| new_stop(&stops).expect("a ramp");
        let stop = |at| RampStop::new(at, Color::WHITE);
        assert_eq!(at(vec![stop(0.0), stop(0.25)]).at, 0.625);
        // In any order, and up to the end.
        assert_eq!(at(vec![stop(0.9), stop(0.1)]).at, 0.5);
        assert_eq!(at(vec![stop(0.0)]).at, 0.5);
        let dark = vec![RampStop::new(0.0, Color::BLACK), stop(0.9)];
        assert_eq!(LinearRgba::from(at(dark).color), LinearRgba::BLACK);
        assert!(new_stop(&vec![1.0f32]).is_none());
    }
}
