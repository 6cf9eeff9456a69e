//! Materials as files: the lighting of a toon material as an asset.

use bevy::{
    asset::{AssetLoader, AssetPath, LoadContext, io::Reader},
    prelude::*,
};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ToonLight;
use crate::files::{
    self,
    renamed::{self, Upgraded},
};

/// The lighting of a [`ToonMaterial`](crate::ToonMaterial) in a file, which several
/// materials can share.
///
/// Files end in `.toon.ron` and are written as [`ComicStyle`](crate::ComicStyle)s are, in RON with
/// implicit `Some`. `light` has the fields of [`ToonLight`]; those that a file leaves out have
/// their defaults:
///
/// ```
/// # use bevy_comics::toon::ToonShading;
/// let shading = ToonShading::from_ron(r##"(
///     version: 2,
///     name: "Skin",
///     light: (
///         highlight: 0.0,
///         ramp: (
///             mode: PerLight,
///             stops: [
///                 (color: "#7052a8"),
///                 (at: 0.08, color: "#d1808f"),
///                 (at: 0.22, color: "#ffffff", softness: 0.12),
///             ],
///         ),
///     ),
/// )"##)?;
/// assert_eq!(shading.light.ramp.unwrap().stops.len(), 3);
/// # Ok::<(), bevy_comics::toon::ToonShadingError>(())
/// ```
///
/// A [`ramp_map`](ToonLight::ramp_map) is the path of its image among the assets, which is loaded
/// with the shading. A shading whose path leads out of their folder, or to another source of assets
/// than that of the shading, is not loaded; neither is one whose path has a `\` or a `:`, which
/// mean something else on other systems. Other images are not part of files: a material keeps its
/// own.
///
/// [`ToonShadingHandle`] gives one to a mesh, [`ToonScene::shading`](crate::ToonScene::shading) to a
/// whole scene. Both follow changes of the file, if the app watches its files (Bevy's feature
/// `file_watcher`). A file that becomes unreadable changes nothing: the last shading stays, and the
/// log names line, column and what is wrong.
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(try_from = "File", into = "File")]
pub struct ToonShading {
    /// Title for people; any text. Default: empty.
    pub name: String,
    /// The lighting. Numbers outside their documented ranges are clamped.
    pub light: ToonLight,
}

/// Gives the material of a mesh the lighting of a [`ToonShading`].
///
/// On an entity with a [`ToonMaterial`](crate::ToonMaterial), the material is changed when the
/// shading has loaded, and again whenever the shading, the handle or the entity's material changes:
/// so all meshes with this material have the shading. Between those moments the material may be
/// edited. Removing the component leaves the material as it is.
///
/// Below a [`ToonScene`](crate::ToonScene), on an entity with a mesh, it takes the place of
/// the scene's shading for this mesh alone; removing it gives the scene's shading back.
///
/// A scene in code can name a path: the component's template takes one in the handle's place.
#[derive(Component, FromTemplate, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ToonShadingHandle(pub Handle<ToonShading>);

/// Why a [`ToonShading`] was not read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ToonShadingError {
    /// The file could not be read.
    #[error("cannot read the shading: {0}")]
    Io(#[from] std::io::Error),
    /// The text is not a shading: bad syntax, an unknown field, a wrong type.
    #[error("not a toon shading, line {line}, column {column}: {message}")]
    #[non_exhaustive]
    Syntax {
        /// Line of the file, from 1.
        line: usize,
        /// Column of that line in characters, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// The format's version is not one that this crate reads.
    #[error(
        "shading format version {found} is not known; this crate reads versions {PREVIOUS} and {VERSION}"
    )]
    #[non_exhaustive]
    Version {
        /// The version that the file states.
        found: u32,
    },
    /// The path of an image leads out of the folder of assets, to another source, or to another
    /// computer.
    #[error("the image {path} is outside the folder of assets")]
    #[non_exhaustive]
    Path {
        /// The path in the file.
        path: String,
    },
    /// The shading could not be written as text.
    #[error("cannot write the shading: {message}")]
    #[non_exhaustive]
    Write {
        /// The reason.
        message: String,
    },
}

/// The version of the file format.
const VERSION: u32 = 2;
const PREVIOUS: u32 = VERSION - 1;

#[derive(Serialize, Deserialize)]
#[serde(rename = "ToonShading", deny_unknown_fields)]
struct File {
    version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    light: ToonLight,
}

impl From<ToonShading> for File {
    fn from(shading: ToonShading) -> Self {
        Self {
            version: VERSION,
            name: shading.name,
            light: shading.light,
        }
    }
}

impl TryFrom<File> for ToonShading {
    type Error = ToonShadingError;

    fn try_from(file: File) -> Result<Self, ToonShadingError> {
        let found = file.version;
        if found != VERSION {
            return Err(ToonShadingError::Version { found });
        }
        Ok(Self {
            name: file.name,
            light: file.light,
        })
    }
}

impl ToonShading {
    /// A shading without a name.
    #[must_use]
    pub fn new(light: ToonLight) -> Self {
        Self {
            name: String::new(),
            light,
        }
    }

    /// The lighting, with the maps of `other` that the shading has none of: files do not have all
    /// of them.
    pub(super) fn with_maps_of(&self, other: &ToonLight) -> ToonLight {
        let light = self.light.clone();
        ToonLight {
            art_map: light.art_map.or_else(|| other.art_map.clone()),
            ramp_map: if light.ramp_map.is_none() {
                other.ramp_map.clone()
            } else {
                light.ramp_map
            },
            threshold_map: (light.threshold_map).or_else(|| other.threshold_map.clone()),
            ..light
        }
    }

    /// Reads a shading from the text of a `.toon.ron` file. The path of its image is not checked:
    /// only what the app's assets load is.
    ///
    /// # Errors
    /// [`ToonShadingError::Syntax`] with line and column, or [`ToonShadingError::Version`].
    pub fn from_ron(text: &str) -> Result<Self, ToonShadingError> {
        let read = read(text)?;
        if let Some(advice) = read.1 {
            warn!("{advice}");
        }
        Ok(read.0)
    }

    /// The text of a `.toon.ron` file that reads back as the same shading. Colors are written in
    /// sRGB, whatever their color space.
    ///
    /// # Errors
    /// [`ToonShadingError::Write`] if a value has no RON form.
    pub fn to_ron(&self) -> Result<String, ToonShadingError> {
        files::written(self).map_err(|message| ToonShadingError::Write { message })
    }
}

/// Reads the text of a file; also says what to change in one of the previous version.
fn read(text: &str) -> Result<(ToonShading, Option<String>), ToonShadingError> {
    let current = match renamed::version(text) {
        Some(PREVIOUS) => renamed::upgraded(text, "2", renamed::SHADING),
        None | Some(VERSION) => Upgraded::unchanged(text),
        Some(found) => return Err(ToonShadingError::Version { found }),
    };
    match files::ron_options().from_str(&current.text) {
        Ok(shading) => Ok((shading, current.advice())),
        Err(error) => Err(ToonShadingError::Syntax {
            line: error.span.start.line,
            column: current.original_column(error.span.start.line, error.span.start.col),
            message: error.code.to_string(),
        }),
    }
}

/// Reads `.toon.ron` files.
#[derive(TypePath, Default)]
pub(super) struct ToonShadingLoader;

impl AssetLoader for ToonShadingLoader {
    type Asset = ToonShading;
    type Settings = ();
    type Error = ToonShadingError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<ToonShading, ToonShadingError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes)
            .map_err(|error| std::io::Error::new(std::io::ErrorKind::InvalidData, error))?;
        let (mut shading, advice) = read(&text)?;
        if let Some(advice) = advice {
            warn!("{}: {advice}", load_context.path());
        }
        // Untrusted files, of a mod for example, read only what is among the assets.
        if let Some(path) = shading.light.ramp_map.path()
            && !is_local(path, load_context.path())
        {
            let path = path.to_string();
            return Err(ToonShadingError::Path { path });
        }
        shading.light.ramp_map = shading
            .light
            .ramp_map
            .loaded(|path| load_context.load(path));
        Ok(shading)
    }

    fn extensions(&self) -> &[&str] {
        &["toon.ron"]
    }
}

/// Whether a shading may read a path: it stays in the folder of its assets on every system, and is
/// among the app's usual assets or those that the shading is from, but not on the web.
fn is_local(path: &AssetPath, shading: &AssetPath) -> bool {
    let source = path.source().as_str();
    let is_known = source.is_none() || source == shading.source().as_str();
    let is_web = matches!(source, Some("http" | "https"));
    let is_foreign = path.path().to_string_lossy().contains(['\\', ':']);
    is_known && !is_web && !is_foreign && !path.is_unapproved()
}

/// The shading that an event says is new or changed.
pub(super) fn changed(event: &AssetEvent<ToonShading>) -> Option<AssetId<ToonShading>> {
    match event {
        AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
        _ => None,
    }
}
