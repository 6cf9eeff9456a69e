//! The table of outline styles that shaders read, and the slot of each object in it.

use bevy::{
    ecs::entity::EntityHashMap,
    platform::collections::HashMap,
    prelude::*,
    render::{
        render_resource::{Buffer, ShaderType, StorageBuffer},
        renderer::{RenderDevice, RenderQueue},
    },
};

use super::shared::Shared;

/// `ObjectStyle` of `objects.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, PartialEq)]
pub(crate) struct ObjectStyleUniform {
    pub color: Vec3,
    pub has_color: f32,
    pub half_width: f32,
    pub kinds: u32,
    pub opacity: f32,
    /// World units per unit of an object that screens follow; 0: they do not.
    pub anchor_size: f32,
    /// Its center in world space.
    pub anchor_center: Vec3,
    pub unused: f32,
    /// Its rotation, a unit quaternion.
    pub anchor_rotation: Vec4,
}

impl Default for ObjectStyleUniform {
    fn default() -> Self {
        Self {
            color: Vec3::ZERO,
            has_color: 0.0,
            half_width: -1.0,
            kinds: 7,
            opacity: 1.0,
            anchor_size: 0.0,
            anchor_center: Vec3::ZERO,
            unused: 0.0,
            anchor_rotation: Vec4::W,
        }
    }
}

/// Most outline styles that can be told apart: a slot is packed in 8 bits. Further ones
/// are drawn like the last, with a warning.
pub(crate) const MOST_STYLES: usize = 255;

/// The objects that are drawn in another way than the others. Both worlds have a copy.
#[derive(Resource, Default)]
pub(crate) struct ObjectStyles {
    /// The table, by slot. Slot 0 is for objects without a style.
    pub entries: Vec<ObjectStyleUniform>,
    /// The slot of each object, by main-world entity.
    pub slots: Shared<u8>,
    /// The slots of objects while they have mostly faded to nothing: their styles, without lines.
    pub faded: Shared<u8>,
    users: Users,
    /// What does not follow from the slots. Only the main world knows it.
    pub flags: ObjectChanges,
}

/// The bit of `ObjectStyleUniform::kinds` of objects of which only hidden parts have lines.
pub(crate) const HIDDEN_ONLY: u32 = 16;

/// The bit of `ObjectStyleUniform::kinds` of objects of which only visible parts have lines.
pub(crate) const VISIBLE_ONLY: u32 = 32;

/// The bits of `ObjectStyleUniform::kinds` of all kinds of line.
const ALL_KINDS: u32 = 7;

/// The bit of `ObjectStyleUniform::kinds` of objects that the color effects leave alone.
pub(crate) const UNSTYLED: u32 = 8;

/// Which components of objects there are in a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ObjectChanges {
    /// Some object has its own line style, or no lines, or [`UNSTYLED`], or fades to nothing.
    pub any: bool,
    /// Some mesh is divided into sections, and some because it has `MeshSections`.
    pub sections: bool,
    pub asked_sections: bool,
    /// The vertices of some mesh say how wide its lines are.
    pub widths: bool,
    /// The color effects leave some object alone.
    pub unstyled: bool,
    /// Some object has a `SelectionOutline` or `XRayOutline`.
    pub highlights: bool,
    /// Screens follow some object.
    pub anchored: bool,
    /// Some mesh fades at some distance.
    pub fades: bool,
}

impl ObjectStyles {
    pub fn any(&self) -> bool {
        !(self.slots.is_empty() && self.faded.is_empty())
    }

    pub fn changes(&self) -> ObjectChanges {
        ObjectChanges {
            any: self.any(),
            unstyled: self.entries.iter().any(|e| e.kinds & UNSTYLED != 0),
            anchored: self.entries.iter().any(|e| e.anchor_size > 0.0),
            ..self.flags
        }
    }

    /// Width of the widest line of any style, in logical pixels; 0 if no style sets it.
    pub fn max_width(&self) -> f32 {
        self.entries
            .iter()
            .map(|e| 2.0 * e.half_width)
            .fold(0.0, f32::max)
    }
}

/// The objects that use the slots of a table. Only the main world knows them.
#[derive(Default)]
struct Users {
    /// The number of objects of each slot.
    counts: Vec<u32>,
    /// The slot of each style.
    known: HashMap<[u32; 15], u8>,
    /// Objects that are drawn like those of the last slot, because no slot is free.
    waiting: EntityHashMap<ObjectStyleUniform>,
}

impl ObjectStyles {
    /// Gives objects another style; `None`: none. The slots of all other objects stay, except for
    /// those that wait for one. Objects with a slot come before those without one, and then in the
    /// order of entities.
    pub fn assign(&mut self, new: impl Iterator<Item = (Entity, Option<ObjectStyleUniform>)>) {
        self.slots.begin();
        let mut wanting = Vec::new();
        for (object, style) in new {
            let slot = self.leave(object);
            match style {
                Some(style) => wanting.push((slot.is_none(), object, slot, style)),
                None => {
                    self.slots.set(object, None);
                }
            }
        }
        let waiting = std::mem::take(&mut self.users.waiting).into_iter();
        wanting.extend(waiting.map(|(object, style)| (true, object, None, style)));
        wanting.sort_unstable_by_key(|(is_new, object, ..)| (*is_new, *object));
        for (_, object, before, style) in wanting {
            let slot = self.enter(object, before, style);
            self.slots.set(object, Some(slot));
        }
    }

    /// Frees the slot of an object if it was its last one; returns it.
    fn leave(&mut self, object: Entity) -> Option<u8> {
        if self.users.waiting.remove(&object).is_some() {
            return None;
        }
        let slot = *self.slots.get(object)?;
        self.release(slot);
        Some(slot)
    }

    /// Frees a slot if this was its last use.
    fn release(&mut self, slot: u8) {
        let at = usize::from(slot);
        self.users.counts[at] -= 1;
        if self.users.counts[at] == 0 {
            let unused = std::mem::take(&mut self.entries[at]);
            self.users.known.remove(&unused.bits());
        }
    }

    /// The slot of the style of an object, see [`take`](Self::take).
    fn enter(&mut self, object: Entity, before: Option<u8>, style: ObjectStyleUniform) -> u8 {
        self.take(before, style).unwrap_or_else(|| {
            warn_once!(
                "more than {MOST_STYLES} different outline styles: the others are drawn like the last"
            );
            self.users.waiting.insert(object, style);
            MOST_STYLES as u8
        })
    }

    /// The slot of a style; that of `before` if it is new and that slot is free. `None` if none is
    /// free.
    fn take(&mut self, before: Option<u8>, style: ObjectStyleUniform) -> Option<u8> {
        if self.entries.is_empty() {
            self.entries.push(ObjectStyleUniform::default());
            self.users.counts.push(1);
        }
        let Self { entries, users, .. } = self;
        let is_free = |at: &usize| users.counts.get(*at).is_none_or(|count| *count == 0);
        let known = users
            .known
            .get(&style.bits())
            .map(|slot| usize::from(*slot));
        let free = || {
            let before = before.map(usize::from).filter(is_free);
            before.or_else(|| (1..=MOST_STYLES).find(is_free))
        };
        let at = known.or_else(free)?;
        if at == entries.len() {
            entries.push(style);
            users.counts.push(0);
        }
        entries[at] = style;
        users.counts[at] += 1;
        users.known.insert(style.bits(), at as u8);
        Some(at as u8)
    }

    /// Says which objects fade to nothing at some distance. If no slot is free, an object keeps its
    /// lines.
    pub fn fade(&mut self, objects: impl Iterator<Item = (Entity, bool)>) {
        self.faded.begin();
        for (object, fades) in objects {
            let before = self.faded.get(object).copied();
            if let Some(before) = before {
                self.release(before);
            }
            let slot = if fades {
                let slot = self.slots.get(object).copied().unwrap_or(0);
                let own = self.entries.get(usize::from(slot));
                let mut style = own.copied().unwrap_or_default();
                style.kinds &= !ALL_KINDS;
                self.take(before, style)
            } else {
                None
            };
            self.faded.set(object, slot);
        }
        let waiting = std::mem::take(&mut self.users.waiting).into_iter();
        let mut waiting: Vec<_> = waiting.collect();
        waiting.sort_unstable_by_key(|(object, _)| *object);
        for (object, style) in waiting {
            let slot = self.enter(object, None, style);
            self.slots.set(object, Some(slot));
        }
    }
}

impl ObjectStyleUniform {
    /// All of it; equal for styles that are drawn alike.
    fn bits(&self) -> [u32; 15] {
        let [r, g, b] = self.color.to_array();
        let [x, y, z] = self.anchor_center.to_array();
        let [i, j, k, w] = self.anchor_rotation.to_array();
        let kinds = f32::from_bits(self.kinds);
        let [color, half, opacity, size] = [
            self.has_color,
            self.half_width,
            self.opacity,
            self.anchor_size,
        ];
        let all = [
            r, g, b, color, half, kinds, opacity, size, x, y, z, i, j, k, w,
        ];
        all.map(f32::to_bits)
    }
}

#[cfg(feature = "objects")]
impl super::changes::Follow for ObjectStyles {
    fn follow(&mut self, main: &Self, changed: &mut bevy::render::sync_world::MainEntityHashSet) {
        self.slots.follow(&main.slots, changed);
        self.faded.follow(&main.faded, changed);
        self.entries.clone_from(&main.entries);
    }
}

/// The table of outline styles on the GPU.
#[derive(Resource, Default)]
pub(crate) struct ObjectStyleBuffer {
    buffer: StorageBuffer<Vec<ObjectStyleUniform>>,
}

impl ObjectStyleBuffer {
    pub fn update(&mut self, styles: &ObjectStyles, device: &RenderDevice, queue: &RenderQueue) {
        if styles.any() && *self.buffer.get() != styles.entries {
            self.buffer.set(styles.entries.clone());
            self.buffer.write_buffer(device, queue);
        }
    }

    pub fn buffer(&self) -> Option<&Buffer> {
        self.buffer.buffer()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(index: u32) -> Entity {
        Entity::from_raw_u32(index).expect("an index")
    }

    fn style(number: u32) -> Option<ObjectStyleUniform> {
        Some(ObjectStyleUniform {
            half_width: number as f32,
            ..Default::default()
        })
    }

    /// After any changes, objects have the same slot if and only if they have the same style, and
    /// the entry of the slot is that style; only objects that changed get another slot.
    #[test]
    fn slots_belong_to_styles() {
        let mut styles = ObjectStyles::default();
        let mut wanted = EntityHashMap::default();
        let mut random = 1_u32;
        for round in 0..2000 {
            let mut changed = EntityHashMap::default();
            for _ in 0..round % 5 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let style = style(random >> 16 & 31).filter(|style| style.half_width > 3.0);
                changed.insert(object(random >> 26), style);
            }
            wanted.extend(changed.clone());
            let before = styles.slots.clone();
            styles.assign(changed.clone().into_iter());
            for (object, style) in &wanted {
                let slot = styles.slots.get(*object);
                let found = slot.map(|slot| styles.entries[usize::from(*slot)]);
                assert_eq!(found, *style, "round {round}");
            }
            let mut others = wanted.keys().filter(|other| !changed.contains_key(*other));
            assert!(others.all(|other| styles.slots.get(*other) == before.get(*other)));
            assert!(styles.entries.len() <= 29 + 1, "{}", styles.entries.len());
        }
    }

    /// An object whose style changes in every frame keeps its slot, also if others are free.
    #[test]
    fn a_style_that_changes_stays_in_its_slot() {
        let mut styles = ObjectStyles::default();
        styles.assign((0..9).map(|index| (object(index), style(index))));
        let slot = styles.slots.get(object(7)).copied();
        styles.assign([(object(3), None), (object(7), style(10))].into_iter());
        assert_eq!(styles.slots.get(object(7)).copied(), slot);
    }

    /// An object that has mostly faded has its own style without lines, and needs no slot later.
    #[test]
    fn faded_objects_have_their_styles_without_lines() {
        let mut styles = ObjectStyles::default();
        let unstyled = ObjectStyleUniform {
            kinds: ALL_KINDS | UNSTYLED,
            ..Default::default()
        };
        let kinds = |styles: &ObjectStyles| {
            [1, 2].map(|index| {
                let slot = styles.faded.get(object(index)).copied();
                slot.map(|slot| styles.entries[usize::from(slot)].kinds)
            })
        };
        styles.assign([(object(1), Some(unstyled))].into_iter());
        styles.fade([(object(1), true), (object(2), true)].into_iter());
        assert_eq!(kinds(&styles), [Some(UNSTYLED), Some(0)]);
        styles.assign([(object(1), None)].into_iter());
        styles.fade([(object(1), true)].into_iter());
        assert_eq!(kinds(&styles), [Some(0); 2]);
        styles.fade([(object(1), false), (object(2), false)].into_iter());
        assert_eq!(kinds(&styles), [None; 2]);
        assert!(!styles.any() && styles.users.known.is_empty());
    }

    /// A slot that becomes free goes to the first object that waits.
    #[test]
    fn a_full_table_changes_only_where_a_slot_becomes_free() {
        let mut styles = ObjectStyles::default();
        styles.assign((0..300).map(|index| (object(index), style(index))));
        let waiting = |styles: &ObjectStyles| {
            let mut waiting: Vec<Entity> = styles.users.waiting.keys().copied().collect();
            waiting.sort_unstable();
            waiting
        };
        let mut all: Vec<Entity> = (0..300).map(object).collect();
        all.sort_unstable();
        assert_eq!(waiting(&styles), all[255..]);
        let before = styles.slots.clone();
        styles.assign([(all[7], style(1000))].into_iter());
        assert_eq!(styles.slots.values(), before.values());
        assert_eq!(waiting(&styles), all[255..]);
        styles.assign([(all[9], None)].into_iter());
        assert_eq!(waiting(&styles), all[256..]);
        assert_eq!(styles.slots.get(all[255]), before.get(all[9]));
    }
}
