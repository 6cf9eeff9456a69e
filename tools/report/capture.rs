//! Depth and picture of moving views, for what is computed on the CPU.

use bevy::{
    core_pipeline::{prepass::DepthPrepass, tonemapping::Tonemapping},
    prelude::*,
    render::RenderApp,
};
use bevy_comics::{Colorization, ComicStyle, Desaturation, effects::Equations};
use nv_flip::{FlipImageRgb8, FlipPool};

use bevy_comics_testkit::{
    read_back,
    reference::{
        color::{srgb_decode, srgb_encode},
        colorization, desaturation,
        map::{Frame, Projection as MapProjection},
    },
    scenes::BuiltIn,
};

use crate::{
    Run,
    rig::{Drawn, Rig},
};

/// A short flight through a scene.
pub struct Capture {
    pub name: String,
    pub size: UVec2,
    pub shots: Vec<Shot>,
}

pub struct Shot {
    /// Raw reversed depth of an infinite perspective view, row by row.
    pub depth: Vec<f32>,
    /// The unstyled, tonemapped picture in linear light, row by row.
    pub picture: Vec<[f64; 3]>,
}

impl Shot {
    /// Raw depth of the nearest and farthest geometry; `None` without any.
    pub fn ends(&self) -> Option<[f32; 2]> {
        bevy_comics_testkit::reference::range::scan(self.depth.iter().copied())
            .map(|bits| bits.map(f32::from_bits))
    }
}

/// Renders a frame and reads it back.
pub fn shoot(rig: &mut Rig) -> Shot {
    rig.headless.step(1);
    let view = rig.view();
    let picture = rig.headless.picture();
    let world = rig.headless.app.sub_app(RenderApp).world();
    let depth = read_back::depth(world, view).expect("a prepass");
    Shot {
        depth: depth.bits.iter().map(|b| f32::from_bits(*b)).collect(),
        picture: picture
            .pixels()
            .map(|p| srgb_decode([0, 1, 2].map(|i| f64::from(p.0[i]) / 255.0)))
            .collect(),
    }
}

/// The camera in a frame. Per frame it moves ahead by a hundredth of the distance to its
/// target, and to the right by 0.3 of that.
fn path(from: Transform, target: Vec3, frame: usize) -> Transform {
    let step = (target - from.translation).length() * 0.01 * frame as f32;
    let moved = from.translation + from.forward() * step + from.right() * (0.3 * step);
    Transform {
        translation: moved,
        ..from
    }
}

/// Wires 0.004 units wide, 1 to 9 units away. Most are narrower than a pixel: strides may
/// miss them.
fn wires(rig: &mut Rig) {
    let world = rig.headless.app.world_mut();
    let wire = world
        .resource_mut::<Assets<Mesh>>()
        .add(Cuboid::new(0.004, 3.0, 0.004));
    let wall = world
        .resource_mut::<Assets<Mesh>>()
        .add(Plane3d::new(Vec3::Z, Vec2::splat(30.0)));
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: Color::srgb(0.8, 0.5, 0.3),
            unlit: true,
            ..default()
        });
    for i in 0..24u8 {
        let z = -1.0 - 0.35 * f32::from(i);
        let at = Transform::from_xyz(0.11 * (f32::from(i) - 12.0), 0.0, z);
        world.spawn((
            Mesh3d(wire.clone()),
            MeshMaterial3d(material.clone()),
            at.with_rotation(Quat::from_rotation_z(0.02 * f32::from(i))),
        ));
    }
    world.spawn((
        Mesh3d(wall),
        MeshMaterial3d(material),
        Transform::from_xyz(0.0, 0.0, -12.0),
    ));
}

/// 300 small balls, most of them a few pixels wide.
fn specks(rig: &mut Rig) {
    let world = rig.headless.app.world_mut();
    let ball = world
        .resource_mut::<Assets<Mesh>>()
        .add(Sphere::new(0.03).mesh().uv(8, 6));
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial {
            base_color: Color::srgb(0.3, 0.6, 0.4),
            unlit: true,
            ..default()
        });
    let mut random = bevy_comics_testkit::scenes::noise::Random::new(8);
    for _ in 0..300 {
        let z = -(1.0 + 40.0 * random.unit() * random.unit());
        let at = Vec3::new(
            z * (random.unit() - 0.5),
            z * (random.unit() - 0.5) * 0.6,
            z,
        );
        world.spawn((
            Mesh3d(ball.clone()),
            MeshMaterial3d(material.clone()),
            Transform::from_translation(at),
        ));
    }
}

pub const FRAMES: usize = 17;

/// The built-in scenes and two difficult ones, with a moving camera.
pub fn captures(run: &Run, frames: usize) -> Vec<Capture> {
    let size = if run.quick {
        UVec2::new(160, 90)
    } else {
        UVec2::new(640, 360)
    };
    let mut all = Vec::new();
    let built_in = BuiltIn::MEASURED
        .into_iter()
        .map(|scene| (scene.name(), Some(scene)));
    for (name, scene) in built_in.chain([("wires", None), ("specks", None)]) {
        if run.quick && !matches!(name, "teapot" | "wires") {
            continue;
        }
        let mut rig = Rig::new(scene, size);
        match name {
            "wires" => wires(&mut rig),
            "specks" => specks(&mut rig),
            _ => {}
        }
        let (from, target) = match &rig.vantage {
            Some(vantage) => (vantage.transform(), vantage.target),
            None => (Transform::IDENTITY, Vec3::new(0.0, 0.0, -4.0)),
        };
        rig.set_drawn(&Drawn::Nothing);
        let camera = rig.camera;
        let world = rig.headless.app.world_mut();
        world
            .entity_mut(camera)
            .insert((DepthPrepass, Tonemapping::AcesFitted));
        rig.headless.step(2);
        let shots = (0..frames)
            .map(|frame| {
                let world = rig.headless.app.world_mut();
                world.entity_mut(camera).insert(path(from, target, frame));
                shoot(&mut rig)
            })
            .collect();
        run.say(&format!("{name} captured"));
        all.push(Capture {
            name: name.to_owned(),
            size,
            shots,
        });
    }
    all
}

/// The linear min-max map between two raw depths of an infinite perspective view.
pub fn frame(ends: [f64; 2]) -> Frame {
    Frame {
        projection: MapProjection::Perspective { offset: 0.0 },
        ends: Some(ends),
        logarithmic: false,
        floor: 1.0 / 16384.0,
        sky_gap: 0.05,
    }
}

/// The style in which errors of the map are judged: the corrected equations of [CS] Eq. 6 and
/// 11 at full strength.
pub fn look() -> ComicStyle {
    ComicStyle::new()
        .with(Desaturation {
            equations: Equations::Corrected,
            ..Desaturation::default()
        })
        .with(Colorization::default())
}

/// Display codes of a pixel in that style. `light`: linear; then D and its complement.
pub fn styled(style: &ComicStyle, light: [f64; 3], [d, l]: [f64; 2]) -> [u8; 3] {
    let mut linear = light;
    let mut saturation = 1.0;
    if let Some(s) = style.get::<Desaturation>() {
        saturation = desaturation::saturation_left(s, l);
        linear = desaturation::desaturate(s, linear, saturation);
    }
    if let Some(s) = style.get::<Colorization>() {
        linear = colorization::colorize(s, linear, d, l, saturation);
    }
    srgb_encode(linear).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// Mean FLIP difference of two pictures of display codes, 0 to 1.
pub fn flip(size: UVec2, a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    let image = |p: &[[u8; 3]]| FlipImageRgb8::with_data(size.x, size.y, p.as_flattened());
    let map = nv_flip::flip(image(a), image(b), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    f64::from(FlipPool::from_image(&map).mean())
}
