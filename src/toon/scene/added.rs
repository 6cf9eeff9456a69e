//! Components that styles add to the objects of a scene.

use bevy::{
    ecs::entity::{EntityHashMap, EntityHashSet},
    prelude::*,
};

use super::{Original, SceneChanges, SceneRoots};
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

/// Meshes that a style may light.
type Lightable = Or<(With<MeshMaterial3d<StandardMaterial>>, With<Original>)>;

/// In place of the index of a camera: none.
const NO_CAMERA: usize = usize::MAX;

impl SceneRoots<'_, '_> {
    /// The entity to which the style of the camera that lights a mesh adds components, and the index
    /// of this camera among the styled ones.
    fn added_for(&self, mesh: Entity) -> Option<(Entity, usize)> {
        let (index, styled) = self.lighting(mesh).next()?;
        Some((styled.top(self.way_up(mesh))?, index))
    }

    /// The first camera whose style adds components to an entity, of those that light a mesh at or
    /// below it.
    fn first_adding_to(
        &self,
        top: Entity,
        children: &Query<&Children>,
        meshes: &Query<(), Lightable>,
    ) -> usize {
        let mut first = NO_CAMERA;
        let mut visited = EntityHashSet::default();
        let mut below = vec![top];
        while first > 0
            && let Some(entity) = below.pop()
        {
            if !visited.insert(entity) {
                continue;
            }
            below.extend(children.get(entity).into_iter().flatten());
            if meshes.contains(entity)
                && let Some((of, index)) = self.added_for(entity)
                && of == top
            {
                first = first.min(index);
            }
        }
        first
    }
}

/// Adds components for the meshes that may be lit by another camera now, and removes those of styles
/// that are gone. Of the cameras that light meshes below one entity, the first one decides.
pub(in crate::toon) fn add_components(
    mut commands: Commands,
    (changes, roots): (Res<SceneChanges>, SceneRoots),
    own: Query<Own>,
    added: Query<Entity, With<AddedByStyle>>,
    (children, meshes): (Query<&Children>, Query<(), Lightable>),
) {
    let styled = &roots.styled.0;
    let adds_nothing = styled.iter().all(|styled| styled.adds == (None, false));
    if (changes.meshes.is_empty() && !changes.all) || (adds_nothing && added.is_empty()) {
        return;
    }
    let mut first_cameras = EntityHashMap::<usize>::default();
    for mesh in changes.meshes.iter().copied() {
        if let Some((top, index)) = roots.added_for(mesh) {
            let first = first_cameras.entry(top).or_insert(NO_CAMERA);
            *first = index.min(*first);
        }
        // What was added for this mesh before may go.
        for above in roots.way_up(mesh).filter(|above| added.contains(*above)) {
            first_cameras.entry(above).or_insert(NO_CAMERA);
        }
    }
    if changes.all {
        for entity in &added {
            first_cameras.entry(entity).or_insert(NO_CAMERA);
        }
    } else {
        // Meshes that have not changed count too.
        for (top, first) in &mut first_cameras {
            if *first > 0 {
                *first = roots.first_adding_to(*top, &children, &meshes);
            }
        }
    }
    for (entity, first) in first_cameras {
        let (sections, anchor) = styled.get(first).map_or((None, false), |first| first.adds);
        let wanted = AddedByStyle { sections, anchor };
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
