//! What the cartoon material costs beside the standard material: the main pass of one scene, with
//! all meshes in one material after the other.

use bevy::prelude::*;
use bevy_comics::{
    CartoonLight, CartoonScene, DetailAxis, FormShape, Glint, GlintShape, Hatching, Ramp,
    RampDetail, RampMode, RampStop, Rim, ShadedForm,
};
use bevy_comics_testkit::{
    bench::{self, Lap},
    scenes::BuiltIn,
};

use crate::{Run, rig::Rig, table::Table};

/// The materials that are compared: `None` is the standard material.
fn variants() -> Vec<(&'static str, Option<CartoonLight>)> {
    let with = |ramp| CartoonLight {
        ramp: Some(ramp),
        ..default()
    };
    let in_mode = |mode| Ramp {
        mode,
        ..Ramp::default()
    };
    let tones = |count: u8| {
        let stop = |k| {
            let part = f32::from(k) / f32::from(count);
            RampStop::new(part, Color::linear_rgb(part, part, part))
        };
        Ramp::new((0..count).map(stop))
    };
    vec![
        ("standard material", None),
        ("no ramp", Some(CartoonLight::default())),
        ("no ramp; no highlights", {
            let highlight = 0.0;
            Some(CartoonLight {
                highlight,
                ..default()
            })
        }),
        ("default ramp", Some(with(Ramp::default()))),
        ("PerLight", Some(with(in_mode(RampMode::PerLight)))),
        ("Brightest", Some(with(in_mode(RampMode::Brightest)))),
        ("Share; 4 stops", Some(with(tones(4)))),
        ("Share; 8 stops", Some(with(tones(8)))),
        ("default ramp; a second one by depth", {
            let ramp = Ramp {
                detail: Some(RampDetail::default()),
                ..Ramp::default()
            };
            Some(with(ramp))
        }),
        ("default ramp; a second one by the visible range", {
            let detail = RampDetail {
                axis: DetailAxis::VisibleRange,
                ..default()
            };
            let ramp = Ramp {
                detail: Some(detail),
                ..Ramp::default()
            };
            Some(with(ramp))
        }),
        ("no ramp; smoothed normals", {
            let form = ShadedForm {
                shape: FormShape::Smoothed { rounds: 8 },
                ..default()
            };
            Some(CartoonLight {
                form: Some(form),
                ..default()
            })
        }),
        ("no ramp; a window as highlight", {
            let glint = Glint {
                shape: GlintShape::Window,
                ..default()
            };
            Some(CartoonLight {
                glint: Some(glint),
                ..default()
            })
        }),
        ("no ramp; a rim", {
            let rim = Some(Rim::default());
            Some(CartoonLight { rim, ..default() })
        }),
        ("no ramp; hatching", {
            let hatching = Some(Hatching::default());
            Some(CartoonLight {
                hatching,
                ..default()
            })
        }),
        ("standard material again", None),
    ]
}

/// Gives all meshes the material of a variant.
fn wear(rig: &mut Rig, meshes: &[Entity], light: Option<&CartoonLight>) {
    let world = rig.headless.app.world_mut();
    for mesh in meshes {
        let mut mesh = world.entity_mut(*mesh);
        match light {
            Some(light) => mesh.insert(CartoonScene::new(light.clone())),
            None => mesh.remove::<CartoonScene>(),
        };
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = UVec2::new(400, 280);
    let mut times = Table::new(&["scene", "variant", "width", "height", "round", "main"]);
    for scene in [BuiltIn::Theatre, BuiltIn::Teapot] {
        let mut rig = Rig::new(Some(scene), size);
        let world = rig.headless.app.world_mut();
        let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
        let meshes: Vec<Entity> = meshes.iter(world).collect();
        // Round 0 compiles the variants, and is not counted.
        for round in 0..=3 * run.rounds {
            for (name, light) in variants() {
                wear(&mut rig, &meshes, light.as_ref());
                rig.headless.step(2);
                let frames = bench::laps(&mut rig.headless, 2 * run.frames);
                let main = frames.iter().map(|laps| laps[Lap::Main as usize]);
                let main = format!("{:.4}", main.fold(f64::INFINITY, f64::min));
                if round > 0 {
                    times.push(&[&scene.name(), &name, &size.x, &size.y, &round, &main]);
                }
            }
        }
        run.say(scene.name());
    }
    run.save("toon_times", &times)
}
