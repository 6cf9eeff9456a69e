//! Cameras that follow a style asset.

use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    prelude::*,
};

use super::{ComicStyle, ComicStyleError};
use crate::effect::EffectRegistry;

/// Gives a camera the style of a [`ComicStyle`] asset.
///
/// The style is [applied](ComicStyle::apply) to the camera when the asset has loaded, and again
/// whenever it changes. Between those moments the camera's components may be edited. If a file
/// becomes unreadable, the camera keeps its last style. Removing this component restores the
/// camera's own style.
///
/// A scene in code can name a path: the component's template takes one in the
/// handle's place.
#[derive(Component, FromTemplate, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct Comic(pub Handle<ComicStyle>);

pub(super) fn apply_styles(
    mut commands: Commands,
    cameras: Query<(Entity, Ref<Comic>)>,
    mut removed: RemovedComponents<Comic>,
    existing: Query<(), With<Comic>>,
    mut events: MessageReader<AssetEvent<ComicStyle>>,
    styles: Res<Assets<ComicStyle>>,
) {
    for entity in removed.read() {
        if !existing.contains(entity)
            && let Ok(mut camera) = commands.get_entity(entity)
        {
            ComicStyle::remove_from(&mut camera);
        }
    }
    let changed: Vec<_> = events
        .read()
        .filter_map(|event| match event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => Some(*id),
            _ => None,
        })
        .collect();
    for (entity, handle) in &cameras {
        if !handle.is_changed() && !changed.contains(&handle.0.id()) {
            continue;
        }
        if let Some(style) = styles.get(&handle.0)
            && let Ok(mut camera) = commands.get_entity(entity)
        {
            style.apply(&mut camera);
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
