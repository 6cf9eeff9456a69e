//! Meshes that are divided into sections, whose borders are creases.

mod divide;
mod table;

use bevy::{
    asset::AssetEventSystems,
    ecs::{entity::EntityHashSet, system::SystemParam},
    mesh::{MeshVertexAttribute, VertexFormat, morph::MeshMorphWeights, skinning::SkinnedMesh},
    platform::collections::{HashMap, HashSet},
    prelude::*,
    render::{RenderApp, renderer::RenderDevice, settings::WgpuFeatures},
    tasks::{AsyncComputeTaskPool, Task, block_on, futures_lite::future},
};

use self::divide::Surface;
use super::{
    components::assign_object_styles,
    groups::{ObjectGroups, update_object_groups},
    inherit::{Inherit, Inherited, register},
    table::ObjectStyles,
};
use crate::{
    schedule::DivideMeshes,
    settings::{FieldRange, impl_sanitized},
};

pub(crate) use table::{
    SectionBuffer, SectionStarts, SectionTables, extract_sections, prepare_sections,
};

/// Divides the meshes of this entity and of its descendants into sections: parts that bend
/// nowhere as sharply as `angle`. Where two sections of an object meet, there is a crease.
///
/// By default, cameras divide all meshes, by rules that leave out some edges and meshes: see
/// [`CreaseSource`](crate::lines::CreaseSource). On the meshes of this component, `angle` replaces
/// these rules. Borders of sections depend neither on the view, nor on the distance, nor on normal
/// maps. The creases themselves are those of the camera's [`Outlines`](crate::Outlines).
///
/// A mesh is divided once, in a background task (see [`MeshTasks`]), from its positions: normals do
/// not count. Until then, and for meshes that the main world does not keep
/// ([`RenderAssetUsages`](bevy::asset::RenderAssetUsages)), there are no such borders; the latter
/// is logged. A mesh that changes is divided again; one that changes in every frame has none. Skinned and morphed
/// meshes have the sections of their rest pose. Parts of a mesh that only touch or pass
/// through each other are sections too.
///
/// Meshes of an [`OutlineGroup`](crate::OutlineGroup) and primitives of a glTF node are treated as
/// one surface: a border between two of their sections has no crease where the surface neither
/// bends by 10 degrees nor has a step. If several entities above a mesh have the component, the
/// nearest one counts. Faithful creases do not use sections.
///
/// A mesh with [`ATTRIBUTE_MESH_SECTION`] has the sections of its author.
///
/// The device must support [`WgpuFeatures::PRIMITIVE_INDEX`], which desktop devices do and
/// browsers do not; otherwise the component does nothing, and the log says so.
///
/// [`WgpuFeatures::PRIMITIVE_INDEX`]: bevy::render::settings::WgpuFeatures::PRIMITIVE_INDEX
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct MeshSections {
    /// Angle between the normals of two triangles from which they belong to two sections, in
    /// degrees. Range 10 to 180, default 50. At 180 the mesh has no sections.
    #[reflect(@FieldRange::linear(10.0, 180.0).unit("°"))]
    pub angle: f32,
}

impl MeshSections {
    /// No sections, whatever the [`CreaseSource`](crate::lines::CreaseSource) of cameras is.
    pub const NONE: Self = Self { angle: 180.0 };
}

impl_sanitized!(MeshSections);

impl Default for MeshSections {
    fn default() -> Self {
        Self { angle: 50.0 }
    }
}

/// When meshes are divided into sections. A resource.
///
/// It applies to [`MeshSections`] and to the [`CreaseSource`](crate::lines::CreaseSource) of cameras.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeshTasks {
    /// In background tasks: the lines along the edges of a mesh appear some frames after it was
    /// loaded.
    #[default]
    Background,
    /// In the frame in which a mesh is loaded, which takes longer: for pictures and films.
    Immediate,
}

/// The section of a vertex, which replaces those that [`MeshSections`] finds. The first vertex of a
/// triangle decides. Two numbers that differ by a multiple of 64 are the same section; at a
/// triangle of section 0 there are no creases at all. The loader of a glTF file must be told about
/// attributes of its own (`GltfPlugin::add_custom_vertex_attribute`). Once such a mesh is divided,
/// because it has [`MeshSections`] or a camera asks for the edges of all meshes, all cameras use
/// its sections.
pub const ATTRIBUTE_MESH_SECTION: MeshVertexAttribute =
    MeshVertexAttribute::new("MeshSection", 0x636f_6d69_6373, VertexFormat::Uint32);

/// A mesh, and how it is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SectionKey {
    mesh: AssetId<Mesh>,
    /// In thousandths of a degree.
    angle: u32,
    origin: Origin,
}

/// Why a mesh is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Origin {
    /// It has [`MeshSections`].
    Asked,
    /// A camera asks for the edges of all meshes: rules keep them quiet.
    Found,
}

impl SectionKey {
    fn new(mesh: &Mesh3d, sections: MeshSections, origin: Origin) -> Self {
        Self {
            mesh: mesh.0.id(),
            origin,
            angle: (sections.angle * 1000.0).round() as u32,
        }
    }

    fn angle(self) -> f32 {
        self.angle as f32 / 1000.0
    }
}

/// The sections of a mesh, one byte a triangle.
type Numbers = Vec<u8>;

/// Meshes whose sections are not known yet.
#[derive(Resource, Default)]
pub(super) struct SectionTasks {
    waiting: HashSet<SectionKey>,
    running: HashMap<SectionKey, Task<Numbers>>,
    /// What is known, but not in the tables.
    done: Vec<(SectionKey, Numbers)>,
    /// Those that have no triangles, cannot be read, or change all the time.
    failed: HashSet<SectionKey>,
    /// How often those that were found have changed.
    changes: HashMap<SectionKey, u32>,
    /// Whether the device can tell which triangle a pixel shows.
    supported: bool,
}

/// Whether a camera asks for the edges of all meshes.
#[derive(Resource, Default, PartialEq)]
pub(crate) struct AllMeshes(pub bool);

/// The sections that a mesh entity has: their key, and if it shares its id with other
/// meshes, by how much its numbers are shifted.
pub(crate) type EntitySections = (SectionKey, Option<u8>);

/// Most meshes that are divided at a time: each is copied for its task.
const MOST_TASKS: usize = 256;
/// Indices of meshes after which no other mesh is copied in a frame.
const MOST_INDICES: usize = 600_000;
/// Most changes of a mesh without [`MeshSections`] after which it is divided again.
const MOST_CHANGES: u32 = 3;

/// Entities with a new mesh, and with a mesh that is skinned or morphed from now on.
type OtherMesh = Or<(Changed<Mesh3d>, Added<SkinnedMesh>, Added<MeshMorphWeights>)>;

/// What says which mesh has which sections.
#[derive(SystemParam)]
pub(super) struct Divided<'w, 's> {
    sections: Inherited<'w, 's, MeshSections>,
    meshes: Query<'w, 's, (&'static Mesh3d, Has<SkinnedMesh>, Has<MeshMorphWeights>)>,
    all: Res<'w, AllMeshes>,
    every_mesh: Query<'w, 's, Entity, With<Mesh3d>>,
    groups: Res<'w, ObjectGroups>,
    other_mesh: Query<'w, 's, Entity, OtherMesh>,
    removed: RemovedComponents<'w, 's, Mesh3d>,
    no_longer_skinned: RemovedComponents<'w, 's, SkinnedMesh>,
    no_longer_morphed: RemovedComponents<'w, 's, MeshMorphWeights>,
}

impl Inherit for MeshSections {
    fn is_inherited(&self) -> bool {
        true
    }
}

impl Divided<'_, '_> {
    /// The entities whose sections may have changed. `used`: some entity has sections.
    fn update(&mut self, used: bool) -> EntityHashSet {
        let mut changed = self.sections.update();
        let removed = self.removed.read();
        let removed = removed.chain(self.no_longer_skinned.read());
        let removed = removed.chain(self.no_longer_morphed.read());
        if self.all.is_changed() {
            changed.extend(&self.every_mesh);
        }
        if used || self.all.0 || !changed.is_empty() {
            changed.extend(self.other_mesh.iter().chain(removed));
            if self.groups.is_changed() {
                changed.extend(self.groups.changed());
            }
        }
        changed
    }

    fn of(&self, entity: Entity) -> Option<EntitySections> {
        let (mesh, skinned, morphed) = self.meshes.get(entity).ok()?;
        let (sections, origin) = match self.sections.of(entity) {
            Some((_, asked)) => (asked.sanitized(), Origin::Asked),
            None if self.all.0 && !skinned && !morphed => (MeshSections::default(), Origin::Found),
            None => return None,
        };
        if sections == MeshSections::NONE {
            return None;
        }
        let shared = self.groups.is_shared(entity);
        // Two meshes of a group rarely have the same numbers.
        let shift = shared.then(|| (entity.index_u32() % u32::from(divide::NUMBERS)) as u8);
        Some((SectionKey::new(mesh, sections, origin), shift))
    }
}

/// Keeps [`SectionTables`] up to date: starts tasks, and takes their results.
pub(super) fn divide_meshes(
    mut divided: Divided,
    meshes: Res<Assets<Mesh>>,
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut tasks: ResMut<SectionTasks>,
    mut tables: ResMut<SectionTables>,
    (mut styles, when): (ResMut<ObjectStyles>, Res<MeshTasks>),
) {
    let changed = divided.update(!tables.is_unused());
    if changed.is_empty() && tables.is_unused() {
        events.clear();
        return;
    }
    if !tasks.supported {
        let asked = |entity: &Entity| {
            let sections = divided.of(*entity);
            sections.is_some_and(|(key, _)| key.origin == Origin::Asked)
        };
        if changed.iter().any(asked) {
            warn_once!(
                "`MeshSections` does nothing: the device does not support the feature \
                 PRIMITIVE_INDEX"
            );
        }
        return;
    }
    tables.begin();
    for event in events.read() {
        if let AssetEvent::Added { id } | AssetEvent::Modified { id } = event {
            for key in tables.keys_of(*id) {
                tables.forget(key);
                tasks.change(key);
            }
        }
    }
    for entity in changed {
        let [unused, new] = tables.assign(entity, divided.of(entity));
        if let Some(key) = unused {
            tasks.forget(key);
            tasks.changes.remove(&key);
        }
        tasks.waiting.extend(new);
    }
    tasks.start(&meshes, *when);
    for (key, numbers) in tasks.finished(*when) {
        tables.add(key, &numbers);
    }
    tables.pack();
    let found = [tables.any(), tables.any_asked()];
    if [styles.flags.sections, styles.flags.asked_sections] != found {
        [styles.flags.sections, styles.flags.asked_sections] = found;
    }
}

impl SectionTasks {
    /// A mesh has changed.
    fn change(&mut self, key: SectionKey) {
        self.forget(key);
        if key.origin == Origin::Found {
            let changes = self.changes.entry(key).or_default();
            *changes += 1;
            if *changes > MOST_CHANGES {
                self.failed.insert(key);
                return;
            }
        }
        self.waiting.insert(key);
    }

    fn forget(&mut self, key: SectionKey) {
        self.waiting.remove(&key);
        self.running.remove(&key);
        self.failed.remove(&key);
    }

    /// Begins to divide the meshes that are loaded, or divides them.
    fn start(&mut self, meshes: &Assets<Mesh>, when: MeshTasks) {
        let (running, failed, done) = (&mut self.running, &mut self.failed, &mut self.done);
        let mut unread = Vec::new();
        let mut indices = 0;
        self.waiting.retain(|key| {
            let full = running.len() >= MOST_TASKS || indices >= MOST_INDICES;
            if full && when == MeshTasks::Background {
                return true;
            }
            let Some(mesh) = meshes.get(key.mesh) else {
                return true;
            };
            indices += divide::indices_of(mesh);
            let (angle, origin) = (key.angle(), key.origin);
            match Surface::new(mesh, origin) {
                Ok(Some(surface)) if when == MeshTasks::Immediate => {
                    done.push((*key, surface.divide(angle, origin)));
                }
                Ok(Some(surface)) => {
                    let divide = async move { surface.divide(angle, origin) };
                    running.insert(*key, AsyncComputeTaskPool::get().spawn(divide));
                }
                // No triangles, or too many: no sections.
                Ok(None) => {
                    failed.insert(*key);
                }
                Err(error) => {
                    failed.insert(*key);
                    unread.push((*key, error));
                }
            }
            false
        });
        let of = |origin| unread.iter().filter(move |(key, _)| key.origin == origin);
        if let Some((key, error)) = of(Origin::Asked).next() {
            let (count, mesh) = (of(Origin::Asked).count(), key.mesh);
            warn!("no `MeshSections` for {count} meshes; the first is {mesh}: {error}");
        }
        if let Some((key, error)) = of(Origin::Found).next() {
            let mesh = key.mesh;
            info_once!(
                "some meshes have no creases at their edges, because the main world cannot read \
                 them; the first is {mesh}: {error}"
            );
        }
    }

    /// Takes the results of the tasks that are done, or waits for all.
    fn finished(&mut self, when: MeshTasks) -> Vec<(SectionKey, Numbers)> {
        let mut done = std::mem::take(&mut self.done);
        self.running.retain(|key, task| {
            let result = match when {
                MeshTasks::Background => block_on(future::poll_once(task)),
                MeshTasks::Immediate => Some(block_on(task)),
            };
            let is_running = result.is_none();
            done.extend(result.map(|numbers| (*key, numbers)));
            is_running
        });
        // Too many parts: no sections.
        let failed = &mut self.failed;
        done.retain(|(key, numbers)| {
            if numbers.is_empty() {
                failed.insert(*key);
            }
            !numbers.is_empty()
        });
        done
    }
}

pub(super) fn build(app: &mut App) {
    register::<MeshSections>(app);
    app.init_resource::<SectionTasks>()
        .init_resource::<SectionTables>()
        .init_resource::<MeshTasks>()
        .init_resource::<AllMeshes>()
        .add_systems(
            PostUpdate,
            divide_meshes
                .in_set(DivideMeshes)
                .after(AssetEventSystems)
                .after(assign_object_styles)
                .after(update_object_groups)
                .run_if(resource_exists::<Assets<Mesh>>),
        );
}

/// Notes what the device supports.
pub(super) fn finish(app: &mut App) {
    let features = app
        .get_sub_app(RenderApp)
        .and_then(|app| app.world().get_resource::<RenderDevice>())
        .map(RenderDevice::features);
    let mut tasks = app.world_mut().resource_mut::<SectionTasks>();
    tasks.supported = features.is_some_and(|f| f.contains(WgpuFeatures::PRIMITIVE_INDEX));
}
