//! Figures 2, 3 and 4 of [CS], on our own scenes, and the numbers of the
//! argument of Figures 2 and 3: how much of [0, 1] each mapping uses.

use std::path::Path;

use bevy::{
    ecs::system::RunSystemOnce,
    prelude::*,
    render::{RenderApp, sync_world::RenderEntity},
};
use bevy_comics::{
    Colorization, ComicStyle, ComicsPlugin, Contours, DepthMap, DepthMapping, Desaturation,
    effects::{ColorizationMode, Equations},
    presets,
};
use image::{Rgba, RgbaImage};

use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions},
    read_back,
    scenes::{BuiltIn, Stage, Vantage},
    studio::{Studio, with_map},
};

use crate::{save, sheet::grid};

const SIZE: UVec2 = UVec2::new(480, 270);
/// Size of a picture among nine.
const SMALL: UVec2 = UVec2::new(256, 144);
const GAP: u32 = 8;
const NEAR: f32 = 0.1;
const FAR: f32 = 1000.0;

const MAPPINGS: [(&str, DepthMapping); 3] = [
    ("linear", DepthMapping::Linear),
    ("logarithmic", DepthMapping::Logarithmic),
    ("minmax", DepthMapping::MinMax),
];

fn sheet(rows: &[Vec<RgbaImage>], size: UVec2) -> RgbaImage {
    let rows: Vec<Vec<&RgbaImage>> = rows.iter().map(|row| row.iter().collect()).collect();
    grid(&rows, size, GAP)
}

/// A style of which only the depth map is set.
fn depth_style(mapping: DepthMapping) -> ComicStyle {
    with_map(
        ComicStyle::new(),
        DepthMap {
            mapping,
            ..default()
        },
    )
}

/// The depth map of the last frame, from its raw depth: pixels and the fraction of
/// [0, 1] that the geometry covers (the widest gap-free measure: its extent,
/// and how many of 256 levels are in use).
struct Measured {
    picture: RgbaImage,
    extent: f64,
    levels: usize,
}

fn measure(
    headless: &Headless,
    camera: Entity,
    mapping: DepthMapping,
    plane_far: f32,
) -> Result<Measured, String> {
    let view = headless
        .app
        .world()
        .get::<RenderEntity>(camera)
        .ok_or("no view")?
        .id();
    let depth =
        read_back::depth(headless.app.sub_app(RenderApp).world(), view).ok_or("no depth")?;
    let distances: Vec<Option<f64>> = depth
        .bits
        .iter()
        .map(|bits| {
            Some(f64::from(NEAR) / f64::from(f32::from_bits(*bits))).filter(|z| z.is_finite())
        })
        .collect();
    let seen = || distances.iter().flatten().copied();
    let (near, far) = match mapping {
        DepthMapping::MinMax => (
            seen().fold(f64::MAX, f64::min),
            seen().fold(f64::MIN, f64::max),
        ),
        _ => (f64::from(NEAR), f64::from(plane_far)),
    };
    let map = |z: f64| match mapping {
        DepthMapping::Logarithmic => (z / near).ln() / (far / near).ln(),
        _ => (z - near) / (far - near),
    };
    let values: Vec<Option<f64>> = distances
        .iter()
        .map(|z| z.map(|z| map(z).clamp(0.0, 1.0)))
        .collect();
    let used = || values.iter().flatten().copied();
    let extent = used().fold(f64::MIN, f64::max) - used().fold(f64::MAX, f64::min);
    let mut hit = [false; 256];
    for value in used() {
        hit[(value * 255.0).round() as usize] = true;
    }
    let picture = RgbaImage::from_fn(depth.width, depth.height, |x, y| {
        let value = values[(y * depth.width + x) as usize];
        // Eq. 2 to 4: depth is 1 near and 0 far.
        let gray = value.map_or(0, |d| ((1.0 - d) * 255.0).round() as u8);
        Rgba([gray, gray, gray, 255])
    });
    Ok(Measured {
        picture,
        extent,
        levels: hit.iter().filter(|h| **h).count(),
    })
}

/// Objects of figure 2: the same group, near the near plane or near the far one.
fn group(headless: &mut Headless, distance: f32) -> Result<Entity, String> {
    let target = headless.render_target();
    let vantage: Vantage = headless
        .app
        .world_mut()
        .run_system_once(|mut stage: Stage| stage.spawn(BuiltIn::Teapot))
        .map_err(|error| error.to_string())?;
    // Seen from far away through a long lens, the group fills the same frame.
    let away = (vantage.eye - vantage.target).normalize();
    let fov =
        2.0 * ((0.5 * vantage.fov).tan() * vantage.eye.distance(vantage.target) / distance).atan();
    let vantage = Vantage {
        eye: vantage.target + away * distance,
        fov,
        near: NEAR,
        far: FAR,
        ..vantage
    };
    Ok(headless
        .app
        .world_mut()
        .spawn((vantage.camera(), target, Msaa::Off))
        .id())
}

fn figure_2(folder: &Path) -> Result<(), String> {
    let mut rows = vec![Vec::new(), Vec::new()];
    println!("figure 2: fraction of [0, 1] that the geometry uses, and levels of 256");
    println!(
        "  {:12} {:>22} {:>22}",
        "mapping", "near the near plane", "near the far plane"
    );
    let mut numbers = Vec::new();
    for (name, mapping) in MAPPINGS {
        let mut line = format!("  {name:12}");
        for (row, distance) in [14.0, 960.0].into_iter().enumerate() {
            let mut headless = Headless::new(
                HeadlessOptions {
                    size: SIZE,
                    ..default()
                },
                ComicsPlugin,
            );
            let camera = group(&mut headless, distance)?;
            let style = depth_style(mapping).with(Desaturation::default());
            style.apply(&mut headless.app.world_mut().commands().entity(camera));
            headless.step(5);
            let measured = measure(&headless, camera, mapping, FAR)?;
            line += &format!(" {:>14.4} {:>4} lv", measured.extent, measured.levels);
            numbers.push(serde_json::json!({
                "mapping": name, "distance": distance,
                "fraction": measured.extent, "levels": measured.levels,
            }));
            rows[row].push(measured.picture);
        }
        println!("{line}");
    }
    let text = serde_json::to_string_pretty(&numbers).map_err(|error| error.to_string())?;
    let path = folder.join("figure-2.json");
    std::fs::write(&path, text + "\n")
        .map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    save(&sheet(&rows, SIZE), &folder.join("figure-2.png"))
}

/// The three maps of an object, and the same sepia and desaturation with each.
fn figure_3(folder: &Path) -> Result<(), String> {
    // A far plane that suits the whole game, not this view.
    const PLANE_FAR: f32 = 1000.0;
    let mut studio = Studio::new(BuiltIn::Teapot, SIZE, Msaa::Off);
    let mut rows = vec![vec![studio.shoot(None)], Vec::new(), Vec::new()];
    for (_, mapping) in MAPPINGS {
        let style = depth_style(mapping)
            .with(Desaturation {
                exponent: 0.5,
                ..default()
            })
            .with(Colorization {
                mode: ColorizationMode::SquareRoot,
                color: Colorization::SEPIA.color,
                ..default()
            })
            .with(Contours {
                threshold: 0.03,
                width: 1.5,
                ..default()
            });
        let projection = Vantage {
            near: NEAR,
            far: PLANE_FAR,
            ..studio.vantage.clone()
        }
        .perspective();
        let camera = studio.camera;
        studio
            .headless
            .app
            .world_mut()
            .entity_mut(camera)
            .insert(projection);
        let picture = studio.shoot(Some(&style));
        rows[1].push(measure(&studio.headless, studio.camera, mapping, PLANE_FAR)?.picture);
        rows[2].push(picture);
    }
    save(&sheet(&rows, SIZE), &folder.join("figure-3.png"))
}

/// The three rows of figure 4: the original, the style, and the style as the
/// paper prints its equations.
fn figure_4(folder: &Path) -> Result<(), String> {
    let mut rows = Vec::new();
    for (scene, preset) in [
        (BuiltIn::Mountains, presets::CRIMSON_DUSK),
        (BuiltIn::Teapot, presets::MUSEUM_PRINT),
        (BuiltIn::Mountains, presets::EMERALD_INK),
    ] {
        let style = preset.style();
        let mut faithful = style.clone();
        if let Some(s) = faithful.get_mut::<Desaturation>() {
            s.equations = Equations::Faithful;
        }
        if let Some(s) = faithful.get_mut::<Colorization>() {
            s.equations = Equations::Faithful;
        }
        let mut studio = Studio::new(scene, SMALL, Msaa::Sample4);
        rows.push(vec![
            studio.shoot(None),
            studio.shoot(Some(&style)),
            studio.shoot(Some(&faithful)),
        ]);
        println!("figure 4: {preset}");
    }
    save(&sheet(&rows, SMALL), &folder.join("figure-4.png"))
}

pub fn write(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder)
        .map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    figure_2(folder)?;
    figure_3(folder)?;
    figure_4(folder)
}
