//! What the panel remembers from one run to the next.

use std::{fs, path::Path};

use bevy::log::warn;
use serde::{Deserialize, Serialize};

/// Where the panel stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Dock {
    Left,
    #[default]
    Right,
    Floating,
}

impl Dock {
    pub const ALL: [Self; 3] = [Self::Left, Self::Right, Self::Floating];

    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "Left",
            Self::Right => "Right",
            Self::Floating => "Window",
        }
    }
}

/// The pages of the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tab {
    #[default]
    Style,
    Presets,
    Files,
    Views,
    Cost,
    Photo,
}

impl Tab {
    pub const ALL: [Self; 6] = [
        Self::Style,
        Self::Presets,
        Self::Files,
        Self::Views,
        Self::Cost,
        Self::Photo,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Style => "Style",
            Self::Presets => "Presets",
            Self::Files => "Files",
            Self::Views => "Views",
            Self::Cost => "Cost",
            Self::Photo => "Photo",
        }
    }
}

/// Everything that is remembered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Memory {
    pub dock: Dock,
    pub tab: Tab,
    /// Points.
    pub width: f32,
    /// Size of the text against the window's own scale.
    pub zoom: f32,
    /// Of a fade to a preset, seconds.
    pub fade: f32,
    /// Of a picture against the window.
    pub multiple: u32,
}

impl Default for Memory {
    fn default() -> Self {
        Self {
            dock: Dock::default(),
            tab: Tab::default(),
            width: 360.0,
            zoom: 1.0,
            fade: 0.6,
            multiple: 2,
        }
    }
}

impl Memory {
    /// What was remembered; the defaults where there is nothing, or nothing
    /// that can be read: this is no file that anybody edits.
    pub fn load(path: Option<&Path>) -> Self {
        path.and_then(|path| fs::read_to_string(path).ok())
            .and_then(|text| ron::from_str::<Self>(&text).ok())
            .unwrap_or_default()
            .sane()
    }

    fn sane(self) -> Self {
        let default = Self::default();
        let within = |value: f32, low: f32, high: f32, default: f32| {
            if value.is_finite() {
                value.clamp(low, high)
            } else {
                default
            }
        };
        Self {
            width: within(self.width, 240.0, 2000.0, default.width),
            zoom: within(self.zoom, 0.5, 4.0, default.zoom),
            fade: within(self.fade, 0.0, 10.0, default.fade),
            multiple: self.multiple.clamp(1, 8),
            ..self
        }
    }

    pub fn save(&self, path: &Path) {
        let written = ron::ser::to_string_pretty(self, ron::ser::PrettyConfig::default())
            .map_err(std::io::Error::other)
            .and_then(|text| {
                if let Some(folder) = path.parent() {
                    fs::create_dir_all(folder)?;
                }
                fs::write(path, text)
            });
        if let Err(error) = written {
            warn!(
                "the inspector cannot remember itself in {}: {error}",
                path.display()
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_remembers_and_forgives() {
        let folder = std::env::temp_dir().join(format!("comics-memory-{}", std::process::id()));
        let path = folder.join("deeper").join("inspector.ron");
        assert_eq!(Memory::load(Some(&path)), Memory::default());
        let memory = Memory {
            dock: Dock::Floating,
            tab: Tab::Cost,
            width: 512.0,
            ..Memory::default()
        };
        memory.save(&path);
        assert_eq!(Memory::load(Some(&path)), memory);
        fs::write(&path, "(width: NaN, zoom: 1e9, multiple: 0)").expect("written");
        let sane = Memory::load(Some(&path));
        assert_eq!((sane.width, sane.zoom, sane.multiple), (360.0, 4.0, 1));
        fs::write(&path, "nonsense").expect("written");
        assert_eq!(Memory::load(Some(&path)), Memory::default());
        fs::remove_dir_all(&folder).expect("removed");
    }
}
