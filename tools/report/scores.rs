//! Which true lines the detectors find, and how many of theirs are true.

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    prelude::*,
};
use bevy_comics::{ComicStyle, Contours, Outlines, effects::ContourOperator};

use bevy_comics_testkit::{
    scenes::BuiltIn,
    truth::{FINE, Truth, fragments, ids_alone, mask},
};

use crate::{
    Run,
    rig::{Drawn, Rig},
    table::Table,
};

const SCENES: [BuiltIn; 4] = [
    BuiltIn::Teapot,
    BuiltIn::Theatre,
    BuiltIn::Village,
    BuiltIn::Mountains,
];

/// The name of the rule of the truth itself, at the resolution of the picture.
pub const SAME_RULE: &str = "same rule at 1x";

/// The effects that are scored.
pub fn detectors() -> Vec<(String, ComicStyle)> {
    use ContourOperator::{Laplace, Prewitt, Roberts, Sobel};
    let contours = |operator| {
        ComicStyle::new().with(Contours {
            operator,
            ..default()
        })
    };
    let mut all: Vec<_> = [Roberts, Prewitt, Sobel, Laplace]
        .into_iter()
        .map(|operator| (format!("{operator:?}"), contours(operator)))
        .collect();
    let outlines = |outlines: Outlines| ComicStyle::new().with(outlines);
    // The ink budget makes crowded lines too thin for the mask. It is not a property of the
    // search for lines, and has a row of its own.
    let found = Outlines {
        ink_budget: 1.0,
        ..default()
    };
    all.push((
        "silhouettes".into(),
        outlines(Outlines {
            ink_budget: 1.0,
            ..Outlines::SILHOUETTES
        }),
    ));
    all.push((
        "silhouettes + creases".into(),
        outlines(Outlines {
            objects: None,
            ..found
        }),
    ));
    all.push(("all outlines".into(), outlines(found)));
    let name = "all outlines with the ink budget";
    all.push((name.into(), outlines(Outlines::default())));
    all
}

fn truth(scene: BuiltIn, size: UVec2, fine: u32) -> Truth {
    let mut rig = Rig::new(Some(scene), size * fine);
    rig.unlight();
    rig.set_drawn(&Drawn::style(ComicStyle::new().with(ids_alone())));
    let world = rig.headless.app.world_mut();
    world
        .entity_mut(rig.camera)
        .insert((DepthPrepass, NormalPrepass));
    rig.headless.step(4);
    rig.truth(size, fine)
}

/// Scores of every detector in every scene.
pub fn score(run: &Run) -> Result<(), String> {
    let mut table = Table::new("scene,detector,truth,found,true,right,drawn,wrong,pixels");
    let size = run.size([160, 90], [480, 270]);
    let scenes = run.some(1, SCENES);
    for &scene in &scenes {
        let truth = truth(scene, size, FINE);
        let mut push = |name: &str, lines: &[bool]| {
            for (what, kinds) in [("silhouettes", &[0][..]), ("every line", &[0, 1, 2])] {
                let wanted = truth.any(kinds);
                let (found, all) = truth.recall(&wanted, lines);
                let (right, drawn) = truth.precision(&wanted, lines);
                let (faint, _) = truth.precision(&truth.faint, lines);
                let (wrong, pixels) = (drawn - faint, truth.inside().count());
                table.push(&[
                    &scene.name(),
                    &name,
                    &what,
                    &found,
                    &all,
                    &right,
                    &drawn,
                    &wrong,
                    &pixels,
                ]);
            }
        };
        let mut rig = Rig::new(Some(scene), size);
        rig.unlight();
        rig.set_drawn(&Drawn::Nothing);
        rig.headless.step(4);
        let plain = rig.headless.picture();
        for (name, style) in detectors() {
            rig.set_drawn(&Drawn::style(style));
            rig.headless.step(4);
            push(&name, &mask(&plain, &rig.headless.picture()));
        }
        push(SAME_RULE, &self::truth(scene, size, 1).any(&[0, 1, 2]));
        run.say(&format!("{}: lines scored", scene.name()));
    }
    run.save("line_scores", &table)?;
    whole(run, &scenes)
}

/// How many small parts the lines of each scene fall into.
fn whole(run: &Run, scenes: &[BuiltIn]) -> Result<(), String> {
    let mut table = Table::new("scene,fragments,line");
    let size = run.size([160, 90], [960, 540]);
    let thin = Outlines {
        width: 1.0,
        ink_budget: 1.0,
        ..default()
    };
    for scene in scenes {
        let mut rig = Rig::new(Some(*scene), size);
        rig.unlight();
        rig.set_drawn(&Drawn::Nothing);
        rig.headless.step(4);
        let plain = rig.headless.picture();
        rig.set_drawn(&Drawn::style(ComicStyle::new().with(thin)));
        rig.headless.step(4);
        let mask = mask(&plain, &rig.headless.picture());
        let line = mask.iter().filter(|ink| **ink).count();
        let small = fragments(&mask, size.x as usize, 6);
        table.push(&[&scene.name(), &small, &line]);
    }
    run.save("line_fragments", &table)
}
