//! The page of a picked object: its material, its light, its lines, its sections.

#[cfg(feature = "toon")]
mod base;
mod highlight;
#[cfg(feature = "toon")]
mod light;
#[cfg(feature = "toon")]
mod light_owner;
#[cfg(feature = "objects")]
mod parts;
mod pick;
mod ray;
#[cfg(feature = "toon")]
mod shading_file;
#[cfg(feature = "toon")]
mod steps;
mod surface;

use std::path::PathBuf;

use bevy::{platform::collections::HashMap, prelude::*, reflect::TypeRegistry};
use bevy_egui::egui::{RichText, Ui};

pub use self::{
    highlight::highlight,
    pick::{in_window, pick},
};
use super::{
    ComicsInspector, Widgets,
    fields::{Editor, button_with_tooltip},
    history::{Exchange, Subject},
    note,
    stash::Stash,
};

/// The state of the page.
pub struct Objects {
    /// The types of the settings, for their defaults.
    types: TypeRegistry,
    /// What is turned off, of everything that was edited.
    shelves: HashMap<Subject, Stash>,
    /// The last values of components that were removed.
    removed: HashMap<Subject, Box<dyn Reflect>>,
    #[cfg(feature = "toon")]
    shadings: shading_file::ShadingFile,
}

impl Objects {
    /// `shadings`: the folder of shading files.
    pub fn new(shadings: PathBuf) -> Self {
        #[cfg_attr(
            not(any(feature = "toon", feature = "objects")),
            allow(unused_mut, reason = "there is nothing to register")
        )]
        let mut types = TypeRegistry::default();
        #[cfg(feature = "toon")]
        types.register::<bevy_comics::ToonLight>();
        #[cfg(feature = "objects")]
        parts::register(&mut types);
        #[cfg(not(feature = "toon"))]
        let _ = shadings;
        Self {
            types,
            shelves: HashMap::default(),
            removed: HashMap::default(),
            #[cfg(feature = "toon")]
            shadings: shading_file::ShadingFile::new(shadings),
        }
    }

    /// Draws the page and applies what was edited. Returns what was there before.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        widgets: &mut Widgets,
    ) -> Vec<Box<dyn Exchange>> {
        let Some(object) = picked(world) else {
            ui.label("No object is picked. Press Pick, then click an object in the view.");
            return Vec::new();
        };
        self.head(ui, world, object, widgets);
        #[cfg_attr(
            not(any(feature = "toon", feature = "objects")),
            allow(unused_mut, reason = "there is nothing to edit")
        )]
        let mut changes = Vec::new();
        // The light has many settings, so it comes last.
        #[cfg(feature = "objects")]
        changes.extend(self.parts(ui, world, object, widgets));
        #[cfg(feature = "toon")]
        changes.extend(self.base(ui, world, object, widgets));
        #[cfg(feature = "toon")]
        changes.extend(self.light(ui, world, object, widgets));
        #[cfg(not(any(feature = "toon", feature = "objects")))]
        ui.label("Nothing to edit: the features toon and objects of the crate are off.");
        changes
    }

    /// The name of the object, and the button that lets go of it.
    fn head(&self, ui: &mut Ui, world: &mut World, object: Entity, widgets: &mut Widgets) {
        ui.horizontal_wrapped(|ui| {
            let name = ui.label(RichText::new(name_of(world, object)).strong());
            note(widgets, "object.name", &name);
            #[cfg(feature = "toon")]
            if let Some(material) = world.get::<bevy_comics::toon::MaterialName>(object) {
                ui.label(format!("material {}", material.0));
            }
            let deselect = ("object.deselect", "Deselect", "Deselects the object (Esc)");
            if button_with_tooltip(ui, widgets, deselect, true) {
                world.resource_mut::<ComicsInspector>().picked = None;
            }
        });
    }

    /// What the widgets of a value share.
    fn editor<'a>(&'a mut self, subject: &Subject, widgets: &'a mut Widgets) -> Editor<'a> {
        Editor {
            widgets,
            stash: self.shelves.entry(subject.clone()).or_default(),
            types: &self.types,
        }
    }
}

/// The picked object, if it exists.
pub fn picked(world: &World) -> Option<Entity> {
    let picked = world.resource::<ComicsInspector>().picked?;
    world.get_entity(picked).is_ok().then_some(picked)
}

/// The name of an object, or of the nearest one above it that has a name.
pub fn name_of(world: &World, object: Entity) -> String {
    let mut above = Some(object);
    // Hierarchies can be circles.
    for _ in 0..64 {
        let Some(entity) = above else {
            break;
        };
        if let Some(name) = world.get::<Name>(entity) {
            return if entity == object {
                name.to_string()
            } else {
                format!("{name}, part {object}")
            };
        }
        above = world.get::<ChildOf>(entity).map(ChildOf::parent);
    }
    format!("Object {object}")
}

/// "1 mesh", "2 meshes".
fn meshes(count: usize) -> String {
    match count {
        1 => "1 mesh".into(),
        _ => format!("{count} meshes"),
    }
}

/// Which value an edit changes, and how many meshes have it.
#[cfg(feature = "toon")]
fn edits(what: &str, count: usize) -> String {
    match count {
        0 | 1 => format!("Edits {what}. Only this mesh has it."),
        _ => format!("Edits {what}. {} have it.", meshes(count)),
    }
}

#[cfg(test)]
mod tests;
