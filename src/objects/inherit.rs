//! Components that apply to descendants too.

use bevy::{
    app::App,
    ecs::{
        change_detection::DetectChanges,
        component::Component,
        entity::{Entity, EntityHashMap},
        hierarchy::{ChildOf, Children},
        lifecycle::{Insert, Remove, RemovedComponents},
        observer::On,
        query::Changed,
        resource::Resource,
        system::{Query, Res, ResMut, SystemParam},
    },
    prelude::DetectChangesMut,
};

/// Changes when some entity gets another parent, or none.
#[derive(Resource, Default)]
pub(super) struct Tree;

pub(super) fn build(app: &mut App) {
    app.init_resource::<Tree>()
        .add_observer(|_: On<Insert, ChildOf>, mut tree: ResMut<Tree>| tree.set_changed())
        .add_observer(|_: On<Remove, ChildOf>, mut tree: ResMut<Tree>| tree.set_changed());
}

/// Whether a component, or the set of entities that inherit it, may have changed.
#[derive(SystemParam)]
pub(super) struct Inherited<'w, 's, C: Component> {
    changed: Query<'w, 's, (), Changed<C>>,
    removed: RemovedComponents<'w, 's, C>,
    tree: Res<'w, Tree>,
}

impl<C: Component> Inherited<'_, '_, C> {
    pub fn is_changed(&mut self) -> bool {
        let removed = self.removed.read().count() > 0;
        removed || self.tree.is_changed() || !self.changed.is_empty()
    }
}

/// Adds an entity with what a component of it says; if that is `inherited`, its descendants
/// too, up to those that have the component themselves.
pub(super) fn inherit<T: Copy>(
    into: &mut EntityHashMap<T>,
    (entity, said): (Entity, T),
    inherited: bool,
    children: &Query<&Children>,
    has_own: impl Fn(Entity) -> bool,
) {
    into.insert(entity, said);
    let mut below = vec![entity];
    while inherited && let Some(parent) = below.pop() {
        let children = children.get(parent).into_iter();
        for child in children.flat_map(|c| c.iter().copied()) {
            if !has_own(child) {
                into.insert(child, said);
                below.push(child);
            }
        }
    }
}
