//! The face and the hair of a figure, with the normals of their meshes and with smoothed ones.

use std::{thread, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_comics::{
    presets,
    toon::{ProxyShape, ShadingProxy, ToonShading},
};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::sheet::in_rows;

/// Frames until normals are made and the picture stands still.
const SETTLE: usize = 10;

pub fn picture() -> RgbaImage {
    let size = UVec2::new(400, 400);
    let mut studio = Studio::new(BuiltIn::Figure, size, Msaa::Sample4);
    let camera = studio.camera;
    let mut camera = studio.headless.app.world_mut().entity_mut(camera);
    if let Some(mut lens) = camera.get_mut::<Projection>()
        && let Projection::Perspective(lens) = &mut *lens
    {
        lens.fov *= 0.72;
    }
    let style = presets::SATURDAY_MORNING.style();
    studio.shoot(Some(&style));
    let stopped = TimeUpdateStrategy::ManualDuration(Duration::ZERO);
    studio.headless.app.insert_resource(stopped);
    let pictures = [None, Some(30)].map(|rounds| {
        let form = rounds.map(|rounds| ShadingProxy {
            shape: ProxyShape::Smoothed { rounds },
            ..default()
        });
        let world = studio.headless.app.world_mut();
        let mut looks = world.resource_mut::<Assets<ToonShading>>();
        for (_, look) in looks.iter_mut() {
            if ["Face", "Hair"].contains(&look.name.as_str()) {
                look.light.proxy = form;
            }
        }
        for _ in 0..SETTLE {
            studio.headless.step(1);
            thread::sleep(Duration::from_millis(200));
        }
        studio.headless.picture()
    });
    in_rows(&pictures, 2, size, 6)
}
