//! The components of a picked object that change its lines.

use std::any::TypeId;

use bevy::{
    ecs::component::Mutable,
    prelude::*,
    reflect::{TypeRegistry, Typed},
};
use bevy_egui::egui::Ui;

use super::{
    super::{
        Widgets,
        fields::{optional, section},
        history::{Exchange, Subject},
        note,
    },
    Objects, name_of,
};
use bevy_comics::{NoOutlines, OutlineStyle, objects::MeshSections};

/// A component that the panel edits.
trait Part:
    Component<Mutability = Mutable> + Struct + Reflect + Typed + Default + Clone + PartialEq
{
    /// The name in the panel.
    const PATH: &'static str;

    fn in_ranges(self) -> Self;

    /// Whether what is below the entity has it as well.
    fn is_inherited(&self) -> bool;

    /// Whether an entity does not inherit it from above.
    fn is_decided_by(entity: EntityRef) -> bool;
}

impl Part for OutlineStyle {
    const PATH: &'static str = "outline_style";

    fn in_ranges(self) -> Self {
        self.sanitized()
    }

    fn is_inherited(&self) -> bool {
        self.inherit
    }

    fn is_decided_by(entity: EntityRef) -> bool {
        entity.contains::<Self>() || entity.contains::<NoOutlines>()
    }
}

impl Part for NoOutlines {
    const PATH: &'static str = "no_outlines";

    fn in_ranges(self) -> Self {
        self
    }

    fn is_inherited(&self) -> bool {
        self.inherit
    }

    fn is_decided_by(entity: EntityRef) -> bool {
        OutlineStyle::is_decided_by(entity)
    }
}

impl Part for MeshSections {
    const PATH: &'static str = "mesh_sections";

    fn in_ranges(self) -> Self {
        self.sanitized()
    }

    fn is_inherited(&self) -> bool {
        true
    }

    fn is_decided_by(entity: EntityRef) -> bool {
        entity.contains::<Self>()
    }
}

pub(super) fn register(types: &mut TypeRegistry) {
    types.register::<OutlineStyle>();
    types.register::<NoOutlines>();
    types.register::<MeshSections>();
}

/// The entity whose component an object has: its own one or that of an entity above it.
fn source<T: Part>(world: &World, object: Entity) -> Option<Entity> {
    let mut above = Some(object);
    // Hierarchies can be circles.
    for _ in 0..65_536 {
        let entity = world.get_entity(above?).ok()?;
        if T::is_decided_by(entity) {
            let part = entity.get::<T>()?;
            return (entity.id() == object || part.is_inherited()).then_some(entity.id());
        }
        above = entity.get::<ChildOf>().map(ChildOf::parent);
    }
    None
}

/// A component that an entity had, or had not.
struct PartStep<T> {
    entity: Entity,
    value: Option<T>,
}

fn subject<T: Part>(entity: Entity) -> Subject {
    Subject::Part(entity, TypeId::of::<T>())
}

impl<T: Part> Exchange for PartStep<T> {
    fn subject(&self) -> Subject {
        subject::<T>(self.entity)
    }

    fn exchange(self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>> {
        let mut entity = world.get_entity_mut(self.entity).ok()?;
        let before = entity.get::<T>().cloned();
        match self.value {
            Some(value) => entity.insert(value),
            None => entity.remove::<T>(),
        };
        Some(Box::new(Self {
            entity: self.entity,
            value: before,
        }))
    }
}

impl Objects {
    /// The lines and sections of an object. Returns what was there before each edit.
    pub(super) fn parts(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        object: Entity,
        widgets: &mut Widgets,
    ) -> Vec<Box<dyn Exchange>> {
        let mut changes = Vec::new();
        section(ui, "Lines", |ui| {
            changes.extend(self.part::<OutlineStyle>(ui, world, object, widgets));
            changes.extend(self.part::<NoOutlines>(ui, world, object, widgets));
        });
        section(ui, "Sections", |ui| {
            changes.extend(self.part::<MeshSections>(ui, world, object, widgets));
        });
        changes
    }

    /// One component: that of the object, or the one that it inherits.
    fn part<T: Part>(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        object: Entity,
        widgets: &mut Widgets,
    ) -> Option<Box<dyn Exchange>> {
        let entity = source::<T>(world, object).unwrap_or(object);
        if entity != object {
            let text = format!(
                "Edits the component of {}, from which it is inherited.",
                name_of(world, entity)
            );
            let from = ui.label(text);
            note(widgets, format!("{}.source", T::PATH), &from);
        }
        let subject = subject::<T>(entity);
        let before = world.get::<T>(entity).cloned();
        let last = self.removed.get(&subject);
        let last = last.and_then(|last| last.as_any().downcast_ref::<T>().cloned());
        let mut edited = before.clone();
        let mut editor = self.editor(&subject, widgets);
        optional(ui, &mut edited, last, T::PATH, &mut editor);
        let edited = edited.map(T::in_ranges);
        if edited == before.clone().map(T::in_ranges) {
            return None;
        }
        match (&before, &edited) {
            (Some(before), Some(edited)) => {
                let stash = self.shelves.entry(subject).or_default();
                stash.keep_fields(T::PATH, before, edited);
            }
            (Some(before), None) => {
                self.removed.insert(subject, Box::new(before.clone()));
            }
            (None, _) => {}
        }
        let step = PartStep {
            entity,
            value: edited,
        };
        Box::new(step).exchange(world)
    }
}

#[cfg(test)]
mod tests;
