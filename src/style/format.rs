//! The file format of styles: RON, with an entry for each effect.

use std::fmt;

use bevy::log::warn;
#[cfg(feature = "toon")]
use serde::ser::Error as _;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{DeserializeSeed, Error, MapAccess, Visitor},
    ser::SerializeStruct,
};
use thiserror::Error;

use super::{ComicStyle, StyleCamera};
#[cfg(feature = "toon")]
use crate::toon::StyleScene;
use crate::{
    effect::{AnyEffect, EffectRegistry, EffectType, names::FILE_KEYS},
    files::{
        renamed::{self, Upgraded},
        ron_options, written,
    },
};

/// Why a style was not read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ComicStyleError {
    /// The file could not be read.
    #[error("cannot read the style: {0}")]
    Io(#[from] std::io::Error),
    /// The text is not a style: bad syntax, an unknown field, a wrong type.
    #[error("not a comic style, line {line}, column {column}: {message}")]
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
        "style format version {found} is not known; this crate reads versions {PREVIOUS} and {VERSION}"
    )]
    #[non_exhaustive]
    Version {
        /// The version that the file states.
        found: u32,
    },
    /// The style could not be written as text.
    #[error("cannot write the style: {message}")]
    #[non_exhaustive]
    Write {
        /// The reason.
        message: String,
    },
}

/// The version of the file format that this crate writes. It reads the previous version too.
const VERSION: u32 = 3;
const PREVIOUS: u32 = VERSION - 1;

/// No entry of a file names another one.
#[cfg(feature = "toon")]
const IMAGE: &str =
    "the light of a scene has a `ramp_map`: put it into a shading file, for a `ToonScene`";

/// A style that was read from a text, see [`EffectRegistry::read_style`].
#[derive(Clone, Debug)]
pub struct ReadStyle {
    /// The style.
    pub style: ComicStyle,
    /// What to rename in the text, if it has the previous version of the format.
    pub advice: Option<String>,
}

impl ComicStyle {
    /// Reads a style from the text of a `.comic.ron` file, with the effects of
    /// this crate. [`EffectRegistry::style_from_ron`] also knows those of an app.
    /// A file of the previous format version is read with one warning in the log, which
    /// says what to rename.
    ///
    /// # Errors
    /// [`ComicStyleError::Syntax`] with line and column, or
    /// [`ComicStyleError::Version`].
    pub fn from_ron(text: &str) -> Result<Self, ComicStyleError> {
        EffectRegistry::built_in().style_from_ron(text)
    }

    /// The text of a `.comic.ron` file that reads back as the same style. Colors
    /// are written in sRGB, whatever their color space.
    ///
    /// # Errors
    /// [`ComicStyleError::Write`] if a value has no RON form.
    pub fn to_ron(&self) -> Result<String, ComicStyleError> {
        written(self).map_err(|message| ComicStyleError::Write { message })
    }
}

impl EffectRegistry {
    /// Reads a style from the text of a `.comic.ron` file, with the effects that
    /// are registered.
    ///
    /// # Errors
    /// As [`ComicStyle::from_ron`].
    pub fn style_from_ron(&self, text: &str) -> Result<ComicStyle, ComicStyleError> {
        let read = self.read_style(text)?;
        if let Some(advice) = read.advice {
            warn!("{advice}");
        }
        Ok(read.style)
    }

    /// As [`style_from_ron`](Self::style_from_ron), but returns the advice for a text of the
    /// previous version instead of logging it.
    ///
    /// # Errors
    /// As [`ComicStyle::from_ron`].
    pub fn read_style(&self, text: &str) -> Result<ReadStyle, ComicStyleError> {
        let current = match renamed::version(text) {
            Some(PREVIOUS) => renamed::upgraded(text, "3", renamed::STYLE),
            None | Some(VERSION) => Upgraded::unchanged(text),
            Some(found) => return Err(ComicStyleError::Version { found }),
        };
        let style = parse(&current.text, &self.types()).map_err(|error| {
            let at = error.span.start;
            ComicStyleError::Syntax {
                line: at.line,
                column: current.original_column(at.line, at.col),
                message: error.code.to_string(),
            }
        })?;
        Ok(ReadStyle {
            style,
            advice: current.advice(),
        })
    }
}

fn parse(
    text: &str,
    types: &[&'static EffectType],
) -> Result<ComicStyle, ron::error::SpannedError> {
    let mut deserializer = ron::Deserializer::from_str_with_options(text, &ron_options())?;
    StyleSeed(types)
        .deserialize(&mut deserializer)
        .and_then(|style| deserializer.end().map(|()| style))
        .map_err(|error| deserializer.span_error(error))
}

impl Serialize for ComicStyle {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let off = if self.partial { self.off.len() } else { 0 };
        let sets_camera = self.camera != StyleCamera::default();
        #[cfg(feature = "toon")]
        let scene = self.scene.as_ref();
        #[cfg(not(feature = "toon"))]
        let scene: Option<&()> = None;
        let optional = [
            self.partial,
            self.depth_map.is_some(),
            self.page.is_some(),
            sets_camera,
            scene.is_some(),
        ];
        let optional: usize = optional.into_iter().map(usize::from).sum();
        let entries = 2 + optional + self.effects().count() + off;
        let mut file = serializer.serialize_struct("ComicStyle", entries)?;
        file.serialize_field("version", &VERSION)?;
        file.serialize_field("name", &self.name)?;
        if self.partial {
            file.serialize_field("partial", &true)?;
        }
        if self.depth_map.is_some() {
            file.serialize_field("depth_map", &self.depth_map)?;
        }
        if self.page.is_some() {
            file.serialize_field("page", &self.page)?;
        }
        if sets_camera {
            file.serialize_field("camera", &self.camera)?;
        }
        if let Some(scene) = scene {
            #[cfg(feature = "toon")]
            if scene.names_an_image() {
                return Err(S::Error::custom(IMAGE));
            }
            file.serialize_field("scene", &Some(scene))?;
        }
        for effect in self.effects() {
            // An `Option` in the file, as `None` may be written.
            file.serialize_field(effect.name(), &Some(effect.as_serialize()))?;
        }
        for name in self.off.iter().filter(|_| self.partial) {
            file.serialize_field(name, &None::<()>)?;
        }
        file.end()
    }
}

/// With the effects of this crate.
impl<'de> Deserialize<'de> for ComicStyle {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        StyleSeed(&EffectRegistry::built_in().types()).deserialize(deserializer)
    }
}

/// Reads a style with these effects.
struct StyleSeed<'a>(&'a [&'static EffectType]);

impl<'de> DeserializeSeed<'de> for StyleSeed<'_> {
    type Value = ComicStyle;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<ComicStyle, D::Error> {
        deserializer.deserialize_struct("ComicStyle", &[], self)
    }
}

impl<'de> Visitor<'de> for StyleSeed<'_> {
    type Value = ComicStyle;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a comic style")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<ComicStyle, M::Error> {
        let mut style = ComicStyle::default();
        let mut version = None;
        let mut seen: Vec<String> = Vec::new();
        while let Some(Key(key)) = map.next_key()? {
            if seen.contains(&key) {
                return Err(M::Error::custom(format_args!(
                    "the entry `{key}` is there twice"
                )));
            }
            match key.as_str() {
                "version" => version = Some(map.next_value::<u32>()?),
                "name" => style.name = map.next_value()?,
                "partial" => style.partial = map.next_value()?,
                "depth_map" => style.depth_map = map.next_value()?,
                "page" => style.page = map.next_value()?,
                "camera" => style.camera = map.next_value()?,
                #[cfg(feature = "toon")]
                "scene" => {
                    let scene: Option<StyleScene> = map.next_value()?;
                    if scene.as_ref().is_some_and(StyleScene::names_an_image) {
                        return Err(M::Error::custom(IMAGE));
                    }
                    style.scene = scene;
                }
                // It lights materials that are not there.
                #[cfg(not(feature = "toon"))]
                "scene" => {
                    map.next_value::<serde::de::IgnoredAny>()?;
                }
                name => {
                    let Some(effect) = self.0.iter().find(|effect| effect.name == name) else {
                        return Err(M::Error::custom(self.unknown(name)));
                    };
                    match map.next_value_seed(EffectSeed(effect))? {
                        Some(effect) => style.insert_any(effect),
                        None => {
                            style.off.insert(effect.name);
                        }
                    }
                }
            }
            seen.push(key);
        }
        match version {
            None => return Err(M::Error::missing_field("version")),
            Some(VERSION) => {}
            Some(found) => return Err(M::Error::custom(other_version(found))),
        }
        if !style.partial {
            // Whatever a complete style does not have is off.
            style.off.clear();
        }
        Ok(style)
    }
}

impl StyleSeed<'_> {
    fn unknown(&self, name: &str) -> String {
        let keys: Vec<String> = FILE_KEYS
            .into_iter()
            .chain(self.0.iter().map(|effect| effect.name))
            .map(|key| format!("`{key}`"))
            .collect();
        format!(
            "no effect is called `{name}`; the entries of a style are {}",
            keys.join(", ")
        )
    }
}

/// The previous version is upgraded as text, which a deserializer does not have.
fn other_version(found: u32) -> String {
    match found {
        PREVIOUS => format!(
            "style format version {PREVIOUS} is read from RON text only; save the style again as version {VERSION}"
        ),
        _ => ComicStyleError::Version { found }.to_string(),
    }
}

/// An entry's name: an identifier in RON, a string elsewhere.
struct Key(String);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Name;
        impl Visitor<'_> for Name {
            type Value = Key;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of an entry")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Key, E> {
                Ok(Key(name.to_owned()))
            }
        }
        deserializer.deserialize_identifier(Name)
    }
}

struct EffectSeed(&'static EffectType);

impl<'de> DeserializeSeed<'de> for EffectSeed {
    type Value = Option<Box<dyn AnyEffect>>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        let mut erased = <dyn erased_serde::Deserializer>::erase(deserializer);
        (self.0.read)(&mut erased)
            .map_err(|error| D::Error::custom(format_args!("{}: {error}", self.0.name)))
    }
}
