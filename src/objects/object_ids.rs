//! The ids of objects.

use std::collections::VecDeque;

use bevy::{ecs::entity::EntityHashMap, platform::collections::HashMap, prelude::*};

/// The ids of objects in [`ViewObjectIds`](super::ViewObjectIds), 1 to 65535. A resource of the
/// render world.
///
/// | mesh | entity whose id it has |
/// |---|---|
/// | below an [`OutlineGroup`](crate::OutlineGroup), or with one | the entity with the nearest group |
/// | one of several primitives of a glTF node, in no group | the first of these primitives, in the order of the node's children |
/// | any other | the entity with the mesh |
///
/// Primitives of a glTF node are meshes of one parent whose asset paths end in
/// `#MeshM/PrimitiveP` with the same file and the same `M`, as the engine's glTF loader
/// spawns them. A second mesh with the same `P` begins a second object.
///
/// An object has an id while a view with ids sees one of its meshes, and keeps it afterwards until
/// another object needs it. Free ids are reused in the order in which they became free, and not
/// within three frames while there are others. While more than 65535 objects are in view, the
/// surplus objects share ids; objects with the same id have no [object
/// edges](crate::lines::ObjectEdges) between them.
#[derive(Resource, Debug, Default)]
pub struct ObjectIds {
    ids: EntityHashMap<u16>,
    /// Of every id, from 1 on.
    slots: Vec<Slot>,
    /// Ids that no mesh has, and when they became free. Those that were given to their own object
    /// again are still in it.
    free: VecDeque<(u16, u32)>,
    frame: u32,
    /// The last frame in which an object came into view.
    given: u32,
    /// The objects that have the id of another one, by their ids.
    sharing: HashMap<u16, Vec<Entity>>,
}

/// Frames for which an id without an object is not given to another one.
const REST: u32 = 3;

/// The object that has an id.
#[derive(Clone, Copy, Debug)]
struct Slot {
    object: Entity,
    /// Meshes with the id, in all views.
    meshes: u32,
    /// When the last of them left.
    freed: u32,
    /// When the object got the id.
    since: u32,
    /// Whether other objects have it too, because there are not enough.
    shared: bool,
}

impl ObjectIds {
    /// The id of an object; `None` if it has none.
    pub fn get(&self, object: Entity) -> Option<u16> {
        self.ids.get(&object).copied()
    }

    /// The id of an object, if it has it to itself.
    pub(super) fn alone(&self, object: Entity) -> Option<u16> {
        let id = self.get(object)?;
        Some(id).filter(|id| !self.slots[usize::from(*id) - 1].shared)
    }

    /// The largest id that was given so far.
    pub(super) fn last(&self) -> usize {
        self.slots.len()
    }

    /// The objects in view that have an id to themselves, and whether it is new in this frame.
    pub(super) fn of_objects(&self) -> impl Iterator<Item = (Entity, u16, bool)> {
        let alone = self.slots.iter().zip(1..=u16::MAX);
        alone
            .filter(|(slot, _)| slot.meshes > 0 && !slot.shared)
            .map(|(slot, id)| (slot.object, id, slot.since == self.frame))
    }

    /// Whether objects came into view in this frame or in the last one.
    pub(super) fn are_new(&self) -> bool {
        self.frame.wrapping_sub(self.given) < 2
    }

    /// The ids that several objects have.
    pub(super) fn shared(&self) -> impl Iterator<Item = u16> {
        let slots = self
            .slots
            .iter()
            .zip(1..=u16::MAX)
            .filter(|_| !self.sharing.is_empty());
        slots.filter(|(slot, _)| slot.shared).map(|(_, id)| id)
    }

    /// Gives a mesh the id of its object.
    pub(super) fn give(&mut self, object: Entity) -> u16 {
        let id = self.get(object).unwrap_or_else(|| self.find(object));
        let slot = &mut self.slots[usize::from(id) - 1];
        if slot.meshes == 0 {
            self.given = self.frame;
        }
        slot.meshes += 1;
        id
    }

    /// Takes the id of a mesh back.
    pub(super) fn take(&mut self, id: u16) {
        let Some(slot) = usize::from(id)
            .checked_sub(1)
            .and_then(|at| self.slots.get_mut(at))
        else {
            return;
        };
        slot.meshes -= 1;
        if slot.meshes == 0 {
            slot.freed = self.frame;
            slot.shared = false;
            self.free.push_back((id, self.frame));
            for object in self.sharing.remove(&id).into_iter().flatten() {
                self.ids.remove(&object);
            }
        }
        // Objects that leave and come back leave their places in the queue behind.
        if self.free.len() > 2 * self.slots.len() + 64 {
            let slots = &self.slots;
            self.free.retain(|(id, freed)| {
                let slot = &slots[usize::from(*id) - 1];
                slot.meshes == 0 && slot.freed == *freed
            });
        }
    }

    /// An id for an object without one.
    fn find(&mut self, object: Entity) -> u16 {
        let slot = Slot {
            object,
            meshes: 0,
            freed: 0,
            since: self.frame,
            shared: false,
        };
        let is_full = self.slots.len() == usize::from(u16::MAX);
        while let Some((id, freed)) = self.free.front().copied() {
            let old = &mut self.slots[usize::from(id) - 1];
            if old.meshes > 0 || old.freed != freed {
                // Its object has come back.
                self.free.pop_front();
            } else if self.frame.wrapping_sub(freed) < REST && !is_full {
                break;
            } else {
                self.free.pop_front();
                if self.ids.get(&old.object) == Some(&id) {
                    self.ids.remove(&old.object);
                }
                *old = slot;
                self.ids.insert(object, id);
                return id;
            }
        }
        if self.slots.len() < usize::from(u16::MAX) {
            self.slots.push(slot);
            let id = self.slots.len() as u16;
            self.ids.insert(object, id);
            return id;
        }
        warn_once!("more than 65535 objects are seen at once: some have no lines between them");
        let id = (object.index_u32() % u32::from(u16::MAX) + 1) as u16;
        self.slots[usize::from(id) - 1].shared = true;
        // All meshes of the object get this id, also if another one becomes free.
        self.sharing.entry(id).or_default().push(object);
        self.ids.insert(object, id);
        self.given = self.frame;
        id
    }
}

/// Begins a frame.
pub(super) fn begin_frame(mut ids: ResMut<ObjectIds>) {
    ids.frame = ids.frame.wrapping_add(1);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(index: u32) -> Entity {
        Entity::from_raw_u32(index).expect("an index")
    }

    #[test]
    fn ids_are_dense_and_rest_before_they_are_given_away() {
        let mut ids = ObjectIds::default();
        // Ten objects at a time, each for two frames.
        let mut given: VecDeque<(u16, u32)> = VecDeque::new();
        for frame in 0..1000_u32 {
            ids.frame += 1;
            for i in 0..5 {
                let new = object(frame * 5 + i);
                let id = ids.give(new);
                assert!(ids.of_objects().any(|found| found == (new, id, true)));
                let same = given
                    .iter()
                    .find(|(old, left)| *old == id && left + REST > frame);
                assert_eq!(same, None, "frame {frame}");
                if frame >= 2 {
                    let old = ids.get(object((frame - 2) * 5 + i)).expect("seen");
                    ids.take(old);
                    given.push_back((old, frame));
                }
            }
        }
        assert!(ids.last() <= 5 * (2 + REST as usize) + 5, "{}", ids.last());
        // One that leaves and comes back has its own, and the queue does not grow.
        let last = object(999 * 5);
        let id = ids.get(last).expect("seen");
        for _ in 0..10_000 {
            ids.take(id);
            ids.frame += 10;
            assert_eq!(ids.give(last), id);
        }
        assert!(ids.free.len() <= 2 * ids.last() + 65, "{}", ids.free.len());
        assert!(ids.of_objects().any(|found| found == (last, id, false)));
    }

    #[test]
    fn beyond_the_last_id_objects_share() {
        let mut ids = ObjectIds::default();
        let all: Vec<u16> = (0..70_000).map(|index| ids.give(object(index))).collect();
        assert!(all.iter().all(|id| *id > 0));
        let alone = ids.of_objects().count();
        assert!(alone >= 65_535 - (70_000 - 65_535), "{alone}");
        // The meshes of one object have the same id, also after others have become free.
        let last = all[69_999];
        let left = [all[5_000], all[5_001]];
        for id in left {
            ids.take(id);
        }
        assert_eq!(ids.give(object(69_999)), last);
        ids.take(last);
        // A cut to as many others: none has to share.
        for id in all.into_iter().filter(|id| !left.contains(id)) {
            ids.take(id);
        }
        for index in 100_000..165_535 {
            ids.give(object(index));
        }
        assert_eq!(ids.of_objects().count(), 65_535);
        assert_eq!(ids.shared().count(), 0);
        for index in 100_000..165_535 {
            let id = ids.get(object(index)).expect("given");
            ids.take(id);
        }
        assert!(ids.slots.iter().all(|slot| slot.meshes == 0));
    }
}
