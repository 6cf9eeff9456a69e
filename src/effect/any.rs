//! An effect whose type is known only at run time, and the description of its type.

use std::any::Any;

use bevy::{
    ecs::world::{EntityRef, EntityWorldMut},
    reflect::{TypeInfo, TypeRegistry, structs::Struct},
    render::render_resource::encase::UniformBuffer,
};
use serde::Deserialize;

use super::{
    AffectedArea, Effect, EffectContext, EffectShader, EffectStage, EffectView, Needs, Variants,
};
use crate::{
    lines::{LineModifiers, Outlines},
    settings::{crossfade, crossfade_weight},
    tones::ToneRange,
};

/// An [`Effect`] whose type is known only at run time. Every effect implements it;
/// lists of effects and tools use it.
pub trait AnyEffect: Any + Send + Sync + std::fmt::Debug {
    /// The description of the effect's type.
    fn effect_type(&self) -> &'static EffectType;
    /// The effect as a reflected struct.
    fn as_struct(&self) -> &dyn Struct;
    /// The effect as a reflected struct, for editing.
    fn as_struct_mut(&mut self) -> &mut dyn Struct;
    /// The effect as `Any`, for a downcast to its type.
    fn as_any(&self) -> &dyn Any;
    /// The effect as `Any`, for a downcast to its type.
    fn as_any_mut(&mut self) -> &mut dyn Any;
    /// The effect as `Any`, for a downcast to its type.
    fn into_any(self: Box<Self>) -> Box<dyn Any>;
    /// A copy of the effect.
    fn boxed(&self) -> Box<dyn AnyEffect>;
    /// Whether the other effect has the same type and equal settings.
    fn equals(&self, other: &dyn AnyEffect) -> bool;
    /// The effect for a serializer.
    fn as_serialize(&self) -> &dyn erased_serde::Serialize;
    /// As [`Effect::sanitized`].
    fn any_sanitized(&self) -> Box<dyn AnyEffect>;
    /// As [`Effect::strength`].
    fn any_strength(&self) -> f32;
    /// As [`Effect::needs`].
    fn any_needs(&self) -> Needs;
    /// As [`Effect::without`].
    fn any_without(&self, missing: Needs) -> Option<Box<dyn AnyEffect>>;
    /// As [`Effect::lines`].
    fn any_lines(&self) -> Option<Outlines>;
    /// As [`Effect::tones`].
    fn any_tones(&self) -> Option<ToneRange>;
    /// As [`Effect::implied`].
    fn any_implied(&self) -> Option<Box<dyn AnyEffect>>;
    /// As [`Effect::variants`].
    fn any_variants(&self, view: &EffectContext, variants: &mut Variants);
    /// As [`Effect::max_radius`].
    fn any_max_radius(&self, view: &EffectContext) -> Option<u32>;
    /// As [`Effect::affected_area`].
    fn any_affected_area(&self, view: &EffectContext) -> AffectedArea;
    /// As [`Effect::line_modifiers`].
    fn any_line_modifiers(&self, view: &EffectContext) -> LineModifiers;

    /// As [`Effect::runs_after_anti_aliasing`].
    fn any_runs_after_anti_aliasing(&self) -> bool;

    /// As [`Effect::line_reach`].
    fn any_line_reach(&self, view: &EffectContext) -> Option<f32>;
    /// The bytes of [`Effect::uniform`] in WGSL's uniform layout.
    fn uniform_bytes(&self, view: &EffectContext) -> Vec<u8>;
    /// Inserts a copy of the effect as a component of an entity.
    fn insert_into(&self, entity: &mut EntityWorldMut);
}

impl<E: Effect> AnyEffect for E {
    fn effect_type(&self) -> &'static EffectType {
        EffectType::of::<E>()
    }

    fn as_struct(&self) -> &dyn Struct {
        self
    }

    fn as_struct_mut(&mut self) -> &mut dyn Struct {
        self
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn into_any(self: Box<Self>) -> Box<dyn Any> {
        self
    }

    fn boxed(&self) -> Box<dyn AnyEffect> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn AnyEffect) -> bool {
        other.as_any().downcast_ref::<E>() == Some(self)
    }

    fn as_serialize(&self) -> &dyn erased_serde::Serialize {
        self
    }

    fn any_sanitized(&self) -> Box<dyn AnyEffect> {
        Box::new(self.clone().sanitized())
    }

    fn any_strength(&self) -> f32 {
        self.strength()
    }

    fn any_needs(&self) -> Needs {
        self.needs()
    }

    fn any_without(&self, missing: Needs) -> Option<Box<dyn AnyEffect>> {
        let effect = self.clone().without(missing)?;
        Some(Box::new(effect))
    }

    fn any_lines(&self) -> Option<Outlines> {
        self.lines()
    }

    fn any_tones(&self) -> Option<ToneRange> {
        self.tones()
    }

    fn any_implied(&self) -> Option<Box<dyn AnyEffect>> {
        self.implied()
    }

    fn any_variants(&self, view: &EffectContext, variants: &mut Variants) {
        self.variants(view, variants);
    }

    fn any_max_radius(&self, view: &EffectContext) -> Option<u32> {
        self.max_radius(view)
    }

    fn any_affected_area(&self, view: &EffectContext) -> AffectedArea {
        self.affected_area(view)
    }

    fn any_line_modifiers(&self, view: &EffectContext) -> LineModifiers {
        self.line_modifiers(view)
    }

    fn any_runs_after_anti_aliasing(&self) -> bool {
        self.runs_after_anti_aliasing()
    }

    fn any_line_reach(&self, view: &EffectContext) -> Option<f32> {
        self.line_reach(view)
    }

    fn uniform_bytes(&self, view: &EffectContext) -> Vec<u8> {
        encode(&self.uniform(view))
    }

    fn insert_into(&self, entity: &mut EntityWorldMut) {
        entity.insert(self.clone());
    }
}

impl dyn AnyEffect {
    pub(crate) fn name(&self) -> &'static str {
        self.effect_type().name
    }
}

impl Clone for Box<dyn AnyEffect> {
    fn clone(&self) -> Self {
        (**self).boxed()
    }
}

impl PartialEq for dyn AnyEffect {
    fn eq(&self, other: &Self) -> bool {
        self.equals(other)
    }
}

/// The bytes of a value in WGSL's uniform layout.
pub(crate) fn encode<T>(value: &T) -> Vec<u8>
where
    T: bevy::render::render_resource::ShaderType
        + bevy::render::render_resource::encase::internal::WriteInto,
{
    let mut buffer = UniformBuffer::new(Vec::new());
    // Cannot fail: the vector grows as needed.
    let written = buffer.write(value);
    debug_assert!(written.is_ok(), "a uniform was not written");
    buffer.into_inner()
}

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
    pub aux_scalar: bool,
    /// [`Effect::DIVIDES_TONES`].
    pub divides_tones: bool,
    /// The reflection data of the type.
    pub type_info: fn() -> &'static TypeInfo,
    /// Creates an effect with default settings.
    pub default: fn() -> Box<dyn AnyEffect>,
    /// Gets the effect from an entity, if the entity has it.
    pub get: for<'w> fn(EntityRef<'w>) -> Option<&'w dyn AnyEffect>,
    /// Registers the effect's type and those of its fields.
    pub register: fn(&mut TypeRegistry),
    pub(crate) remove: fn(&mut EntityWorldMut),
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
                aux_scalar: E::AUX_SCALAR,
                divides_tones: E::DIVIDES_TONES,
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

fn remove<E: Effect>(entity: &mut EntityWorldMut) {
    entity.remove::<E>();
}

fn read<E: Effect>(
    deserializer: &mut dyn erased_serde::Deserializer<'_>,
) -> Result<Option<Box<dyn AnyEffect>>, erased_serde::Error> {
    let effect = Option::<E>::deserialize(deserializer)?;
    Ok(effect.map(|effect| Box::new(effect) as Box<dyn AnyEffect>))
}

/// If only one side has the effect, it fades. If the depth map is `remapped`, the part that depends
/// on it fades out until half time, and in again.
fn blended<E: Effect>(
    a: Option<&dyn AnyEffect>,
    b: Option<&dyn AnyEffect>,
    t: f32,
    remapped: bool,
) -> Option<Box<dyn AnyEffect>> {
    let typed = |effect: Option<&dyn AnyEffect>| effect?.as_any().downcast_ref::<E>().cloned();
    let (a, b) = (typed(a), typed(b));
    // Where a mode changes, the effect has no strength at half time anyway.
    let same_modes = |(a, b): (&E, &E)| a.same_modes(b);
    let fades_map = remapped && a.as_ref().zip(b.as_ref()).is_none_or(same_modes);
    let effect = crossfade(a, b, t, E::faded, E::mixed, E::same_modes)?;
    Some(Box::new(if fades_map {
        effect.map_faded(crossfade_weight(t))
    } else {
        effect
    }))
}
