//! What a style does to the meshes of a scene.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::ToonLight;
use crate::settings::{clamp_fields, mix_fields};

/// What a [`ComicStyle`](crate::ComicStyle) does to the meshes that a camera with a
/// [`Comic`](crate::Comic) sees: those with a [`StandardMaterial`] on the
/// [`RenderLayers`](bevy::camera::visibility::RenderLayers) of the camera, also those that are
/// spawned later.
///
/// They are drawn with toon copies of their materials, as below a [`ToonScene`](crate::ToonScene).
/// A mesh has the first of these that exists:
///
/// 1. its own [`ToonMaterial`](crate::ToonMaterial);
/// 2. its [`ToonShadingHandle`](crate::ToonShadingHandle);
/// 3. the nearest [`ToonScene`](crate::ToonScene) above it;
/// 4. [`light`](Self::light).
///
/// All cameras draw the same materials. Where cameras have different scenes for one mesh, that of
/// the active camera with the lowest [`Camera::order`] applies, and a warning is logged. The other
/// cameras keep their effects.
///
/// A style changes no lights. If its shadows need a light with shadow maps and there is none, a
/// warning is logged.
#[derive(Reflect, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StyleScene {
    /// Lighting of all materials. Files have it without a `ramp_map`. Default:
    /// [`ToonLight::default`].
    pub light: ToonLight,
}

impl StyleScene {
    /// A scene with this lighting.
    #[must_use]
    pub fn new(light: ToonLight) -> Self {
        Self { light }
    }

    /// The settings that are used: every number is clamped to its documented range, and a number
    /// that is not finite is replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        clamp_fields(Self {
            light: self.light.sanitized(),
        })
    }

    /// Whether a light has an image, which files of styles do not name.
    pub(crate) fn names_an_image(&self) -> bool {
        !self.light.ramp_map.is_none()
    }

    /// The scene at fraction `t` of the way to another one: numbers and colors of lights are
    /// interpolated, the rest is that of this scene.
    pub(crate) fn mixed(&self, other: &Self, t: f32) -> Self {
        Self {
            light: mix_fields(&self.light, &other.light, t),
        }
    }

    /// Whether shadows of other surfaces are to be drawn.
    pub(super) fn draws_cast_shadows(&self) -> bool {
        self.light.cast_shadows && self.light.shadow_strength > 0.0
    }
}
