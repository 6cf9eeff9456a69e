//! The light of a picked object.

use bevy::prelude::*;
use bevy_egui::egui::Ui;

use super::{
    super::{
        Widgets,
        fields::{button_with_tooltip, section, settings},
        history::{Exchange, Subject},
        note,
    },
    Objects, edits,
    light_owner::LightOwner,
    meshes, name_of,
    steps::{LightStep, MaterialStep, subject_of, with_material},
};
use bevy_comics::{
    ToonLight,
    toon::{Ramp, RampStop},
};

/// The path of the lighting in the panel.
const PATH: &str = "light";

impl Objects {
    /// The light of an object. Returns what was there before an edit.
    pub(super) fn light(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        object: Entity,
        widgets: &mut Widgets,
    ) -> Option<Box<dyn Exchange>> {
        section(ui, "Light", |ui| {
            if let Some(place) = LightOwner::of(world, object) {
                return self.settings_of(ui, world, &place, widgets);
            }
            let standard = world.get::<MeshMaterial3d<StandardMaterial>>(object);
            match standard.map(|material| material.0.clone()) {
                Some(standard) => offer(ui, world, &standard, widgets),
                None => {
                    ui.label("The object has neither a toon material nor a standard material.");
                    None
                }
            }
        })
        .flatten()
    }

    /// The settings of the lighting in a place.
    fn settings_of(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        place: &LightOwner,
        widgets: &mut Widgets,
    ) -> Option<Box<dyn Exchange>> {
        let count = place.meshes(world);
        let place_label = ui.label(what_is_edited(world, place, count));
        note(widgets, "light.place", &place_label);
        let before = place.light(world)?.clone();
        let title = place.title(world).to_owned();
        self.shadings.show(ui, place, (&before, &title), widgets);
        ui.separator();
        let mut edited = before.clone();
        let subject = subject_of(place);
        let default = ToonLight::default();
        let mut editor = self.editor(&subject, widgets);
        settings(ui, &mut edited, Some(&default), (PATH, None), &mut editor);
        self.set(world, place, (before, edited), subject)
    }

    /// Sets the lighting of a place, if it was edited.
    fn set(
        &mut self,
        world: &mut World,
        place: &LightOwner,
        (before, edited): (ToonLight, ToonLight),
        subject: Subject,
    ) -> Option<Box<dyn Exchange>> {
        let edited = in_ranges(edited);
        // Values that the game has set out of range are not a change by the panel.
        if edited == in_ranges(before.clone()) {
            return None;
        }
        let stash = self.shelves.entry(subject).or_default();
        stash.keep_fields(PATH, &before, &edited);
        let step = Box::new(LightStep {
            place: place.clone(),
            light: edited,
        });
        step.exchange(world)
    }
}

/// Which value an edit changes, and how many meshes have it.
fn what_is_edited(world: &World, place: &LightOwner, count: usize) -> String {
    let edited = match place {
        LightOwner::Shading(shading) => {
            let title = match place.title(world) {
                "" => String::new(),
                title => format!(" “{title}”"),
            };
            match shading.path() {
                Some(path) => format!("the shading{title} in {path}"),
                None => format!("the shading{title}, which is made by code"),
            }
        }
        LightOwner::Scene(root) => {
            format!("ToonScene::light of {}", name_of(world, *root))
        }
        LightOwner::Material(material) => match material.path() {
            Some(path) => format!("the material {path}"),
            None => "the material, which is made by code".into(),
        },
    };
    edits(&edited, count)
}

/// Offers to make a standard material a toon material.
fn offer(
    ui: &mut Ui,
    world: &mut World,
    standard: &Handle<StandardMaterial>,
    widgets: &mut Widgets,
) -> Option<Box<dyn Exchange>> {
    let count = with_material(world, standard).len();
    ui.label(format!("A standard material, of {}.", meshes(count)));
    let convert = (
        "light.convert",
        "Make it a toon material",
        "All meshes that have this material get a ToonMaterial with its colors and textures.",
    );
    if !button_with_tooltip(ui, widgets, convert, true) {
        return None;
    }
    let step = MaterialStep::toon(world, standard);
    let Some(step) = step else {
        ui.label("The material has not loaded, or the app does not draw toon materials.");
        return None;
    };
    Box::new(step).exchange(world)
}

/// A lighting with every number in its range. Stops stay in their order, so that one that is
/// dragged past another keeps its row.
pub(super) fn in_ranges(light: ToonLight) -> ToonLight {
    let ramp = light.ramp.clone();
    let mut used = light.sanitized();
    if let (Some(used), Some(own)) = (&mut used.ramp, ramp) {
        used.stops = in_order(&own.stops, &used.stops);
        if let (Some(used), Some(own)) = (&mut used.detail, own.detail) {
            used.plain = in_order(&own.plain, &used.plain);
        }
    }
    used
}

/// The stops that are `used`, in the order in which a ramp has its own ones.
fn in_order(own: &[RampStop], used: &[RampStop]) -> Vec<RampStop> {
    if own.is_empty() {
        return used.to_vec();
    }
    let alone = |stop: &RampStop| Ramp::new([*stop]).sanitized().stops;
    own.iter().take(used.len()).flat_map(alone).collect()
}

#[cfg(test)]
mod tests;
