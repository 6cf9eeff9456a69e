//! The registry of an app's effects.

use std::{
    marker::PhantomData,
    sync::{Arc, PoisonError, RwLock},
};

use bevy::prelude::*;

use super::{Effect, EffectType, names};

/// The registered effects of an app, in the order in which they apply to a pixel.
/// Clones share one list.
#[derive(Resource, Clone, Debug, Default)]
pub struct EffectRegistry(Arc<RwLock<Registered>>);

#[derive(Debug, Default)]
struct Registered {
    types: Vec<&'static EffectType>,
    /// The fused pass is composed, so no effect can be added any more.
    sealed: bool,
}

impl EffectRegistry {
    /// All registered effects, in the order of the chain.
    pub fn types(&self) -> Vec<&'static EffectType> {
        self.0
            .read()
            .unwrap_or_else(PoisonError::into_inner)
            .types
            .clone()
    }

    /// The effect with this name, if it is registered.
    pub fn get(&self, name: &str) -> Option<&'static EffectType> {
        self.types().into_iter().find(|effect| effect.name == name)
    }

    /// Refuses every further effect, because the fused pass is composed now.
    pub(crate) fn seal(&self) {
        let mut known = self.0.write().unwrap_or_else(PoisonError::into_inner);
        known.sealed = true;
    }

    /// Adds an effect at the end of its stage. An effect that cannot be composed
    /// into the fused pass is refused with an error in the log.
    pub(crate) fn register(&self, effect: &'static EffectType) {
        let mut known = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let late = known
            .sealed
            .then_some("the shader is already composed; add its plugin before the app runs");
        let types = &mut known.types;
        if let Some(reason) = late.or_else(|| names::refuses(effect, types)) {
            error!("the effect `{}` is not registered: {reason}", effect.name);
            return;
        }
        let at = types.partition_point(|known| known.stage <= effect.stage);
        types.insert(at, effect);
    }
}

/// Registers an effect with an app. It may be added before or after
/// [`ComicsPlugin`](crate::ComicsPlugin); the order only decides which effect of a
/// stage applies first.
///
/// ```no_run
/// # use bevy::prelude::*;
/// # use bevy_comics::{ComicsPlugin, EffectPlugin, ToneBands as Rain};
/// App::new().add_plugins((DefaultPlugins, ComicsPlugin, EffectPlugin::<Rain>::default()));
/// ```
pub struct EffectPlugin<E>(PhantomData<fn() -> E>);

impl<E> Default for EffectPlugin<E> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<E: Effect> Plugin for EffectPlugin<E> {
    fn build(&self, app: &mut App) {
        app.register_type::<E>()
            .register_type_data::<E, ReflectSerialize>()
            .register_type_data::<E, ReflectDeserialize>()
            .world_mut()
            .get_resource_or_init::<EffectRegistry>()
            .register(EffectType::of::<E>());
    }
}
