//! What a style does not need is left out: its work is counted and timed.

use bevy::prelude::*;
use bevy_comics::ComicsPlugin;

use bevy_comics_testkit::{
    bench,
    headless::Headless,
    scenes::BuiltIn,
    work::{self, WorkCounter},
};

use crate::{
    Run,
    rig::{self, Rig},
    table::Table,
};

/// The row of a counted style.
fn work_row(work: &work::Work) -> Vec<String> {
    vec![
        work.name.replace(',', ";"),
        work.ran.len().to_string(),
        work.ran.join(" + "),
        work.left_out.to_string(),
        work.bindings.to_string(),
        format!("{:.2}", work.fetches[0]),
        format!("{:.0}", work.fetches[1]),
        format!("{:.2}", work.bytes),
        format!("{:.2}", work.lines.walk),
        format!("{:.2}", work.lines.find),
        format!("{:.2}", work.lines.columns),
        format!("{:.2}", work.lines.draw),
        format!("{:.2}", work.lines.bytes),
    ]
}

/// Times whole frames of an app without the plugin and of one with it but without a style,
/// in turn.
fn idle(run: &Run) -> Result<(), String> {
    let size = UVec2::new(320, 180);
    let mut apps: Vec<(&str, Headless)> = Vec::new();
    for name in [
        "without the plugin",
        "idle plugin",
        "without the plugin again",
    ] {
        let options = bench::options(size);
        let mut headless = match name {
            "idle plugin" => Headless::new(options, ComicsPlugin),
            _ => Headless::new(options, ()),
        };
        let target = headless.render_target();
        let world = headless.app.world_mut();
        let mesh = Mesh3d(world.add_asset(Cuboid::from_length(1.0)));
        let material = world.add_asset::<StandardMaterial>(StandardMaterial::default());
        world.spawn((mesh, MeshMaterial3d(material)));
        let at = Transform::from_xyz(2.0, 2.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y);
        world.spawn((Camera3d::default(), at, target, Msaa::Off));
        headless.step(10);
        apps.push((name, headless));
    }
    let mut table = Table::new("app,round,milliseconds");
    for round in 0..run.pick(10, 300) {
        for (name, headless) in &mut apps {
            let ms = bench::whole_frame(headless);
            table.push(&[name, &round, &format!("{ms:.4}")]);
        }
    }
    run.say("idle plugin timed");
    run.save("idle_times", &table)
}

/// Spawns a lit ball of about `vertices` vertices in the middle of the view.
pub fn ball(rig: &mut Rig, vertices: u32) {
    let side = (f64::from(vertices).sqrt().round() as u32).max(4);
    let material = StandardMaterial::from_color(Color::srgb(0.7, 0.4, 0.3));
    let light = DirectionalLight::default();
    let world = rig.headless.app.world_mut();
    world.spawn((light, Transform::from_rotation(Quat::from_rotation_x(-0.7))));
    let mesh = Sphere::new(1.0).mesh().uv(side - 1, side - 1);
    rig.put(mesh, material, Transform::from_xyz(0.0, 0.0, -3.0));
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut styles = run.some(2, work::ladder());
    if run.quick {
        // With lines, and everything else.
        styles.extend(work::ladder().pop());
    }
    let size = run.size([320, 180], [1280, 720]);
    let named = styles.iter().cloned();
    let variants = rig::styles(named.map(|(name, style)| (name.replace(',', ";"), style)));
    let mut times = rig::times();
    let mut rig = Rig::new(Some(BuiltIn::Teapot), size);
    rig.unlight();
    rig::record(run, &mut times, "ladder", "teapot", &mut rig, &variants);
    run.save("ladder_times", &times)?;
    idle(run)?;

    // The same on every adapter, so it is last where the time is short.
    let mut counted = Table::new(
        "style,passes,ran,left_out,bindings,fetches,most,bytes,walk,find,columns,draw,line_bytes",
    );
    let mut counter = WorkCounter::default();
    for (name, style) in &styles {
        counted.rows.push(work_row(&counter.count(name, style)));
    }
    run.say("work counted");
    run.save("work", &counted)
}
