//! A camera that goes once around the scene.

use std::f32::consts::TAU;

use bevy::prelude::*;
use bevy_comics_testkit::headless::Headless;

use crate::{
    model,
    output::{FrameWriter, Frames},
};

/// Time of one turn, seconds.
const SECONDS: f32 = 4.0;
/// Updates for each frame: depth ranges that are smoothed over time follow.
const UPDATES: usize = 2;

/// Writes `count` frames of a turn around the vertical axis through `pivot`.
pub fn write(
    headless: &mut Headless,
    camera: Entity,
    pivot: Vec3,
    count: u32,
    frames: &Frames,
) -> Result<(), String> {
    let size = (headless.options.size.x, headless.options.size.y);
    let start = headless.app.world().get::<Transform>(camera).copied();
    let start = start.ok_or("the camera has no place")?;
    let mut writer = FrameWriter::new(frames, size, count, SECONDS)?;
    for frame in 0..count {
        let mut place = start;
        let angle = TAU * frame as f32 / count as f32;
        place.rotate_around(pivot, Quat::from_rotation_y(angle));
        set_place(headless.app.world_mut(), camera, place);
        headless.step(UPDATES);
        writer.add(headless.picture())?;
        println!("turntable: {} of {count}", frame + 1);
    }
    println!("wrote {}", writer.finish()?);
    Ok(())
}

/// Moves the camera, and the surroundings of a model with it.
pub fn set_place(world: &mut World, camera: Entity, place: Transform) {
    let mut camera = world.entity_mut(camera);
    if let Some(mut environment) = camera.get_mut::<EnvironmentMapLight>() {
        model::turn_environment(&place, &mut environment);
    }
    camera.insert(place);
}
