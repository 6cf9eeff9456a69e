//! Picking an object in the view.

use bevy::prelude::*;
use bevy_egui::egui::{Key, Popup, Ui};

use super::{
    super::{
        ComicsInspector, Widgets,
        memory::Tab,
        note,
        objects::{highlight, in_window, pick, picked},
    },
    Panel,
    header::cameras,
};

/// Draws a box around the picked object, in every view of the window.
pub(super) fn show_picked(ui: &Ui, world: &mut World, widgets: &mut Widgets) {
    if let Some(object) = picked(world) {
        let cameras = views(world);
        highlight(ui, world, &cameras, object, widgets);
    }
}

/// The 3D cameras that draw to the window, in the order in which they draw.
fn views(world: &mut World) -> Vec<Entity> {
    let all: Vec<Entity> = cameras(world)
        .into_iter()
        .map(|(camera, _)| camera)
        .collect();
    in_window(world, &all)
}

impl Panel {
    /// The button that lets the next press in a view pick an object.
    pub(super) fn pick_button(&mut self, ui: &mut Ui, world: &mut World, widgets: &mut Widgets) {
        let mut inspector = world.resource_mut::<ComicsInspector>();
        let button = ui
            .selectable_label(inspector.picking, "⌖ Pick")
            .on_hover_text(
                "Then click an object in the view, to edit its light, its lines and its sections",
            );
        note(widgets, "pick", &button);
        if button.clicked() {
            inspector.picking = !inspector.picking;
            if inspector.picking {
                self.memory.tab = Tab::Object;
            }
        }
    }

    /// Takes the press that picks an object, and the key that lets go of it.
    pub(super) fn pick(&mut self, ui: &Ui, world: &mut World) {
        self.holds_pointer &= ui.input(|input| input.pointer.any_down());
        let mut inspector = world.resource_mut::<ComicsInspector>();
        // A text field, or a list that is open, has the key first.
        let is_free = !self.is_typing && !Popup::is_any_open(ui.ctx());
        if is_free && ui.input(|input| input.key_pressed(Key::Escape)) {
            if inspector.picking {
                inspector.picking = false;
            } else {
                inspector.picked = None;
            }
        }
        let pressed = inspector.picking && ui.input(|input| input.pointer.primary_pressed());
        if !pressed || ui.ctx().is_pointer_over_egui() {
            return;
        }
        let Some(at) = ui.input(|input| input.pointer.interact_pos()) else {
            return;
        };
        let at = at * ui.ctx().zoom_factor();
        let cameras = views(world);
        let object = pick(world, &cameras, Vec2::new(at.x, at.y));
        self.holds_pointer = true;
        self.memory.tab = Tab::Object;
        let mut inspector = world.resource_mut::<ComicsInspector>();
        inspector.picking = false;
        inspector.picked = object;
    }
}
