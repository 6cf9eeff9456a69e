//! The pages of the panel.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::Ui;

use super::{
    super::{
        Widgets,
        fields::{self, Editor},
        history::Step,
        memory::Tab,
        views,
    },
    Panel,
};
use bevy_comics::{ComicStyle, StyleTransition, diagnostics::DebugView, effect::EffectRegistry};

impl Panel {
    /// Draws the chosen page.
    pub(super) fn page(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        camera: Entity,
        style: &mut ComicStyle,
        widgets: &mut Widgets,
    ) {
        match self.memory.tab {
            Tab::Style => {
                if world.entity(camera).contains::<StyleTransition>() {
                    ui.label("A transition to another style is running. Editing ends it.");
                }
                let effects = world.resource::<EffectRegistry>().types();
                let types = self.types.get_or_insert_with(|| fields::types(&effects));
                let mut editor = Editor {
                    widgets,
                    stash: &self.cameras.entry(camera).or_default().stash,
                    types,
                };
                let search = self.search.search();
                fields::style(ui, style, &effects, search.as_ref(), &mut editor);
            }
            Tab::Object => {
                let gesture = self.gesture(ui);
                for before in self.objects.show(ui, world, widgets) {
                    let step = Step::Object(before);
                    self.history.record(step, camera, gesture);
                    self.message = None;
                }
            }
            Tab::Presets => self.presets.show(
                ui,
                world,
                camera,
                self.files.folder(),
                &mut self.memory.fade,
                widgets,
            ),
            Tab::Files => self.files.show(ui, camera, style, widgets),
            Tab::Views => {
                // A view that the game has set stays when the panel closes.
                if !world.entity(camera).contains::<DebugView>() && !self.debugged.contains(&camera)
                {
                    self.debugged.push(camera);
                }
                views::show(ui, world, camera, style, widgets);
            }
            Tab::Cost => self.costs.show(ui, world, camera, widgets),
            Tab::Photo => {
                self.photo
                    .show(ui, world, &mut self.memory.multiple, widgets);
            }
        }
    }

    /// Stops the measurements of the pages that are not shown.
    pub(super) fn leave_other_pages(&mut self, world: &mut World) {
        if self.memory.tab != Tab::Views {
            views::leave(world);
        }
        if self.memory.tab != Tab::Cost {
            self.costs.close(world);
        }
    }
}
