//! Cameras whose style lights the meshes that they see.

use bevy::{camera::visibility::RenderLayers, ecs::system::SystemParam, prelude::*};

use super::{Original, RootKey, ToonScene};
use crate::toon::{MaterialName, StyleScene, StyleScope};

/// On a camera with a [`Comic`](crate::Comic): what its style does to meshes.
#[derive(Component, Clone, Debug, PartialEq)]
#[component(clone_behavior = Ignore)]
pub(crate) struct CameraScene(pub StyleScene);

/// A camera that lights meshes.
pub(super) struct StyledCamera {
    pub camera: Entity,
    order: isize,
    layers: RenderLayers,
    scope: StyleScope,
    /// Those of the parts of its scene.
    names: Vec<String>,
    /// The same in lower case, as names of materials are compared with them.
    patterns: Vec<String>,
    /// What it adds to meshes: sections of this angle, and an anchor of patterns.
    pub adds: (Option<f32>, bool),
}

type Found<'a> = (
    Entity,
    Ref<'a, CameraScene>,
    &'a Camera,
    (Option<&'a RenderLayers>, Option<&'a StyleScope>),
);

impl StyledCamera {
    fn new((camera, scene, settings, (layers, scope)): &Found) -> Self {
        Self {
            camera: *camera,
            order: settings.order,
            layers: layers.unwrap_or_default().clone(),
            scope: scope.cloned().unwrap_or_default(),
            names: scene.0.names().map(str::to_owned).collect(),
            patterns: scene.0.names().map(str::to_lowercase).collect(),
            adds: (scene.0.angle(), scene.0.screens),
        }
    }

    /// Whether it lights the same meshes as before.
    fn is(&self, (camera, scene, settings, (layers, scope)): &Found) -> bool {
        self.camera == *camera
            && self.order == settings.order
            && self.layers == *layers.unwrap_or_default()
            && self.scope == *scope.unwrap_or(&StyleScope::Layers)
            && self.adds == (scene.0.angle(), scene.0.screens)
            && scene.0.names().eq(self.names.iter().map(String::as_str))
    }

    /// Whether it lights a mesh on these layers. `way_up`: the mesh and the entities above it.
    pub fn lights(&self, layers: &RenderLayers, mut way_up: impl Iterator<Item = Entity>) -> bool {
        match &self.scope {
            StyleScope::Layers => self.layers.intersects(layers),
            StyleScope::Roots(roots) => way_up.any(|entity| roots.contains(&entity)),
            StyleScope::CameraOnly => false,
        }
    }

    /// The entity that its style adds components to, for a mesh that it lights.
    #[cfg(feature = "objects")]
    pub fn top(&self, mut way_up: impl Iterator<Item = Entity>) -> Option<Entity> {
        match &self.scope {
            StyleScope::Roots(roots) => way_up.find(|entity| roots.contains(entity)),
            _ => way_up.last(),
        }
    }

    /// The part of its scene that lights a material, from 1; 0 if none does.
    pub fn part_of(&self, name: Option<&MaterialName>) -> usize {
        StyleScene::part_of(&self.patterns, name)
    }
}

/// The active cameras that light meshes, as meshes were last converted for them. The first one that
/// lights a mesh decides.
#[derive(Resource, Default)]
pub(super) struct StyledCameras(pub Vec<StyledCamera>);

/// What cameras light, and how that changes.
#[derive(SystemParam)]
pub(in crate::toon) struct CameraScenes<'w, 's> {
    cameras: Query<
        'w,
        's,
        (
            Entity,
            Ref<'static, CameraScene>,
            &'static Camera,
            (Option<&'static RenderLayers>, Option<&'static StyleScope>),
        ),
    >,
    styled: ResMut<'w, StyledCameras>,
    on_other_layers: Query<
        'w,
        's,
        Entity,
        (
            Changed<RenderLayers>,
            Or<(With<MeshMaterial3d<StandardMaterial>>, With<Original>)>,
        ),
    >,
    on_default_layers: RemovedComponents<'w, 's, RenderLayers>,
}

impl CameraScenes<'_, '_> {
    /// Notes the cameras. Returns whether any mesh may be lit by another one than before.
    pub fn update(&mut self) -> bool {
        let cameras = self.cameras.iter().filter(|(.., camera, (_, scope))| {
            camera.is_active && *scope != Some(&StyleScope::CameraOnly)
        });
        let mut found: Vec<Found> = cameras.collect();
        found.sort_by_key(|(entity, _, camera, _)| (camera.order, *entity));
        let known = &self.styled.0;
        let is_same = known.len() == found.len()
            && (known.iter().zip(&found)).all(|(known, found)| known.is(found));
        if !is_same {
            self.styled.0 = found.iter().map(StyledCamera::new).collect();
        }
        !is_same
    }

    pub fn is_empty(&self) -> bool {
        self.styled.0.is_empty()
    }

    /// Whether a light is that of a camera.
    pub fn has(&self, (root, light): RootKey) -> bool {
        let mut styled = self.styled.0.iter();
        styled.any(|camera| camera.camera == root && light <= camera.names.len() + 1)
    }

    /// The lights that have changed, or all of them, as those of scenes.
    pub fn lights(&self, all: bool) -> Vec<(RootKey, ToonScene)> {
        let mut lights = Vec::new();
        for StyledCamera { camera, .. } in &self.styled.0 {
            if let Ok((_, scene, ..)) = self.cameras.get(*camera)
                && (all || scene.is_changed())
            {
                lights.extend((0..=scene.0.names().count()).map(|part| {
                    let light = scene.0.light_of(part).clone();
                    ((*camera, 1 + part), ToonScene::new(light))
                }));
            }
        }
        lights
    }

    /// The entities that may be on other layers than before.
    pub fn moved(&mut self) -> impl Iterator<Item = Entity> {
        self.on_other_layers
            .iter()
            .chain(self.on_default_layers.read())
    }
}

/// Seconds with lights and lit meshes, but without shadows, until the scene counts as loaded.
const LOADED: f32 = 5.0;

/// The most seconds that a frame counts: loading makes long frames.
const LONGEST_FRAME: f32 = 0.25;

/// Warns of a style with shadows in a scene where no light casts any: a style changes no lights.
pub(in crate::toon) fn warn_of_missing_shadows(
    cameras: Query<(Entity, &CameraScene)>,
    meshes: Query<(), With<Original>>,
    suns: Query<&DirectionalLight>,
    lamps: Query<&PointLight>,
    spots: Query<&SpotLight>,
    time: Option<Res<Time<Real>>>,
    mut seconds: Local<f32>,
) {
    if *seconds > LOADED {
        return;
    }
    let mut wanting = (cameras.iter()).filter(|(_, scene)| scene.0.draws_cast_shadows());
    let Some((camera, _)) = wanting.next().filter(|_| !meshes.is_empty()) else {
        return;
    };
    if suns.iter().any(|light| light.shadow_maps_enabled)
        || lamps.iter().any(|light| light.shadow_maps_enabled)
        || spots.iter().any(|light| light.shadow_maps_enabled)
    {
        // There is nothing to say any more.
        *seconds = f32::INFINITY;
    } else if !suns.is_empty() || !lamps.is_empty() || !spots.is_empty() {
        *seconds += time.map_or(0.0, |time| time.delta_secs().min(LONGEST_FRAME));
        if *seconds > LOADED {
            warn!(
                "the style of {camera} draws shadows, but no light has `shadow_maps_enabled`: a \
                 style changes no lights"
            );
        }
    }
}
