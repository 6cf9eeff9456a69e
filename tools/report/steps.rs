//! How many fragments lines fall into, and how many lines are found, when one step of finding and
//! linking them is changed at a time.

use bevy::prelude::*;
use bevy_comics::{
    ComicStyle, Outlines,
    lines::{Creases, Silhouettes},
};
use bevy_comics_testkit::{
    scenes::BuiltIn,
    specimens::Specimen,
    truth::{FINE, fragments, ids_alone, mask},
};

use crate::{
    Run,
    models::{DISTANCES, Studio},
    rig::{Drawn, Rig},
    table::Table,
};

/// Higher thresholds: of steps, and of the angle of folds.
fn stricter(steps: f32, folds: f32) -> Outlines {
    let (silhouettes, creases) = (Silhouettes::default(), Creases::default());
    Outlines {
        silhouettes: Some(Silhouettes {
            threshold: steps * silhouettes.threshold,
            ..silhouettes
        }),
        creases: Some(Creases {
            angle: folds * creases.angle,
            ..creases
        }),
        ..Outlines::default()
    }
}

/// The default and its changes, without the ink budget, which makes crowded lines too thin for the
/// mask.
pub fn variants() -> Vec<(&'static str, Outlines)> {
    let default = Outlines::default();
    let specks = |specks| Outlines {
        min_length: specks,
        ..default
    };
    let all = [
        ("the default", default),
        ("min_length 8", specks(8)),
        ("min_length 3", specks(3)),
        ("min_length 1", specks(1)),
        (
            "not linked",
            Outlines {
                hysteresis: 0.0,
                ..default
            },
        ),
        (
            "hysteresis 32",
            Outlines {
                hysteresis: 32.0,
                ..default
            },
        ),
        (
            "hysteresis_ratio 0.25",
            Outlines {
                hysteresis_ratio: 0.25,
                ..default
            },
        ),
        (
            "not smooth",
            Outlines {
                smooth: false,
                ..default
            },
        ),
        (
            "gap_closing 3",
            Outlines {
                gap_closing: 3,
                ..default
            },
        ),
        ("steps x 1.5 and folds x 1.25", stricter(1.5, 1.25)),
        ("steps x 1.5", stricter(1.5, 1.0)),
    ];
    let free = |(name, outlines)| {
        let free = Outlines {
            ink_budget: 1.0,
            ..outlines
        };
        (name, free)
    };
    all.map(free).into()
}

/// What is counted of a variant.
#[derive(Clone, Copy, Default)]
struct Counts {
    fragments: usize,
    line: usize,
    found: usize,
    wanted: usize,
}

fn style(outlines: Outlines, width: f32) -> Drawn {
    Drawn::style(ComicStyle::new().with(Outlines { width, ..outlines }))
}

/// Of a model that turns, for each variant.
fn of_model(
    run: &Run,
    [fine, lined, thin]: &mut [Studio; 3],
    distance: f32,
    variants: &[(&str, Outlines)],
) -> Vec<Counts> {
    let size = lined.rig.size;
    let frames = if run.quick { 1 } else { 6 };
    let mut counts = vec![Counts::default(); variants.len()];
    for frame in 0..frames {
        let turned = frame as f32 / frames as f32;
        fine.turn(distance, turned);
        let truth = fine.rig.truth(size, FINE);
        let wanted = truth.any(&[0, 1, 2]);
        for ((_, outlines), counts) in variants.iter().zip(&mut counts) {
            lined.rig.set_drawn(&style(*outlines, 2.0));
            thin.rig.set_drawn(&style(*outlines, 1.0));
            for studio in [&mut *lined, &mut *thin] {
                // Another variant may need pipelines and a prepass.
                studio.rig.headless.step(2);
                studio.turn(distance, turned);
            }
            let (found, all) = truth.recall(&wanted, &lined.mask());
            let mask = thin.mask();
            counts.found += found;
            counts.wanted += all;
            counts.fragments += fragments(&mask, thin.rig.size.x as usize, 6);
            counts.line += mask.iter().filter(|ink| **ink).count();
        }
    }
    counts
}

/// Of the mountains, for each variant. True lines are not looked for.
fn of_mountains(variants: &[(&str, Outlines)]) -> Vec<Counts> {
    let size = UVec2::new(960, 540);
    let mut rig = Rig::new(Some(BuiltIn::Mountains), size);
    rig.unlight();
    rig.set_drawn(&Drawn::Nothing);
    rig.headless.step(4);
    let plain = rig.headless.picture();
    let of = |(_, outlines): &(&str, Outlines)| {
        rig.set_drawn(&style(*outlines, 1.0));
        rig.headless.step(4);
        let mask = mask(&plain, &rig.headless.picture());
        Counts {
            fragments: fragments(&mask, size.x as usize, 6),
            line: mask.iter().filter(|ink| **ink).count(),
            ..default()
        }
    };
    variants.iter().map(of).collect()
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut table = Table::new(&[
        "subject",
        "distance",
        "step",
        "fragments",
        "line",
        "found",
        "true",
    ]);
    let size = if run.quick {
        UVec2::new(120, 68)
    } else {
        UVec2::new(240, 136)
    };
    let variants = run.some(2, variants());
    let mut studios = [
        Studio::new(size * FINE, ids_alone()),
        Studio::new(size, Outlines::default()),
        Studio::new(size * FINE, Outlines::default()),
    ];
    let mut push = |subject: &str, distance: &str, counts: Vec<Counts>| {
        for ((step, _), counts) in variants.iter().zip(counts) {
            table.push(&[
                &subject,
                &distance,
                step,
                &counts.fragments,
                &counts.line,
                &counts.found,
                &counts.wanted,
            ]);
        }
        run.say(&format!("{subject} {distance}: steps scored"));
    };
    for model in run.some(1, Specimen::ALL) {
        for studio in &mut studios {
            studio.show(model);
            studio.rig.headless.step(4);
        }
        for (name, distance) in DISTANCES {
            let counts = of_model(run, &mut studios, distance, &variants);
            push(model.name(), name, counts);
        }
    }
    if !run.quick {
        push("mountains", "", of_mountains(&variants));
    }
    run.save("line_steps", &table)
}
