//! The page of style files, and the name of the open one in the toolbar.

use bevy::ecs::entity::Entity;
use bevy_egui::egui::{TextEdit, Ui};

use super::{
    super::{
        Widgets,
        fields::{self, button},
        note,
    },
    Files, OpenFile, on_camera, style_files,
};
use bevy_comics::ComicStyle;

impl Files {
    /// Shows the open file, whether the style differs from it, and the file's
    /// error: in full or as a hint.
    pub fn mark(&self, ui: &mut Ui, camera: Entity, style: &ComicStyle, in_full: bool) {
        let Some(open) = self.open.get(&camera) else {
            return;
        };
        let file = open.path.file_name().unwrap_or_default().to_string_lossy();
        if open.is_saved(style) {
            ui.label(file.into_owned());
        } else {
            ui.strong(format!("• {file}"))
                .on_hover_text("The style has changes that are not saved");
        }
        if let Some(error) = &open.error {
            fields::error(
                ui,
                if in_full {
                    error
                } else {
                    "has an error: see the page Files"
                },
            );
        }
    }

    pub fn show(
        &mut self,
        ui: &mut Ui,
        camera: Entity,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
        self.names(ui, widgets);
        self.buttons(ui, camera, style, widgets);
        self.state(ui, camera, widgets);
        ui.separator();
        self.list(ui, camera, style, widgets);
    }

    /// The fields for the name of the file and for the title of the style.
    fn names(&mut self, ui: &mut Ui, widgets: &mut Widgets) {
        ui.horizontal(|ui| {
            let name = ui.add(TextEdit::singleline(&mut self.name).hint_text("file name"));
            note(widgets, "files.name", &name);
            name.on_hover_text("A name in the folder below, or a path");
            ui.label("File");
        });
        ui.horizontal(|ui| {
            let title = ui.add(TextEdit::singleline(&mut self.title).hint_text("title"));
            note(widgets, "files.title", &title);
            ui.label("Title");
        });
    }

    /// The buttons that load and save.
    fn buttons(
        &mut self,
        ui: &mut Ui,
        camera: Entity,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
        let named = self.path().is_some();
        ui.horizontal(|ui| {
            if button(ui, widgets, "files.load", "Load", named)
                && let Some(path) = self.path()
                && let Some(loaded) = self.load(camera, &path)
            {
                *style = on_camera(&loaded, style);
            }
            let is_open = self.open.contains_key(&camera);
            if button(ui, widgets, "files.save", "Save", is_open) {
                self.save(camera, style);
            }
            if button(ui, widgets, "files.save_as", "Save as", named)
                && let Some(path) = self.path()
            {
                self.save_as(camera, style, path);
            }
            if button(ui, widgets, "files.new", "New", true) {
                self.forget(camera);
                self.name.clear();
                self.title.clear();
                *style = ComicStyle::new();
            }
        });
    }

    /// The result of the last action, and the open file.
    fn state(&self, ui: &mut Ui, camera: Entity, widgets: &mut Widgets) {
        if let Some(message) = &self.message {
            fields::error(ui, message);
        }
        if let Some(OpenFile {
            path, error, saved, ..
        }) = self.open.get(&camera)
        {
            ui.label(format!("Open: {}", path.display()));
            if saved.partial {
                ui.label(
                    "The file holds a partial style: it sets only some effects. Saving \
                     writes all effects of the camera to it.",
                );
            }
            if let Some(error) = error {
                let error = fields::error(ui, error);
                note(widgets, "files.error", &error);
                ui.label("The camera keeps the last valid style until the file is corrected.");
            }
        }
    }

    /// The files of the folder. A click loads one.
    fn list(&mut self, ui: &mut Ui, camera: Entity, style: &mut ComicStyle, widgets: &mut Widgets) {
        ui.label(format!("Files in {}:", self.folder.display()));
        for path in style_files(&self.folder) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let open = self.open.get(&camera).is_some_and(|open| open.path == path);
            let item = ui.selectable_label(open, name.as_ref());
            note(widgets, format!("files.{name}"), &item);
            if item.clicked()
                && let Some(loaded) = self.load(camera, &path)
            {
                *style = on_camera(&loaded, style);
            }
        }
    }
}
