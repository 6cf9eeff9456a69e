//! Components that apply to descendants too.

use bevy::ecs::{
    entity::{Entity, EntityHashMap},
    hierarchy::Children,
    system::Query,
};

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
