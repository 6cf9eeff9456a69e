//! The row of a vector: a number for each axis.

use bevy_egui::egui::{DragValue, Response, Ui};

use super::widgets::suffix;
use bevy_comics::effect::FieldRange;

/// Numbers that are dragged or typed, one for each axis.
pub(super) fn vector(ui: &mut Ui, axes: &mut [f32], range: Option<FieldRange>) -> Response {
    let number = |ui: &mut Ui, value: &mut f32| {
        let step = f64::from(value.abs() * 0.01).max(0.01);
        let Some(range) = range else {
            return ui.add(DragValue::new(value).speed(step));
        };
        let drag = DragValue::new(value)
            .range(range.min as f32..=range.max as f32)
            .speed(step.min((range.max - range.min) * 0.01));
        ui.add(drag.suffix(suffix(range.unit)))
    };
    ui.horizontal(|ui| {
        let each = axes.iter_mut().map(|value| number(ui, value));
        let all = each.reduce(|all, next| all.union(next));
        all.unwrap_or_else(|| ui.label(""))
    })
    .inner
}
