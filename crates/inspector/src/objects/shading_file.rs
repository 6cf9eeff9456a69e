//! Writes a light as a shading file.

use std::path::{Path, PathBuf};

use bevy_egui::egui::{TextEdit, Ui};

use super::{
    super::{
        Widgets,
        fields::{button_with_tooltip, error},
        files::{path_of, write},
        note,
    },
    light_owner::LightOwner,
};
use bevy_comics::{ToonLight, toon::ToonShading};

const SUFFIX: &str = ".toon.ron";

/// The field for the file's name, and the result of the last try.
pub(super) struct ShadingFile {
    folder: PathBuf,
    name: String,
    result: Option<Result<PathBuf, String>>,
}

impl ShadingFile {
    pub fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            name: String::new(),
            result: None,
        }
    }

    /// The field for the name, the button that saves, and the last result.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        place: &LightOwner,
        (light, title): (&ToonLight, &str),
        widgets: &mut Widgets,
    ) {
        ui.horizontal(|ui| {
            let hint = own_name(place).unwrap_or("file name");
            let field = TextEdit::singleline(&mut self.name)
                .hint_text(hint)
                .desired_width(140.0);
            let field = ui.add(field);
            note(widgets, "shading.name", &field);
            field.on_hover_text(format!("A name in {}, or a path", self.folder.display()));
            let save = (
                "shading.save",
                "Save as a shading",
                "Writes the light as a .toon.ron file, with the path of its ramp's image. Other images are not part of it.",
            );
            let path = self.path(place);
            if button_with_tooltip(ui, widgets, save, path.is_some())
                && let Some(path) = path
            {
                self.save((light, title), path);
            }
        });
        match &self.result {
            Some(Ok(path)) => {
                let saved = ui.label(format!("Saved: {}", path.display()));
                note(widgets, "shading.saved", &saved);
            }
            Some(Err(text)) => {
                let failed = error(ui, text);
                note(widgets, "shading.error", &failed);
            }
            None => {}
        }
    }

    /// Where the light is written: under the typed name, else under that of its shading.
    fn path(&self, place: &LightOwner) -> Option<PathBuf> {
        path_of(&self.name, SUFFIX, &self.folder)
            .or_else(|| path_of(own_name(place)?, SUFFIX, &self.folder))
    }

    /// `title`: that of the shading, if it has one.
    fn save(&mut self, (light, title): (&ToonLight, &str), path: PathBuf) {
        let shading = ToonShading {
            name: match title {
                "" => title_of(&path),
                title => title.to_owned(),
            },
            light: light.clone().sanitized(),
        };
        let written = shading
            .to_ron()
            .map_err(|error| error.to_string())
            .and_then(|text| write(&path, &text).map_err(|error| error.to_string()));
        self.result = Some(match written {
            Ok(()) => Ok(path),
            Err(error) => Err(format!("{}: {error}", path.display())),
        });
    }
}

/// The file name of a shading that came from a file.
fn own_name(place: &LightOwner) -> Option<&str> {
    match place {
        LightOwner::Shading(shading) => shading.path()?.path().file_name()?.to_str(),
        _ => None,
    }
}

/// The title of a shading in a file: the file's name.
fn title_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.strip_suffix(SUFFIX).unwrap_or(&name).to_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use bevy_comics::toon::{Ramp, RampStop};

    #[test]
    fn a_light_is_saved_under_a_name_in_the_folder() {
        let folder = std::env::temp_dir().join(format!("comics-shadings-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        let place = LightOwner::Scene(bevy::ecs::entity::Entity::PLACEHOLDER);
        let mut file = ShadingFile::new(folder.clone());
        assert_eq!(file.path(&place), None, "no name, no file");
        file.name = "  ".into();
        assert_eq!(file.path(&place), None);
        file.name = " skin ".into();
        let path = file.path(&place).expect("a path");
        assert_eq!(path, folder.join("skin.toon.ron"));
        let light = ToonLight {
            highlight: 40.0,
            ramp: Some(Ramp::new([
                RampStop::new(0.5, bevy::color::Color::WHITE),
                RampStop::new(0.0, bevy::color::Color::BLACK),
            ])),
            ..ToonLight::default()
        };
        file.save((&light, ""), path.clone());
        assert_eq!(file.result, Some(Ok(path.clone())));
        let text = fs::read_to_string(&path).expect("written");
        let read = ToonShading::from_ron(&text).expect("a shading");
        assert_eq!(read.name, "skin");
        // In range, and the stops in order.
        let read = read.light;
        assert_eq!(read.highlight, 4.0);
        let stops = read.ramp.expect("a ramp").stops;
        assert_eq!(stops.iter().map(|s| s.at).collect::<Vec<_>>(), [0.0, 0.5]);
        // A folder in the place of the file.
        let taken = folder.join("taken.toon.ron");
        fs::create_dir_all(&taken).expect("a folder");
        file.save((&light, ""), taken);
        assert!(matches!(file.result, Some(Err(_))), "{:?}", file.result);
        fs::remove_dir_all(&folder).expect("removed");
    }
}
