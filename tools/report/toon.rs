//! What the toon material costs beside the standard material: the main pass of one scene, with all
//! meshes in one material after the other. A depth prepass lets each pixel be shaded once; without
//! it, the order of draws, which is another one for every material, decides how many are shaded
//! twice.

use bevy::{
    asset::RenderAssetUsages,
    core_pipeline::prepass::DepthPrepass,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};
use bevy_comics::{
    Hatching, ToonLight, ToonScene,
    toon::{
        DetailAxis, HighlightShape, ProxyShape, Ramp, RampDetail, RampMode, RampStop, Rim,
        ShadingProxy, StylizedHighlight,
    },
};
use bevy_comics_testkit::{
    bench::{self, Lap},
    scenes::BuiltIn,
};

use crate::{Run, rig::Rig, table::Table};

/// An image of grays, darker to the left.
fn grays(images: &mut Assets<Image>, width: u32, height: u32) -> Handle<Image> {
    let texel = |k: u32| {
        let code = (255 * (k % width) / (width - 1)) as u8;
        [code, code, code, 255]
    };
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    images.add(Image::new(
        size,
        TextureDimension::D2,
        (0..width * height).flat_map(texel).collect(),
        TextureFormat::Rgba8Unorm,
        RenderAssetUsages::default(),
    ))
}

/// Ramps that are images, and thresholds from one.
fn mapped(images: &mut Assets<Image>) -> Vec<(&'static str, Option<ToonLight>)> {
    let mut painted = |mode, height, detail| ToonLight {
        ramp: Some(Ramp {
            mode,
            detail,
            ..Ramp::default()
        }),
        ramp_map: grays(images, 256, height).into(),
        ..default()
    };
    let row = painted(RampMode::LightFraction, 1, None);
    let each = painted(RampMode::PerLight, 1, None);
    let rows = painted(RampMode::LightFraction, 64, Some(RampDetail::default()));
    let thresholds = ToonLight {
        ramp: Some(Ramp::default()),
        threshold_map: Some(grays(images, 256, 256)),
        ..default()
    };
    vec![
        ("LightFraction; 256 tones of an image", Some(row)),
        ("PerLight; 256 tones of an image", Some(each)),
        ("LightFraction; 64 rows of an image by depth", Some(rows)),
        ("default ramp; thresholds of an image", Some(thresholds)),
    ]
}

/// The materials that are compared: `None` is the standard material.
fn variants(images: &mut Assets<Image>) -> Vec<(&'static str, Option<ToonLight>)> {
    let light = |change: fn(&mut ToonLight)| {
        let mut light = ToonLight::default();
        change(&mut light);
        Some(light)
    };
    let with = |ramp| {
        let ramp = Some(ramp);
        Some(ToonLight { ramp, ..default() })
    };
    let ramp = |change: fn(&mut Ramp)| {
        let mut ramp = Ramp::default();
        change(&mut ramp);
        with(ramp)
    };
    let tones = |count: u8| {
        let stop = |k| {
            let part = f32::from(k) / f32::from(count);
            RampStop::new(part, Color::linear_rgb(part, part, part))
        };
        with(Ramp::new((0..count).map(stop)))
    };
    let by_depth = |ramp: &mut Ramp| ramp.detail = Some(RampDetail::default());
    let by_range = |ramp: &mut Ramp| {
        let axis = DetailAxis::VisibleRange;
        ramp.detail = Some(RampDetail { axis, ..default() });
    };
    let smoothed = |light: &mut ToonLight| {
        let shape = ProxyShape::Smoothed { rounds: 8 };
        light.proxy = Some(ShadingProxy { shape, ..default() });
    };
    let window = |light: &mut ToonLight| {
        let shape = HighlightShape::Window;
        light.stylized_highlight = Some(StylizedHighlight { shape, ..default() });
    };
    let mut all = vec![
        ("standard material", None),
        ("no ramp", light(|_| ())),
        ("no ramp; no highlights", light(|l| l.highlight = 0.0)),
        ("default ramp", ramp(|_| ())),
        ("PerLight", ramp(|r| r.mode = RampMode::PerLight)),
        ("Brightest", ramp(|r| r.mode = RampMode::Brightest)),
        ("LightFraction; 4 stops", tones(4)),
        ("LightFraction; 8 stops", tones(8)),
        ("default ramp; a second one by depth", ramp(by_depth)),
        (
            "default ramp; a second one by the visible range",
            ramp(by_range),
        ),
        ("no ramp; smoothed normals", light(smoothed)),
        ("no ramp; a window as highlight", light(window)),
        ("no ramp; a rim", light(|l| l.rim = Some(Rim::default()))),
        (
            "no ramp; hatching",
            light(|l| l.hatching = Some(Hatching::default())),
        ),
    ];
    all.extend(mapped(images));
    all.push(("standard material again", None));
    all
}

/// Gives all meshes the material of a variant.
fn set_light(rig: &mut Rig, meshes: &[Entity], light: Option<&ToonLight>) {
    let world = rig.headless.app.world_mut();
    for mesh in meshes {
        let mut mesh = world.entity_mut(*mesh);
        match light {
            Some(light) => mesh.insert(ToonScene::new(light.clone())),
            None => mesh.remove::<ToonScene>(),
        };
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = run.size([100, 70], [400, 280]);
    let mut times = Table::new("scene,variant,width,height,round,main");
    for scene in run.some(1, [BuiltIn::Theatre, BuiltIn::Teapot]) {
        let mut rig = Rig::new(Some(scene), size);
        let (camera, meshes) = (rig.camera, rig.meshes());
        let world = rig.headless.app.world_mut();
        world.entity_mut(camera).insert(DepthPrepass);
        let variants = variants(&mut world.resource_mut::<Assets<Image>>());
        let variants = run.some(5, variants);
        // Round 0 compiles the variants, and is not counted.
        for round in 0..=run.rounds {
            for (name, light) in &variants {
                set_light(&mut rig, &meshes, light.as_ref());
                rig.headless.step(2);
                let frames = bench::laps(&mut rig.headless, 2 * run.frames);
                let main = frames.iter().map(|laps| laps[Lap::Main as usize]);
                let main = format!("{:.4}", main.fold(f64::INFINITY, f64::min));
                if round > 0 {
                    times.push(&[&scene.name(), name, &size.x, &size.y, &round, &main]);
                }
            }
        }
        run.say(scene.name());
    }
    run.save("toon_times", &times)
}
