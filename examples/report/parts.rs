//! What single parts cost: factors of lines, marked objects, and effects of the page.

use bevy::prelude::*;
use bevy_comics::{
    ComicStyle, Halftone, HalftoneMode, LineColor, LineWeight, Outlines, Paper, PrintOffset,
    ScreenSampling, ScreenShape, SelectionOutline, SpeedLines, TwoTone, XRayOutline,
};

use bevy_comics_testkit::scenes::BuiltIn;

use crate::{
    Run,
    rig::{self, Rig, Wear},
};

/// Outlines of which one thing differs from the default.
fn lines() -> Vec<(String, Wear)> {
    let default = Outlines::default();
    [
        ("outlines", default),
        (
            "gaps up to 3 pixels closed",
            Outlines {
                bridge: 3,
                ..default
            },
        ),
        (
            "overshooting by 8 pixels",
            Outlines {
                overshoot: 8.0,
                ..default
            },
        ),
        (
            "persistent for 4 frames",
            Outlines {
                persistence: 4,
                ..default
            },
        ),
        (
            "under pressure",
            Outlines {
                weight: LineWeight {
                    pressure: 0.5,
                    ..LineWeight::EVEN
                },
                ..default
            },
        ),
        (
            "in the colour of surfaces",
            Outlines {
                color: LineColor::SURFACE,
                ..default
            },
        ),
    ]
    .map(|(name, outlines)| {
        (
            name.to_owned(),
            Wear::style(ComicStyle::new().with(outlines)),
        )
    })
    .into()
}

fn page() -> Vec<(String, Wear)> {
    let none = ComicStyle::new();
    let screen = |halftone: Halftone| ComicStyle::new().with(halftone);
    let default = Halftone::default();
    let printed = none
        .clone()
        .with(PrintOffset::default())
        .with(default)
        .with(Paper::default());
    [
        ("halftone of four inks", screen(default)),
        (
            "halftone of one ink",
            screen(Halftone {
                mode: HalftoneMode::Spot,
                shape: ScreenShape::Round,
                ..default
            }),
        ),
        (
            "halftone of four inks in grains",
            screen(Halftone {
                shape: ScreenShape::Stochastic,
                ..default
            }),
        ),
        (
            "halftone of four inks; whole dots",
            screen(Halftone {
                sampling: ScreenSampling::Cell,
                ..default
            }),
        ),
        ("print offset", none.clone().with(PrintOffset::default())),
        ("paper", none.clone().with(Paper::default())),
        ("two tones", none.clone().with(TwoTone::default())),
        ("speed lines", none.with(SpeedLines::default())),
        ("halftone; print offset and paper", printed),
    ]
    .map(|(name, style)| (name.to_owned(), Wear::style(style)))
    .into()
}

/// Marks every mesh of the scene.
fn mark<M: Component + Clone>(rig: &mut Rig, mark: M) {
    let world = rig.headless.app.world_mut();
    let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
    let meshes: Vec<Entity> = meshes.iter(world).collect();
    for mesh in meshes {
        world.entity_mut(mesh).insert(mark.clone());
    }
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = if run.quick {
        UVec2::new(320, 180)
    } else {
        UVec2::new(1280, 720)
    };
    let mut times = rig::times();
    let mut rig = Rig::new(Some(BuiltIn::Teapot), size);
    rig.unlight();
    rig::record(run, &mut times, "lines", "teapot", &mut rig, &lines());
    rig::record(run, &mut times, "page", "teapot", &mut rig, &page());
    let variants = [
        ("nothing marked", Wear::Nothing),
        ("selected", Wear::Selected),
        ("seen through walls", Wear::SeenThrough),
    ]
    .map(|(name, wear)| (name.to_owned(), wear));
    rig::record(run, &mut times, "marks", "teapot", &mut rig, &variants);
    run.save("part_times", &times)
}

/// Marks the meshes of the scene as a variant asks.
pub fn set_marks(rig: &mut Rig, wear: &Wear) {
    let world = rig.headless.app.world_mut();
    let mut marked =
        world.query_filtered::<Entity, Or<(With<SelectionOutline>, With<XRayOutline>)>>();
    let marked: Vec<Entity> = marked.iter(world).collect();
    for mesh in marked {
        world
            .entity_mut(mesh)
            .remove::<(SelectionOutline, XRayOutline)>();
    }
    match wear {
        Wear::Selected => mark(rig, SelectionOutline::default()),
        Wear::SeenThrough => mark(rig, XRayOutline::default()),
        _ => {}
    }
}
