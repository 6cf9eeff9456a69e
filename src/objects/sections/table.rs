//! The sections of all meshes, as the pass that draws ids reads them.

use bevy::{
    asset::AssetId,
    ecs::{
        change_detection::DetectChanges,
        entity::{Entity, EntityHashMap},
        resource::Resource,
        system::{Res, ResMut},
    },
    mesh::Mesh,
    platform::collections::{HashMap, HashSet},
    render::{
        Extract,
        render_resource::{Buffer, StorageBuffer},
        renderer::{RenderDevice, RenderQueue},
        sync_world::MainEntity,
    },
};

use super::{
    super::changes::ChangedObjects,
    EntitySections, Numbers, SectionKey,
    divide::{NUMBERS, SILENT},
};

/// The sections of meshes. Both worlds have a copy.
#[derive(Resource, Clone, Default)]
pub(crate) struct SectionTables {
    pub(super) numbers: HashMap<SectionKey, Numbers>,
    entities: EntityHashMap<EntitySections>,
}

impl SectionTables {
    /// Whether any mesh has sections.
    pub fn any(&self) -> bool {
        !self.numbers.is_empty() && !self.entities.is_empty()
    }

    pub(super) fn is_unused(&self) -> bool {
        self.entities.is_empty()
    }

    pub(super) fn has(&self, entities: &EntityHashMap<EntitySections>) -> bool {
        self.entities == *entities
    }

    /// Also forgets the sections that no entity has any more.
    pub(super) fn assign(&mut self, entities: EntityHashMap<EntitySections>) {
        self.entities = entities;
        let used = self.used();
        self.numbers.retain(|key, _| used.contains(key));
    }

    pub(super) fn used(&self) -> HashSet<SectionKey> {
        self.entities.values().map(|(key, _)| *key).collect()
    }

    /// The keys with this mesh.
    pub(super) fn keys_of(&self, mesh: AssetId<Mesh>) -> Vec<SectionKey> {
        let keys = self.entities.values().map(|(key, _)| *key);
        let found: HashSet<SectionKey> = keys.filter(|key| key.mesh == mesh).collect();
        found.into_iter().collect()
    }
}

pub(crate) fn extract_sections(
    main: Extract<Res<SectionTables>>,
    mut tables: ResMut<SectionTables>,
    mut changed: ResMut<ChangedObjects>,
) {
    if main.is_changed() {
        // Any of them may begin at another word now.
        let meshes = tables.entities.keys().chain(main.entities.keys());
        changed.0.extend(meshes.copied().map(MainEntity::from));
        tables.clone_from(&main);
    }
}

/// The sections of all meshes on the GPU, four triangles to a word.
#[derive(Resource, Default)]
pub(crate) struct SectionBuffer {
    words: StorageBuffer<Vec<u32>>,
    /// The first word of the sections.
    starts: HashMap<EntitySections, u32>,
}

impl SectionBuffer {
    /// The first word of a mesh's sections; `None` if it has none.
    pub fn start(&self, tables: &SectionTables, mesh: Entity) -> Option<u32> {
        let key = tables.entities.get(&mesh)?;
        self.starts.get(key).copied()
    }

    /// Always there after [`prepare_sections`].
    pub fn buffer(&self) -> Option<&Buffer> {
        self.words.buffer()
    }

    fn fill(&mut self, tables: &SectionTables) {
        let words = self.words.get_mut();
        words.clear();
        // A buffer must not be empty.
        words.push(0);
        self.starts.clear();
        for key in tables.entities.values() {
            let Some(numbers) = tables.numbers.get(&key.0) else {
                continue;
            };
            self.starts.entry(*key).or_insert_with(|| {
                let start = words.len() as u32;
                let (_, shift) = *key;
                let numbers = numbers.iter().map(|n| number(*n, shift));
                words.extend(packed(numbers));
                start
            });
        }
    }
}

/// The number of a section as shaders read it: those of meshes that share their id have
/// another range, 128 to 254, in which they are shifted.
fn number(section: u8, shift: Option<u8>) -> u8 {
    match shift {
        Some(shift) if section != SILENT => {
            let shifted = (u16::from(section - 1) + u16::from(shift)) % u16::from(NUMBERS);
            NUMBERS + 1 + shifted as u8
        }
        _ => section,
    }
}

/// Four bytes to a word, the first one lowest.
fn packed(bytes: impl Iterator<Item = u8>) -> Vec<u32> {
    let bytes: Vec<u8> = bytes.collect();
    let word = |four: &[u8]| {
        let bytes = std::array::from_fn(|i| four.get(i).copied().unwrap_or(0));
        u32::from_le_bytes(bytes)
    };
    bytes.chunks(4).map(word).collect()
}

pub(crate) fn prepare_sections(
    tables: Res<SectionTables>,
    mut buffer: ResMut<SectionBuffer>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    if !tables.is_changed() && buffer.buffer().is_some() {
        return;
    }
    buffer.fill(&tables);
    buffer.words.write_buffer(&device, &queue);
}
