//! Strips of frames: every capability of lines in motion. For looking at; not part of the
//! documents.

use std::path::Path;

use bevy::{
    anti_alias::taa::TemporalAntiAliasing,
    core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass},
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::{
    ComicStyle, LineBoil, LineColor, LineWeight, Outlines, SelectionOutline, ToneBands, XRayOutline,
};
use bevy_comics_testkit::{scenes::BuiltIn, studio::Studio};
use image::RgbaImage;

use crate::{save, sheet::grid};

const SIZE: UVec2 = UVec2::new(400, 225);
const GAP: u32 = 4;
/// Frames that are drawn, and the frames between two of a strip.
const FRAMES: usize = 36;
const EVERY: usize = 6;

/// How the camera moves.
#[derive(Clone, Copy)]
enum Motion {
    /// Around the target, by a third of a turn.
    Turntable,
    /// Away from the target, to four times the distance.
    Dolly,
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
            Self::Dolly => {
                let eye = target + away * 4.0f32.powf(t);
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
}

impl Strip {
    fn new(name: &'static str, scene: BuiltIn, path: Motion, outlines: Outlines) -> Self {
        Self {
            name,
            scene,
            path,
            outlines,
            prepare: |_| (),
        }
    }
}

fn weighted(weight: LineWeight) -> Outlines {
    Outlines {
        width: 2.5,
        weight,
        ..default()
    }
}

/// Marks a third of the meshes of the scene.
fn mark<M: Component + Default>(studio: &mut Studio) {
    let world = studio.headless.app.world_mut();
    let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
    let meshes: Vec<Entity> = meshes.iter(world).collect();
    for mesh in meshes.into_iter().step_by(3) {
        world.entity_mut(mesh).insert(M::default());
    }
}

fn jitter(studio: &mut Studio) {
    let world = studio.headless.app.world_mut();
    world.entity_mut(studio.camera).insert((
        TemporalAntiAliasing::default(),
        DepthPrepass,
        MotionVectorPrepass,
    ));
}

fn strips() -> Vec<Strip> {
    use BuiltIn::{Mountains, Teapot, Theatre, Village};
    use Motion::{Dolly, Turntable, Walk};
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
        nib: 0.3,
        ..even
    };
    let boil = Outlines {
        boil: LineBoil {
            amplitude: 1.5,
            ..LineBoil::default()
        },
        ..plain
    };
    let hold = Outlines {
        width: 3.0,
        color: LineColor::SURFACE,
        ..plain
    };
    let stroke = Outlines {
        overshoot: 10.0,
        weight: LineWeight {
            taper: 12.0,
            ..even
        },
        ..plain
    };
    vec![
        Strip::new("default", Village, Walk, plain),
        Strip::new("kinds", Teapot, Turntable, weighted(kinds)),
        Strip::new("light", Teapot, Turntable, weighted(light)),
        Strip::new("brush", Theatre, Turntable, weighted(brush)),
        Strip::new("boil", Theatre, Turntable, boil),
        Strip::new("surface", Village, Walk, hold),
        Strip::new("overshoot", Village, Walk, stroke),
        Strip::new("budget", Mountains, Dolly, plain),
        Strip::new(
            "without-budget",
            Mountains,
            Dolly,
            Outlines {
                budget: 1.0,
                ..plain
            },
        ),
        Strip::new(
            "persistence",
            Village,
            Walk,
            Outlines {
                persistence: 4,
                ..plain
            },
        ),
        Strip {
            prepare: jitter,
            ..Strip::new("memory", Village, Walk, plain)
        },
        Strip {
            prepare: jitter,
            ..Strip::new(
                "without-memory",
                Village,
                Walk,
                Outlines {
                    memory: 1.0,
                    ..plain
                },
            )
        },
        Strip {
            prepare: mark::<SelectionOutline>,
            ..Strip::new("selection", Theatre, Turntable, plain)
        },
        Strip {
            prepare: mark::<XRayOutline>,
            ..Strip::new("x-ray", Village, Walk, plain)
        },
    ]
}

fn frames(strip: &Strip) -> Vec<RgbaImage> {
    let mut studio = Studio::new(strip.scene, SIZE, Msaa::Off);
    (strip.prepare)(&mut studio);
    let bands = ToneBands {
        levels: 4,
        ..default()
    };
    let style = ComicStyle::new().with(strip.outlines).with(bands);
    studio.shoot(Some(&style));
    let mut shown = Vec::new();
    for frame in 0..FRAMES {
        let at = strip.path.at(&studio, frame as f32 / FRAMES as f32);
        let camera = studio.camera;
        let world = studio.headless.app.world_mut();
        world.entity_mut(camera).insert(at);
        studio.headless.step(1);
        if frame % EVERY == 0 {
            shown.push(studio.headless.picture());
        }
    }
    shown
}

/// One picture for each capability: six frames of 36, in two rows.
pub fn write(folder: &Path) -> Result<(), String> {
    for strip in strips() {
        let frames = frames(&strip);
        let rows: Vec<Vec<&RgbaImage>> = frames.chunks(3).map(|row| row.iter().collect()).collect();
        let out = folder.join(format!("{}.png", strip.name));
        save(&grid(&rows, SIZE, GAP), &out)?;
    }
    Ok(())
}
