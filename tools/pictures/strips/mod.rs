//! Strips of frames: every capability of lines in motion. For looking at; the documents have
//! figures of parts of them.

mod cuttings;
mod stages;

use std::path::Path;

use bevy::prelude::*;
use bevy_comics::{
    ComicStyle, Desaturation, IsoLines, Outlines, ToneBands,
    lines::{CreaseSource, Creases, EdgeStyle, LineBoil, LineColor, LineWeight},
};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::{
    save,
    sheet::{enlarged, in_rows},
};
use cuttings::Figures;

const SIZE: UVec2 = UVec2::new(720, 405);
const GAP: u32 = 4;
/// Frames that are drawn, and the frames between two of a strip.
const FRAMES: usize = 36;
const EVERY: usize = 6;

/// How the camera moves.
#[derive(Clone, Copy)]
enum Motion {
    /// Around the target, by a third of a turn.
    Turntable,
    /// Away from the target, to three times the distance.
    Dolly,
    /// From side to side around the target, by a tenth of a degree a frame.
    Sway,
    /// Along the view, at the height of the eye, and a little to the side.
    Walk,
}

impl Motion {
    /// The camera at a time from 0 to 1.
    fn at(self, studio: &Studio, t: f32) -> Transform {
        let (eye, target) = (studio.vantage.eye, studio.vantage.target);
        let away = eye - target;
        match self {
            Self::Turntable => {
                let turned = Quat::from_rotation_y(t * std::f32::consts::TAU / 3.0) * away;
                Transform::from_translation(target + turned).looking_at(target, Vec3::Y)
            }
            Self::Sway => {
                let turned = Quat::from_rotation_y((3.6f32 * t).to_radians()) * away;
                Transform::from_translation(target + turned).looking_at(target, Vec3::Y)
            }
            Self::Dolly => {
                let eye = target + away * 3.0f32.powf(t);
                Transform::from_translation(eye).looking_at(target, Vec3::Y)
            }
            Self::Walk => {
                let step = Vec3::new(-away.x, 0.0, -away.z) * 0.35 * t;
                let side = away.cross(Vec3::Y).normalize_or_zero() * 0.05 * away.length() * t;
                let moved = step + side;
                Transform::from_translation(eye + moved).looking_at(target + moved, Vec3::Y)
            }
        }
    }
}

/// What a strip shows: its name, scene, motion, lines, and what else the scene is given.
struct Strip {
    name: &'static str,
    scene: BuiltIn,
    path: Motion,
    outlines: Outlines,
    prepare: fn(&mut Studio),
    more: fn(ComicStyle) -> ComicStyle,
    /// Frames between two that are shown.
    every: usize,
    /// By how much the middle of the frames is enlarged.
    zoom: u32,
}

impl Strip {
    fn new(name: &'static str, scene: BuiltIn, path: Motion, outlines: Outlines) -> Self {
        Self {
            name,
            scene,
            path,
            outlines,
            prepare: |_| (),
            more: |style| style,
            every: EVERY,
            zoom: 1,
        }
    }

    /// On a changed scene.
    fn on(self, prepare: fn(&mut Studio)) -> Self {
        Self { prepare, ..self }
    }

    /// Frames in a row, of which the middle is enlarged: for what changes from one to the next.
    fn closely(self) -> Self {
        Self {
            every: 1,
            zoom: 5,
            ..self
        }
    }

    /// With more effects.
    fn with(self, more: fn(ComicStyle) -> ComicStyle) -> Self {
        Self { more, ..self }
    }
}

fn weighted(weight: LineWeight) -> Outlines {
    Outlines {
        width: 2.5,
        weight,
        ..default()
    }
}

/// Weights and kinds of lines.
fn weights() -> Vec<Strip> {
    use BuiltIn::{Teapot, Theatre, Village};
    use Motion::{Turntable, Walk};
    let even = LineWeight::EVEN;
    let plain = Outlines::default();
    let kinds = LineWeight {
        outer: 1.6,
        inner: 0.8,
        crease: 0.5,
        object: 0.8,
        ..even
    };
    let light = LineWeight {
        shade: 0.7,
        lit: 0.6,
        ..even
    };
    let brush = LineWeight {
        pressure: 0.6,
        taper: 16.0,
        nib_roundness: 0.3,
        ..even
    };
    let boil = Outlines {
        boil: LineBoil {
            amplitude: 1.5,
            ..LineBoil::default()
        },
        ..plain
    };
    let wide = Outlines {
        width: 3.0,
        ..plain
    };
    let normals = Outlines {
        creases: Some(Creases {
            source: CreaseSource::Normals,
            ..default()
        }),
        ..plain
    };
    let highlight = EdgeStyle {
        unlit_opacity: 0.0,
        ..default()
    };
    let edges = Outlines {
        creases: Some(Creases {
            convex: Some(highlight),
            ..default()
        }),
        ..plain
    };
    let hold = Outlines {
        width: 3.0,
        color: LineColor::SURFACE,
        ..plain
    };
    vec![
        Strip::new("default", Village, Walk, plain),
        Strip::new("kinds", Teapot, Turntable, weighted(kinds)),
        Strip::new("light", Teapot, Turntable, weighted(light)),
        Strip::new("brush", Theatre, Turntable, weighted(brush)),
        Strip::new("widths", Teapot, Turntable, wide).on(stages::widths),
        Strip::new("boil", Theatre, Turntable, boil),
        Strip::new("surface", Village, Walk, hold),
        Strip::new("normals", Village, Walk, normals),
        Strip::new("edges", Village, Walk, edges),
        Strip::new("fog", Village, Walk, plain).on(stages::fog),
    ]
}

/// Lines that are made whole and steady, and how many they are; each with its opposite.
fn wholeness() -> Vec<Strip> {
    use BuiltIn::{Mountains, Teapot, Village};
    use Motion::{Dolly, Sway, Turntable, Walk};
    let plain = Outlines::default();
    let free = Outlines {
        ink_budget: 1.0,
        ..plain
    };
    let thin = Outlines {
        width: 1.5,
        ..plain
    };
    let stroke = Outlines {
        overshoot: 16.0,
        weight: LineWeight {
            taper: 24.0,
            ..LineWeight::EVEN
        },
        ..plain
    };
    let blunt = Outlines {
        overshoot: 0.0,
        ..stroke
    };
    let bridged = Outlines {
        gap_closing: 3,
        ..thin
    };
    let kept = Outlines {
        hold_frames: 8,
        ..thin
    };
    let forgetful = Outlines {
        history_weight: 0.0,
        ..plain
    };
    vec![
        Strip::new("overshoot", Teapot, Turntable, stroke).on(stages::folds),
        Strip::new("no-overshoot", Teapot, Turntable, blunt).on(stages::folds),
        Strip::new("bridge", Teapot, Turntable, bridged).on(stages::wires),
        Strip::new("no-bridge", Teapot, Turntable, thin).on(stages::wires),
        Strip::new("persistence", Teapot, Sway, kept)
            .on(stages::distant_folds)
            .closely(),
        Strip::new("no-persistence", Teapot, Sway, thin)
            .on(stages::distant_folds)
            .closely(),
        Strip::new("budget", Mountains, Dolly, plain),
        Strip::new("no-budget", Mountains, Dolly, free),
        Strip::new("forest", Teapot, Sway, plain).on(stages::trees),
        Strip::new("forest-no-budget", Teapot, Sway, free).on(stages::trees),
        Strip::new("memory", Village, Walk, plain).on(stages::jitter),
        Strip::new("no-memory", Village, Walk, forgetful).on(stages::jitter),
    ]
}

/// What single objects have of their own, and lines that are not outlines.
fn objects() -> Vec<Strip> {
    use BuiltIn::{Mountains, Teapot, Village};
    use Motion::{Sway, Turntable, Walk};
    let plain = Outlines::default();
    let gray = |style: ComicStyle| style.with(Desaturation::default());
    let levels = |style: ComicStyle| {
        style.with(IsoLines {
            step: 50.0,
            ..default()
        })
    };
    vec![
        Strip::new("selection", Teapot, Turntable, plain).on(stages::select_one),
        Strip::new("x-ray", Village, Walk, plain).on(stages::hide_a_figure),
        Strip::new("no-style", Teapot, Turntable, plain)
            .on(stages::unstyle_one)
            .with(gray),
        Strip::new("transparent", Teapot, Sway, plain).on(stages::glass),
        Strip::new("iso-lines", Mountains, Walk, plain).with(levels),
    ]
}

fn frames(strip: &Strip) -> Vec<RgbaImage> {
    let mut studio = Studio::new(strip.scene, SIZE, Msaa::Off);
    (strip.prepare)(&mut studio);
    let bands = ToneBands {
        levels: 4,
        ..default()
    };
    let style = (strip.more)(ComicStyle::new().with(strip.outlines).with(bands));
    studio.shoot(Some(&style));
    let mut shown = Vec::new();
    for frame in 0..FRAMES {
        let at = strip.path.at(&studio, frame as f32 / FRAMES as f32);
        let camera = studio.camera;
        let world = studio.headless.app.world_mut();
        world.entity_mut(camera).insert(at);
        studio.headless.step(1);
        if frame % strip.every == 0 && shown.len() < FRAMES / EVERY {
            shown.push(enlarged(&studio.headless.picture(), strip.zoom));
        }
    }
    shown
}

/// One picture for each capability: six frames of 36, in two rows. `names`: of the strips that are
/// drawn; none: all. Writes the figures of the documents too, of which all strips are drawn.
pub fn write(folder: &Path, names: &[String]) -> Result<(), String> {
    let all: Vec<Strip> = [weights(), wholeness(), objects()]
        .into_iter()
        .flatten()
        .collect();
    let known = |name: &String| all.iter().any(|strip| strip.name == *name);
    if let Some(unknown) = names.iter().find(|name| !known(name)) {
        let known: Vec<_> = all.iter().map(|strip| strip.name).collect();
        return Err(format!(
            "no strip {unknown:?}: there are {}",
            known.join(", ")
        ));
    }
    let mut figures = Figures::default();
    for strip in all {
        if !names.is_empty() && !names.iter().any(|name| name == strip.name) {
            continue;
        }
        let frames = frames(&strip);
        let out = folder.join(format!("{}.png", strip.name));
        save(&in_rows(&frames, 3, SIZE, GAP), &out)?;
        figures.add(strip.name, &frames);
    }
    figures.write(folder)
}
