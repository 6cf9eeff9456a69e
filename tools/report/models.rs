//! How well outlines follow the edges of models that resemble real assets, while these
//! turn: recall and precision against the geometry at a finer resolution, and fragments.

use std::f32::consts::TAU;

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    prelude::*,
};
use bevy_comics::{ComicStyle, Outlines};
use bevy_comics_testkit::{
    specimens::Specimen,
    truth::{FINE, fragments, ids_alone},
};

use crate::{
    Run,
    rig::{Drawn, Rig, unlit},
    table::Table,
};

/// Distances of the camera in radii of the model: it fills the picture, or is a
/// sixth as high.
pub const DISTANCES: [(&str, f32); 2] = [("close", 2.6), ("distant", 16.0)];

/// A camera in front of a white model on white: every darker pixel is ink.
pub struct Studio {
    pub rig: Rig,
    parts: Vec<Entity>,
}

impl Studio {
    pub fn new(size: UVec2, outlines: Outlines) -> Self {
        let mut rig = Rig::new(None, size);
        rig.set_drawn(&Drawn::style(ComicStyle::new().with(outlines)));
        let world = rig.headless.app.world_mut();
        world.insert_resource(ClearColor(Color::WHITE));
        world
            .entity_mut(rig.camera)
            .insert((DepthPrepass, NormalPrepass));
        Self { rig, parts: vec![] }
    }

    pub fn show(&mut self, specimen: Specimen) {
        let meshes = specimen.parts().into_iter().map(|(mesh, _)| mesh);
        self.show_meshes(meshes.collect());
    }

    pub fn show_meshes(&mut self, meshes: Vec<Mesh>) {
        let world = self.rig.headless.app.world_mut();
        for part in self.parts.drain(..) {
            world.despawn(part);
        }
        let material = StandardMaterial {
            double_sided: true,
            cull_mode: None,
            ..unlit(Color::WHITE)
        };
        for mesh in meshes {
            let part = self.rig.put(mesh, material.clone(), Transform::IDENTITY);
            self.parts.push(part);
        }
    }

    /// Draws the model turned by a fraction of a full turn.
    pub fn turn(&mut self, distance: f32, turned: f32) {
        let eye = Quat::from_rotation_y(turned * TAU) * Vec3::new(0.0, 0.34, 0.94) * distance;
        let at = Transform::from_translation(eye).looking_at(Vec3::ZERO, Vec3::Y);
        let world = self.rig.headless.app.world_mut();
        world.entity_mut(self.rig.camera).insert(at);
        self.rig.headless.step(2);
    }

    /// The pixels with ink: at least a quarter of the light is missing.
    pub fn mask(&mut self) -> Vec<bool> {
        let picture = self.rig.headless.picture();
        picture.pixels().map(|p| p.0[1] < 191).collect()
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut table =
        Table::new("model,distance,frame,found,true,right,drawn,false,wrong,pixels,fragments,line");
    let (frames, size) = (run.pick(1, 90), run.size([120, 68], [240, 136]));
    let mut fine = Studio::new(size * FINE, ids_alone());
    // Without the ink budget, which makes crowded lines too thin for the mask.
    let found = Outlines {
        ink_budget: 1.0,
        ..default()
    };
    let mut lined = Studio::new(size, found);
    let thin = Outlines {
        width: 1.0,
        ..found
    };
    let large = size * FINE;
    let mut thin = Studio::new(large, thin);
    for model in run.some(1, Specimen::ALL) {
        for studio in [&mut fine, &mut lined, &mut thin] {
            studio.show(model);
            studio.rig.headless.step(4);
        }
        for (name, distance) in DISTANCES {
            for frame in 0..frames {
                let turned = frame as f32 / frames as f32;
                for studio in [&mut fine, &mut lined, &mut thin] {
                    studio.turn(distance, turned);
                }
                let truth = fine.rig.truth(size, FINE);
                let wanted = truth.any(&[0, 1, 2]);
                let lines = lined.mask();
                let (found, all) = truth.recall(&wanted, &lines);
                let (right, drawn) = truth.precision(&wanted, &lines);
                let (faint, _) = truth.precision(&truth.faint, &lines);
                let mask = thin.mask();
                let small = fragments(&mask, large.x as usize, 6);
                let line = mask.iter().filter(|ink| **ink).count();
                table.push(&[
                    &model.name(),
                    &name,
                    &frame,
                    &found,
                    &all,
                    &right,
                    &drawn,
                    &(drawn - right),
                    &(drawn - faint),
                    &truth.inside().count(),
                    &small,
                    &line,
                ]);
            }
        }
        run.say(&format!("{}: lines scored", model.name()));
    }
    run.save("model_scores", &table)
}
