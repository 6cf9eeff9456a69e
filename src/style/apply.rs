//! Cameras that follow a style asset.

use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    ecs::entity::EntityHashSet,
    prelude::*,
};

use super::{
    ComicStyle, ComicStyleError, StyleTransition, StyleVolume,
    layer::{set_grade, set_surroundings},
    presets,
};
use crate::effect::EffectRegistry;

/// Gives a camera the style of a [`ComicStyle`] asset.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_comics::presets;
/// # fn setup(mut commands: Commands) {
/// commands.spawn((Camera3d::default(), presets::SATURDAY_MORNING.comic()));
/// # }
/// ```
///
/// The style is [applied](ComicStyle::apply) to the camera when the asset has loaded, and again
/// whenever it changes. This includes its [`camera`](ComicStyle::camera) and
/// [`scene`](ComicStyle::scene). Between those moments the camera's components may be edited. If a
/// file becomes unreadable, the camera keeps its last style. Removing this component restores the
/// camera's own style, its other settings, and the materials of the scene.
///
/// A scene in code can name a path: the component's template takes one in the
/// handle's place.
#[derive(Component, FromTemplate, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct Comic(pub Handle<ComicStyle>);

/// Gives a camera a partial style over that of its [`Comic`], or over its own: for light and weather,
/// for example, over any style.
///
/// It stays while the style below it changes, also by a [`StyleTransition`]. Styles of
/// [`StyleVolume`]s lie over it. A complete style counts as a partial one. Its `camera` and `scene`
/// need a [`Comic`] on the camera, which may be empty. Removing this component restores the style
/// below.
#[derive(Component, FromTemplate, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct ComicGrade(pub Handle<ComicStyle>);

/// The styles that have changed or were removed. Cameras wait for new ones.
fn changed(events: &mut MessageReader<AssetEvent<ComicStyle>>) -> Vec<AssetId<ComicStyle>> {
    let ids = events.read().filter_map(|event| match event {
        AssetEvent::Modified { id } | AssetEvent::Removed { id } => Some(*id),
        _ => None,
    });
    ids.collect()
}

pub(super) fn apply_grades(
    mut commands: Commands,
    cameras: Query<(Entity, Ref<ComicGrade>)>,
    mut removed: RemovedComponents<ComicGrade>,
    mut events: MessageReader<AssetEvent<ComicStyle>>,
    styles: Res<Assets<ComicStyle>>,
    mut waiting: Local<EntityHashSet>,
) {
    for entity in removed.read() {
        waiting.remove(&entity);
        if !cameras.contains(entity)
            && let Ok(mut camera) = commands.get_entity(entity)
        {
            camera.queue(|mut camera: EntityWorldMut| set_grade(&mut camera, None));
        }
    }
    let changed = changed(&mut events);
    for (entity, grade) in &cameras {
        let is_new = grade.is_changed() || waiting.contains(&entity);
        if !is_new && !changed.contains(&grade.0.id()) {
            continue;
        }
        let Some(style) = styles.get(&grade.0).cloned() else {
            waiting.insert(entity);
            continue;
        };
        waiting.remove(&entity);
        if let Ok(mut camera) = commands.get_entity(entity) {
            camera.queue(move |mut camera: EntityWorldMut| set_grade(&mut camera, Some(style)));
        }
    }
}

pub(super) fn apply_styles(
    mut commands: Commands,
    cameras: Query<(Entity, Ref<Comic>)>,
    mut removed: RemovedComponents<Comic>,
    existing: Query<(), With<Comic>>,
    mut events: MessageReader<AssetEvent<ComicStyle>>,
    styles: Res<Assets<ComicStyle>>,
    mut waiting: Local<EntityHashSet>,
) {
    for entity in removed.read() {
        waiting.remove(&entity);
        if !existing.contains(entity)
            && let Ok(mut camera) = commands.get_entity(entity)
        {
            ComicStyle::remove_from(&mut camera);
        }
    }
    let changed = changed(&mut events);
    for (entity, handle) in &cameras {
        let is_new = handle.is_changed() || waiting.contains(&entity);
        if !is_new && !changed.contains(&handle.0.id()) {
            continue;
        }
        let Ok(mut camera) = commands.get_entity(entity) else {
            continue;
        };
        if let Some(style) = styles.get(&handle.0) {
            waiting.remove(&entity);
            style.apply(&mut camera);
        } else {
            waiting.insert(entity);
            if handle.is_added() {
                camera.queue(|mut camera: EntityWorldMut| set_surroundings(&mut camera));
            }
        }
    }
}

/// Adds the presets whose [handles](presets::Preset::handle) are used: no asset server loads them.
pub(super) fn add_presets(
    comics: Query<&Comic, Changed<Comic>>,
    grades: Query<&ComicGrade, Changed<ComicGrade>>,
    volumes: Query<&StyleVolume, Changed<StyleVolume>>,
    transitions: Query<&StyleTransition, Changed<StyleTransition>>,
    mut styles: ResMut<Assets<ComicStyle>>,
) {
    let comics = comics.iter().map(|comic| &comic.0);
    let comics = comics.chain(grades.iter().map(|grade| &grade.0));
    let volumes = volumes.iter().map(|volume| &volume.style);
    let targets = transitions.iter().filter_map(StyleTransition::asset);
    for handle in comics.chain(volumes).chain(targets) {
        if handle.is_uuid()
            && !styles.contains(handle)
            && let Some(preset) = presets::of(handle)
        {
            // Only an index that is gone is an error.
            let _ = styles.insert(handle, preset.style());
        }
    }
}

/// Reads style files with the effects that the app knows.
#[derive(TypePath)]
pub(super) struct StyleLoader {
    registry: EffectRegistry,
}

impl FromWorld for StyleLoader {
    fn from_world(world: &mut World) -> Self {
        Self {
            registry: world.get_resource_or_init::<EffectRegistry>().clone(),
        }
    }
}

impl AssetLoader for StyleLoader {
    type Asset = ComicStyle;
    type Settings = ();
    type Error = ComicStyleError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<ComicStyle, ComicStyleError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes)
            .map_err(|error| std::io::Error::new(std::io::ErrorKind::InvalidData, error))?;
        let read = self.registry.read_style(&text)?;
        if let Some(advice) = read.advice {
            warn!("{}: {advice}", load_context.path());
        }
        Ok(read.style)
    }

    fn extensions(&self) -> &[&str] {
        &["comic.ron"]
    }
}
