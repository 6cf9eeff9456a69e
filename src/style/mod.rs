//! A whole look as one asset, `*.comic.ron`, applied to a camera as its
//! components.

mod apply;
mod blend;
mod format;
pub mod presets;
mod transition;

use bevy::{
    app::{App, Plugin, Update},
    asset::{Asset, AssetApp, AssetServer},
    ecs::{
        schedule::IntoScheduleConfigs,
        system::EntityCommands,
        world::{EntityRef, EntityWorldMut},
    },
    reflect::{Reflect, std_traits::ReflectDefault},
};

pub use apply::ComicStyleHandle;
pub use format::ComicStyleError;
pub use transition::{StyleTransition, StyleTransitionFinished, TransitionEasing};

use crate::{
    depth::DepthMap,
    effect::{AnyEffect, Effect, EffectRegistry, EffectSet},
};

/// A look: the depth map and the effects of a camera, in one asset.
///
/// ```
/// use bevy_comics::{ComicStyle, Contours, Desaturation};
///
/// let style = ComicStyle::new()
///     .with(Desaturation::default())
///     .with(Contours { width: 3.0, ..Default::default() });
/// assert_eq!(style.get::<Contours>().unwrap().width, 3.0);
/// ```
///
/// Files end in `.comic.ron` and are written in RON with implicit `Some`; effects
/// are entries by their names. What is left out is off, and fields that are left
/// out have their default:
///
/// ```ron
/// (
///     version: 2,
///     name: "Old photograph",
///     colorization: (mode: Atmosphere, color: "#9e8057"),
///     contours: (threshold: 0.03),
/// )
/// ```
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(opaque)]
#[reflect(Default, Clone, PartialEq, Debug)]
pub struct ComicStyle {
    /// Version of the file format; 1 is the only one.
    pub version: u32,
    /// What people call it.
    pub name: String,
    /// The depth map; its default where absent.
    pub depth_map: Option<DepthMap>,
    /// The effects; what is not among them is off.
    pub effects: EffectSet,
}

impl ComicStyle {
    /// The version of the file format that this crate reads and writes.
    pub const VERSION: u32 = 2;

    /// A style without effects.
    pub fn new() -> Self {
        Self {
            version: Self::VERSION,
            ..Self::default()
        }
    }

    /// The same style with this effect, in place of another one of its type.
    #[must_use]
    pub fn with<E: Effect>(mut self, effect: E) -> Self {
        self.insert(effect);
        self
    }

    /// The same style without the effect of this type.
    #[must_use]
    pub fn without<E: Effect>(mut self) -> Self {
        self.remove::<E>();
        self
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
        self.effects.insert(Box::new(effect));
    }

    /// Takes the effect of this type out.
    pub fn remove<E: Effect>(&mut self) -> Option<E> {
        let effect = self.effects.remove(E::NAME)?.into_any();
        effect.downcast().ok().map(|effect| *effect)
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
        self.effects.insert(effect);
    }

    /// Takes the effect of this name out.
    pub fn remove_by_name(&mut self, name: &str) -> Option<Box<dyn AnyEffect>> {
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
            version: self.version,
            name: self.name.clone(),
            depth_map: self.depth_map.map(DepthMap::sanitized),
            effects,
        }
    }

    /// The style that a camera's components are, without a name: of the effects
    /// that `registry` knows.
    pub fn of(camera: EntityRef, registry: &EffectRegistry) -> Self {
        let mut style = Self {
            depth_map: camera.get().copied(),
            ..Self::new()
        };
        for effect in registry.types() {
            if let Some(effect) = (effect.get)(camera) {
                style.effects.insert(effect.boxed());
            }
        }
        style
    }

    /// Makes the camera look like this style: inserts the components that it
    /// has and removes those that it has not, of the effects that the app knows.
    pub fn apply(&self, camera: &mut EntityCommands) {
        let style = self.clone();
        camera.queue(move |mut camera: EntityWorldMut| style.put(&mut camera));
    }

    fn put(&self, camera: &mut EntityWorldMut) {
        let types = camera
            .world()
            .get_resource::<EffectRegistry>()
            .map(EffectRegistry::types)
            .unwrap_or_default();
        match self.depth_map {
            Some(map) => camera.insert(map),
            None => camera.remove::<DepthMap>(),
        };
        for effect in types {
            if self.effects.by_name(effect.name).is_none() {
                (effect.remove)(camera);
            }
        }
        for effect in self.effects.iter() {
            effect.insert_into(camera);
        }
    }
}

/// Styles in an app: the asset, its loader, and transitions.
pub(crate) struct StylePlugin;

impl Plugin for StylePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<StyleTransition>()
            .register_type::<ComicStyleHandle>();
        if app.world().contains_resource::<AssetServer>() {
            app.init_asset::<ComicStyle>()
                .register_asset_reflect::<ComicStyle>()
                .init_asset_loader::<apply::StyleLoader>()
                .add_systems(
                    Update,
                    (apply::apply_styles, transition::run_transitions).chain(),
                );
        }
    }
}
