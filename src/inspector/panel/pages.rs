//! The pages of the panel, and what they leave behind.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::Ui;

use super::{
    super::{Widgets, fields, memory::Tab, views},
    Panel,
};
use crate::{ComicStyle, DebugView, EffectRegistry, StyleTransition};

impl Panel {
    /// The page that is chosen.
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
                    ui.label("A transition is under way: a change ends it.");
                }
                let types = world.resource::<EffectRegistry>().types();
                fields::style(ui, style, &types, widgets);
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
                // A view that the game has chosen stays the game's.
                if !world.entity(camera).contains::<DebugView>() && !self.debugged.contains(&camera)
                {
                    self.debugged.push(camera);
                }
                views::show(ui, world, camera, widgets);
            }
            Tab::Cost => self.costs.show(ui, world, camera, widgets),
            Tab::Photo => {
                self.photo
                    .show(ui, world, &mut self.memory.multiple, widgets);
            }
        }
    }

    /// Ends what only a page that is not shown needs.
    pub(super) fn leave_other_pages(&mut self, world: &mut World) {
        if self.memory.tab != Tab::Views {
            views::leave(world);
        }
        if self.memory.tab != Tab::Cost {
            self.costs.close(world);
        }
    }
}
