//! The registry of an app's effects.

use std::{
    marker::PhantomData,
    sync::{Arc, PoisonError, RwLock},
};

use bevy::{
    app::{App, Plugin},
    ecs::{resource::Resource, world::EntityRef},
    log::error,
    reflect::{ReflectDeserialize, ReflectSerialize, TypeInfo, TypeRegistry},
};
use serde::Deserialize;

use super::{AnyEffect, Effect, EffectShader, EffectStage, EffectView, blend, names};

/// The description of an effect's type.
pub struct EffectType {
    /// [`Effect::NAME`].
    pub name: &'static str,
    /// [`Effect::STAGE`].
    pub stage: EffectStage,
    /// [`Effect::SHADER`].
    pub shader: EffectShader,
    /// [`Effect::REPLACES`].
    pub replaces: &'static [&'static str],
    /// [`Effect::VIEW`].
    pub view: Option<EffectView>,
    /// [`Effect::HALF_BOX`].
    pub half_box: bool,
    /// [`Effect::AUX_SCALAR`].
    pub number: bool,
    /// The reflection data of the type.
    pub type_info: fn() -> &'static TypeInfo,
    /// Creates an effect with default settings.
    pub default: fn() -> Box<dyn AnyEffect>,
    /// Gets the effect from an entity, if the entity has it.
    pub get: for<'w> fn(EntityRef<'w>) -> Option<&'w dyn AnyEffect>,
    /// Registers the effect's type and those of its fields.
    pub register: fn(&mut TypeRegistry),
    pub(crate) remove: fn(&mut bevy::ecs::world::EntityWorldMut),
    pub(crate) read: ReadEffect,
    pub(crate) blend: BlendEffects,
}

type ReadEffect = for<'a, 'de> fn(
    &'a mut dyn erased_serde::Deserializer<'de>,
) -> Result<Option<Box<dyn AnyEffect>>, erased_serde::Error>;

/// Interpolates from the first effect (`t` = 0) to the second (`t` = 1). The flag
/// says whether the mapping of the depth map changes.
type BlendEffects =
    fn(Option<&dyn AnyEffect>, Option<&dyn AnyEffect>, f32, bool) -> Option<Box<dyn AnyEffect>>;

impl EffectType {
    /// The description of an effect's type.
    pub const fn of<E: Effect>() -> &'static Self {
        const {
            &Self {
                name: E::NAME,
                stage: E::STAGE,
                shader: E::SHADER,
                replaces: E::REPLACES,
                view: E::VIEW,
                half_box: E::HALF_BOX,
                number: E::AUX_SCALAR,
                type_info: E::type_info,
                default: default::<E>,
                get: get::<E>,
                register: TypeRegistry::register::<E>,
                remove: remove::<E>,
                read: read::<E>,
                blend: blended::<E>,
            }
        }
    }
}

impl std::fmt::Debug for EffectType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("EffectType")
            .field("name", &self.name)
            .field("stage", &self.stage)
            .finish_non_exhaustive()
    }
}

fn default<E: Effect>() -> Box<dyn AnyEffect> {
    Box::new(E::default())
}

fn get<'w, E: Effect>(entity: EntityRef<'w>) -> Option<&'w dyn AnyEffect> {
    entity.get::<E>().map(|effect| effect as &dyn AnyEffect)
}

fn remove<E: Effect>(entity: &mut bevy::ecs::world::EntityWorldMut) {
    entity.remove::<E>();
}

fn read<E: Effect>(
    deserializer: &mut dyn erased_serde::Deserializer<'_>,
) -> Result<Option<Box<dyn AnyEffect>>, erased_serde::Error> {
    let effect = Option::<E>::deserialize(deserializer)?;
    Ok(effect.map(|effect| Box::new(effect) as Box<dyn AnyEffect>))
}

fn blended<E: Effect>(
    a: Option<&dyn AnyEffect>,
    b: Option<&dyn AnyEffect>,
    t: f32,
    remapped: bool,
) -> Option<Box<dyn AnyEffect>> {
    let typed = |effect: Option<&dyn AnyEffect>| effect?.as_any().downcast_ref::<E>().cloned();
    let effect = blend::blend(typed(a), typed(b), t, remapped)?;
    Some(Box::new(effect))
}

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
