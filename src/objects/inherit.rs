//! Components that apply to descendants too.
//!
//! An entity takes from the nearest entity on the way up, itself included, that has the component:
//! always from itself, and from others if they let it.

use std::marker::PhantomData;

use bevy::{
    ecs::{
        entity::{EntityHashMap, EntityHashSet},
        query::{QueryFilter, ROQueryItem, ReadOnlyQueryData},
        system::SystemParam,
    },
    prelude::*,
    reflect::GetTypeRegistration,
    render::sync_world::MainEntityHashSet,
};

use super::{
    Backdrop, DepthWrite, LineWidths, NoOutlines, NoStyle, ObjectSimplification, OutlineStyle,
    SelectionOutline, XRayOutline, changes::Follow, groups::DEEPEST, shared::Shared,
};

/// The entity got another parent or none, or lost a component that others inherit.
#[derive(Message)]
pub(super) enum Moved {
    Parent(Entity),
    Component(Entity),
}

pub(super) fn build(app: &mut App) {
    app.add_message::<Moved>()
        .add_observer(|on: On<Insert, ChildOf>, mut moved: MessageWriter<Moved>| {
            moved.write(Moved::Parent(on.entity));
        })
        .add_observer(|on: On<Remove, ChildOf>, mut moved: MessageWriter<Moved>| {
            moved.write(Moved::Parent(on.entity));
        });
}

/// Registers a component, and notes the entities that lose it.
pub(super) fn register<C: Component + GetTypeRegistration>(app: &mut App) {
    app.register_type::<C>()
        .add_observer(|on: On<Remove, C>, mut moved: MessageWriter<Moved>| {
            moved.write(Moved::Component(on.entity));
        });
}

/// What entities inherit: a component, or several that go together.
pub(super) trait Heritage: 'static {
    /// What an entity has of its own.
    type Own: ReadOnlyQueryData + 'static;
    /// Finds the entities of which that is new or other.
    type Changed: QueryFilter + 'static;

    /// Whether descendants inherit it.
    fn passes_on(own: &ROQueryItem<'_, '_, Self::Own>) -> bool;
}

/// A component that descendants inherit by itself.
pub(crate) trait Inherit: Component {
    fn is_inherited(&self) -> bool;
}

macro_rules! inherit_by_field {
    ($($component:ty),*) => {
        $(impl Inherit for $component {
            fn is_inherited(&self) -> bool {
                self.inherit
            }
        })*
    };
}

inherit_by_field! {
    Backdrop, DepthWrite, LineWidths, NoOutlines, NoStyle, ObjectSimplification, OutlineStyle,
    SelectionOutline, XRayOutline
}

macro_rules! inherited_by_default {
    ($($component:ty),*) => {
        $(impl Default for $component {
            fn default() -> Self {
                Self { inherit: true }
            }
        })*
    };
}

inherited_by_default! { Backdrop, LineWidths, NoOutlines, NoStyle }

impl<C: Inherit> Heritage for C {
    type Own = &'static C;
    type Changed = Changed<C>;

    fn passes_on(own: &ROQueryItem<'_, '_, Self::Own>) -> bool {
        own.is_inherited()
    }
}

/// Either of two components; the first counts if an entity has both.
pub(crate) struct Either<A, B>(PhantomData<(A, B)>);

impl<A: Inherit, B: Inherit> Heritage for Either<A, B> {
    type Own = AnyOf<(&'static A, &'static B)>;
    type Changed = Or<(Changed<A>, Changed<B>)>;

    fn passes_on((first, second): &ROQueryItem<'_, '_, Self::Own>) -> bool {
        match (first, second) {
            (Some(first), _) => first.is_inherited(),
            (None, second) => second.is_some_and(Inherit::is_inherited),
        }
    }
}

/// Keeps who inherits from whom. Every component has to be [registered](register).
#[derive(SystemParam)]
pub(super) struct Inherited<'w, 's, H: Heritage> {
    own: Query<'w, 's, <H as Heritage>::Own>,
    changed: Query<'w, 's, Entity, <H as Heritage>::Changed>,
    moved: MessageReader<'w, 's, Moved>,
    parents: Query<'w, 's, &'static ChildOf>,
    children: Query<'w, 's, &'static Children>,
    /// The entity that each entity takes from.
    sources: Local<'s, EntityHashMap<Entity>>,
}

impl<H: Heritage> Inherited<'_, '_, H> {
    /// Looks for changes; returns the entities that may take something else now, or nothing. To be
    /// called once in every frame.
    pub fn update(&mut self) -> EntityHashSet {
        let mut changed: EntityHashSet = self.changed.iter().collect();
        let mut moved = Vec::new();
        for event in self.moved.read() {
            match event {
                // It may have another one of several that go together.
                Moved::Component(entity) if self.own.contains(*entity) => {
                    changed.insert(*entity);
                }
                Moved::Component(entity) | Moved::Parent(entity) => moved.push(*entity),
            }
        }
        let mut affected = EntityHashSet::default();
        if self.sources.is_empty() && changed.is_empty() {
            return affected;
        }
        let mut visited = EntityHashSet::default();
        for top in changed.iter().copied().chain(moved) {
            let source = self.nearest(top);
            if self.sources.get(&top).copied() == source && !changed.contains(&top) {
                continue;
            }
            let mut below = vec![(top, source)];
            while let Some((entity, source)) = below.pop() {
                if !visited.insert(entity) {
                    continue;
                }
                let before = match source {
                    Some(source) => self.sources.insert(entity, source),
                    None => self.sources.remove(&entity),
                };
                if before != source || source.is_some_and(|source| changed.contains(&source)) {
                    affected.insert(entity);
                }
                let passed_on = match self.own.get(entity) {
                    Ok(own) => Some(entity).filter(|_| H::passes_on(&own)),
                    Err(_) => source,
                };
                let children = self.children.get(entity).into_iter().flatten().copied();
                let heirs = children.filter(|child| !self.own.contains(*child));
                below.extend(heirs.map(|child| (child, passed_on)));
            }
        }
        affected
    }

    /// The entity that an entity takes from, and what it takes.
    pub fn of(&self, entity: Entity) -> Option<(Entity, ROQueryItem<'_, '_, H::Own>)> {
        let source = *self.sources.get(&entity)?;
        Some((source, self.own.get(source).ok()?))
    }

    fn nearest(&self, entity: Entity) -> Option<Entity> {
        let mut at = entity;
        for _ in 0..DEEPEST {
            if let Ok(own) = self.own.get(at) {
                return Some(at).filter(|_| at == entity || H::passes_on(&own));
            }
            at = self.parents.get(at).ok()?.parent();
        }
        None
    }
}

/// The values of the meshes that have a component or inherit it. Both worlds have a copy.
#[derive(Resource)]
pub(crate) struct Values<C, V>(pub Shared<V>, PhantomData<C>);

impl<C, V> Default for Values<C, V> {
    fn default() -> Self {
        Self(Shared::default(), PhantomData)
    }
}

impl<C: Inherit, V: Clone + PartialEq> Values<C, V> {
    /// Updates them once in every frame; returns the meshes that have another one now, or none.
    pub(super) fn update(
        &mut self,
        inherited: &mut Inherited<C>,
        value: impl Fn(&C) -> V,
    ) -> EntityHashSet {
        let mut changed = inherited.update();
        self.0.begin();
        changed.retain(|mesh| {
            let source = inherited.of(*mesh);
            self.0.set(*mesh, source.map(|(_, own)| value(own)))
        });
        changed
    }
}

impl<C: Component, V: Clone + PartialEq + Send + Sync + 'static> Follow for Values<C, V> {
    fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet) {
        self.0.follow(&main.0, changed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Component, Reflect)]
    struct Paint {
        color: u32,
        inherit: bool,
    }

    impl Inherit for Paint {
        fn is_inherited(&self) -> bool {
            self.inherit
        }
    }

    /// What follows from the changes alone, and how many entities they affected in this frame.
    #[derive(Resource, Default)]
    struct Painted(EntityHashMap<u32>, usize);

    fn paint(mut inherited: Inherited<Paint>, mut painted: ResMut<Painted>) {
        let affected = inherited.update();
        painted.1 = affected.len();
        for entity in affected {
            match inherited.of(entity) {
                Some((_, paint)) => painted.0.insert(entity, paint.color),
                None => painted.0.remove(&entity),
            };
        }
    }

    fn app() -> App {
        let mut app = App::new();
        build(&mut app);
        register::<Paint>(&mut app);
        app.init_resource::<Painted>()
            .add_systems(PostUpdate, paint);
        app
    }

    /// The paint of every entity, from the whole hierarchy.
    fn scan(world: &World, entities: &[Entity]) -> EntityHashMap<u32> {
        let of = |entity: &Entity| {
            let mut at = *entity;
            loop {
                if let Some(paint) = world.get::<Paint>(at) {
                    return (at == *entity || paint.inherit).then_some((*entity, paint.color));
                }
                at = world.get::<ChildOf>(at)?.parent();
            }
        };
        entities.iter().filter_map(of).collect()
    }

    #[test]
    fn updates_agree_with_a_scan() {
        let mut app = app();
        let mut state = 1u64;
        let mut random = |below: usize| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as usize % below
        };
        let mut entities: Vec<Entity> = Vec::new();
        for round in 0..2000 {
            for _ in 0..random(5) {
                let world = app.world_mut();
                entities.retain(|entity| world.get_entity(*entity).is_ok());
                let action = if entities.len() < 16 { 0 } else { random(9) };
                if action == 0 {
                    entities.push(world.spawn_empty().id());
                    continue;
                }
                let [entity, other] = [(); 2].map(|()| entities[random(entities.len())]);
                let above = |at: &Entity| world.get::<ChildOf>(*at).map(ChildOf::parent);
                let is_circle = std::iter::successors(Some(other), above).any(|at| at == entity);
                let mut entity = world.entity_mut(entity);
                let color = random(3) as u32;
                match action {
                    1..=3 if !is_circle => {
                        entity.insert(ChildOf(other));
                    }
                    4 => {
                        entity.remove::<ChildOf>();
                    }
                    5 | 6 => {
                        let inherit = random(4) > 0;
                        entity.insert(Paint { color, inherit });
                    }
                    7 => {
                        if let Some(mut paint) = entity.get_mut::<Paint>() {
                            paint.color = color;
                            paint.inherit = random(4) > 0;
                        }
                    }
                    8 if random(3) == 0 => entity.despawn(),
                    8 => {
                        entity.remove::<Paint>();
                    }
                    _ => {}
                }
            }
            app.update();
            entities.retain(|entity| app.world().get_entity(*entity).is_ok());
            let painted = &app.world().resource::<Painted>().0;
            assert_eq!(*painted, scan(app.world(), &entities), "round {round}");
        }
    }

    /// One that changes affects itself and its heirs, and a tree without paint nothing.
    #[test]
    fn changes_affect_only_heirs() {
        let mut app = app();
        let world = app.world_mut();
        let paint = |color| Paint {
            color,
            inherit: true,
        };
        let painted: Vec<Entity> = (0..100).map(|at| world.spawn(paint(at)).id()).collect();
        let child = world.spawn(ChildOf(painted[7])).id();
        app.update();
        let affected = |app: &mut App| {
            app.update();
            app.world().resource::<Painted>().1
        };
        assert_eq!(affected(&mut app), 0);
        app.world_mut().entity_mut(painted[7]).insert(paint(5));
        assert_eq!(affected(&mut app), 2);
        let plain = app.world_mut().spawn_empty().id();
        app.world_mut().spawn(ChildOf(plain));
        assert_eq!(affected(&mut app), 0);
        // Parents in a circle, which the engine does not prevent, end the walk.
        app.world_mut().entity_mut(plain).insert(ChildOf(child));
        app.world_mut()
            .entity_mut(painted[7])
            .insert(ChildOf(plain));
        assert_eq!(affected(&mut app), 2);
        app.world_mut().entity_mut(painted[7]).remove::<Paint>();
        assert_eq!(affected(&mut app), 4);
    }
}
