//! The field in which settings are searched for.

use bevy_egui::egui::{Id, Key, TextEdit, Ui};

use super::super::{Widgets, fields::button_with_tooltip, note, search::Search};

#[derive(Default)]
pub(super) struct SearchField {
    text: String,
    wants_focus: bool,
}

impl SearchField {
    /// The search, if there is one.
    pub fn search(&self) -> Option<Search> {
        Search::of(&self.text)
    }

    /// Moves the focus to the field when it is shown next.
    pub fn focus(&mut self) {
        self.wants_focus = true;
    }

    pub fn show(&mut self, ui: &mut Ui, widgets: &mut Widgets) {
        ui.horizontal(|ui| {
            // The width of the clear button, which is always there so that the
            // field does not change its size while it is typed into.
            let width = (ui.available_width() - 32.0).max(80.0);
            let field = TextEdit::singleline(&mut self.text)
                .id(Id::new("comics_search"))
                .hint_text("Search settings (Ctrl+F)")
                .desired_width(width);
            let response = ui.add(field);
            note(widgets, "search", &response);
            if std::mem::take(&mut self.wants_focus) {
                response.request_focus();
            }
            // The toolkit takes the focus from a field at Escape.
            let escaped = (response.has_focus() || response.lost_focus())
                && ui.input(|input| input.key_pressed(Key::Escape));
            let clear = ("search.clear", "✖", "Clear the search (Esc)");
            let cleared = button_with_tooltip(ui, widgets, clear, !self.text.is_empty());
            if escaped || cleared {
                self.text.clear();
            }
        });
    }
}
