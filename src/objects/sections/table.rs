//! The sections of all meshes, as the pass that draws ids reads them.

use std::ops::Range;

use bevy::{
    ecs::entity::{EntityHashMap, EntityHashSet},
    platform::collections::HashMap,
    prelude::*,
    render::{
        Extract,
        render_resource::Buffer,
        renderer::{RenderDevice, RenderQueue},
    },
};

use super::{
    super::{changes::ChangedObjects, shared::Shared},
    EntitySections, Origin, SectionKey,
};
use crate::gpu::Table;

/// The sections of meshes. A resource of the main world.
#[derive(Resource, Default)]
pub(crate) struct SectionTables {
    entities: EntityHashMap<EntitySections>,
    /// How many of them have [`MeshSections`](super::MeshSections).
    asked: usize,
    /// The keys of each mesh.
    keys: HashMap<AssetId<Mesh>, Vec<SectionKey>>,
    divisions: HashMap<SectionKey, Division>,
    /// The sections of all meshes, four triangles to a word. New ones are added at the end. The
    /// first word belongs to no mesh.
    words: Vec<u32>,
    /// The number of words that no mesh uses any more.
    unused: usize,
    /// How often all words were packed anew.
    packings: u32,
    starts: Shared<u32>,
}

/// A mesh that is divided, or will be.
#[derive(Default)]
struct Division {
    /// The entities with the mesh.
    entities: EntityHashSet,
    /// Its words, when they are known.
    words: Option<Range<usize>>,
}

impl SectionTables {
    /// Whether any mesh has sections.
    pub fn any(&self) -> bool {
        !self.starts.is_empty()
    }

    /// Whether any mesh has `MeshSections`.
    pub fn any_asked(&self) -> bool {
        self.asked > 0
    }

    pub(super) fn is_unused(&self) -> bool {
        self.entities.is_empty()
    }

    /// Begins the changes of a frame.
    pub(super) fn begin(&mut self) {
        self.starts.begin();
    }

    /// Sets which sections an entity has. Returns a key that no entity has any more, and one that
    /// no entity had.
    pub(super) fn assign(
        &mut self,
        entity: Entity,
        new: Option<EntitySections>,
    ) -> [Option<SectionKey>; 2] {
        let old = match new {
            Some(new) => self.entities.insert(entity, new),
            None => self.entities.remove(&entity),
        };
        let mut keys = [None; 2];
        // The engine marks the mesh of an entity as changed whenever its material does.
        if old == new {
            return keys;
        }
        let is_asked = |of: Option<EntitySections>| {
            usize::from(of.is_some_and(|(key, _)| key.origin == Origin::Asked))
        };
        self.asked = self.asked + is_asked(new) - is_asked(old);
        if let Some((key, _)) = new {
            let division = self.divisions.entry(key).or_insert_with(|| {
                keys[1] = Some(key);
                self.keys.entry(key.mesh).or_default().push(key);
                Division::default()
            });
            division.entities.insert(entity);
        }
        if let Some((key, _)) = old.filter(|old| new.is_none_or(|new| new.0 != old.0))
            && let Some(division) = self.divisions.get_mut(&key)
        {
            division.entities.remove(&entity);
            if division.entities.is_empty() {
                self.forget(key);
                self.divisions.remove(&key);
                if let Some(keys) = self.keys.get_mut(&key.mesh) {
                    keys.retain(|other| *other != key);
                    if keys.is_empty() {
                        self.keys.remove(&key.mesh);
                    }
                }
                keys[0] = Some(key);
            }
        }
        self.set_start(entity);
        keys
    }

    /// Removes the sections of a mesh.
    pub(super) fn forget(&mut self, key: SectionKey) {
        let Some(division) = self.divisions.get_mut(&key) else {
            return;
        };
        self.unused += division.words.take().map_or(0, |words| words.len());
        for entity in division.entities.clone() {
            self.set_start(entity);
        }
    }

    /// Adds the sections of a mesh, one byte a triangle.
    pub(super) fn add(&mut self, key: SectionKey, numbers: &[u8]) {
        self.forget(key);
        let Some(division) = self.divisions.get_mut(&key) else {
            return;
        };
        if self.words.is_empty() {
            self.words.push(0);
        }
        let start = self.words.len();
        self.words.extend(numbers.chunks(4).map(word));
        division.words = Some(start..self.words.len());
        for entity in division.entities.clone() {
            self.set_start(entity);
        }
    }

    /// Packs the words anew if most of them are unused.
    pub(super) fn pack(&mut self) {
        if self.unused <= self.words.len() / 2 {
            return;
        }
        let mut packed = vec![0];
        for words in self.divisions.values_mut().filter_map(|d| d.words.as_mut()) {
            let start = packed.len();
            packed.extend_from_slice(&self.words[words.clone()]);
            *words = start..packed.len();
        }
        self.words = packed;
        self.unused = 0;
        self.packings = self.packings.wrapping_add(1);
        let entities: Vec<Entity> = self.entities.keys().copied().collect();
        for entity in entities {
            self.set_start(entity);
        }
    }

    fn set_start(&mut self, entity: Entity) {
        let start = self.entities.get(&entity).and_then(|(key, shift)| {
            let words = self.divisions.get(key)?.words.as_ref()?;
            let shift = shift.map_or(0, |shift| u32::from(shift) + 1);
            // Beyond 64 million triangles, meshes have no sections.
            let found = FOUND * u32::from(key.origin == Origin::Found);
            (words.end < 1 << 24).then_some(words.start as u32 | shift << 24 | found)
        });
        self.starts.set(entity, start);
    }

    /// The keys with this mesh.
    pub(super) fn keys_of(&self, mesh: AssetId<Mesh>) -> Vec<SectionKey> {
        self.keys.get(&mesh).cloned().unwrap_or_default()
    }
}

/// Up to four bytes, the first one lowest.
fn word(bytes: &[u8]) -> u32 {
    let bytes = std::array::from_fn(|i| bytes.get(i).copied().unwrap_or(0));
    u32::from_le_bytes(bytes)
}

/// The bit of the start of sections that were found without being asked for.
const FOUND: u32 = 1 << 31;

/// For each mesh with sections, bits 0 to 23 are its first word. Bits 24 to 30 are 0, or for a mesh
/// that shares its id with others 1 more than what its numbers are shifted by. Bit 31: see [`FOUND`].
#[derive(Resource, Default)]
pub(crate) struct SectionStarts(Shared<u32>);

impl SectionStarts {
    pub fn get(&self, mesh: Entity) -> Option<u32> {
        self.0.get(mesh).copied()
    }

    /// Whether a mesh is drawn with sections. `masked`: only parts of its triangles are seen, so
    /// that their edges are no creases unless they were asked for.
    pub fn draws(&self, mesh: Entity, masked: bool) -> bool {
        self.get(mesh)
            .is_some_and(|start| !masked || start & FOUND == 0)
    }
}

/// The sections of all meshes on the GPU, four triangles to a word.
#[derive(Resource, Default)]
pub(crate) struct SectionBuffer {
    pub words: Table<1>,
    packings: u32,
}

impl SectionBuffer {
    /// Always there after [`prepare_sections`].
    pub fn buffer(&self) -> Option<&Buffer> {
        self.words.buffer()
    }
}

pub(crate) fn extract_sections(
    main: Extract<Res<SectionTables>>,
    mut starts: ResMut<SectionStarts>,
    mut buffer: ResMut<SectionBuffer>,
    mut changed: ResMut<ChangedObjects>,
) {
    starts.0.follow(&main.starts, &mut changed.0);
    let buffer = &mut *buffer;
    let mut known = buffer.words.len();
    if std::mem::replace(&mut buffer.packings, main.packings) != main.packings {
        buffer.words.truncate(main.words.len());
        known = 0;
    }
    for (at, word) in main.words.iter().enumerate().skip(known) {
        buffer.words.set(at, [*word]);
    }
}

pub(crate) fn prepare_sections(
    mut buffer: ResMut<SectionBuffer>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    // A buffer must not be empty.
    if buffer.words.len() == 0 {
        buffer.words.set(0, [0]);
    }
    buffer.words.write(&device, &queue);
}

#[cfg(test)]
mod tests {
    use bevy::{asset::uuid::Uuid, platform::collections::HashSet};

    use super::*;

    /// After any changes, every entity whose mesh is divided names the words of that mesh, at most
    /// about half of all words are unused, and only starts that have to are written.
    #[test]
    fn words_follow_meshes() {
        let mut tables = SectionTables::default();
        let mut divided: HashMap<SectionKey, Vec<u8>> = HashMap::default();
        let mut wanted: EntityHashMap<EntitySections> = EntityHashMap::default();
        let mut random = 1_u32;
        let mut next = move |below: u32| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 12) % below
        };
        for round in 0..3000 {
            tables.begin();
            let packings = tables.packings;
            let entity = Entity::from_raw_u32(next(12)).expect("an index");
            let mesh = AssetId::from(Uuid::from_u128(u128::from(next(5))));
            let key = SectionKey {
                mesh,
                angle: 50,
                origin: Origin::Asked,
            };
            match next(4) {
                0 => {
                    wanted.remove(&entity);
                    tables.assign(entity, None);
                }
                1 => {
                    let numbers = vec![next(200) as u8 + 1; next(20) as usize + 1];
                    tables.add(key, &numbers);
                    if wanted.values().any(|(used, _)| *used == key) {
                        divided.insert(key, numbers);
                    }
                }
                _ => {
                    let shift = (next(2) == 0).then_some(entity.index_u32() as u8);
                    wanted.insert(entity, (key, shift));
                    tables.assign(entity, Some((key, shift)));
                }
            }
            let used: HashSet<SectionKey> = wanted.values().map(|(key, _)| *key).collect();
            divided.retain(|key, _| used.contains(key));
            let written = tables.starts.changed().len();
            tables.pack();
            assert!(tables.packings != packings || tables.starts.changed().len() == written);
            for (entity, (key, shift)) in &wanted {
                let start = tables.starts.get(*entity).copied();
                let numbers = divided.get(key);
                assert_eq!(start.is_some(), numbers.is_some(), "round {round}");
                if let (Some(start), Some(numbers)) = (start, numbers) {
                    assert_eq!(
                        start >> 24 & 127,
                        shift.map_or(0, |shift| u32::from(shift) + 1)
                    );
                    let words = &tables.words[start as usize & 0xff_ffff..];
                    let packed: Vec<u32> = numbers.chunks(4).map(word).collect();
                    assert_eq!(words[..packed.len()], packed, "round {round}");
                }
            }
            assert!(
                tables
                    .starts
                    .values()
                    .keys()
                    .all(|e| wanted.contains_key(e))
            );
            let all: usize = divided
                .values()
                .map(|numbers| numbers.len().div_ceil(4))
                .sum();
            assert!(
                tables.words.len() <= 2 * all + 3,
                "{}, {all}",
                tables.words.len()
            );
        }
        assert!(tables.packings > 10, "{}", tables.packings);
    }
}
