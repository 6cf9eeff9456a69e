//! The figure with the engine's `StandardMaterial`, with bevy_shader_mtoon and with this crate,
//! under four kinds of light.

use std::{fs::File, io::BufWriter, path::Path};

use bevy::{
    core_pipeline::tonemapping::DebandDither, ecs::system::RunSystemOnce, light::RectLight,
    prelude::*, render::view::Msaa,
};
use bevy_comics::{ComicsPlugin, presets, toon::{Ramp, RampMode, RampStop, ToonShading}};
use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions},
    scenes::{
        BuiltIn, ToonPart, Stage,
        lights::{Lighting, relight},
    },
};
use bevy_shader_mtoon::{MtoonMaterial, MtoonPlugin, MtoonSun, VrmOutlineMode};
use image::{
    RgbaImage,
    codecs::png::{CompressionType, FilterType, PngEncoder},
    imageops,
};

const SIZE: UVec2 = UVec2::splat(280);
/// Pixels between pictures.
const GAP: u32 = 6;

#[derive(Clone, Copy, PartialEq)]
enum Who {
    Engine,
    Peer,
    Ours,
}

/// The figure under each kind of light.
fn row(who: Who) -> Vec<RgbaImage> {
    let options = HeadlessOptions {
        size: SIZE,
        log: true,
        ..default()
    };
    let mut headless = Headless::new(options, (ComicsPlugin, MtoonPlugin));
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let vantage = world
        .run_system_once(|mut stage: Stage| stage.spawn(BuiltIn::Figure))
        .expect("the stage is there");
    let camera = world.spawn(vantage.camera()).id();
    world
        .entity_mut(camera)
        .insert((target, Msaa::Sample4, DebandDither::Disabled));
    if who == Who::Ours {
        let style = presets::SATURDAY_MORNING.style();
        style.apply(&mut world.commands().entity(camera));
        world.flush();
        let mut parts = world.query::<(Entity, &ToonPart)>();
        let parts: Vec<_> = parts
            .iter(world)
            .map(|(part, light)| (part, light.0.clone()))
            .collect();
        for (part, light) in parts {
            world.entity_mut(part).insert(light);
        }
    }
    headless.step(3);
    if who == Who::Ours {
        share_light(headless.app.world_mut());
    }
    if who == Who::Peer {
        wear_mtoon(headless.app.world_mut());
    }
    let picture = |lighting| {
        let world = headless.app.world_mut();
        relight(world, camera, lighting);
        let mut suns = world.query_filtered::<Entity, With<DirectionalLight>>();
        for sun in suns.iter(world).collect::<Vec<_>>() {
            world.entity_mut(sun).insert(MtoonSun);
        }
        // The lamp of a theatre is nearer to a face.
        let mut areas = world.query_filtered::<&mut Transform, With<RectLight>>();
        for mut at in areas.iter_mut(world) {
            *at = Transform::from_xyz(-3.0, 3.5, 6.0).looking_at(Vec3::ZERO, Vec3::Y);
        }
        headless.step(12);
        headless.picture()
    };
    Lighting::ALL.map(picture).into()
}

/// Skin by the fraction of all light, with one edge under several lamps. The looks of the figure are
/// made for the light of its scene.
fn share_light(world: &mut World) {
    let color = |code| Color::from(Srgba::hex(code).expect("a color"));
    let stops = [
        RampStop::new(0.0, color("#cf9fae")),
        RampStop::new(0.18, color("#f0b9a8")),
        RampStop::new(0.21, Color::WHITE).soft(0.03),
    ];
    let mut looks = world.resource_mut::<Assets<ToonShading>>();
    for id in looks.ids().collect::<Vec<_>>() {
        let Some(mut look) = looks.get_mut(id) else {
            continue;
        };
        if look.name != "Face" && look.name != "Skin" {
            continue;
        }
        look.light.ramp = Some(Ramp {
            mode: RampMode::LightFraction,
            ..Ramp::new(stops)
        });
        if let Some(proxy) = &mut look.light.proxy {
            proxy.amount = 0.95;
            proxy.amount_at_far = 0.95;
        }
    }
}

/// Gives all meshes that crate's material: colors as they are, darker shades, its own lines.
fn wear_mtoon(world: &mut World) {
    crate::give_uvs(world);
    let mut worn = world.query::<(Entity, &MeshMaterial3d<StandardMaterial>)>();
    let worn: Vec<_> = worn.iter(world).map(|(e, m)| (e, m.0.clone())).collect();
    for (entity, material) in worn {
        let color =
            (world.resource::<Assets<StandardMaterial>>().get(&material)).map(|m| m.base_color);
        let color = color.unwrap_or(Color::WHITE);
        let toon = MtoonMaterial {
            base_color: color,
            shade_factor: shade(color),
            shading_toony_factor: 0.95,
            outline_mode: VrmOutlineMode::Screen,
            outline_width: 0.004,
            ..default()
        };
        let toon = world.resource_mut::<Assets<MtoonMaterial>>().add(toon);
        world
            .entity_mut(entity)
            .remove::<MeshMaterial3d<StandardMaterial>>()
            .insert(MeshMaterial3d(toon));
    }
}

/// The color of shade: three fifths of the light.
fn shade(color: Color) -> Color {
    let light = color.to_linear();
    Color::linear_rgb(0.6 * light.red, 0.6 * light.green, 0.6 * light.blue)
}

/// Draws the sheet: a row for each material, a column for each kind of light.
pub fn write(file: &Path) -> image::ImageResult<()> {
    let rows = [Who::Engine, Who::Peer, Who::Ours].map(row);
    let step = SIZE + UVec2::splat(GAP);
    let columns = rows[0].len() as u32;
    let size = step * UVec2::new(columns, rows.len() as u32) - UVec2::splat(GAP);
    let mut sheet = RgbaImage::from_pixel(size.x, size.y, image::Rgba([255; 4]));
    for (y, row) in (0u32..).zip(&rows) {
        for (x, picture) in (0u32..).zip(row) {
            imageops::replace(
                &mut sheet,
                picture,
                (x * step.x).into(),
                (y * step.y).into(),
            );
        }
    }
    let file = BufWriter::new(File::create(file)?);
    let small = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive);
    sheet.write_with_encoder(small)
}
