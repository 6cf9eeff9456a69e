//! A component that draws a whole scene with the toon material.

use bevy::{
    asset::{AssetEvent, AssetId, Assets, Handle},
    ecs::{
        change_detection::{DetectChanges, Ref},
        component::Component,
        entity::Entity,
        hierarchy::ChildOf,
        lifecycle::RemovedComponents,
        message::MessageReader,
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
#[derive(Component)]
pub(super) struct Original {
    pub(super) material: Handle<StandardMaterial>,
    pub(super) root: Entity,
    pub(super) shading: Option<Handle<ToonShading>>,
}

/// What a toon copy is a copy of: root, standard material and shading.
type CopyKey = (
    Entity,
    AssetId<StandardMaterial>,
    Option<AssetId<ToonShading>>,
);

/// The toon copies, so that meshes with the same material and shading share one.
#[derive(Resource, Default)]
pub(super) struct Copies(HashMap<CopyKey, Handle<ToonMaterial>>);

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

    fn get(&self, root: Entity) -> Option<Ref<'_, ToonScene>> {
        self.roots.get(root).ok().map(|(_, scene)| scene)
    }

    pub(super) fn any_has_overrides(&self) -> bool {
        self.roots.iter().any(|(_, s)| !s.overrides.is_empty())
    }
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
    fn copy(&self, key: CopyKey, scene: &ToonScene) -> Option<ToonMaterial> {
        let (_, original, shading) = key;
        let shadings = self.shadings.as_ref();
        let loaded = [shading, scene.shading.as_ref().map(Handle::id)]
            .into_iter()
            .flatten()
            .find_map(|shading| shadings.and_then(|shadings| shadings.get(shading)));
        Some(ToonMaterial {
            base: StandardMaterial {
                opaque_render_method: OpaqueRendererMethod::Forward,
                ..self.standard.get(original)?.clone()
            },
            extension: loaded.map_or_else(
                || scene.light.clone(),
                |shading| shading.with_maps_of(&scene.light),
            ),
        })
    }

    /// The shared copy, which is made if it is not there.
    fn shared(&mut self, original: &Original, scene: &ToonScene) -> Option<Handle<ToonMaterial>> {
        let shading = original.shading.as_ref().map(Handle::id);
        let key = (original.root, original.material.id(), shading);
        if let Some(handle) = self.copies.0.get(&key) {
            return Some(handle.clone());
        }
        let copy = self.copy(key, scene)?;
        let handle = self.toon.add(copy);
        self.copies.0.insert(key, handle.clone());
        Some(handle)
    }
}

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

/// What determines the shading of a mesh.
type Said = (
    Option<&'static ToonShadingHandle>,
    Option<&'static MaterialName>,
);

/// Converts the meshes below a root that have a standard material.
pub(super) fn convert(
    mut commands: Commands,
    roots: SceneRoots,
    meshes: Query<(Entity, &MeshMaterial3d<StandardMaterial>, Said)>,
    mut materials: Materials,
) {
    if roots.roots.is_empty() {
        if !materials.copies.0.is_empty() {
            materials.copies.0.clear();
        }
        return;
    }
    // The copies of a root are kept as long as the root exists.
    (materials.copies.0).retain(|(root, ..), _| roots.roots.contains(*root));
    for (entity, material, (own, name)) in &meshes {
        let Some((root, scene)) = roots.nearest(entity) else {
            continue;
        };
        let original = Original {
            material: material.0.clone(),
            root,
            shading: choose(&scene, own, name),
        };
        if let Some(handle) = materials.shared(&original, &scene) {
            commands
                .entity(entity)
                .remove::<MeshMaterial3d<StandardMaterial>>()
                .insert((MeshMaterial3d(handle), original));
        }
    }
}

/// Restores the standard material of meshes whose nearest root has changed.
pub(super) fn restore(
    mut commands: Commands,
    mut removed: RemovedComponents<ToonScene>,
    roots: SceneRoots,
    moved: Query<(), Changed<ChildOf>>,
    converted: Query<(Entity, &Original), With<MeshMaterial3d<ToonMaterial>>>,
) {
    let root_gone = removed.read().count() > 0;
    let root_new = roots.roots.iter().any(|(_, scene)| scene.is_added());
    if !root_gone && !root_new && moved.is_empty() {
        return;
    }
    for (entity, original) in &converted {
        let nearest = roots.nearest(entity).map(|(root, _)| root);
        if nearest != Some(original.root) {
            commands
                .entity(entity)
                .remove::<(MeshMaterial3d<ToonMaterial>, Original)>()
                .insert(MeshMaterial3d(original.material.clone()));
        }
    }
}

/// Changes of what determines the shading of a mesh.
#[derive(SystemParam)]
pub(super) struct SaidChanges<'w, 's> {
    changed: Query<
        'w,
        's,
        (),
        (
            With<Original>,
            Or<(Changed<ToonShadingHandle>, Changed<MaterialName>)>,
        ),
    >,
    removed_shadings: RemovedComponents<'w, 's, ToonShadingHandle>,
    removed_names: RemovedComponents<'w, 's, MaterialName>,
}

impl SaidChanges<'_, '_> {
    fn any(&mut self) -> bool {
        let removed = self.removed_shadings.read().count() + self.removed_names.read().count();
        removed > 0 || !self.changed.is_empty()
    }
}

/// Chooses the shadings of converted meshes again, after changes of what says them.
pub(super) fn choose_again(
    mut commands: Commands,
    mut changes: SaidChanges,
    roots: SceneRoots,
    converted: Query<(Entity, &Original, Said)>,
    mut materials: Materials,
) {
    let any = changes.any();
    let is_tuned = |scene: &Ref<ToonScene>| scene.is_changed() && !scene.is_added();
    if !any && !roots.roots.iter().any(|(_, scene)| is_tuned(&scene)) {
        return;
    }
    for (entity, original, (own, name)) in &converted {
        let Some(scene) = roots.get(original.root) else {
            continue;
        };
        let shading = choose(&scene, own, name);
        if shading == original.shading {
            continue;
        }
        let chosen = Original {
            material: original.material.clone(),
            root: original.root,
            shading,
        };
        if let Some(handle) = materials.shared(&chosen, &scene) {
            commands
                .entity(entity)
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

/// Updates the copies after changes of standard materials, of shadings or of a root's settings.
pub(super) fn follow_materials(
    mut standard: MessageReader<AssetEvent<StandardMaterial>>,
    mut shadings: MessageReader<AssetEvent<ToonShading>>,
    roots: SceneRoots,
    mut materials: Materials,
) {
    let standard = standard.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    });
    let standard: HashSet<_> = standard.collect();
    let shadings: HashSet<_> = shadings.read().filter_map(shading::changed).collect();
    let tuned = roots.roots.iter().any(|(_, scene)| scene.is_changed());
    if standard.is_empty() && shadings.is_empty() && !tuned {
        return;
    }
    // Also those that no mesh has at the moment: one may have them again.
    let copies = materials
        .copies
        .0
        .iter()
        .map(|(key, copy)| (*key, copy.clone()));
    for (key, handle) in copies.collect::<Vec<_>>() {
        let (root, original, shading) = key;
        let Some(scene) = roots.get(root) else {
            continue;
        };
        let is_changed = |shading: Option<AssetId<ToonShading>>| {
            shading.is_some_and(|id| shadings.contains(&id))
        };
        let follows = scene.is_changed()
            || standard.contains(&original)
            || is_changed(shading)
            || is_changed(scene.shading.as_ref().map(Handle::id));
        if follows
            && let Some(copy) = materials.copy(key, &scene)
            && let Some(mut material) = materials.toon.get_mut(&handle)
        {
            *material = copy;
        }
    }
}
