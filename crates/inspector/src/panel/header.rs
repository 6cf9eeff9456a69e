//! The head of the panel: which camera and which page it shows, and where it is.

use bevy::prelude::*;
use bevy_egui::egui::{self, ComboBox, RichText, Ui};

use super::{
    super::{
        ComicsInspector, Helper, Widgets,
        fields::button,
        memory::{Dock, Tab},
        note,
    },
    Panel,
};

impl Panel {
    /// The camera, the panel's place, the close button and the pages.
    pub(super) fn head(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        cameras: &[(Entity, String)],
        chosen: &mut Option<Entity>,
        widgets: &mut Widgets,
    ) {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Comics").heading());
            let name = cameras
                .iter()
                .find(|(camera, _)| Some(*camera) == *chosen)
                .map_or("no camera", |(_, name)| name.as_str());
            let before = *chosen;
            let combo = ComboBox::from_id_salt("camera")
                .selected_text(name)
                .show_ui(ui, |ui| {
                    for (camera, name) in cameras {
                        let item = ui.selectable_value(chosen, Some(*camera), name);
                        note(widgets, format!("camera.{name}"), &item);
                    }
                });
            note(widgets, "camera", &combo.response);
            if let Some(left) = before.filter(|_| before != *chosen) {
                // The button that showed the original is now the other camera's.
                self.show_original(world, left, false);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if button(ui, widgets, "close", "✖", true) {
                    world.resource_mut::<ComicsInspector>().open = false;
                }
                let dock = ComboBox::from_id_salt("dock")
                    .selected_text(self.memory.dock.name())
                    .width(64.0)
                    .show_ui(ui, |ui| {
                        for &dock in Dock::ALL {
                            let item =
                                ui.selectable_value(&mut self.memory.dock, dock, dock.name());
                            note(widgets, format!("dock.{}", dock.name()), &item);
                        }
                    });
                note(widgets, "dock", &dock.response);
            });
        });
        ui.horizontal_wrapped(|ui| {
            for &tab in Tab::ALL {
                let item = ui.selectable_label(self.memory.tab == tab, tab.name());
                note(widgets, format!("tab.{}", tab.name()), &item);
                if item.clicked() {
                    self.memory.tab = tab;
                    self.message = None;
                }
            }
        });
    }
}

/// The camera whose style is shown: the chosen one, or the first one if that
/// does not exist.
pub(super) fn chosen_camera(world: &World, cameras: &[(Entity, String)]) -> Option<Entity> {
    let chosen = world.resource::<ComicsInspector>().camera;
    cameras
        .iter()
        .map(|(camera, _)| *camera)
        .find(|camera| Some(*camera) == chosen)
        .or_else(|| cameras.first().map(|(camera, _)| *camera))
}

/// The 3D cameras with their names, in the order in which they draw.
pub(super) fn cameras(world: &mut World) -> Vec<(Entity, String)> {
    let mut found: Vec<(isize, Entity, String)> = world
        .query_filtered::<(Entity, &Camera, Option<&Name>), (With<Camera3d>, Without<Helper>)>()
        .iter(world)
        .map(|(entity, camera, name)| {
            let name = name.map_or_else(|| format!("Camera {entity}"), ToString::to_string);
            (camera.order, entity, name)
        })
        .collect();
    found.sort_by_key(|(order, entity, _)| (*order, *entity));
    found
        .into_iter()
        .map(|(_, entity, name)| (entity, name))
        .collect()
}
