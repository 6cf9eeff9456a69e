//! The row of an image, which the panel shows and does not edit.

use bevy::{asset::Handle, image::Image};
use bevy_egui::egui::Ui;

use super::{
    super::{Widgets, note},
    Setting, explained,
};

/// The name of an image.
pub(super) fn image(
    ui: &mut Ui,
    handle: Option<&Handle<Image>>,
    setting: &Setting,
    widgets: &mut Widgets,
) {
    ui.horizontal(|ui| {
        let name = ui.weak(name_of(handle));
        note(widgets, setting.path, &name);
        explained(name, setting.docs);
        explained(ui.label(&setting.label), setting.docs);
    });
}

fn name_of(handle: Option<&Handle<Image>>) -> String {
    match handle {
        None => "no image".into(),
        Some(handle) => handle
            .path()
            .map_or_else(|| "made by code".into(), ToString::to_string),
    }
}
