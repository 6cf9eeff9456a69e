//! A component that draws a whole scene with the toon material.

#[cfg(feature = "objects")]
mod added;
mod cameras;
mod copies;

use std::borrow::Cow;

use bevy::{
    camera::visibility::RenderLayers,
    ecs::{entity::EntityHashSet, system::SystemParam},
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::{
    MaterialName, StyleScene, ToonLight, ToonMaterial, ToonShading, ToonShadingHandle, shading,
};
use cameras::{CameraScenes, StyledCamera, StyledCameras};
use copies::{Copies, Materials};

#[cfg(feature = "objects")]
pub use added::AddedByStyle;
#[cfg(feature = "objects")]
pub(super) use added::add_components;
pub(crate) use cameras::CameraScene;
pub(super) use cameras::warn_of_missing_shadows;
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

    /// Where the toon material of a mesh comes from: the entity with the `ToonScene`, or the camera
    /// with the [`Comic`](crate::Comic); the standard material that was replaced; and the shading
    /// that was chosen for the mesh, loaded or not. `None` if neither lights the mesh. Edits of the
    /// standard material stay; those of the toon copy are lost when it is written again.
    pub fn original<'w>(
        mesh: EntityRef<'w>,
    ) -> Option<(
        Entity,
        &'w Handle<StandardMaterial>,
        Option<&'w Handle<ToonShading>>,
    )> {
        let original = mesh.get::<Original>()?;
        let shading = original.shading.as_ref();
        Some((original.root.0, &original.material, shading))
    }

    /// The shading of the scene for a name.
    fn shading_of(&self, name: Option<&MaterialName>) -> Option<&Handle<ToonShading>> {
        name.and_then(|name| self.overrides.get(name))
            .or(self.shading.as_ref())
    }
}

/// A light: an entity with a [`ToonScene`], with 0; or a camera with a [`CameraScene`], with 1 for
/// the light of the scene, and more for those of its parts.
type RootKey = (Entity, usize);

/// On a converted mesh: its standard material, the light that it was converted for, and the shading
/// that was chosen for it.
#[derive(Component, PartialEq)]
pub(super) struct Original {
    material: Handle<StandardMaterial>,
    root: RootKey,
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
    /// Whether these are all meshes, as cameras have changed.
    all: bool,
}

/// Notes changes. Without any, a frame does nothing for each mesh.
pub(super) fn build(app: &mut App) {
    app.init_resource::<Copies>()
        .init_resource::<StyledCameras>()
        .init_resource::<SceneChanges>()
        .add_observer(note::<Insert, MeshMaterial3d<StandardMaterial>>)
        .add_observer(note::<Insert, ChildOf>)
        .add_observer(note::<Remove, ChildOf>)
        .add_observer(note::<Remove, ToonScene>);
}

fn note<E: EntityEvent, B: Bundle>(on: On<E, B>, mut changes: ResMut<SceneChanges>) {
    changes.subtrees.insert(on.event_target());
}

/// The most entities in a row of parents that are looked at.
const DEEPEST: usize = 65_536;

/// What lights meshes, and the way to it.
#[derive(SystemParam)]
pub(super) struct SceneRoots<'w, 's> {
    roots: Query<'w, 's, (Entity, &'static ToonScene)>,
    parents: Query<'w, 's, &'static ChildOf>,
    layers: Query<'w, 's, &'static RenderLayers>,
    cameras: Query<'w, 's, &'static CameraScene>,
    styled: Res<'w, StyledCameras>,
}

/// The settings of what lights a mesh.
pub(super) enum LitBy<'a> {
    Scene(&'a ToonScene),
    Camera(&'a StyleScene),
}

impl LitBy<'_> {
    /// Whether they differ by the names of materials.
    pub(super) fn reads_names(&self) -> bool {
        match self {
            Self::Scene(scene) => !scene.overrides.is_empty(),
            Self::Camera(scene) => !scene.parts.is_empty(),
        }
    }

    /// The shading of a mesh: its own, or what the scene says for its name.
    fn shading(
        &self,
        own: Option<&ToonShadingHandle>,
        name: Option<&MaterialName>,
    ) -> Option<Handle<ToonShading>> {
        let named = || match self {
            Self::Scene(scene) => scene.shading_of(name),
            Self::Camera(_) => None,
        };
        own.map(|own| &own.0).or_else(named).cloned()
    }
}

impl SceneRoots<'_, '_> {
    /// What lights a mesh: the nearest entity with a [`ToonScene`] among it and its ancestors, else
    /// the first camera whose style includes it, by the name of its material.
    pub(super) fn of(
        &self,
        mesh: Entity,
        name: Option<&MaterialName>,
    ) -> Option<(RootKey, LitBy<'_>)> {
        let nearest = self.way_up(mesh).find_map(|e| self.roots.get(e).ok());
        if let Some((root, scene)) = nearest {
            return Some(((root, 0), LitBy::Scene(scene)));
        }
        let mut lighting = self.lighting(mesh).map(|(_, styled)| styled);
        let first = lighting.next()?;
        let camera = first.camera;
        let scene = self.scene_of(camera)?;
        let mut others = lighting.map(|styled| styled.camera);
        if let Some(other) = others.find(|other| self.scene_of(*other) != Some(scene)) {
            warn_once!(
                "the styles of {camera} and {other} light the same meshes: that of {camera} applies, \
                 which comes first by `Camera::order`, then by entity"
            );
        }
        let light = 1 + first.part_of(name);
        Some(((camera, light), LitBy::Camera(scene)))
    }

    /// The cameras whose styles include a mesh, and their indices. The first one decides.
    fn lighting(&self, mesh: Entity) -> impl Iterator<Item = (usize, &StyledCamera)> {
        let layers = self.layers.get(mesh).ok().unwrap_or_default();
        let styled = self.styled.0.iter().enumerate();
        styled.filter(move |(_, styled)| styled.lights(layers, self.way_up(mesh)))
    }

    /// An entity and those above it. Parents in a circle, which the engine does not prevent, end.
    fn way_up(&self, entity: Entity) -> impl Iterator<Item = Entity> {
        let above = self.parents.iter_ancestors(entity);
        std::iter::once(entity).chain(above).take(DEEPEST)
    }

    fn scene_of(&self, camera: Entity) -> Option<&StyleScene> {
        self.cameras.get(camera).ok().map(|scene| &scene.0)
    }

    pub(super) fn any_reads_names(&self) -> bool {
        let scenes = self.roots.iter().map(|(_, scene)| LitBy::Scene(scene));
        let cameras = self.cameras.iter().map(|scene| LitBy::Camera(&scene.0));
        scenes.chain(cameras).any(|lit_by| lit_by.reads_names())
    }
}

/// Notes the settings of scenes and cameras that changed, and finds the meshes that may have another
/// material.
pub(super) fn find_meshes(
    tuned: Query<(Entity, &ToonScene), Changed<ToonScene>>,
    scenes: Query<(), With<ToonScene>>,
    mut removed: RemovedComponents<ToonScene>,
    mut cameras: CameraScenes,
    children: Query<&Children>,
    meshes: Query<Entity, Or<(With<MeshMaterial3d<StandardMaterial>>, With<Original>)>>,
    (mut copies, mut changes): (ResMut<Copies>, ResMut<SceneChanges>),
) {
    let changes = &mut *changes;
    changes.meshes.clear();
    changes.all = false;
    copies.begin();
    let mut all = cameras.update();
    if scenes.is_empty() && cameras.is_empty() && copies.is_unused() {
        changes.subtrees.clear();
        return;
    }
    for root in removed.read().filter(|root| !scenes.contains(*root)) {
        copies.forget((root, 0));
    }
    if all {
        copies.keep(|root| root.1 == 0 || cameras.has(root));
    }
    let of_scenes = tuned
        .iter()
        .map(|(root, scene)| ((root, 0), Cow::Borrowed(scene)));
    let of_cameras = cameras
        .lights(all)
        .into_iter()
        .map(|(root, scene)| (root, Cow::Owned(scene)));
    let lights: Vec<(RootKey, Cow<ToonScene>)> = of_scenes.chain(of_cameras).collect();
    copies.rewrite(lights.iter().map(|(root, scene)| (*root, &**scene)));
    for (root, scene) in &lights {
        if copies.update(*root, scene) {
            match root {
                (scene, 0) => {
                    changes.subtrees.insert(*scene);
                }
                _ => all = true,
            }
        }
    }
    if all {
        changes.all = true;
        changes.subtrees.clear();
        changes.waiting.clear();
        changes.meshes.extend(&meshes);
        return;
    }
    let mut below: Vec<Entity> = changes.subtrees.drain().collect();
    let mut visited = EntityHashSet::default();
    while let Some(entity) = below.pop() {
        if visited.insert(entity) {
            below.extend(children.get(entity).into_iter().flatten());
        }
    }
    visited.extend(changes.waiting.drain());
    if !cameras.is_empty() {
        visited.extend(cameras.moved());
    }
    changes
        .meshes
        .extend(visited.into_iter().filter(|mesh| meshes.contains(*mesh)));
}

/// What determines the shading of a mesh.
type Said = (
    Option<&'static ToonShadingHandle>,
    Option<&'static MaterialName>,
);

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

/// Gives meshes that are lit their toon copies, and others their standard materials.
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
        let Some((root, lit_by)) = roots.of(entity, name) else {
            if original.is_some() {
                mesh.remove::<(MeshMaterial3d<ToonMaterial>, Original)>()
                    .insert(MeshMaterial3d(source.clone()));
            }
            continue;
        };
        let chosen = Original {
            material: source.clone(),
            root,
            shading: lit_by.shading(own, name),
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
