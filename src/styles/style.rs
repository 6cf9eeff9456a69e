//! A whole look as one asset, `*.comic.ron`, applied to a camera as its
//! components.

use bevy::{
    asset::{Asset, AssetEvent, AssetLoader, Assets, Handle, LoadContext, io::Reader},
    ecs::{
        change_detection::{DetectChanges, Ref},
        component::Component,
        entity::Entity,
        lifecycle::RemovedComponents,
        message::MessageReader,
        query::{QueryData, With},
        reflect::ReflectComponent,
        system::{Commands, EntityCommands, Query, Res},
        world::EntityRef,
    },
    reflect::{Reflect, TypePath, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{BlackFlats, Colorization, Contours, Desaturation, Outlines, Sketch, ToneBands};
use crate::depth::DepthMap;

/// A look: every comics component a camera may have, in one asset.
///
/// Files end in `.comic.ron` and are written in RON with implicit `Some`; what
/// is left out is off, and fields that are left out have their default:
///
/// ```ron
/// (
///     version: 1,
///     name: "Old photograph",
///     colorization: (mode: Atmosphere, color: "#9e8057"),
///     contours: (threshold: 0.03),
/// )
/// ```
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ComicStyle {
    /// Version of the file format; 1 is the only one.
    pub version: u32,
    /// What people call it.
    #[serde(default)]
    pub name: String,
    /// The depth map; its default where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_map: Option<DepthMap>,
    /// Tone bands, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tone_bands: Option<ToneBands>,
    /// Desaturation, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub desaturation: Option<Desaturation>,
    /// Colorization, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colorization: Option<Colorization>,
    /// Black flats, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub black_flats: Option<BlackFlats>,
    /// Contours, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contours: Option<Contours>,
    /// Outlines, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outlines: Option<Outlines>,
    /// A sketch, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sketch: Option<Sketch>,
}

/// Why a style file was not understood.
#[derive(Debug, Error)]
pub enum ComicStyleError {
    /// The file could not be read.
    #[error("cannot read the style: {0}")]
    Io(#[from] std::io::Error),
    /// The file is not a style: bad syntax, an unknown field, a wrong type.
    #[error("not a comic style, line {}, column {}: {}", .0.span.start.line, .0.span.start.col, .0.code)]
    Syntax(#[from] ron::error::SpannedError),
    /// The file was written for another version of this crate.
    #[error("style format version {found} is not known; this crate reads version {known}", known = ComicStyle::VERSION)]
    Version {
        /// The version that the file states.
        found: u32,
    },
    /// The style could not be written as text.
    #[error("cannot write the style: {0}")]
    Write(#[from] ron::Error),
}

fn ron_options() -> ron::Options {
    ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME)
}

impl ComicStyle {
    /// The version of the file format that this crate reads and writes.
    pub const VERSION: u32 = 1;

    /// Reads a style from the text of a `.comic.ron` file.
    ///
    /// # Errors
    /// [`ComicStyleError::Syntax`] with line and column, or
    /// [`ComicStyleError::Version`].
    pub fn from_ron(text: &str) -> Result<Self, ComicStyleError> {
        let style: Self = ron_options().from_str(text)?;
        if style.version != Self::VERSION {
            return Err(ComicStyleError::Version {
                found: style.version,
            });
        }
        Ok(style)
    }

    /// The text of a `.comic.ron` file that reads back equal.
    ///
    /// # Errors
    /// [`ComicStyleError::Write`] if a value has no RON form.
    pub fn to_ron(&self) -> Result<String, ComicStyleError> {
        let pretty = ron::ser::PrettyConfig::default().indentor("    ");
        let mut text = ron_options().to_string_pretty(self, pretty)?;
        text.push('\n');
        Ok(text)
    }

    /// The style as it is used: every number in its documented range.
    #[must_use]
    pub fn sanitized(&self) -> Self {
        Self {
            version: self.version,
            name: self.name.clone(),
            depth_map: self.depth_map.map(DepthMap::sanitized),
            tone_bands: self.tone_bands.map(ToneBands::sanitized),
            desaturation: self.desaturation.map(Desaturation::sanitized),
            colorization: self.colorization.map(Colorization::sanitized),
            black_flats: self.black_flats.map(BlackFlats::sanitized),
            contours: self.contours.map(Contours::sanitized),
            outlines: self.outlines.map(Outlines::sanitized),
            sketch: self.sketch.map(Sketch::sanitized),
        }
    }

    /// The style that a camera's components are, without a name.
    pub fn of(camera: EntityRef) -> Self {
        // Every part of a look is optional, so that every entity has one.
        camera
            .get_components::<Look>()
            .map_or_else(|_| Self::default(), |look| look.style())
    }

    /// Makes the camera look like this style: inserts the components that it
    /// has and removes those that it has not.
    pub fn apply(&self, camera: &mut EntityCommands) {
        fn set<C: Component>(camera: &mut EntityCommands, component: Option<C>) {
            match component {
                Some(component) => camera.insert(component),
                None => camera.remove::<C>(),
            };
        }
        set(camera, self.depth_map);
        set(camera, self.tone_bands);
        set(camera, self.desaturation);
        set(camera, self.colorization);
        set(camera, self.black_flats);
        set(camera, self.contours);
        set(camera, self.outlines);
        set(camera, self.sketch);
    }
}

/// What a camera looks like now.
#[derive(QueryData)]
pub(crate) struct Look {
    pub depth_map: Option<&'static DepthMap>,
    pub tone_bands: Option<&'static ToneBands>,
    pub desaturation: Option<&'static Desaturation>,
    pub colorization: Option<&'static Colorization>,
    pub black_flats: Option<&'static BlackFlats>,
    pub contours: Option<&'static Contours>,
    pub outlines: Option<&'static Outlines>,
    pub sketch: Option<&'static Sketch>,
}

impl LookItem<'_, '_> {
    pub fn style(&self) -> ComicStyle {
        ComicStyle {
            version: ComicStyle::VERSION,
            name: String::new(),
            depth_map: self.depth_map.copied(),
            tone_bands: self.tone_bands.copied(),
            desaturation: self.desaturation.copied(),
            colorization: self.colorization.copied(),
            black_flats: self.black_flats.copied(),
            contours: self.contours.copied(),
            outlines: self.outlines.copied(),
            sketch: self.sketch.copied(),
        }
    }
}

/// Gives a camera the look of a [`ComicStyle`] asset.
///
/// The style's components are put on the camera when the asset has loaded and
/// again whenever it changes; between that they are the camera's own and may be
/// edited. A file that becomes unreadable keeps the last good look. Removing
/// this component removes the look.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ComicStyleHandle(pub Handle<ComicStyle>);

pub(crate) fn apply_styles(
    mut commands: Commands,
    cameras: Query<(Entity, Ref<ComicStyleHandle>)>,
    mut removed: RemovedComponents<ComicStyleHandle>,
    existing: Query<(), With<ComicStyleHandle>>,
    mut events: MessageReader<AssetEvent<ComicStyle>>,
    styles: Res<Assets<ComicStyle>>,
) {
    for entity in removed.read() {
        if !existing.contains(entity)
            && let Ok(mut camera) = commands.get_entity(entity)
        {
            ComicStyle::default().apply(&mut camera);
        }
    }
    let changed: Vec<_> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    for (entity, handle) in &cameras {
        if !handle.is_changed() && !changed.contains(&handle.0.id()) {
            continue;
        }
        if let Some(style) = styles.get(&handle.0)
            && let Ok(mut camera) = commands.get_entity(entity)
        {
            style.apply(&mut camera);
        }
    }
}

#[derive(Default, TypePath)]
pub(crate) struct StyleLoader;

impl AssetLoader for StyleLoader {
    type Asset = ComicStyle;
    type Settings = ();
    type Error = ComicStyleError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        _load_context: &mut LoadContext<'_>,
    ) -> Result<ComicStyle, ComicStyleError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes)
            .map_err(|error| std::io::Error::new(std::io::ErrorKind::InvalidData, error))?;
        ComicStyle::from_ron(&text)
    }

    fn extensions(&self) -> &[&str] {
        &["comic.ron"]
    }
}
