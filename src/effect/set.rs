//! A set of effects, at most one of each type.

use super::{AnyEffect, Effect, EffectStage};

/// Effects, at most one of each type, ordered by stage and, within a stage, by
/// insertion.
#[derive(Clone, Debug, Default)]
pub struct EffectSet(Vec<Box<dyn AnyEffect>>);

impl EffectSet {
    /// The effects, in order.
    pub fn iter(&self) -> impl Iterator<Item = &dyn AnyEffect> {
        self.0.iter().map(AsRef::as_ref)
    }

    /// The effect with this name, if the set contains it.
    pub fn by_name(&self, name: &str) -> Option<&dyn AnyEffect> {
        self.iter().find(|effect| effect.name() == name)
    }

    /// The effect of this type, if the set contains it.
    pub fn get<E: Effect>(&self) -> Option<&E> {
        self.iter()
            .find_map(|effect| effect.as_any().downcast_ref())
    }

    /// The effect of this type for editing, if the set contains it.
    pub fn get_mut<E: Effect>(&mut self) -> Option<&mut E> {
        self.0
            .iter_mut()
            .find_map(|effect| effect.as_any_mut().downcast_mut())
    }

    /// Adds an effect, or replaces the one with the same name.
    pub fn insert(&mut self, effect: Box<dyn AnyEffect>) {
        let key = |e: &dyn AnyEffect| -> EffectStage { e.effect_type().stage };
        let name = effect.name();
        if let Some(known) = self.0.iter_mut().find(|e| e.name() == name) {
            *known = effect;
            return;
        }
        let at = self
            .0
            .partition_point(|e| key(e.as_ref()) <= key(effect.as_ref()));
        self.0.insert(at, effect);
    }

    /// Removes and returns the effect with this name.
    pub fn remove(&mut self, name: &str) -> Option<Box<dyn AnyEffect>> {
        let at = self.0.iter().position(|effect| effect.name() == name)?;
        Some(self.0.remove(at))
    }
}

impl PartialEq for EffectSet {
    fn eq(&self, other: &Self) -> bool {
        self.0.len() == other.0.len()
            && self.iter().all(|effect| {
                other
                    .by_name(effect.name())
                    .is_some_and(|theirs| effect.equals(theirs))
            })
    }
}
