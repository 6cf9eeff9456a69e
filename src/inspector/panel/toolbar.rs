//! Undo, the clipboard, and the ways to compare.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::{self, Key, Modifiers, Ui};

use super::{
    super::{Widgets, fields::button, memory::Tab, note},
    Panel, put,
};
use crate::{ComicStyle, ComicsDiagnostics, EffectRegistry, SplitView, StyleWeight};

/// The keys of the toolbar, in this frame.
struct Keys {
    undo: bool,
    redo: bool,
    save: bool,
}

impl Keys {
    /// Takes them from the input, unless somebody types.
    fn take(ui: &Ui) -> Self {
        let typing = ui.ctx().text_edit_focused();
        let key = |modifiers: Modifiers, key: Key| {
            !typing
                && ui
                    .ctx()
                    .input_mut(|input| input.consume_key(modifiers, key))
        };
        // Before undo, whose key is a part of this one.
        let redo =
            key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || key(Modifiers::COMMAND, Key::Y);
        let undo = key(Modifiers::COMMAND, Key::Z);
        let save = key(Modifiers::COMMAND, Key::S);
        Self { undo, redo, save }
    }
}

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
        let keys = Keys::take(ui);
        let mut stepped = false;
        ui.horizontal_wrapped(|ui| {
            stepped = self.undo_and_redo(ui, world, camera, style, &keys, widgets);
            self.copy_and_paste(ui, world, style, widgets);
        });
        ui.horizontal_wrapped(|ui| {
            self.two_looks(ui, camera, style, widgets);
            self.original(ui, world, camera, widgets);
            split(ui, world, camera, widgets);
        });
        ui.horizontal_wrapped(|ui| {
            weight(ui, world, camera, widgets);
            // Its own page says it at length.
            let in_full = self.memory.tab != Tab::Files;
            self.files.mark(ui, camera, style, in_full);
        });
        if keys.save {
            self.files.save(camera, style);
        }
        if world.resource::<ComicsDiagnostics>().is_compiling(camera) {
            ui.label("Compiling: the last look stays until it is done.");
        }
        stepped
    }

    /// The steps of the history; says whether one was taken.
    fn undo_and_redo(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        camera: Entity,
        style: &mut ComicStyle,
        keys: &Keys,
        widgets: &mut Widgets,
    ) -> bool {
        let (undos, redos) = self.cameras.entry(camera).or_default().history.steps();
        let undo = button(ui, widgets, "undo", "⮪ Undo", undos > 0) || keys.undo;
        let redo = button(ui, widgets, "redo", "⮫ Redo", redos > 0) || keys.redo;
        let state = self.cameras.entry(camera).or_default();
        let step = if undo {
            state.history.undo(style)
        } else if redo {
            state.history.redo(style)
        } else {
            None
        };
        let Some(step) = step else {
            return false;
        };
        put(world, camera, &step);
        *style = step;
        true
    }

    /// The style as text, to the clipboard and from it.
    fn copy_and_paste(
        &mut self,
        ui: &mut Ui,
        world: &World,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
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
                .map(|text| world.resource::<EffectRegistry>().style_from_ron(&text))
            {
                Some(Ok(pasted)) => *style = pasted,
                Some(Err(error)) => {
                    self.message = Some(format!("The clipboard holds no style: {error}"));
                }
                None => self.message = Some("The clipboard is empty.".into()),
            }
        }
    }

    /// The two looks that are compared.
    fn two_looks(
        &mut self,
        ui: &mut Ui,
        camera: Entity,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
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
    }

    /// The button that shows the picture without its style.
    fn original(&mut self, ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
        let original = ui
            .button("Original")
            .on_hover_text("Shows the picture without its style while it is held");
        note(widgets, "compare.original", &original);
        let held = original.is_pointer_button_down_on()
            || (original.has_focus() && ui.input(|input| input.key_down(Key::Space)));
        self.show_original(world, camera, held);
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

/// Half of the picture without the style, and where it ends.
fn split(ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
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
}

/// How much of the style is seen.
fn weight(ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
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
}
