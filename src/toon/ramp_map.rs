//! Tones that are painted in an image.

use bevy::{asset::AssetPath, prelude::*};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An image of the tones of a [`Ramp`](crate::toon::Ramp), for
/// [`ToonLight::ramp_map`](crate::ToonLight::ramp_map): the ramps that Lake et al. (2000) and
/// X-Toon (Barla, Thollot and Markosian 2006) paint.
///
/// From left to right, more light arrives: each column is a tone, with hard edges between them. A
/// pixel has the mean of the tones that it covers, exactly, so any number of tones has smooth
/// edges. The rows are those of the second axis, [`Ramp::detail`](crate::toon::Ramp::detail): the
/// first one, at the top, is used where there is all detail, the last one where there is none, and
/// tones between rows are mixed in linear light. Without that axis, only the first row is used.
///
/// The image is 2 to [`LARGEST`](Self::LARGEST) texels wide and 1 to as many high, in a format
/// without compression; images in sRGB and in linear light are both read correctly. Colors are
/// clamped to what a display shows, components that are not finite are 0, and alpha is ignored. The
/// image must be kept in the main world, as loaded ones are
/// ([`RenderAssetUsages`](bevy::asset::RenderAssetUsages)). When it changes, the tones follow a
/// frame later. If an image cannot be used, a warning says why, and the stops of the ramp are drawn
/// instead.
///
/// Its sums are a texture of their own, of 16 bytes a texel and for one column more: 4 KB for a row
/// of 256 tones, 1 MB for 256 rows.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_comics::prelude::*;
/// fn painted(assets: Res<AssetServer>) -> ToonLight {
///     ToonLight {
///         ramp_map: assets.load("ramps/skin.png").into(),
///         ..default()
///     }
/// }
/// ```
#[derive(Reflect, Clone, Debug, Default)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
pub struct RampMap {
    pub(super) image: Option<Handle<Image>>,
    /// Of an image that is not loaded yet, as files have it.
    path: Option<AssetPath<'static>>,
    #[reflect(ignore)]
    pub(super) sums: Sums,
}

/// What is known of the sums of an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Sums {
    #[default]
    Unknown,
    Ready(Handle<Image>),
    /// The stops of the ramp are drawn.
    None,
}

impl RampMap {
    /// The largest width and height of an image, in texels.
    pub const LARGEST: u32 = 1024;

    /// Tones of an image.
    #[must_use]
    pub fn new(image: Handle<Image>) -> Self {
        Self {
            image: Some(image),
            ..Self::default()
        }
    }

    /// Tones of an image at a path of the assets, which is loaded when a material has it.
    #[must_use]
    pub fn at(path: impl Into<AssetPath<'static>>) -> Self {
        Self {
            path: Some(path.into()),
            ..Self::default()
        }
    }

    /// The image, if it is known; a shading that was not read by the asset server has only a path.
    #[must_use]
    pub fn image(&self) -> Option<&Handle<Image>> {
        self.image.as_ref()
    }

    /// The path of the image among the assets. Images that were made by code have none.
    #[must_use]
    pub fn path(&self) -> Option<&AssetPath<'static>> {
        let of_image = self.image.as_ref().and_then(Handle::path);
        of_image.or(self.path.as_ref())
    }

    /// Whether there is no image.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.image.is_none() && self.path.is_none()
    }

    /// Whether its tones are drawn. They are not yet, or never, if the image could not be read.
    pub(super) fn is_ready(&self) -> bool {
        matches!(self.sums, Sums::Ready(_))
    }

    /// The same with its image, loaded by `load` if there is only a path.
    pub(super) fn loaded(self, load: impl FnOnce(AssetPath<'static>) -> Handle<Image>) -> Self {
        match (&self.image, &self.path) {
            (None, Some(path)) => Self::new(load(path.clone())),
            _ => self,
        }
    }
}

impl From<Handle<Image>> for RampMap {
    fn from(image: Handle<Image>) -> Self {
        Self::new(image)
    }
}

/// Two are equal if their images are.
impl PartialEq for RampMap {
    fn eq(&self, other: &Self) -> bool {
        match (&self.image, &other.image) {
            (Some(a), Some(b)) => a == b,
            _ => self.is_none() == other.is_none() && self.path() == other.path(),
        }
    }
}

/// What a material binds. Until the sums are known, it is the image: a material is drawn when its
/// images have loaded.
impl<'a> From<&'a RampMap> for Option<&'a Handle<Image>> {
    fn from(map: &'a RampMap) -> Self {
        match &map.sums {
            Sums::Unknown => map.image.as_ref(),
            Sums::Ready(sums) => Some(sums),
            Sums::None => None,
        }
    }
}

/// Files have the path.
impl Serialize for RampMap {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let path = self.path().map(ToString::to_string);
        path.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for RampMap {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Some(path) = Option::<String>::deserialize(deserializer)? else {
            return Ok(Self::default());
        };
        let path = AssetPath::try_parse(&path).map_err(serde::de::Error::custom)?;
        Ok(Self::at(path.into_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_are_equal_by_their_images() {
        let [none, a, b] = [
            RampMap::default(),
            RampMap::at("a.png"),
            RampMap::at("b.png"),
        ];
        assert!(none.is_none() && !a.is_none());
        assert!(a == RampMap::at("a.png") && a != b && a != none && none == RampMap::default());
        let handle = Handle::<Image>::default();
        let mut ready = RampMap::new(handle.clone());
        ready.sums = Sums::None;
        assert!(ready == RampMap::new(handle) && ready != none && ready != a);
    }
}
