//! The toolbar: undo, the clipboard, and comparisons.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::{self, Key, Modifiers, Ui};

use super::{
    super::{
        Widgets,
        fields::{button, button_with_tooltip},
        files::on_camera,
        history::{Step, Way},
        memory::Tab,
        note, rust_code,
    },
    Message, Panel, put,
};
use bevy_comics::{ComicStyle, ComicsDiagnostics, SplitView, StyleWeight, effect::EffectRegistry};

/// The toolbar's keyboard shortcuts that were pressed in this frame.
struct Keys {
    undo: bool,
    redo: bool,
    save: bool,
    find: bool,
}

impl Keys {
    /// Takes the keys from the input. A text field that has the focus keeps its
    /// own shortcuts.
    fn take(ui: &Ui) -> Self {
        let is_typing = ui.ctx().text_edit_focused();
        let consume = |modifiers: Modifiers, key: Key| {
            ui.ctx()
                .input_mut(|input| input.consume_key(modifiers, key))
        };
        let key = |modifiers: Modifiers, key: Key| !is_typing && consume(modifiers, key);
        // Before undo: its keys match Ctrl+Shift+Z as well.
        let redo =
            key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || key(Modifiers::COMMAND, Key::Y);
        let undo = key(Modifiers::COMMAND, Key::Z);
        let save = key(Modifiers::COMMAND, Key::S);
        let find = consume(Modifiers::COMMAND, Key::F);
        Self {
            undo,
            redo,
            save,
            find,
        }
    }
}

impl Panel {
    /// Draws the toolbar; whether a step was undone or redone.
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
            self.pick_button(ui, world, widgets);
            self.copy_and_paste(ui, world, style, widgets);
        });
        ui.horizontal_wrapped(|ui| {
            self.two_styles(ui, camera, style, widgets);
            self.original(ui, world, camera, widgets);
            split(ui, world, camera, widgets);
        });
        ui.horizontal_wrapped(|ui| {
            weight(ui, world, camera, widgets);
            // The page of files shows the whole error.
            let in_full = self.memory.tab != Tab::Files;
            self.files.mark(ui, camera, style, in_full);
        });
        if keys.save {
            self.files.save(camera, style);
        }
        if keys.find {
            self.memory.tab = Tab::Style;
            self.search.focus();
        }
        if world.resource::<ComicsDiagnostics>().is_compiling(camera) {
            ui.label("Compiling shaders. The picture changes when they are ready.");
        }
        stepped
    }

    /// The buttons of the history; whether a step was taken.
    fn undo_and_redo(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        camera: Entity,
        style: &mut ComicStyle,
        keys: &Keys,
        widgets: &mut Widgets,
    ) -> bool {
        let (undos, redos) = self.history.steps(camera);
        let undo = button(ui, widgets, "undo", "⮪ Undo", undos > 0) || keys.undo;
        let redo = button(ui, widgets, "redo", "⮫ Redo", redos > 0) || keys.redo;
        let way = match (undo, redo) {
            (true, _) => Way::Undo,
            (_, true) => Way::Redo,
            _ => return false,
        };
        let stash = &mut self.cameras.entry(camera).or_default().stash;
        let mut is_style = false;
        self.history.take(way, camera, |step| match step {
            Step::Style(camera, other) => {
                is_style = true;
                stash.keep(style, &other);
                put(world, camera, &other);
                let now = std::mem::replace(style, other);
                Some(Step::Style(camera, now))
            }
            Step::Object(value) => value.exchange(world).map(Step::Object),
        });
        self.message = None;
        is_style
    }

    /// Buttons that copy the style to the clipboard and paste it from there.
    fn copy_and_paste(
        &mut self,
        ui: &mut Ui,
        world: &World,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
        let copy = (
            "copy",
            "Copy",
            "Copies the style as the text of a style file",
        );
        if button_with_tooltip(ui, widgets, copy, true) {
            self.message = match style.to_ron() {
                Ok(text) => self.copied(text, "The style is on the clipboard."),
                Err(error) => Some(Message::Failed(error.to_string())),
            };
        }
        let rust = (
            "copy_rust",
            "Copy as Rust",
            "Copies the style as a Rust expression, for a module that imports \
             bevy::prelude::* and bevy_comics::prelude::*",
        );
        if button_with_tooltip(ui, widgets, rust, true) {
            let done = "The style is on the clipboard, as Rust code.";
            self.message = self.copied(rust_code(style), done);
        }
        let paste = (
            "paste",
            "Paste",
            "Replaces the style by the text of a style file from the clipboard",
        );
        if button_with_tooltip(ui, widgets, paste, true) {
            let effects = world.resource::<EffectRegistry>();
            let pasted = self.clipboard.paste();
            self.message = match pasted.map(|text| effects.style_from_ron(&text)) {
                Some(Ok(pasted)) => {
                    *style = on_camera(&pasted, style);
                    None
                }
                Some(Err(error)) => Some(Message::Failed(format!(
                    "The clipboard does not hold a style: {error}"
                ))),
                None => Some(Message::Failed("The clipboard is empty.".into())),
            };
        }
    }

    fn copied(&mut self, text: String, done: &'static str) -> Option<Message> {
        self.clipboard.copy(text);
        Some(Message::Done(done))
    }

    /// The buttons of the two styles that are compared.
    fn two_styles(
        &mut self,
        ui: &mut Ui,
        camera: Entity,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
        let state = self.cameras.entry(camera).or_default();
        for (letter, b) in [("A", false), ("B", true)] {
            let item = ui
                .selectable_label(state.shows_b == b, letter)
                .on_hover_text(
                    "Two styles to compare. Each keeps its own changes; B starts as a copy of A.",
                );
            note(widgets, format!("compare.{letter}"), &item);
            if item.clicked() && state.shows_b != b {
                let other = state.other.take().unwrap_or_else(|| style.clone());
                state.other = Some(std::mem::replace(style, other));
                state.shows_b = b;
            }
        }
    }

    /// The button that shows the picture without a style while it is held.
    fn original(&mut self, ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
        let original = ui
            .button("Original")
            .on_hover_text("Shows the picture without a style while the button is held");
        note(widgets, "compare.original", &original);
        let held = original.is_pointer_button_down_on()
            || (original.has_focus() && ui.input(|input| input.key_down(Key::Space)));
        self.show_original(world, camera, held);
    }

    /// Sets the style's weight to 0, or back to the game's value.
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

/// The check box of the split view, and the slider of the split's position.
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

/// The slider of the style's weight.
fn weight(ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
    let mut entity = world.entity_mut(camera);
    let mut weight = entity.get::<StyleWeight>().copied().unwrap_or_default().0;
    let slider = ui
        .add(egui::Slider::new(&mut weight, 0.0..=1.0).text("Weight"))
        .on_hover_text("Strength of the style: 0 is the original picture, 1 the full style. Sets the component StyleWeight, which is not part of the style.");
    note(widgets, "weight", &slider);
    if slider.changed() {
        if weight == 1.0 {
            entity.remove::<StyleWeight>();
        } else {
            entity.insert(StyleWeight(weight));
        }
    }
}
