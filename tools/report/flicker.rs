//! The range over time: how much the picture changes because the range changes, and how
//! far a smoothed range lags behind the exact one.
//!
//! The flicker of a frame is the difference between the frame and the same frame drawn
//! with the range of the frame before: the change that the scene itself does not cause.

use bevy::{
    core_pipeline::{prepass::DepthPrepass, tonemapping::Tonemapping},
    prelude::*,
};
use bevy_comics::depth::RangeSmoothing;

use bevy_comics_testkit::{
    reference::{
        histogram::Bins,
        smoothing::{Range, Smoothing},
    },
    scenes::BuiltIn,
};

use crate::{
    Run,
    capture::{self, Shot, shoot},
    rig::{Drawn, Rig, unlit},
    table::Table,
};

/// Duration of a frame.
pub const SECONDS: f64 = 1.0 / 60.0;

struct Sequence {
    shots: Vec<Shot>,
    /// Frames that begin with a camera cut.
    cuts: Vec<usize>,
}

/// No smoothing, each stage alone, the default, and the default with percentiles.
pub fn variants() -> Vec<(&'static str, Option<RangeSmoothing>)> {
    let off = RangeSmoothing::OFF;
    let all = RangeSmoothing::default();
    let outliers = 0.005;
    vec![
        ("off", None),
        ("percentiles", Some(RangeSmoothing { outliers, ..off })),
        (
            "median of three",
            Some(RangeSmoothing {
                despike: true,
                ..off
            }),
        ),
        (
            "hysteresis",
            Some(RangeSmoothing {
                hysteresis: all.hysteresis,
                ..off
            }),
        ),
        (
            "exponential",
            Some(RangeSmoothing {
                expand: all.expand,
                shrink: all.shrink,
                ..off
            }),
        ),
        ("the default", Some(all)),
        (
            "the default and percentiles",
            Some(RangeSmoothing { outliers, ..all }),
        ),
    ]
}

/// The ranges that are drawn, frame by frame, computed by the reference of the shader.
fn ranges(sequence: &Sequence, settings: Option<RangeSmoothing>) -> Vec<Option<[f64; 2]>> {
    let mut range = Range::default();
    sequence
        .shots
        .iter()
        .enumerate()
        .map(|(i, shot)| {
            let mut ends = shot.ends().map(|e| e.map(f64::from));
            let Some(s) = settings else {
                return ends;
            };
            if s.outliers > 0.0 {
                let (bins, total) = Bins::Octaves.count(shot.depth.iter().copied());
                let fraction = f64::from(s.outliers);
                ends = ends.map(|e| Bins::Octaves.percentiles(&bins, total, fraction, e));
            }
            let reference = Smoothing {
                offset: Some(0.0),
                despike: s.despike,
                hysteresis: f64::from(s.hysteresis),
                expand: f64::from(s.expand),
                shrink: f64::from(s.shrink),
            };
            range.step(ends, &reference, SECONDS, sequence.cuts.contains(&i))
        })
        .collect()
}

const FRAMES: usize = 72;

fn play(name: &str, size: UVec2) -> Sequence {
    let scene = if name == "fly-through" {
        BuiltIn::Mountains
    } else {
        BuiltIn::Teapot
    };
    let mut rig = Rig::new(Some(scene), size);
    rig.set_drawn(&Drawn::Nothing);
    let camera = rig.camera;
    let vantage = rig.vantage.clone().expect("a built-in scene");
    let from = vantage.transform();
    let ahead = |distance: f32, aside: f32| {
        from.translation + from.forward() * distance + from.right() * aside
    };
    rig.headless
        .app
        .world_mut()
        .entity_mut(camera)
        .insert((DepthPrepass, Tonemapping::AcesFitted));
    let [mountain, intruder] =
        [[0.4, 0.45, 0.5], [0.8, 0.2, 0.1]].map(|color| unlit(Color::srgb_from_array(color)));
    let hidden = Transform::from_translation(from.translation + from.back() * 100.0);
    let extra = match name {
        "far mountain" => rig.put(Cone::new(9.0, 14.0), mountain, hidden),
        _ => rig.put(Sphere::new(0.12).mesh().uv(24, 16), intruder, hidden),
    };
    let specks = if name.starts_with("particles") { 60 } else { 0 };
    let speck = || Sphere::new(0.02).mesh().uv(6, 4);
    let dust: Vec<Entity> = (0..specks)
        .map(|_| rig.put(speck(), unlit(Color::WHITE), Transform::default()))
        .collect();
    rig.headless.step(3);
    let mut cuts = Vec::new();
    let mut random = bevy_comics_testkit::scenes::noise::Random::new(4);
    let shots = (0..FRAMES)
        .map(|frame| {
            let world = rig.headless.app.world_mut();
            let t = frame as f32 / FRAMES as f32;
            let mut shown = None;
            match name {
                "intruder, 1 frame" if frame == 20 => shown = Some(ahead(0.9, 0.1)),
                "intruder, 30 frames" if (20..50).contains(&frame) => {
                    let part = (frame - 20) as f32 / 30.0;
                    shown = Some(ahead(0.9, 0.7 - 1.4 * part));
                }
                "far mountain" if (24..60).contains(&frame) => {
                    let mut at = ahead(70.0, 6.0);
                    at.y = from.translation.y;
                    shown = Some(at);
                }
                "fly-through" => {
                    let at = from.translation + from.forward() * (120.0 * t) + Vec3::Y * (12.0 * t);
                    let turn = Quat::from_rotation_y(0.5 * t) * from.rotation;
                    world
                        .entity_mut(camera)
                        .insert(Transform::from_translation(at).with_rotation(turn));
                }
                "camera cut" if frame == 30 => {
                    cuts.push(frame);
                    let at = from.translation * 3.0;
                    let cut = Transform::from_translation(at).looking_at(vantage.target, Vec3::Y);
                    world.entity_mut(camera).insert(cut);
                }
                _ => {}
            }
            let mut object = world.entity_mut(extra);
            match shown {
                Some(at) => object.insert((Transform::from_translation(at), Visibility::Visible)),
                None => object.insert(Visibility::Hidden),
            };
            for (i, speck) in dust.iter().enumerate() {
                // Each is visible for 9 of 29 frames, at a random place before the
                // camera.
                let alive = (frame + 7 * i) % 29 < 9;
                if (frame + 7 * i) % 29 == 0 || frame == 0 {
                    let distance = 0.6 + 6.0 * random.unit();
                    let at = ahead(distance, 0.4 * distance * (random.unit() - 0.5))
                        + Vec3::Y * (0.3 * distance * (random.unit() - 0.5));
                    world
                        .entity_mut(*speck)
                        .insert(Transform::from_translation(at));
                }
                let seen = [Visibility::Hidden, Visibility::Visible][usize::from(alive)];
                world.entity_mut(*speck).insert(seen);
            }
            shoot(&mut rig)
        })
        .collect();
    Sequence { shots, cuts }
}

pub const SEQUENCES: [&str; 6] = [
    "intruder, 1 frame",
    "intruder, 30 frames",
    "far mountain",
    "fly-through",
    "camera cut",
    "particles",
];

fn draw(shot: &Shot, range: Option<[f64; 2]>) -> Vec<[u8; 3]> {
    let style = capture::look();
    let frame = range.map(capture::frame);
    shot.depth
        .iter()
        .zip(&shot.picture)
        .map(|(d, light)| {
            let map = match &frame {
                Some(frame) => frame.depth_map(f64::from(*d)),
                None => [1.0, 0.0],
            };
            capture::styled(&style, *light, map)
        })
        .collect()
}

/// (mean, 99th percentile) over the pixels of the largest change of a channel, in display
/// codes.
fn change(a: &[[u8; 3]], b: &[[u8; 3]]) -> [f64; 2] {
    let mut all: Vec<u8> = a
        .iter()
        .zip(b)
        .map(|(a, b)| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0))
        .collect();
    all.sort_unstable();
    let mean = all.iter().map(|c| f64::from(*c)).sum::<f64>() / all.len() as f64;
    [mean, f64::from(all[(all.len() - 1) * 99 / 100])]
}

/// Distance of two ranges in octaves of distance: that of the end that differs more.
fn octaves(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> f64 {
    match (a, b) {
        (Some(a), Some(b)) => (0..2)
            .map(|i| (a[i] / b[i]).log2().abs())
            .fold(0.0, f64::max),
        _ => 0.0,
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = run.size([64, 36], [192, 108]);
    let mut table = Table::new("sequence,variant,frame,mean,p99,lag");
    for name in run.some(1, SEQUENCES) {
        let sequence = play(name, size);
        let exact = ranges(&sequence, None);
        for (variant, settings) in variants() {
            let drawn = ranges(&sequence, settings);
            for frame in 1..sequence.shots.len() {
                let [mean, p99] = if drawn[frame] == drawn[frame - 1] {
                    [0.0; 2]
                } else {
                    let shot = &sequence.shots[frame];
                    change(&draw(shot, drawn[frame]), &draw(shot, drawn[frame - 1]))
                };
                table.push(&[
                    &name.replace(',', ";"),
                    &variant,
                    &frame,
                    &format!("{mean:.4}"),
                    &format!("{p99:.0}"),
                    &format!("{:.4}", octaves(drawn[frame], exact[frame])),
                ]);
            }
        }
        run.say(&format!("{name}: flicker measured"));
        if name == "intruder, 30 frames" && !run.quick {
            strip(run, &sequence, size)?;
        }
    }
    run.save("flicker", &table)
}

/// Writes a picture of six frames: without smoothing above, with the default below.
fn strip(run: &Run, sequence: &Sequence, size: UVec2) -> Result<(), String> {
    let moments = [18usize, 20, 24, 35, 51, 66];
    let gap = 4;
    let mut picture = image::RgbaImage::from_pixel(
        moments.len() as u32 * (size.x + gap) - gap,
        2 * size.y + gap,
        image::Rgba([255, 255, 255, 255]),
    );
    for (row, settings) in [None, Some(RangeSmoothing::default())]
        .into_iter()
        .enumerate()
    {
        let drawn = ranges(sequence, settings);
        for (column, frame) in moments.into_iter().enumerate() {
            let pixels = draw(&sequence.shots[frame], drawn[frame]);
            for (i, p) in pixels.iter().enumerate() {
                let (x, y) = (i as u32 % size.x, i as u32 / size.x);
                picture.put_pixel(
                    column as u32 * (size.x + gap) + x,
                    row as u32 * (size.y + gap) + y,
                    image::Rgba([p[0], p[1], p[2], 255]),
                );
            }
        }
    }
    let path = run.folder().join("flicker.png");
    picture
        .save(&path)
        .map_err(|error| format!("{}: {error}", path.display()))
}
