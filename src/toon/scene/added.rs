//! Components that styles add to the objects of a scene.

use bevy::{ecs::entity::EntityHashMap, prelude::*};

use super::{SceneChanges, SceneRoots};
use crate::objects::{MeshSections, PatternAnchor};

/// On an entity to which the style of a camera has added [`MeshSections`] or a [`PatternAnchor`]: see
/// [`StyleScene::sections`](crate::toon::StyleScene::sections) and
/// [`StyleScene::screens`](crate::toon::StyleScene::screens). They are removed with the style,
/// unless the game has changed them.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct AddedByStyle {
    /// The angle of its sections.
    sections: Option<f32>,
    /// Whether its anchor was added.
    anchor: bool,
}

type Own = (
    Option<&'static MeshSections>,
    Option<&'static PatternAnchor>,
    Option<&'static AddedByStyle>,
);

/// Adds components for the meshes that may be lit by another camera now, and removes those of styles
/// that are gone.
pub(in crate::toon) fn add_components(
    mut commands: Commands,
    (changes, roots): (Res<SceneChanges>, SceneRoots),
    own: Query<Own>,
    added: Query<Entity, With<AddedByStyle>>,
    added_below: Query<Entity, (With<AddedByStyle>, With<ChildOf>)>,
) {
    let styled = &roots.styled.0;
    let adds_nothing = styled.iter().all(|styled| styled.adds == (None, false));
    if (changes.meshes.is_empty() && !changes.all) || (adds_nothing && added.is_empty()) {
        return;
    }
    let mut wanted = EntityHashMap::<AddedByStyle>::default();
    for mesh in changes.meshes.iter().copied() {
        let lighting = roots.lighting(mesh).next();
        let top = lighting.and_then(|styled| styled.top(roots.way_up(mesh)));
        let (sections, anchor) = lighting.map_or((None, false), |styled| styled.adds);
        // A mesh that no camera lights may have others beside it.
        let (top, adds) = (top.unwrap_or(mesh), AddedByStyle { sections, anchor });
        wanted.entry(top).or_insert(adds);
    }
    if changes.all {
        for entity in &added {
            wanted.entry(entity).or_default();
        }
    }
    for entity in &added_below {
        if !styled.iter().any(|styled| styled.has_root(entity)) {
            wanted.insert(entity, AddedByStyle::default());
        }
    }
    for (entity, wanted) in wanted {
        if let Ok(own) = own.get(entity)
            && let Ok(entity) = commands.get_entity(entity)
        {
            adjust(entity, own, wanted);
        }
    }
}

/// Adds to an entity what is wanted in place of what was added before. What the game has put there,
/// or changed, is the game's.
fn adjust(
    mut entity: EntityCommands,
    (sections, anchor, added): (
        Option<&MeshSections>,
        Option<&PatternAnchor>,
        Option<&AddedByStyle>,
    ),
    wanted: AddedByStyle,
) {
    let before = added.copied().unwrap_or_default();
    let has_sections = sections.is_some_and(|own| before.sections != Some(own.angle));
    let has_anchor = anchor.is_some_and(|own| !before.anchor || *own != PatternAnchor::default());
    let now = AddedByStyle {
        sections: wanted.sections.filter(|_| !has_sections),
        anchor: wanted.anchor && !has_anchor,
    };
    if now == before {
        return;
    }
    if now.sections != before.sections && !has_sections {
        match now.sections {
            Some(angle) => entity.insert(MeshSections { angle }),
            None => entity.remove::<MeshSections>(),
        };
    }
    if now.anchor != before.anchor && !has_anchor {
        if now.anchor {
            entity.insert(PatternAnchor::default());
        } else {
            entity.remove::<PatternAnchor>();
        }
    }
    if now == AddedByStyle::default() {
        entity.remove::<AddedByStyle>();
    } else {
        entity.insert(now);
    }
}
