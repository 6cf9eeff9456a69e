//! The meshes whose instances in the pass of object ids have to be made anew, because something
//! has changed that the engine's own list of changes does not have.

use bevy::{
    ecs::component::Mutable,
    mesh::skinning::SkinnedMesh,
    pbr::Lightmap,
    prelude::*,
    render::{
        Extract,
        batching::NoAutomaticBatching,
        sync_world::{MainEntity, MainEntityHashSet},
    },
};

/// The meshes that changed in this frame.
#[derive(Resource, Default)]
pub(crate) struct ChangedObjects(pub MainEntityHashSet);

/// A resource of the main world of which the render world has a copy.
pub(super) trait Follow: Resource<Mutability = Mutable> {
    /// Makes this a copy of `main`, and notes the meshes that differ.
    fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet);
}

pub(super) fn follow<R: Follow>(
    main: Extract<Res<R>>,
    mut copy: ResMut<R>,
    mut changed: ResMut<ChangedObjects>,
) {
    copy.follow(&main, &mut changed.0);
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
