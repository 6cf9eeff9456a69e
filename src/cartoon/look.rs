//! Materials as files: the lighting of a cartoon material as an asset.

use bevy::{
    asset::{
        Asset, AssetEvent, AssetId, AssetLoader, AssetPath, Assets, Handle, LoadContext, io::Reader,
    },
    ecs::{
        change_detection::{DetectChanges, Ref},
        component::Component,
        message::MessageReader,
        query::Without,
        reflect::ReflectComponent,
        system::{Query, Res, ResMut},
        template::FromTemplate,
    },
    pbr::MeshMaterial3d,
    platform::collections::HashSet,
    reflect::{
        Reflect, ReflectDeserialize, ReflectSerialize, TypePath, std_traits::ReflectDefault,
    },
};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use thiserror::Error;

use super::{CartoonLight, CartoonMaterial, scene::Original};
use crate::style::format;

/// The lighting of a [`CartoonMaterial`](crate::CartoonMaterial) in a file, which several
/// materials can share.
///
/// Files end in `.toon.ron` and are written as [`ComicStyle`](crate::ComicStyle)s are, in RON with
/// implicit `Some`. `light` has the fields of [`CartoonLight`]; those that a file leaves out have
/// their defaults:
///
/// ```
/// # use bevy_comics::ToonLook;
/// let look = ToonLook::from_ron(r##"(
///     version: 1,
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
/// assert_eq!(look.light.ramp.unwrap().stops.len(), 3);
/// # Ok::<(), bevy_comics::ToonLookError>(())
/// ```
///
/// A [`ramp_map`](CartoonLight::ramp_map) is the path of its image among the assets, which is loaded
/// with the look. A look whose path leads out of their folder, or to another source of assets than that of
/// the look, is not loaded; neither is one whose path has a `\` or a `:`, which mean something else on
/// other systems. Other images are not part of files: a material keeps its own.
///
/// [`ToonLookHandle`] gives one to a mesh, [`CartoonScene::look`](crate::CartoonScene::look) to a
/// whole scene. Both follow changes of the file, if the app watches its files (Bevy's feature
/// `file_watcher`). A file that becomes unreadable changes nothing: the last look stays, and the
/// log names line, column and what is wrong.
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct ToonLook {
    /// Title for people; any text. Default: empty.
    pub name: String,
    /// The lighting. Numbers outside their documented ranges count as the nearest end.
    pub light: CartoonLight,
}

/// Gives the material of a mesh the lighting of a [`ToonLook`].
///
/// On an entity with a [`CartoonMaterial`](crate::CartoonMaterial), the material is changed when
/// the look has loaded, and again whenever the look, the handle or the entity's material changes:
/// so all meshes with this material have the look. Between those moments the material may be
/// edited. Removing the component leaves the material as it is.
///
/// Below a [`CartoonScene`](crate::CartoonScene), on an entity with a mesh, it takes the place of
/// the scene's look for this mesh alone; removing it gives the scene's look back.
///
/// A scene in code can name a path: the component's template takes one in the handle's place.
#[derive(Component, FromTemplate, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ToonLookHandle(pub Handle<ToonLook>);

/// Why a [`ToonLook`] was not read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ToonLookError {
    /// The file could not be read.
    #[error("cannot read the look: {0}")]
    Io(#[from] std::io::Error),
    /// The text is not a look: bad syntax, an unknown field, a wrong type.
    #[error("not a toon look, line {line}, column {column}: {message}")]
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
    #[error("look format version {found} is not known; this crate reads version {VERSION}")]
    #[non_exhaustive]
    Version {
        /// The version that the file states.
        found: u32,
    },
    /// The path of an image leads out of the folder of assets, to another source, or to another computer.
    #[error("the image {path} is outside the folder of assets")]
    #[non_exhaustive]
    Path {
        /// The path in the file.
        path: String,
    },
    /// The look could not be written as text.
    #[error("cannot write the look: {message}")]
    #[non_exhaustive]
    Write {
        /// The reason.
        message: String,
    },
}

/// The version of the file format.
const VERSION: u32 = 1;

/// What a file has.
#[derive(Serialize, Deserialize)]
#[serde(rename = "ToonLook", deny_unknown_fields)]
struct File {
    version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    light: CartoonLight,
}

impl Serialize for ToonLook {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let file = File {
            version: VERSION,
            name: self.name.clone(),
            light: self.light.clone(),
        };
        file.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for ToonLook {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let file = File::deserialize(deserializer)?;
        let found = file.version;
        if found == VERSION {
            Ok(file.into())
        } else {
            Err(D::Error::custom(ToonLookError::Version { found }))
        }
    }
}

impl From<File> for ToonLook {
    fn from(file: File) -> Self {
        Self {
            name: file.name,
            light: file.light,
        }
    }
}

impl ToonLook {
    /// A look without a name.
    #[must_use]
    pub fn new(light: CartoonLight) -> Self {
        Self {
            name: String::new(),
            light,
        }
    }

    /// The lighting, with the maps of `other` that the look has none of: files do not have all of them.
    pub(super) fn with_maps_of(&self, other: &CartoonLight) -> CartoonLight {
        let light = self.light.clone();
        CartoonLight {
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

    /// Reads a look from the text of a `.toon.ron` file. The path of its image is not checked: only what
    /// the app's assets load is.
    ///
    /// # Errors
    /// [`ToonLookError::Syntax`] with line and column, or [`ToonLookError::Version`].
    pub fn from_ron(text: &str) -> Result<Self, ToonLookError> {
        if let Some(found) = format::stated_version(text)
            && found != VERSION
        {
            return Err(ToonLookError::Version { found });
        }
        let file: Result<File, _> = format::ron_options().from_str(text);
        file.map(Into::into).map_err(|error| ToonLookError::Syntax {
            line: error.span.start.line,
            column: error.span.start.col,
            message: error.code.to_string(),
        })
    }

    /// The text of a `.toon.ron` file that reads back as the same look. Colours are written in
    /// sRGB, whatever their colour space.
    ///
    /// # Errors
    /// [`ToonLookError::Write`] if a value has no RON form.
    pub fn to_ron(&self) -> Result<String, ToonLookError> {
        let pretty = ron::ser::PrettyConfig::default().indentor("    ");
        let mut text = format::ron_options()
            .to_string_pretty(self, pretty)
            .map_err(|error| ToonLookError::Write {
                message: error.to_string(),
            })?;
        text.push('\n');
        Ok(text)
    }
}

/// Reads `.toon.ron` files.
#[derive(TypePath, Default)]
pub(super) struct ToonLookLoader;

impl AssetLoader for ToonLookLoader {
    type Asset = ToonLook;
    type Settings = ();
    type Error = ToonLookError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<ToonLook, ToonLookError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes)
            .map_err(|error| std::io::Error::new(std::io::ErrorKind::InvalidData, error))?;
        let mut look = ToonLook::from_ron(&text)?;
        // Files of strangers, of a mod for example, read only what is among the assets.
        if let Some(path) = look.light.ramp_map.path()
            && !is_local(path, load_context.path())
        {
            let path = path.to_string();
            return Err(ToonLookError::Path { path });
        }
        look.light.ramp_map = look.light.ramp_map.loaded(|path| load_context.load(path));
        Ok(look)
    }

    fn extensions(&self) -> &[&str] {
        &["toon.ron"]
    }
}

/// Whether a look may read a path: it stays in the folder of its assets on every system, and is among the
/// app's usual assets or those that the look is from, but not on the web.
fn is_local(path: &AssetPath, look: &AssetPath) -> bool {
    let source = path.source().as_str();
    let is_known = source.is_none() || source == look.source().as_str();
    let is_web = matches!(source, Some("http" | "https"));
    let is_foreign = path.path().to_string_lossy().contains(['\\', ':']);
    is_known && !is_web && !is_foreign && !path.is_unapproved()
}

/// The look that an event says is new or changed.
pub(super) fn changed(event: &AssetEvent<ToonLook>) -> Option<AssetId<ToonLook>> {
    match event {
        AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
        _ => None,
    }
}

/// Gives the materials of single meshes their looks. A [`CartoonScene`](crate::CartoonScene) does
/// it for its own copies.
pub(super) fn apply_looks(
    meshes: Query<(Ref<ToonLookHandle>, Ref<MeshMaterial3d<CartoonMaterial>>), Without<Original>>,
    mut events: MessageReader<AssetEvent<ToonLook>>,
    looks: Res<Assets<ToonLook>>,
    mut materials: ResMut<Assets<CartoonMaterial>>,
) {
    let changed: HashSet<_> = events.read().filter_map(changed).collect();
    for (handle, material) in &meshes {
        let id = handle.0.id();
        if !handle.is_changed() && !material.is_changed() && !changed.contains(&id) {
            continue;
        }
        let Some(look) = looks.get(id) else {
            continue;
        };
        let Some(before) = materials.get(&material.0) else {
            continue;
        };
        let light = look.with_maps_of(&before.extension);
        if before.extension != light
            && let Some(mut material) = materials.get_mut(&material.0)
        {
            material.extension = light;
        }
    }
}
