//! Maps of strokes at all tones and sizes.

use bevy::reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

use crate::settings::clamp_or_default;

/// A tonal art map: strokes of all tones and sizes in one image, for
/// [`ToonLight::art_map`](super::ToonLight::art_map) (Praun et al. 2001).
///
/// Each texel holds the tone from which it is ink (Webb et al. 2002), in one channel. Strokes of a
/// light tone are part of all darker ones, and those of a coarse mip level part of all finer ones.
/// At every level the fraction of texels that are ink is the tone, and strokes are equally wide in
/// texels. The image repeats without seams. Equal settings give equal images.
///
/// In WebGL 2, the levels of an image cannot be counted: other images need mip levels down to 16
/// texels there, as these have.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_comics::{prelude::*, toon::TonalArtMap};
/// fn pencil(mut images: ResMut<Assets<Image>>) -> ToonLight {
///     ToonLight {
///         hatching: Some(Hatching::default()),
///         art_map: Some(images.add(TonalArtMap::default().image())),
///         ..default()
///     }
/// }
/// ```
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TonalArtMap {
    /// Width and height in texels: the next power of two. Range 16 to 1024, default 256. The time
    /// to draw a map grows with the number of texels.
    pub size: u32,
    /// Length of the longest strokes, as a fraction of the map; the shortest ones have 0.4 of it.
    /// Range 0.05 to 1, default 0.5.
    pub length: f32,
    /// Width of strokes in texels, which are about as large as pixels. Range 1 to 8, default 2.
    pub width: f32,
    /// How far strokes are from parallel, in degrees to both sides; they also bend as much. Range 0
    /// to 45, default 4.
    pub spread: f32,
    /// Tone from which half of the strokes cross the others. Range 0 to 1, default 0.45; at 1 none
    /// do.
    pub crossing: f32,
    /// Other seeds give other strokes. Default: 0.
    pub seed: u32,
}

impl Default for TonalArtMap {
    fn default() -> Self {
        Self {
            size: 256,
            length: 0.5,
            width: 2.0,
            spread: 4.0,
            crossing: 0.45,
            seed: 0,
        }
    }
}

impl TonalArtMap {
    /// The settings that are used: every number is clamped to its documented range, and a number
    /// that is not finite is replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            size: self.size.clamp(16, 1024).next_power_of_two(),
            length: clamp_or_default(self.length, default.length, 0.05, 1.0),
            width: clamp_or_default(self.width, default.width, 1.0, 8.0),
            spread: clamp_or_default(self.spread, default.spread, 0.0, 45.0),
            crossing: clamp_or_default(self.crossing, default.crossing, 0.0, 1.0),
            seed: self.seed,
        }
    }
}
