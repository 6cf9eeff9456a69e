//! Styles as assets (`*.comic.ron`), and how they are put on cameras.

mod apply;
mod blend;
mod camera;
mod format;
mod layer;
pub mod presets;
#[cfg(test)]
mod tests;
mod transition;
mod volume;

use std::collections::BTreeSet;

use bevy::{camera::visibility::VisibilitySystems, prelude::*};

pub use apply::{Comic, ComicGrade, ComicGradeTemplate, ComicTemplate};
pub use camera::{StyleCamera, StyleDither};
pub use format::{ComicStyleError, ReadStyle};
pub use presets::Preset;
pub use transition::{StyleTransition, StyleTransitionFinished, TransitionEasing};
pub use volume::{InStyleVolumes, StyleVolume};

pub use crate::page::{PageHeight, PageScale};
#[cfg(all(feature = "toon", feature = "objects"))]
pub use crate::toon::AddedByStyle;
#[cfg(feature = "toon")]
pub use crate::toon::{StylePart, StyleScene, StyleScope};
use crate::{
    depth::DepthMap,
    effect::{AnyEffect, Effect, EffectSet},
};

/// The effects of a camera, its depth map, and what goes with them: settings of the camera, and the
/// light on the materials of the scene.
///
/// ```
/// use bevy_comics::{ComicStyle, Desaturation, Outlines};
///
/// let style = ComicStyle::new()
///     .with(Desaturation::default())
///     .with(Outlines { width: 3.0, ..Default::default() });
/// assert_eq!(style.get::<Outlines>().unwrap().width, 3.0);
/// ```
///
/// Files end in `.comic.ron` and are written in RON with implicit `Some`. Each
/// effect is an entry under its name. Fields that a file leaves out have their
/// defaults:
///
/// ```ron
/// (
///     version: 3,
///     name: "Old photograph",
///     colorization: (mode: Atmosphere, color: "#9e8057"),
///     outlines: (width: 1.5),
/// )
/// ```
///
/// # Complete and partial styles
///
/// A style lies over the camera's own style: the effects and the [`DepthMap`]
/// that the camera has without a `ComicStyle`.
///
/// * A **complete** style (the default) decides about every effect: those that
///   it does not mention are off.
/// * A **partial** style changes the effects that it mentions; the camera keeps
///   its own effects otherwise. `outlines: None` in the file, or
///   [`turn_off`](Self::turn_off), turns one off.
/// * Both leave the camera's own [`DepthMap`] alone unless they mention
///   `depth_map`.
/// * A partial style without a `scene` keeps that of the style below it.
/// * Without a `page`, lengths of a complete style are logical pixels; a partial one keeps the
///   camera's page.
///
/// Effects are the smallest unit: a style that mentions `outlines` sets all fields of
/// [`Outlines`](crate::Outlines). Applying another style replaces the last one.
/// [`ComicStyle::over`] computes the result.
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(opaque)]
#[reflect(Default, Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct ComicStyle {
    /// Title for people; any text. Default: empty.
    pub name: String,
    /// Whether effects that the style does not mention stay as the camera has
    /// them. Default: `false`, they are off.
    pub partial: bool,
    /// The depth map. `None` leaves the camera's own alone. Default: `None`.
    pub depth_map: Option<DepthMap>,
    /// Height of the view in page pixels ([`PageHeight`]): lengths in pixels are relative to it, so
    /// the view is the same drawing at every size. With `None`, they are logical pixels; a partial
    /// style leaves the camera's page alone. Range 90 to 4320, default `None`.
    pub page: Option<f32>,
    /// What cameras with a [`Comic`] have besides effects: dither, samples, tonemapping. Default:
    /// [`StyleCamera::default`].
    pub camera: StyleCamera,
    /// What cameras with a [`Comic`] do to the meshes that they see. `None` leaves them alone.
    /// Default: `None`.
    #[cfg(feature = "toon")]
    pub scene: Option<StyleScene>,
    /// The effects. Default: none.
    pub effects: EffectSet,
    /// Names of the effects that a partial style turns off. A complete style
    /// turns off all that it does not mention and needs no names. Default: none.
    pub off: BTreeSet<&'static str>,
}

impl ComicStyle {
    /// A complete style without effects.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same style as a partial one.
    #[must_use]
    pub fn partial(self) -> Self {
        Self {
            partial: true,
            ..self
        }
    }

    /// The same style with this effect, in place of another one of its type.
    #[must_use]
    pub fn with<E: Effect>(mut self, effect: E) -> Self {
        self.insert(effect);
        self
    }

    /// The same style without mention of this effect.
    #[must_use]
    pub fn without<E: Effect>(mut self) -> Self {
        self.remove::<E>();
        self
    }

    /// The same style with this depth map.
    #[must_use]
    pub fn with_depth_map(self, map: DepthMap) -> Self {
        Self {
            depth_map: Some(map),
            ..self
        }
    }

    /// The same style with this scene.
    #[cfg(feature = "toon")]
    #[must_use]
    pub fn with_scene(self, scene: StyleScene) -> Self {
        Self {
            scene: Some(scene),
            ..self
        }
    }

    /// The same style on a page of this height in page pixels.
    #[must_use]
    pub fn with_page(self, height: f32) -> Self {
        Self {
            page: Some(height),
            ..self
        }
    }

    /// The effect of this type, if the style has it.
    pub fn get<E: Effect>(&self) -> Option<&E> {
        self.effects.get()
    }

    /// The effect of this type, to be edited.
    pub fn get_mut<E: Effect>(&mut self) -> Option<&mut E> {
        self.effects.get_mut()
    }

    /// Adds an effect, in place of another one of its type.
    pub fn insert<E: Effect>(&mut self, effect: E) {
        self.insert_any(Box::new(effect));
    }

    /// Removes every mention of this effect; the value if the style had one.
    pub fn remove<E: Effect>(&mut self) -> Option<E> {
        let effect = self.remove_by_name(E::NAME)?.into_any();
        effect.downcast().ok().map(|effect| *effect)
    }

    /// Turns this effect off, also where the camera has one of its own: for
    /// partial styles.
    #[must_use]
    pub fn turn_off<E: Effect>(mut self) -> Self {
        self.remove::<E>();
        self.off.insert(E::NAME);
        self
    }

    /// The style's effects, in the order of their stages.
    pub fn effects(&self) -> impl Iterator<Item = &dyn AnyEffect> {
        self.effects.iter()
    }

    /// The effect of this name, if the style has it.
    pub fn by_name(&self, name: &str) -> Option<&dyn AnyEffect> {
        self.effects.by_name(name)
    }

    /// Adds an effect whose type is known at run time only.
    pub fn insert_any(&mut self, effect: Box<dyn AnyEffect>) {
        self.off.remove(effect.name());
        self.effects.insert(effect);
    }

    /// Removes every mention of the effect of this name; the value if the style
    /// had one.
    pub fn remove_by_name(&mut self, name: &str) -> Option<Box<dyn AnyEffect>> {
        self.off.remove(name);
        self.effects.remove(name)
    }

    /// The style as it is used: every number in its documented range.
    #[must_use]
    pub fn sanitized(&self) -> Self {
        let mut effects = EffectSet::default();
        for effect in self.effects.iter() {
            effects.insert(effect.any_sanitized());
        }
        Self {
            depth_map: self.depth_map.map(DepthMap::sanitized),
            page: self.page.map(|height| PageHeight(height).sanitized().0),
            effects,
            #[cfg(feature = "toon")]
            scene: self.scene.clone().map(StyleScene::sanitized),
            ..self.clone()
        }
    }
}

/// Styles in an app: the asset, its loader, presets and transitions.
pub(crate) struct StylePlugin;

impl Plugin for StylePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<StyleTransition>()
            .register_type::<Comic>()
            .register_type::<ComicGrade>()
            .register_type::<StyleCamera>()
            .register_type::<StyleVolume>()
            .register_type::<InStyleVolumes>();
    }
}

impl StylePlugin {
    /// The part that needs the engine's assets.
    pub(crate) fn build_assets(app: &mut App) {
        presets::embed(app);
        app.init_asset::<ComicStyle>()
            .register_asset_reflect::<ComicStyle>()
            .init_asset_loader::<apply::StyleLoader>()
            .add_systems(
                Update,
                (
                    apply::add_presets,
                    apply::apply_styles,
                    apply::apply_grades,
                    transition::run_transitions,
                )
                    .chain(),
            )
            .add_systems(
                PostUpdate,
                volume::style_by_place
                    .after(TransformSystems::Propagate)
                    .after(VisibilitySystems::VisibilityPropagate),
            );
    }
}
