//! Style files: loading, saving, and watching for changes by other programs.

mod page;

use std::{
    fs, io,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy::{ecs::entity::EntityHashMap, prelude::*};

use bevy_comics::{ComicStyle, effect::EffectRegistry, style::ComicStyleError};

const SUFFIX: &str = ".comic.ron";
/// How often the open file is read again.
const WATCH: Duration = Duration::from_millis(250);

/// The file that a camera's style was loaded from or saved to.
struct OpenFile {
    path: PathBuf,
    /// The last style that was read from the file or written to it.
    saved: ComicStyle,
    /// The last text that was read from the file or written to it.
    seen: String,
    /// Why the file does not hold a style now. The camera keeps the last one.
    error: Option<String>,
    /// When the file was last read.
    looked: Instant,
}

impl OpenFile {
    /// Whether a camera's style is as the file has it.
    fn is_saved(&self, style: &ComicStyle) -> bool {
        // Values out of range in the file are not a change by the user.
        let file = on_camera(&self.saved, style).sanitized();
        let named = ComicStyle {
            name: self.saved.name.clone(),
            ..with_surroundings(style.clone(), &file)
        };
        named == file
    }
}

/// The style of a camera after a style was loaded or pasted: a partial one keeps
/// the effects that it does not mention.
pub fn on_camera(loaded: &ComicStyle, camera: &ComicStyle) -> ComicStyle {
    if loaded.partial {
        loaded.over(camera)
    } else {
        loaded.clone()
    }
}

/// A style with what the panel does not edit of another one.
fn with_surroundings(style: ComicStyle, of: &ComicStyle) -> ComicStyle {
    ComicStyle {
        camera: of.camera,
        #[cfg(feature = "toon")]
        scene: of.scene.clone(),
        ..style
    }
}

/// The open files of all cameras.
pub struct Files {
    folder: PathBuf,
    registry: EffectRegistry,
    open: EntityHashMap<OpenFile>,
    /// The text in the field for the file name.
    name: String,
    /// The text in the field for the style's title.
    title: String,
    message: Option<String>,
}

/// The text of a file.
fn text_of(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| ComicStyleError::from(error).to_string())
}

/// The style in the text of a file. Logs what to change in a file of an older version.
fn style_of(path: &Path, text: &str, registry: &EffectRegistry) -> Result<ComicStyle, String> {
    let read = registry
        .read_style(text)
        .map_err(|error| error.to_string())?;
    if let Some(advice) = read.advice {
        warn!("{}: {advice}", path.display());
    }
    Ok(read.style)
}

impl Files {
    pub fn new(folder: PathBuf, registry: EffectRegistry) -> Self {
        Self {
            folder,
            registry,
            open: EntityHashMap::default(),
            name: String::new(),
            title: String::new(),
            message: None,
        }
    }

    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Closes a camera's file.
    pub fn forget(&mut self, camera: Entity) {
        self.open.remove(&camera);
    }

    fn path(&self) -> Option<PathBuf> {
        path_of(&self.name, SUFFIX, &self.folder)
    }

    fn load(&mut self, camera: Entity, path: &Path) -> Option<ComicStyle> {
        let read = text_of(path).and_then(|text| {
            let style = style_of(path, &text, &self.registry)?;
            Ok((text, style))
        });
        match read {
            Ok((seen, saved)) => {
                self.message = None;
                self.name = self.shown(path);
                self.title.clone_from(&saved.name);
                let open = OpenFile {
                    path: path.to_owned(),
                    saved: saved.clone(),
                    seen,
                    error: None,
                    looked: Instant::now(),
                };
                self.open.insert(camera, open);
                Some(saved)
            }
            Err(error) => {
                self.message = Some(format!("{}: {error}", path.display()));
                None
            }
        }
    }

    /// A path as the field for the file name shows it.
    fn shown(&self, path: &Path) -> String {
        let inside = path.parent() == Some(self.folder.as_path());
        let shown = if inside {
            path.file_name().map(Path::new).unwrap_or(path)
        } else {
            path
        };
        let text = shown.to_string_lossy();
        text.strip_suffix(SUFFIX).unwrap_or(&text).to_owned()
    }

    /// Saves to the open file.
    pub fn save(&mut self, camera: Entity, style: &ComicStyle) {
        match self
            .open
            .get(&camera)
            .map(|open| open.path.clone())
            .or_else(|| self.path())
        {
            Some(path) => self.save_as(camera, style, path),
            None => {
                let message = "The style has no file yet. Enter a file name on the page Files.";
                self.message = Some(message.into());
            }
        }
    }

    fn save_as(&mut self, camera: Entity, style: &ComicStyle, path: PathBuf) {
        let title = if self.title.trim().is_empty() {
            self.shown(&path)
        } else {
            self.title.clone()
        };
        let named = ComicStyle {
            name: title.clone(),
            ..style.clone()
        };
        // On a camera without `Comic`, they are in the file alone.
        let is_bare = with_surroundings(named.clone(), &ComicStyle::new()) == named;
        let open = self.open.get(&camera).filter(|_| is_bare);
        let saved = match open {
            Some(open) => with_surroundings(named, &open.saved),
            None => named,
        };
        let written = saved.to_ron().and_then(|text| {
            write(&path, &text)?;
            Ok(text)
        });
        match written {
            Ok(seen) => {
                self.message = None;
                self.name = self.shown(&path);
                self.title = title;
                let open = OpenFile {
                    path,
                    saved,
                    seen,
                    error: None,
                    looked: Instant::now(),
                };
                self.open.insert(camera, open);
            }
            Err(error) => self.message = Some(format!("{}: {error}", path.display())),
        }
    }

    /// The new style of a camera's file, if another program has changed it.
    pub fn watch(&mut self, camera: Entity, style: &ComicStyle) -> Option<ComicStyle> {
        let open = self.open.get_mut(&camera)?;
        if open.looked.elapsed() < WATCH {
            return None;
        }
        open.looked = Instant::now();
        let text = match text_of(&open.path) {
            Ok(text) if text == open.seen => return None,
            Ok(text) => text,
            Err(error) => {
                open.seen.clear();
                open.error = Some(error);
                return None;
            }
        };
        let style_read = style_of(&open.path, &text, &self.registry);
        open.seen = text;
        match style_read {
            Ok(read) => {
                open.error = None;
                open.saved = read.clone();
                self.title.clone_from(&read.name);
                let named = ComicStyle {
                    name: style.name.clone(),
                    ..on_camera(&read, style)
                };
                (named != *style).then_some(named)
            }
            Err(error) => {
                open.error = Some(error);
                None
            }
        }
    }
}

/// The path that a typed name means: a name alone is a file in the folder, and the suffix need not
/// be typed. `None` if nothing is typed.
pub fn path_of(name: &str, suffix: &str, folder: &Path) -> Option<PathBuf> {
    let name = name.trim();
    if name.is_empty() {
        return None;
    }
    let mut path = PathBuf::from(name);
    if !name.ends_with(suffix) {
        path = PathBuf::from(format!("{name}{suffix}"));
    }
    if path
        .parent()
        .is_none_or(|parent| parent.as_os_str().is_empty())
    {
        path = folder.join(path);
    }
    Some(path)
}

/// Writes a file at once, so that a game that watches it never reads a part.
pub fn write(path: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let part = path.with_extension("part");
    fs::write(&part, text)?;
    fs::rename(&part, path)
}

/// The style files of a folder, by name.
pub fn style_files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.to_string_lossy().ends_with(SUFFIX))
        .collect();
    files.sort();
    files
}

#[cfg(test)]
mod tests;
