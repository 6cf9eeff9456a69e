use bevy::{
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    ecs::system::RunSystemOnce,
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::*;
use bevy_comics_testkit::{
    bench::{self, BenchPlugin, Blit, Lap},
    headless::{Headless, HeadlessOptions},
    scenes::{BuiltIn, Stage},
    work::default_comic,
};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let scene = BuiltIn::ALL
        .into_iter()
        .find(|s| s.name() == args[0])
        .unwrap();
    let (w, h): (u32, u32) = args[1]
        .split_once('x')
        .map(|(a, b)| (a.parse().unwrap(), b.parse().unwrap()))
        .unwrap();
    let rounds: usize = args[2].parse().unwrap();
    let only = args.get(3).cloned().unwrap_or_default();
    let size = UVec2::new(w, h);
    let mut headless = Headless::new(
        HeadlessOptions { size, ..default() },
        (ComicsPlugin, BenchPlugin),
    );
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let vantage = world
        .run_system_once(move |mut stage: Stage| stage.spawn(scene))
        .unwrap();
    let camera = world.spawn(vantage.camera()).id();
    world
        .entity_mut(camera)
        .insert((target, Msaa::Off, Tonemapping::None, DebandDither::Disabled));
    headless.step(3);
    for (_, material) in headless
        .app
        .world_mut()
        .resource_mut::<Assets<StandardMaterial>>()
        .iter_mut()
    {
        material.unlit = true;
    }
    let wide = |width: f32| ComicStyle::new().with(Outlines { width, ..default() });
    let sil = |width: f32| {
        ComicStyle::new().with(Outlines {
            width,
            ..Outlines::SILHOUETTES
        })
    };
    let none = ComicStyle::new();
    let all: Vec<(&str, ComicStyle, bool)> = vec![
        ("nothing", none.clone(), false),
        ("blit", none.clone(), true),
        ("tint", none.clone().with(Colorization::SEPIA), false),
        (
            "desaturation",
            none.clone().with(Desaturation::default()),
            false,
        ),
        ("contours", none.clone().with(Contours::default()), false),
        ("comic", default_comic(), false),
        ("silhouettes2", sil(2.0), false),
        (
            "sil+creases2",
            ComicStyle::new().with(Outlines {
                objects: None,
                ..default()
            }),
            false,
        ),
        ("outlines1", wide(1.0), false),
        ("outlines2", wide(2.0), false),
        ("outlines3", wide(3.0), false),
        ("outlines4", wide(4.0), false),
        ("outlines8", wide(8.0), false),
        ("outlines16", wide(16.0), false),
        ("vignette", none.clone().with(Vignette::default()), false),
        (
            "find s",
            ComicStyle::new().with(Outlines {
                silhouettes: Some(Silhouettes {
                    threshold: 1.0,
                    edge_limit: 0.99,
                    ..default()
                }),
                ..Outlines::SILHOUETTES
            }),
            false,
        ),
        (
            "find s+c",
            ComicStyle::new().with(Outlines {
                silhouettes: Some(Silhouettes {
                    threshold: 1.0,
                    edge_limit: 0.99,
                    ..default()
                }),
                creases: Some(Creases {
                    angle: 180.0,
                    edge_limit: 0.99,
                    ..default()
                }),
                objects: None,
                ..default()
            }),
            false,
        ),
        (
            "find s+c+o",
            ComicStyle::new().with(Outlines {
                silhouettes: Some(Silhouettes {
                    threshold: 1.0,
                    edge_limit: 0.99,
                    ..default()
                }),
                creases: Some(Creases {
                    angle: 180.0,
                    edge_limit: 0.99,
                    ..default()
                }),
                objects: Some(default()),
                ..default()
            }),
            false,
        ),
        ("sketch", none.clone().with(Sketch::default()), false),
    ];
    let all: Vec<_> = all
        .into_iter()
        .filter(|(n, ..)| {
            only.is_empty() || *n == "nothing" || *n == "blit" || only.split(',').any(|o| o == *n)
        })
        .collect();
    let mut times: Vec<Vec<[f64; 5]>> = vec![vec![]; all.len()];
    for round in 0..=rounds {
        for (i, (_, style, blit)) in all.iter().enumerate() {
            let world = headless.app.world_mut();
            style.apply(&mut world.commands().entity(camera));
            world.flush();
            if *blit {
                world.entity_mut(camera).insert(Blit);
            } else {
                world.entity_mut(camera).remove::<Blit>();
            }
            headless.step(2);
            let laps = bench::laps(&mut headless, 2);
            let mut best = [f64::MAX; 5];
            for l in laps {
                for k in 0..5 {
                    best[k] = best[k].min(l[k]);
                }
            }
            if round > 0 {
                times[i].push(best);
            }
        }
    }
    let med = |mut v: Vec<f64>| {
        v.sort_by(f64::total_cmp);
        v[v.len() / 2]
    };
    let lap = |i: usize, l: Lap| med(times[i].iter().map(|t| t[l as usize]).collect());
    let blits: Vec<f64> = (0..rounds)
        .map(|r| times[1][r][Lap::Post as usize] - times[0][r][Lap::Post as usize])
        .collect();
    println!("{} {w}x{h}: blit {:.2} ms", args[0], med(blits.clone()));
    for i in 2..all.len() {
        let over: Vec<f64> = (0..rounds)
            .map(|r| {
                [Lap::Range, Lap::Lines, Lap::Post]
                    .iter()
                    .map(|l| times[i][r][*l as usize] - times[0][r][*l as usize])
                    .sum::<f64>()
                    / blits[r]
            })
            .collect();
        println!(
            "{:14} {:6.2} blits | prepass {:6.2} range {:6.2} lines {:6.2} post {:6.2} ms",
            all[i].0,
            med(over),
            lap(i, Lap::Prepass) - lap(0, Lap::Prepass),
            lap(i, Lap::Range) - lap(0, Lap::Range),
            lap(i, Lap::Lines) - lap(0, Lap::Lines),
            lap(i, Lap::Post) - lap(0, Lap::Post)
        );
    }
}
