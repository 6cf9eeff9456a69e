//! A component that draws a whole scene with the toon material.

mod copies;

use bevy::{
    ecs::{entity::EntityHashSet, system::SystemParam},
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::{MaterialName, ToonLight, ToonMaterial, ToonShading, ToonShadingHandle, shading};
use copies::{Copies, Materials};

pub(super) use copies::follow_materials;

/// Draws an entity and all its descendants with [`ToonMaterial`]. Put it on the
/// root of a glTF scene, for example.
///
/// Every `MeshMaterial3d<StandardMaterial>` on these entities is replaced by a
/// toon copy of its material, also on entities that are spawned later. The copy
/// follows changes of the standard material, of this component and of its shadings. Removing the
/// component restores the standard materials. If several ancestors of an entity have
/// the component, the nearest one applies.
///
/// Scenes with equal settings share copies, so that their meshes are drawn together: an edit of the
/// `ToonMaterial` of one mesh is an edit of all. A [`ToonShadingHandle`] changes one mesh alone.
///
/// A mesh uses the first of these that exists and has loaded:
///
/// 1. the [`ToonShadingHandle`] of the mesh;
/// 2. the shading of its material's name in [`overrides`](Self::overrides);
/// 3. [`shading`](Self::shading);
/// 4. [`light`](Self::light).
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ToonScene {
    /// Lighting of the materials without a shading. Default: [`ToonLight::default`].
    pub light: ToonLight,
    /// Lighting from a file, in place of `light`. Default: `None`.
    pub shading: Option<Handle<ToonShading>>,
    /// Shadings of single materials, by their names in the glTF file, or by the [`MaterialName`] of
    /// the meshes. Default: none.
    pub overrides: HashMap<MaterialName, Handle<ToonShading>>,
}

impl ToonScene {
    /// A scene with this lighting.
    #[must_use]
    pub fn new(light: ToonLight) -> Self {
        Self {
            light,
            ..Self::default()
        }
    }

    /// A scene with lighting from a file.
    #[must_use]
    pub fn with_shading(self, shading: Handle<ToonShading>) -> Self {
        Self {
            shading: Some(shading),
            ..self
        }
    }

    /// The same scene with this shading for the material of this name.
    #[must_use]
    pub fn with_override(
        mut self,
        name: impl Into<MaterialName>,
        shading: Handle<ToonShading>,
    ) -> Self {
        self.overrides.insert(name.into(), shading);
        self
    }

    /// Where the toon material of a mesh comes from: the entity with the `ToonScene`, the standard
    /// material that the scene has replaced, and the shading that it has chosen for the mesh, loaded
    /// or not. `None` if no scene draws the mesh. Edits of the standard material stay; those of the
    /// toon copy are lost when the scene writes it again.
    pub fn original<'w>(
        mesh: EntityRef<'w>,
    ) -> Option<(
        Entity,
        &'w Handle<StandardMaterial>,
        Option<&'w Handle<ToonShading>>,
    )> {
        let original = mesh.get::<Original>()?;
        let shading = original.shading.as_ref();
        Some((original.root, &original.material, shading))
    }

    /// The shading of the scene for a name.
    fn shading_of(&self, name: Option<&MaterialName>) -> Option<&Handle<ToonShading>> {
        name.and_then(|name| self.overrides.get(name))
            .or(self.shading.as_ref())
    }
}

/// On a converted mesh: its standard material, the root that converted it, and the shading that was
/// chosen for it.
#[derive(Component, PartialEq)]
pub(super) struct Original {
    material: Handle<StandardMaterial>,
    root: Entity,
    shading: Option<Handle<ToonShading>>,
}

/// What may have another material than before.
#[derive(Resource, Default)]
pub(super) struct SceneChanges {
    /// Entities, with all of their descendants.
    subtrees: EntityHashSet,
    /// Meshes whose standard material has not loaded.
    waiting: EntityHashSet,
    /// The meshes among all these, in this frame.
    pub(super) meshes: Vec<Entity>,
}

/// Notes changes. Without any, a frame does nothing for each mesh.
pub(super) fn build(app: &mut App) {
    app.init_resource::<Copies>()
        .init_resource::<SceneChanges>()
        .add_observer(note::<Insert, MeshMaterial3d<StandardMaterial>>)
        .add_observer(note::<Insert, ChildOf>)
        .add_observer(note::<Remove, ChildOf>)
        .add_observer(note::<Remove, ToonScene>);
}

fn note<E: EntityEvent, B: Bundle>(on: On<E, B>, mut changes: ResMut<SceneChanges>) {
    changes.subtrees.insert(on.event_target());
}

/// The scenes, and the way to them.
#[derive(SystemParam)]
pub(super) struct SceneRoots<'w, 's> {
    roots: Query<'w, 's, (Entity, Ref<'static, ToonScene>)>,
    parents: Query<'w, 's, &'static ChildOf>,
}

impl SceneRoots<'_, '_> {
    /// The nearest entity with a [`ToonScene`] among an entity and its ancestors.
    pub(super) fn nearest(&self, entity: Entity) -> Option<(Entity, Ref<'_, ToonScene>)> {
        let above = self.parents.iter_ancestors(entity);
        std::iter::once(entity)
            .chain(above)
            .find_map(|e| self.roots.get(e).ok())
    }

    pub(super) fn any_has_overrides(&self) -> bool {
        self.roots.iter().any(|(_, s)| !s.overrides.is_empty())
    }
}

/// Notes the settings of scenes that changed, and finds the meshes that may have another material.
pub(super) fn find_meshes(
    tuned: Query<(Entity, &ToonScene), Changed<ToonScene>>,
    scenes: Query<(), With<ToonScene>>,
    mut removed: RemovedComponents<ToonScene>,
    children: Query<&Children>,
    meshes: Query<(), Or<(With<MeshMaterial3d<StandardMaterial>>, With<Original>)>>,
    (mut copies, mut changes): (ResMut<Copies>, ResMut<SceneChanges>),
) {
    let changes = &mut *changes;
    changes.meshes.clear();
    copies.begin();
    if scenes.is_empty() && copies.is_unused() {
        changes.subtrees.clear();
        return;
    }
    for root in removed.read().filter(|root| !scenes.contains(*root)) {
        copies.forget(root);
    }
    copies.rewrite(tuned.iter());
    for (root, scene) in &tuned {
        if copies.update(root, scene) {
            changes.subtrees.insert(root);
        }
    }
    let mut below: Vec<Entity> = changes.subtrees.drain().collect();
    let mut visited = EntityHashSet::default();
    while let Some(entity) = below.pop() {
        if visited.insert(entity) {
            below.extend(children.get(entity).into_iter().flatten());
        }
    }
    visited.extend(changes.waiting.drain());
    changes
        .meshes
        .extend(visited.into_iter().filter(|mesh| meshes.contains(*mesh)));
}

/// What determines the shading of a mesh.
type Said = (
    Option<&'static ToonShadingHandle>,
    Option<&'static MaterialName>,
);

/// The shading of a mesh: its own, or what the scene says for its name.
fn choose(
    scene: &ToonScene,
    own: Option<&ToonShadingHandle>,
    name: Option<&MaterialName>,
) -> Option<Handle<ToonShading>> {
    own.map(|own| &own.0)
        .or_else(|| scene.shading_of(name))
        .cloned()
}

type Dressed = (
    Option<&'static MeshMaterial3d<StandardMaterial>>,
    Option<&'static MeshMaterial3d<ToonMaterial>>,
    Option<&'static Original>,
);

/// Converted meshes whose shading may be another one now.
#[derive(SystemParam)]
pub(super) struct SaidChanges<'w, 's> {
    changed: Query<
        'w,
        's,
        Entity,
        (
            With<Original>,
            Or<(Changed<ToonShadingHandle>, Changed<MaterialName>)>,
        ),
    >,
    removed_shadings: RemovedComponents<'w, 's, ToonShadingHandle>,
    removed_names: RemovedComponents<'w, 's, MaterialName>,
}

impl SaidChanges<'_, '_> {
    fn meshes(&mut self) -> impl Iterator<Item = Entity> {
        let removed = self
            .removed_shadings
            .read()
            .chain(self.removed_names.read());
        self.changed.iter().chain(removed)
    }
}

/// Gives meshes below a scene their toon copies, and others their standard materials.
pub(super) fn convert(
    mut commands: Commands,
    mut changes: ResMut<SceneChanges>,
    mut said: SaidChanges,
    roots: SceneRoots,
    meshes: Query<(Dressed, Said)>,
    mut materials: Materials,
) {
    let mut found = std::mem::take(&mut changes.meshes);
    found.extend(said.meshes());
    for entity in found {
        let Ok(((standard, toon, original), (own, name))) = meshes.get(entity) else {
            continue;
        };
        let standard = standard.map(|material| &material.0);
        let Some(source) = standard.or(original.map(|original| &original.material)) else {
            continue;
        };
        let mut mesh = commands.entity(entity);
        let Some((root, scene)) = roots.nearest(entity) else {
            if original.is_some() {
                mesh.remove::<(MeshMaterial3d<ToonMaterial>, Original)>()
                    .insert(MeshMaterial3d(source.clone()));
            }
            continue;
        };
        let chosen = Original {
            material: source.clone(),
            root,
            shading: choose(&scene, own, name),
        };
        let Some(handle) = materials.shared(&chosen) else {
            changes.waiting.insert(entity);
            continue;
        };
        let is_done = standard.is_none()
            && original == Some(&chosen)
            && toon.is_some_and(|toon| toon.0 == handle);
        if !is_done {
            mesh.remove::<MeshMaterial3d<StandardMaterial>>()
                .insert((MeshMaterial3d(handle), chosen));
        }
    }
}

/// Gives the materials of single meshes their shadings. A [`ToonScene`] does
/// it for its own copies.
pub(super) fn apply_shadings(
    meshes: Query<(Ref<ToonShadingHandle>, Ref<MeshMaterial3d<ToonMaterial>>), Without<Original>>,
    mut events: MessageReader<AssetEvent<ToonShading>>,
    shadings: Res<Assets<ToonShading>>,
    mut materials: ResMut<Assets<ToonMaterial>>,
) {
    let changed: HashSet<_> = events.read().filter_map(shading::changed).collect();
    for (handle, material) in &meshes {
        let id = handle.0.id();
        if !handle.is_changed() && !material.is_changed() && !changed.contains(&id) {
            continue;
        }
        let Some(shading) = shadings.get(id) else {
            continue;
        };
        let Some(before) = materials.get(&material.0) else {
            continue;
        };
        let light = shading.with_maps_of(&before.extension);
        if before.extension != light
            && let Some(mut material) = materials.get_mut(&material.0)
        {
            material.extension = light;
        }
    }
}

#[cfg(test)]
mod tests;
