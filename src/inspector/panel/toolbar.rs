//! Undo, the clipboard, and the ways to compare.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::{self, Key, Modifiers, Ui};

use super::{
    super::{Widgets, fields::button, memory::Tab, note},
    Panel, put,
};
use crate::{ComicStyle, ComicsDiagnostics, SplitView, StyleWeight};

impl Panel {
    /// Undo, the clipboard and the comparisons; says whether a step was undone or
    /// redone.
    pub(super) fn toolbar(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        camera: Entity,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) -> bool {
        let mut stepped = false;
        let typing = ui.ctx().text_edit_focused();
        let key = |modifiers: Modifiers, key: Key| {
            !typing
                && ui
                    .ctx()
                    .input_mut(|input| input.consume_key(modifiers, key))
        };
        let redo_key =
            key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || key(Modifiers::COMMAND, Key::Y);
        let undo_key = key(Modifiers::COMMAND, Key::Z);
        let save_key = key(Modifiers::COMMAND, Key::S);
        let (undos, redos) = self.cameras.entry(camera).or_default().history.steps();
        ui.horizontal_wrapped(|ui| {
            let undo = button(ui, widgets, "undo", "⮪ Undo", undos > 0) || undo_key;
            let redo = button(ui, widgets, "redo", "⮫ Redo", redos > 0) || redo_key;
            let state = self.cameras.entry(camera).or_default();
            let step = if undo {
                state.history.undo(style)
            } else if redo {
                state.history.redo(style)
            } else {
                None
            };
            if let Some(step) = step {
                put(world, camera, &step);
                *style = step;
                stepped = true;
            }
            if button(ui, widgets, "copy", "Copy", true) {
                match style.to_ron() {
                    Ok(text) => self.clipboard.copy(text),
                    Err(error) => self.message = Some(error.to_string()),
                }
            }
            if button(ui, widgets, "paste", "Paste", true) {
                self.message = None;
                match self
                    .clipboard
                    .paste()
                    .map(|text| ComicStyle::from_ron(&text))
                {
                    Some(Ok(pasted)) => *style = pasted,
                    Some(Err(error)) => {
                        self.message = Some(format!("The clipboard holds no style: {error}"));
                    }
                    None => self.message = Some("The clipboard is empty.".into()),
                }
            }
        });
        ui.horizontal_wrapped(|ui| {
            let state = self.cameras.entry(camera).or_default();
            for (letter, b) in [("A", false), ("B", true)] {
                let item = ui.selectable_label(state.shows_b == b, letter).on_hover_text(
                    "Two looks to compare: each remembers its own changes. The second starts as a copy of the first.",
                );
                note(widgets, format!("compare.{letter}"), &item);
                if item.clicked() && state.shows_b != b {
                    let other = state.other.take().unwrap_or_else(|| style.clone());
                    state.other = Some(std::mem::replace(style, other));
                    state.shows_b = b;
                }
            }
            let original = ui
                .button("Original")
                .on_hover_text("Shows the picture without its style while it is held");
            note(widgets, "compare.original", &original);
            let held = original.is_pointer_button_down_on()
                || (original.has_focus() && ui.input(|input| input.key_down(Key::Space)));
            self.show_original(world, camera, held);

            let mut entity = world.entity_mut(camera);
            let mut split = entity.contains::<SplitView>();
            let check = ui
                .checkbox(&mut split, "Split")
                .on_hover_text("The original on the left, the style on the right");
            note(widgets, "compare.split", &check);
            if check.changed() {
                if split {
                    entity.insert(SplitView::default());
                } else {
                    entity.remove::<SplitView>();
                }
            }
            if let Some(mut split) = entity.get_mut::<SplitView>() {
                let slider = ui.add(egui::Slider::new(&mut split.at, 0.0..=1.0).show_value(false));
                note(widgets, "compare.split.at", &slider);
            }
        });
        ui.horizontal_wrapped(|ui| {
            let mut entity = world.entity_mut(camera);
            let mut weight = entity.get::<StyleWeight>().copied().unwrap_or_default().0;
            let slider = ui
                .add(egui::Slider::new(&mut weight, 0.0..=1.0).text("Weight"))
                .on_hover_text("How much of the style is seen (StyleWeight)");
            note(widgets, "weight", &slider);
            if slider.changed() {
                if weight == 1.0 {
                    entity.remove::<StyleWeight>();
                } else {
                    entity.insert(StyleWeight(weight));
                }
            }
            // Its own page says it at length.
            let in_full = self.memory.tab != Tab::Files;
            self.files.mark(ui, camera, style, in_full);
        });
        if save_key {
            self.files.save(camera, style);
        }
        if world.resource::<ComicsDiagnostics>().is_compiling(camera) {
            ui.label("Compiling: the last look stays until it is done.");
        }
        stepped
    }

    pub(super) fn show_original(&mut self, world: &mut World, camera: Entity, held: bool) {
        let state = self.cameras.entry(camera).or_default();
        let Ok(mut entity) = world.get_entity_mut(camera) else {
            return;
        };
        if held && state.weight_before.is_none() {
            state.weight_before = Some(entity.get::<StyleWeight>().copied());
            entity.insert(StyleWeight(0.0));
        } else if !held && let Some(before) = state.weight_before.take() {
            match before {
                Some(weight) => entity.insert(weight),
                None => entity.remove::<StyleWeight>(),
            };
        }
    }
}
