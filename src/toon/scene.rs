//! A component that draws a whole scene with the toon material.

use bevy::{
    app::App,
    asset::{AssetEvent, AssetId, Assets, Handle},
    ecs::{
        change_detection::{DetectChanges, Ref},
        component::Component,
        entity::{Entity, EntityHashMap, EntityHashSet},
        hierarchy::{ChildOf, Children},
        lifecycle::{Insert, Remove, RemovedComponents},
        message::MessageReader,
        observer::On,
        query::{Changed, Or, With, Without},
        reflect::ReflectComponent,
        resource::Resource,
        system::{Commands, Query, Res, ResMut, SystemParam},
    },
    material::OpaqueRendererMethod,
    pbr::{MeshMaterial3d, StandardMaterial},
    platform::collections::{HashMap, HashSet},
    reflect::{Reflect, std_traits::ReflectDefault},
};

use super::{MaterialName, ToonLight, ToonMaterial, ToonShading, ToonShadingHandle, shading};

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
/// The lighting of a mesh is that of the first of these that there is and that has loaded:
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

    /// The same with another look for the material of this name.
    #[must_use]
    pub fn with_override(
        mut self,
        name: impl Into<MaterialName>,
        shading: Handle<ToonShading>,
    ) -> Self {
        self.overrides.insert(name.into(), shading);
        self
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
    pub(super) material: Handle<StandardMaterial>,
    pub(super) root: Entity,
    pub(super) shading: Option<Handle<ToonShading>>,
}

/// What the copies of a scene have besides their standard materials and shadings.
#[derive(Clone, Debug, PartialEq)]
struct Settings {
    light: ToonLight,
    shading: Option<Handle<ToonShading>>,
}

impl Settings {
    fn of(scene: &ToonScene) -> Self {
        Self {
            light: scene.light.clone(),
            shading: scene.shading.clone(),
        }
    }
}

/// A scene as its meshes were last converted.
#[derive(PartialEq)]
struct Root {
    settings: usize,
    shading: Option<Handle<ToonShading>>,
    overrides: HashMap<MaterialName, Handle<ToonShading>>,
}

/// What a toon copy is a copy of: settings, standard material and shading.
type CopyKey = (
    usize,
    AssetId<StandardMaterial>,
    Option<AssetId<ToonShading>>,
);

/// The toon copies. Meshes with the same standard material and shading share one, also those of
/// different scenes with equal settings.
#[derive(Resource, Default)]
pub(super) struct Copies {
    copies: HashMap<CopyKey, Handle<ToonMaterial>>,
    /// The different settings of all scenes, and how many scenes have them: none where a place is
    /// free.
    settings: Vec<(Settings, usize)>,
    roots: EntityHashMap<Root>,
    /// Settings that have changed in this frame.
    changed: Vec<usize>,
}

impl Copies {
    /// The place of settings, as one more scene has them.
    fn enter(&mut self, settings: Settings) -> usize {
        let known = self.settings.iter();
        let mut known = known.enumerate().filter(|(_, (_, users))| *users > 0);
        if let Some((at, _)) = known.find(|(_, (known, _))| *known == settings) {
            self.settings[at].1 += 1;
            return at;
        }
        let free = self.settings.iter().position(|(_, users)| *users == 0);
        let at = free.unwrap_or(self.settings.len());
        if at == self.settings.len() {
            self.settings.push((settings, 1));
        } else {
            self.settings[at] = (settings, 1);
        }
        at
    }

    /// One scene fewer has the settings. Copies of settings that no scene has are dropped.
    fn leave(&mut self, at: usize) {
        let (settings, users) = &mut self.settings[at];
        *users -= 1;
        if *users == 0 {
            *settings = Settings::of(&ToonScene::default());
            self.copies.retain(|(settings, ..), _| *settings != at);
        }
    }

    /// Changes settings in place where all scenes that have them say the same new ones: so their
    /// copies only change.
    fn rewrite<'a>(&mut self, tuned: impl Iterator<Item = (Entity, &'a ToonScene)>) {
        let mut said: HashMap<usize, (Settings, usize)> = HashMap::default();
        for (root, scene) in tuned {
            if let Some(known) = self.roots.get(&root) {
                let settings = Settings::of(scene);
                let same = said.entry(known.settings).or_insert((settings.clone(), 0));
                same.1 += usize::from(same.0 == settings);
            }
        }
        for (at, (settings, scenes)) in said {
            if scenes == self.settings[at].1 && !self.is_known(&settings) {
                self.settings[at].0 = settings;
                self.changed.push(at);
            }
        }
    }

    /// Notes what a scene says; whether its meshes may have other copies now.
    fn update(&mut self, root: Entity, scene: &ToonScene) -> bool {
        let settings = Settings::of(scene);
        let before = self.roots.get(&root).map(|root| root.settings);
        let at = match before {
            Some(at) if self.settings[at].0 == settings => at,
            _ => self.enter(settings),
        };
        let new = Root {
            settings: at,
            shading: scene.shading.clone(),
            overrides: scene.overrides.clone(),
        };
        let old = self.roots.insert(root, new);
        let is_other = old.as_ref() != self.roots.get(&root);
        if let Some(before) = before.filter(|before| *before != at) {
            self.leave(before);
        }
        is_other
    }

    fn is_known(&self, settings: &Settings) -> bool {
        let mut known = self.settings.iter();
        known.any(|(known, users)| *users > 0 && known == settings)
    }

    fn forget(&mut self, root: Entity) {
        if let Some(root) = self.roots.remove(&root) {
            self.leave(root.settings);
        }
    }
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
        .add_observer(
            |on: On<Insert, MeshMaterial3d<StandardMaterial>>,
             mut changes: ResMut<SceneChanges>| {
                changes.subtrees.insert(on.entity);
            },
        )
        .add_observer(
            |on: On<Insert, ChildOf>, mut changes: ResMut<SceneChanges>| {
                changes.subtrees.insert(on.entity);
            },
        )
        .add_observer(
            |on: On<Remove, ChildOf>, mut changes: ResMut<SceneChanges>| {
                changes.subtrees.insert(on.entity);
            },
        )
        .add_observer(
            |on: On<Remove, ToonScene>, mut changes: ResMut<SceneChanges>| {
                changes.subtrees.insert(on.entity);
            },
        );
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
    copies.changed.clear();
    if scenes.is_empty() && copies.roots.is_empty() {
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

/// Standard materials, shadings, and the copies that are made of both.
#[derive(SystemParam)]
pub(super) struct Materials<'w> {
    standard: Res<'w, Assets<StandardMaterial>>,
    shadings: Option<Res<'w, Assets<ToonShading>>>,
    toon: ResMut<'w, Assets<ToonMaterial>>,
    copies: ResMut<'w, Copies>,
}

impl Materials<'_> {
    /// What a copy is, if its standard material has loaded.
    fn copy(&self, key: CopyKey) -> Option<ToonMaterial> {
        let (settings, original, shading) = key;
        let settings = &self.copies.settings[settings].0;
        let shadings = self.shadings.as_ref();
        let loaded = [shading, settings.shading.as_ref().map(Handle::id)]
            .into_iter()
            .flatten()
            .find_map(|shading| shadings.and_then(|shadings| shadings.get(shading)));
        Some(ToonMaterial {
            base: StandardMaterial {
                opaque_render_method: OpaqueRendererMethod::Forward,
                ..self.standard.get(original)?.clone()
            },
            extension: loaded.map_or_else(
                || settings.light.clone(),
                |shading| shading.with_maps_of(&settings.light),
            ),
        })
    }

    /// The shared copy, which is made if it is not there.
    fn shared(&mut self, original: &Original) -> Option<Handle<ToonMaterial>> {
        let settings = self.copies.roots.get(&original.root)?.settings;
        let shading = original.shading.as_ref().map(Handle::id);
        let key = (settings, original.material.id(), shading);
        if let Some(handle) = self.copies.copies.get(&key) {
            return Some(handle.clone());
        }
        let copy = self.copy(key)?;
        let handle = self.toon.add(copy);
        self.copies.copies.insert(key, handle.clone());
        Some(handle)
    }
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

/// The materials of a mesh.
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

/// Updates the copies after changes of standard materials, of shadings or of scenes.
pub(super) fn follow_materials(
    mut standard: MessageReader<AssetEvent<StandardMaterial>>,
    mut shadings: MessageReader<AssetEvent<ToonShading>>,
    mut materials: Materials,
) {
    let (mut modified, mut removed) = (HashSet::new(), HashSet::new());
    for event in standard.read() {
        match event {
            AssetEvent::Modified { id } => modified.insert(*id),
            AssetEvent::Removed { id } => removed.insert(*id),
            _ => false,
        };
    }
    if !removed.is_empty() {
        // No mesh has them any more.
        (materials.copies.copies).retain(|(_, original, _), _| !removed.contains(original));
    }
    let shadings: HashSet<_> = shadings.read().filter_map(shading::changed).collect();
    let Copies {
        copies,
        settings,
        changed,
        ..
    } = &*materials.copies;
    if modified.is_empty() && shadings.is_empty() && changed.is_empty() {
        return;
    }
    let is_changed =
        |shading: Option<AssetId<ToonShading>>| shading.is_some_and(|id| shadings.contains(&id));
    let follows = |(at, original, shading): CopyKey| {
        changed.contains(&at)
            || modified.contains(&original)
            || is_changed(shading)
            || is_changed(settings[at].0.shading.as_ref().map(Handle::id))
    };
    // Also those that no mesh has at the moment: one may have them again.
    let copies = copies.iter().filter(|(key, _)| follows(**key));
    let copies: Vec<_> = copies.map(|(key, copy)| (*key, copy.clone())).collect();
    for (key, handle) in copies {
        if let Some(copy) = materials.copy(key)
            && let Some(mut material) = materials.toon.get_mut(&handle)
        {
            *material = copy;
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
