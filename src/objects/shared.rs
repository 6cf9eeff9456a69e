//! Values of entities, of which the render world has a copy.

use bevy::{
    ecs::entity::{Entity, EntityHashMap},
    render::sync_world::{MainEntity, MainEntityHashSet},
};

/// The values that some entities have. The entities that changed last are kept, so that the copy
/// follows without a look at the others.
#[derive(Clone, Debug)]
pub(crate) struct Shared<V> {
    values: EntityHashMap<V>,
    /// The entities whose values changed in the last round of changes.
    changed: Vec<Entity>,
    /// The number of rounds with changes.
    rounds: u32,
    /// Whether the next change belongs to the last round.
    continues: bool,
}

impl<V> Default for Shared<V> {
    fn default() -> Self {
        Self {
            values: EntityHashMap::default(),
            changed: Vec::new(),
            rounds: 0,
            continues: false,
        }
    }
}

impl<V> Shared<V> {
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

impl<V: Clone + PartialEq> Shared<V> {
    pub fn get(&self, entity: Entity) -> Option<&V> {
        self.values.get(&entity)
    }

    pub fn contains(&self, entity: Entity) -> bool {
        self.values.contains_key(&entity)
    }

    pub fn keys(&self) -> impl Iterator<Item = Entity> {
        self.values.keys().copied()
    }

    /// Begins a round of changes: everything that a system changes in one run.
    pub fn begin(&mut self) {
        self.continues = false;
    }

    /// Sets or removes a value; returns whether that changed it.
    pub fn set(&mut self, entity: Entity, value: Option<V>) -> bool {
        let is_other = self.values.get(&entity) != value.as_ref();
        if is_other {
            if !std::mem::replace(&mut self.continues, true) {
                self.changed.clear();
                self.rounds = self.rounds.wrapping_add(1);
            }
            self.changed.push(entity);
            match value {
                Some(value) => self.values.insert(entity, value),
                None => self.values.remove(&entity),
            };
        }
        is_other
    }

    /// The entities whose values changed in the last round of changes.
    pub fn changed(&self) -> &[Entity] {
        &self.changed
    }

    /// Makes this a copy of `main`, and notes the entities whose values differ.
    pub fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet) {
        let rounds = main.rounds.wrapping_sub(self.rounds);
        self.rounds = main.rounds;
        if rounds == 1 {
            for entity in &main.changed {
                match main.values.get(entity) {
                    Some(value) => self.values.insert(*entity, value.clone()),
                    None => self.values.remove(entity),
                };
            }
            changed.extend(main.changed.iter().copied().map(MainEntity::from));
        } else if rounds != 0 {
            let all = self.values.keys().chain(main.values.keys());
            changed.extend(all.copied().map(MainEntity::from));
            self.values.clone_from(&main.values);
        }
    }

    #[cfg(test)]
    pub fn values(&self) -> &EntityHashMap<V> {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A copy that follows after one round is told what changed; one that follows later is whole.
    #[test]
    fn copies_follow_also_when_they_have_missed_changes() {
        let entity = |index| Entity::from_raw_u32(index).expect("an index");
        let (mut main, mut copy) = (Shared::default(), Shared::default());
        let mut random = 1_u32;
        for frame in 0..500 {
            main.begin();
            for _ in 0..frame % 4 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let value = Some(random >> 20 & 3).filter(|value| *value > 0);
                main.set(entity(random >> 27), value);
            }
            if frame % 7 > 0 {
                let before: Shared<u32> = copy.clone();
                let mut changed = MainEntityHashSet::default();
                copy.follow(&main, &mut changed);
                assert_eq!(copy.values, main.values, "frame {frame}");
                let differs = |e: &u32| before.get(entity(*e)) != copy.get(entity(*e));
                let missed = (0..32)
                    .filter(differs)
                    .find(|e| !changed.contains(&MainEntity::from(entity(*e))));
                assert_eq!(missed, None, "frame {frame}");
                if frame % 7 > 1 {
                    assert!(changed.len() <= 3, "frame {frame}: {}", changed.len());
                }
            }
        }
    }
}
