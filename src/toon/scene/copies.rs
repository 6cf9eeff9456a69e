//! The toon copies of standard materials, which scenes with equal settings share.

use bevy::{
    ecs::system::SystemParam,
    material::OpaqueRendererMethod,
    platform::collections::{HashMap, HashSet},
    prelude::*,
};

use super::{Original, RootKey, ToonScene};
use crate::toon::{MaterialName, ToonLight, ToonMaterial, ToonShading, shading};

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
pub(in crate::toon) struct Copies {
    copies: HashMap<CopyKey, Handle<ToonMaterial>>,
    /// The different settings of all scenes, and how many scenes have them: none where a place is
    /// free.
    settings: Vec<(Settings, usize)>,
    roots: HashMap<RootKey, Root>,
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
    pub fn rewrite<'a>(&mut self, tuned: impl Iterator<Item = (RootKey, &'a ToonScene)>) {
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
    pub fn update(&mut self, root: RootKey, scene: &ToonScene) -> bool {
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

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.changed.clear();
    }

    /// Whether there are no scenes.
    pub fn is_unused(&self) -> bool {
        self.roots.is_empty()
    }

    /// Forgets a scene that is gone.
    pub fn forget(&mut self, root: RootKey) {
        if let Some(root) = self.roots.remove(&root) {
            self.leave(root.settings);
        }
    }

    /// Forgets the scenes that are gone.
    pub fn keep(&mut self, is_there: impl Fn(RootKey) -> bool) {
        let roots = self.roots.keys().copied();
        let gone: Vec<RootKey> = roots.filter(|root| !is_there(*root)).collect();
        for root in gone {
            self.forget(root);
        }
    }
}

/// Standard materials, shadings, and the copies that are made of both.
#[derive(SystemParam)]
pub(in crate::toon) struct Materials<'w> {
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
    pub fn shared(&mut self, original: &Original) -> Option<Handle<ToonMaterial>> {
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

/// Updates the copies after changes of standard materials, of shadings or of scenes.
pub(in crate::toon) fn follow_materials(
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
