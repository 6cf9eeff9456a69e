//! What a style does to the meshes of a scene.

use std::fmt;

use bevy::prelude::*;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{Error, SeqAccess, Visitor},
};

use super::{MaterialName, ToonLight};
use crate::settings::{FieldRange, NotFinite, clamp_fields, clamp_or_default, mix_fields};

/// What a [`ComicStyle`](crate::ComicStyle) does to the meshes that a camera with a
/// [`Comic`](crate::Comic) sees: those with a [`StandardMaterial`] on the
/// [`RenderLayers`](bevy::camera::visibility::RenderLayers) of the camera, also those that are
/// spawned later. [`StyleScope`] on the camera limits it to parts of the scene, or to none.
///
/// They are drawn with toon copies of their materials, as below a [`ToonScene`](crate::ToonScene).
/// A mesh has the first of these that exists:
///
/// 1. its own [`ToonMaterial`](crate::ToonMaterial);
/// 2. its [`ToonShadingHandle`](crate::ToonShadingHandle);
/// 3. the nearest [`ToonScene`](crate::ToonScene) above it;
/// 4. the light of the first of the [`parts`](Self::parts) that names its material;
/// 5. [`light`](Self::light).
///
/// All cameras draw the same materials. Where cameras have different scenes for one mesh, that of
/// the active camera that comes first applies, by [`Camera::order`], then by entity; the first
/// time, a warning is logged. The other cameras keep their effects.
///
/// A style changes no lights. If its shadows need a light with shadow maps and there are only
/// lights without, a warning is logged.
#[derive(Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StyleScene {
    /// Lighting of the materials that no part names. Files have it without a `ramp_map`. Default:
    /// [`ToonLight::default`].
    pub light: ToonLight,
    /// Exceptions by the names of materials, of which the first one that fits applies. At most 32:
    /// further ones have no effect, and a file with more is refused. Default: none.
    #[serde(deserialize_with = "few")]
    pub parts: Vec<StylePart>,
    /// Gives the meshes [`MeshSections`](crate::objects::MeshSections) of this angle in degrees: on
    /// the entity at the top of each hierarchy with such a mesh, or on each of the
    /// roots of its `StyleScope`, if it has none of its own. Range 10 to 180. `None` leaves it to
    /// the camera's [`CreaseSource`](crate::lines::CreaseSource). Needs the feature `objects`.
    /// Default: `None`.
    #[reflect(@FieldRange::linear(10.0, 180.0).unit("°"), @NotFinite(50.0))]
    pub sections: Option<f32>,
    /// Whether patterns follow objects: the same entities get a
    /// [`PatternAnchor`](crate::objects::PatternAnchor), which halftones and strokes with an anchor
    /// to objects use. Needs the feature `objects`. Default: `false`.
    pub screens: bool,
}

/// Materials of a [`StyleScene`] that differ from the rest, by their names.
#[derive(Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StylePart {
    /// Names of materials, with `|` between them. In a name, `*` is any text; upper and lower case
    /// are the same, and spaces at both ends do not count. `"eye*|*_eye"` is `Eye`, `eyelash` and
    /// `left_eye`. A name is the [`MaterialName`] of the mesh, which those of glTF files get from
    /// the file. Default: empty, which is no material.
    pub names: String,
    /// Their lighting. `None`: that of the scene. Default: `None`.
    pub light: Option<ToonLight>,
}

/// On a camera with a [`Comic`](crate::Comic): which meshes its style changes.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
#[non_exhaustive]
pub enum StyleScope {
    /// Those on the [`RenderLayers`](bevy::camera::visibility::RenderLayers) of the camera.
    #[default]
    Layers,
    /// Those of these entities and their descendants, whatever their layers are.
    Roots(#[entities] Vec<Entity>),
    /// None: the camera has the effects and settings of its style alone.
    CameraOnly,
}

impl StyleScene {
    /// The largest number of parts.
    pub const MOST_PARTS: usize = 32;

    /// A scene with this lighting.
    #[must_use]
    pub fn new(light: ToonLight) -> Self {
        Self {
            light,
            ..Self::default()
        }
    }

    /// The same scene with this lighting for materials of these [names](StylePart::names), after
    /// the parts that it has.
    #[must_use]
    pub fn with_part(mut self, names: impl Into<String>, light: ToonLight) -> Self {
        self.parts.push(StylePart {
            names: names.into(),
            light: Some(light),
        });
        self
    }

    /// The settings that are used: every number is clamped to its documented range, and a number
    /// that is not finite is replaced by its default. Parts beyond the largest number are left out.
    #[must_use]
    pub fn sanitized(mut self) -> Self {
        self.parts.truncate(Self::MOST_PARTS);
        for part in &mut self.parts {
            part.light = part.light.take().map(ToonLight::sanitized);
        }
        clamp_fields(Self {
            light: self.light.sanitized(),
            ..self
        })
    }

    /// Whether a light has an image, which files of styles do not name.
    pub(crate) fn names_an_image(&self) -> bool {
        let of_parts = self.parts.iter().filter_map(|part| part.light.as_ref());
        of_parts
            .chain([&self.light])
            .any(|light| !light.ramp_map.is_none())
    }

    /// The scene at fraction `t` of the way to another one: numbers and colors of lights are
    /// interpolated, also those of parts if both scenes have parts of the same names; the rest is
    /// that of this scene.
    pub(crate) fn mixed(&self, other: &Self, t: f32) -> Self {
        let mut mixed = Self {
            light: mix_fields(&self.light, &other.light, t),
            ..self.clone()
        };
        if self.names().eq(other.names()) {
            for (part, end) in mixed.parts.iter_mut().zip(&other.parts) {
                if let (Some(light), Some(end)) = (&mut part.light, &end.light) {
                    *light = mix_fields(&*light, end, t);
                }
            }
        }
        mixed
    }

    /// The angle of sections, in its range.
    pub(super) fn angle(&self) -> Option<f32> {
        let clamped = |angle| clamp_or_default(angle, 50.0, 10.0, 180.0);
        self.sections.map(clamped)
    }

    /// The names of the parts that are used.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        let used = self.parts.iter().take(Self::MOST_PARTS);
        used.map(|part| part.names.as_str())
    }

    /// The part of a material, from 1; 0 if it has none. `patterns`: names of parts in lower case.
    pub(super) fn part_of(patterns: &[String], name: Option<&MaterialName>) -> usize {
        let Some(name) = name.filter(|_| !patterns.is_empty()) else {
            return 0;
        };
        let name = name.0.to_lowercase();
        let part = patterns.iter().position(|names| is_named(names, &name));
        part.map_or(0, |part| part + 1)
    }

    /// The light of a part, from 1; 0 is the scene.
    pub(super) fn light_of(&self, part: usize) -> &ToonLight {
        let part = part.checked_sub(1).and_then(|part| self.parts.get(part));
        part.and_then(|part| part.light.as_ref())
            .unwrap_or(&self.light)
    }

    /// Whether shadows of other surfaces are to be drawn.
    pub(super) fn draws_cast_shadows(&self) -> bool {
        let mut lights = (0..=self.names().count()).map(|part| self.light_of(part));
        lights.any(|light| light.cast_shadows && light.shadow_strength > 0.0)
    }
}

/// Whether a name is among those of a part. Both are in lower case.
fn is_named(names: &str, name: &str) -> bool {
    let mut patterns = names.split('|').map(str::trim);
    patterns.any(|pattern| !pattern.is_empty() && fits(pattern, name))
}

/// Whether a name fits a pattern, in which `*` is any text.
fn fits(pattern: &str, name: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else {
        return pattern == name;
    };
    let Some(mut name) = name.strip_prefix(start) else {
        return false;
    };
    let mut pieces = rest.split('*');
    let end = pieces.next_back().unwrap_or_default();
    for piece in pieces {
        let Some(at) = name.find(piece) else {
            return false;
        };
        name = &name[at + piece.len()..];
    }
    name.ends_with(end)
}

/// No more parts than are used: a file takes memory in proportion to its length.
fn few<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<StylePart>, D::Error> {
    struct Parts;

    impl<'de> Visitor<'de> for Parts {
        type Value = Vec<StylePart>;

        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            write!(f, "at most {} parts", StyleScene::MOST_PARTS)
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
            let mut parts = Vec::new();
            while let Some(part) = seq.next_element()? {
                if parts.len() == StyleScene::MOST_PARTS {
                    return Err(A::Error::invalid_length(parts.len() + 1, &self));
                }
                parts.push(part);
            }
            Ok(parts)
        }
    }

    deserializer.deserialize_seq(Parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_found_by_the_names_of_materials() {
        let eyes = |names: &str| {
            let scene = StyleScene::default()
                .with_part("hair", ToonLight::default())
                .with_part(names, ToonLight::default());
            scene.names().map(str::to_lowercase).collect::<Vec<_>>()
        };
        for (names, name, part) in [
            ("*eye*", "Left Eye", 2),
            ("eye* | *_EYE", "left_eye", 2),
            ("eye*|*_eye", "Eyelash", 2),
            ("eye*|*_eye", "bull's-eye", 0),
            ("a*b*c", "a_b_b_c", 2),
            ("a*b*c", "a_c_b", 0),
            ("aba*aba", "aba", 0),
            ("*", "anything", 2),
            ("*", "HAIR", 1),
            ("", "eye", 0),
            ("", "", 0),
        ] {
            let found = StyleScene::part_of(&eyes(names), Some(&name.into()));
            assert_eq!(found, part, "{name} in {names}");
        }
        let unnamed = StyleScene::part_of(&eyes("*"), None);
        assert_eq!(unnamed, 0, "a mesh without a name");
    }

    #[test]
    fn parts_beyond_the_largest_number_have_no_effect() {
        let scene = StyleScene {
            parts: vec![StylePart::default(); StyleScene::MOST_PARTS + 1],
            ..StyleScene::default()
        };
        assert_eq!(scene.names().count(), StyleScene::MOST_PARTS);
    }

    #[test]
    fn a_file_has_few_parts_and_no_images() {
        let read = |parts: &str| {
            let text = format!("(version: 3, scene: (parts: [{parts}]))");
            let style = crate::ComicStyle::from_ron(&text);
            style.map_err(|error| error.to_string())
        };
        assert!(read(&"(names: \"a\"),".repeat(32)).is_ok());
        let error = read(&"(),".repeat(33)).expect_err("too many");
        assert!(error.contains("at most 32 parts"), "{error}");
        let error = read("(light: (ramp_map: \"a.png\"))").expect_err("an image");
        assert!(error.contains("`ramp_map`"), "{error}");
    }
}
