//! Meshes that are parts of one object: those below an [`OutlineGroup`], and the
//! primitives of a glTF node.
//!
//! Observers note which entities changed. Without changes, a frame costs nothing.

use bevy::{
    asset::AssetPath, ecs::entity::EntityHashSet, platform::collections::HashMap, prelude::*,
    render::sync_world::MainEntityHashSet,
};

use super::{changes::Follow, shared::Shared};

/// All meshes of this entity and of its descendants are one object: between them, there
/// are no [object edges](crate::lines::ObjectEdges).
///
/// Use it for things that look like one object but have several meshes: the chunks of a terrain,
/// the parts of a building. Between the group and other objects, edges remain. Silhouettes and
/// creases remain inside the group too, because they follow from depth and normals.
/// [`OutlineStyle`](crate::OutlineStyle) and [`NoOutlines`](crate::NoOutlines) still apply to
/// single meshes.
///
/// If groups are nested, a mesh belongs to the nearest one on the way up, itself included.
/// So a mesh with an `OutlineGroup` of its own is an object of its own.
///
/// The primitives of one glTF node are one object without a group, see
/// [id](crate::testing::ObjectIds); [`SplitPrimitives`] separates them.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct OutlineGroup;

/// The primitives of glTF nodes below this entity, and of itself, are objects of their own: there
/// are [object edges](crate::lines::ObjectEdges) between them.
///
/// The engine spawns one primitive per material. So with this component, all borders between the
/// materials of a model have lines. Meshes in an [`OutlineGroup`] stay one object.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct SplitPrimitives;

/// The longest way up to a group. It ends walks in hierarchies that are circles.
pub(super) const DEEPEST: usize = 65_536;

/// The objects that meshes are parts of. Both worlds have a copy.
#[derive(Resource, Default)]
pub(crate) struct ObjectGroups {
    /// The entity with the nearest `OutlineGroup`, of every mesh in a group.
    roots: Shared<Entity>,
    /// The first primitive of the same glTF node, of every primitive that shares its node
    /// with others and is in no group.
    primitives: Shared<Entity>,
}

impl ObjectGroups {
    /// Whether a mesh has the id of a group, or shares it with other primitives.
    pub fn is_shared(&self, mesh: Entity) -> bool {
        self.roots.get(mesh).or(self.primitives.get(mesh)).is_some()
    }

    /// The entity whose id the mesh has.
    pub fn object(&self, mesh: Entity) -> Entity {
        let other = self.roots.get(mesh).or(self.primitives.get(mesh));
        other.copied().unwrap_or(mesh)
    }

    /// The meshes whose object may have changed last.
    pub fn changed(&self) -> impl Iterator<Item = Entity> {
        let changed = self.roots.changed().iter().chain(self.primitives.changed());
        changed.copied()
    }
}

impl Follow for ObjectGroups {
    fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet) {
        self.roots.follow(&main.roots, changed);
        self.primitives.follow(&main.primitives, changed);
    }
}

/// What changed since the groups were last updated.
#[derive(Resource, Default)]
pub(crate) struct GroupChanges {
    /// Entities that may belong to another group now, with all of their descendants.
    subtrees: EntityHashSet,
    /// Children and the parents that they left.
    left: Vec<(Entity, Entity)>,
}

/// Notes the entities that get another value of a component, or lose it.
fn note_changes<C: Component>(app: &mut App) {
    app.add_observer(|on: On<Insert, C>, mut changes: ResMut<GroupChanges>| {
        changes.subtrees.insert(on.entity);
    })
    .add_observer(|on: On<Remove, C>, mut changes: ResMut<GroupChanges>| {
        changes.subtrees.insert(on.entity);
    });
}

/// Registers the components and keeps [`ObjectGroups`] up to date.
pub(crate) fn build(app: &mut App) {
    note_changes::<OutlineGroup>(app);
    note_changes::<SplitPrimitives>(app);
    note_changes::<Mesh3d>(app);
    app.register_type::<OutlineGroup>()
        .register_type::<SplitPrimitives>()
        .init_resource::<ObjectGroups>()
        .init_resource::<GroupChanges>()
        .add_observer(
            |on: On<Insert, ChildOf>, mut changes: ResMut<GroupChanges>| {
                changes.subtrees.insert(on.entity);
            },
        )
        .add_observer(parent_left)
        .add_systems(PostUpdate, update_object_groups);
}

fn parent_left(
    on: On<Discard, ChildOf>,
    parents: Query<&ChildOf>,
    mut changes: ResMut<GroupChanges>,
) {
    changes.subtrees.insert(on.entity);
    if let Ok(child_of) = parents.get(on.entity) {
        changes.left.push((on.entity, child_of.parent()));
    }
}

/// What the groups depend on.
type Tree<'w, 's> = Query<
    'w,
    's,
    (
        Option<&'static ChildOf>,
        Option<&'static Children>,
        Option<&'static Mesh3d>,
        Has<OutlineGroup>,
        Has<SplitPrimitives>,
    ),
>;

pub(crate) fn update_object_groups(
    mut changes: ResMut<GroupChanges>,
    mut groups: ResMut<ObjectGroups>,
    tree: Tree,
) {
    if changes.subtrees.is_empty() && changes.left.is_empty() {
        return;
    }
    let changes = std::mem::take(&mut *changes);
    let mut update = Update {
        tree,
        groups: groups.bypass_change_detection(),
        visited: EntityHashSet::default(),
        parents: EntityHashSet::default(),
        changed: false,
    };
    update.groups.roots.begin();
    update.groups.primitives.begin();
    for (child, parent) in changes.left {
        if update.groups.primitives.get(child).is_some() {
            update.parents.insert(parent);
        }
    }
    for entity in changes.subtrees {
        update.subtree(entity);
    }
    for parent in std::mem::take(&mut update.parents) {
        update.primitives(parent);
    }
    if update.changed {
        groups.set_changed();
    }
}

struct Update<'a, 'w, 's> {
    tree: Tree<'w, 's>,
    groups: &'a mut ObjectGroups,
    visited: EntityHashSet,
    /// Parents whose children may share other primitives.
    parents: EntityHashSet,
    changed: bool,
}

impl Update<'_, '_, '_> {
    fn is_root(&self, entity: Entity) -> bool {
        self.tree.get(entity).is_ok_and(|(.., root, _)| root)
    }

    /// The nearest entity with a component, from `entity` upwards.
    fn nearest(&self, entity: Entity, has_it: impl Fn(&Self, Entity) -> bool) -> Option<Entity> {
        let mut at = entity;
        for _ in 0..DEEPEST {
            if has_it(self, at) {
                return Some(at);
            }
            at = self.tree.get(at).ok()?.0?.parent();
        }
        None
    }

    fn is_split(&self, entity: Entity) -> bool {
        self.tree.get(entity).is_ok_and(|(.., split)| split)
    }

    /// Updates the group of an entity and of its descendants, up to nested groups.
    fn subtree(&mut self, top: Entity) {
        let root = self.nearest(top, Self::is_root);
        let mut below = vec![top];
        while let Some(entity) = below.pop() {
            if !self.visited.insert(entity) {
                continue;
            }
            let nothing = (None, None, None, false, false);
            let (child_of, children, mesh, ..) = self.tree.get(entity).unwrap_or(nothing);
            let is_primitive = mesh.is_some_and(|m| m.0.path().and_then(primitive).is_some())
                || self.groups.primitives.get(entity).is_some();
            let parent = child_of.filter(|_| mesh.is_some()).map(ChildOf::parent);
            let root = root.filter(|_| mesh.is_some());
            self.changed |= self.groups.roots.set(entity, root);
            match parent.filter(|_| is_primitive) {
                Some(parent) => {
                    self.parents.insert(parent);
                }
                None => self.changed |= self.groups.primitives.set(entity, None),
            }
            let children = children.into_iter().flatten().copied();
            below.extend(children.filter(|child| !self.is_root(*child)));
        }
    }

    /// Updates which children of a parent are primitives of one glTF node.
    ///
    /// The glTF loader spawns each primitive as a child of its node, with a mesh from the
    /// path `FILE#MeshM/PrimitiveP`. Games may spawn such meshes below a parent of their
    /// own, many times. So the first child with each primitive of a mesh makes an object,
    /// the second child with each primitive makes another one, and so on.
    fn primitives(&mut self, parent: Entity) {
        let Ok((_, Some(children), ..)) = self.tree.get(parent) else {
            return;
        };
        let split = self.nearest(parent, Self::is_split).is_some();
        let mut copies: HashMap<&AssetPath, usize> = HashMap::default();
        let mut objects: HashMap<(AssetPath, &str, usize), Vec<Entity>> = HashMap::default();
        let mut others = Vec::new();
        for child in children.iter() {
            let mesh = self.tree.get(child).ok().and_then(|(_, _, mesh, ..)| mesh);
            let path = mesh.and_then(|mesh| mesh.0.path());
            let found = path.and_then(|path| Some((path, primitive(path)?)));
            let apart = split || self.is_split(child) || self.groups.roots.get(child).is_some();
            let Some((path, mesh)) = found.filter(|_| !apart) else {
                others.push(child);
                continue;
            };
            let copy = copies.entry(path).or_default();
            let object = (path.without_label(), mesh, *copy);
            *copy += 1;
            objects.entry(object).or_default().push(child);
        }
        let mut changed = false;
        let primitives = &mut self.groups.primitives;
        for members in objects.values() {
            let first = Some(members[0]).filter(|_| members.len() > 1);
            for member in members {
                changed |= primitives.set(*member, first);
            }
        }
        for other in others {
            changed |= primitives.set(other, None);
        }
        self.changed |= changed;
    }
}

/// The label of the mesh of a primitive: `Mesh3` of `model.glb#Mesh3/Primitive0`. `None`
/// for other assets.
fn primitive<'a>(path: &'a AssetPath) -> Option<&'a str> {
    let (mesh, primitive) = path.label()?.split_once('/')?;
    let numbered = |part: &str, name| {
        let number = part.strip_prefix(name);
        number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
    };
    (numbered(mesh, "Mesh") && numbered(primitive, "Primitive")).then_some(mesh)
}

#[cfg(test)]
mod tests;
