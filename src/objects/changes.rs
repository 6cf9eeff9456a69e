//! The meshes whose instances in the pass of object ids have to be made anew, because something
//! has changed that the engine's own list of changes does not have.

use bevy::{
    app::SubApp,
    ecs::{
        entity::{Entity, EntityHashMap},
        lifecycle::RemovedComponents,
        query::{Changed, Or},
        resource::Resource,
        schedule::{IntoScheduleConfigs, SystemSet},
        system::{Query, ResMut},
    },
    mesh::skinning::SkinnedMesh,
    pbr::Lightmap,
    render::{
        Extract, ExtractSchedule,
        batching::NoAutomaticBatching,
        sync_world::{MainEntity, MainEntityHashSet},
    },
};

/// The meshes that changed in this frame.
#[derive(Resource, Default)]
pub(crate) struct ChangedObjects(pub MainEntityHashSet);

impl ChangedObjects {
    /// Notes the keys whose values differ.
    pub fn note<V: PartialEq>(&mut self, old: &EntityHashMap<V>, new: &EntityHashMap<V>) {
        let changed = new
            .iter()
            .filter(|(mesh, value)| old.get(*mesh) != Some(value));
        let gone = old.keys().filter(|mesh| !new.contains_key(*mesh));
        let all = changed.map(|(mesh, _)| mesh).chain(gone);
        self.0.extend(all.copied().map(MainEntity::from));
    }
}

/// A change of a component on which the draw call of a mesh depends.
type Drawn = Or<(
    Changed<Lightmap>,
    Changed<NoAutomaticBatching>,
    Changed<SkinnedMesh>,
)>;

fn note_components(
    changed: Extract<Query<Entity, Drawn>>,
    (mut lightmaps, mut batching, mut skins): (
        Extract<RemovedComponents<Lightmap>>,
        Extract<RemovedComponents<NoAutomaticBatching>>,
        Extract<RemovedComponents<SkinnedMesh>>,
    ),
    mut objects: ResMut<ChangedObjects>,
) {
    objects.0.clear();
    let removed = lightmaps.read().chain(batching.read()).chain(skins.read());
    objects
        .0
        .extend(changed.iter().chain(removed).map(MainEntity::from));
}

/// The systems that note what changed while they extract it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct NoteChanges;

pub(super) fn build(render_app: &mut SubApp) {
    render_app
        .init_resource::<ChangedObjects>()
        .add_systems(ExtractSchedule, note_components.before(NoteChanges));
}
