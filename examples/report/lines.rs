//! Which lines the operators find and what they cost; error and cost of the anti-aliasing
//! of bands and lines.

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    prelude::*,
    render::RenderApp,
};
use bevy_comics::{ComicStyle, ContourOperator, Contours, ObjectEdges, Outlines, ToneBands};

use bevy_comics_testkit::{
    read_back,
    scenes::BuiltIn,
    truth::{FINE, Truth, mask},
    work::default_comic,
};

use crate::{
    Run, capture,
    rig::{self, Rig, Wear},
    table::Table,
};

const SCENES: [BuiltIn; 4] = [
    BuiltIn::Teapot,
    BuiltIn::Theatre,
    BuiltIn::Village,
    BuiltIn::Mountains,
];

fn contours(operator: ContourOperator) -> ComicStyle {
    ComicStyle::new().with(Contours {
        operator,
        ..default()
    })
}

fn outlines(outlines: Outlines) -> ComicStyle {
    ComicStyle::new().with(outlines)
}

fn detectors() -> Vec<(String, ComicStyle)> {
    use ContourOperator::{Laplace, Prewitt, Roberts, Sobel};
    let mut all: Vec<_> = [Roberts, Prewitt, Sobel, Laplace]
        .into_iter()
        .map(|operator| (format!("{operator:?}"), contours(operator)))
        .collect();
    all.push(("silhouettes".into(), outlines(Outlines::SILHOUETTES)));
    all.push((
        "silhouettes + creases".into(),
        outlines(Outlines {
            objects: None,
            ..default()
        }),
    ));
    all.push(("all outlines".into(), outlines(Outlines::default())));
    all
}

/// Invisible object edges: ids are drawn, and no line.
pub fn ids_alone() -> Outlines {
    Outlines {
        silhouettes: None,
        creases: None,
        objects: Some(ObjectEdges {
            opacity: 1e-6,
            ..default()
        }),
        ..default()
    }
}

/// The true lines of a picture of `size`, from the prepasses of a camera that is
/// [`FINE`] times as large and draws [`ids_alone`].
pub fn read_truth(rig: &Rig, size: UVec2) -> Truth {
    let view = rig.view();
    let world = rig.headless.app.sub_app(RenderApp).world();
    let depth = read_back::depth(world, view).expect("a prepass");
    let depth: Vec<f32> = depth.bits.iter().map(|b| f32::from_bits(*b)).collect();
    let normals = read_back::normals(world, view).expect("a prepass").pixels;
    let ids = read_back::object_ids(world, view).expect("ids");
    let ids: Vec<u32> = ids.pixels.iter().map(|p| p[0]).collect();
    let [width, height] = size.to_array().map(|v| v as usize);
    Truth::new(width, height, &depth, &normals, &ids)
}

fn truth(scene: BuiltIn, size: UVec2) -> Truth {
    let mut rig = Rig::new(Some(scene), size * FINE);
    rig.unlight();
    rig.wear(&Wear::style(outlines(ids_alone())));
    let world = rig.headless.app.world_mut();
    world
        .entity_mut(rig.camera)
        .insert((DepthPrepass, NormalPrepass));
    rig.headless.step(4);
    read_truth(&rig, size)
}

fn score(run: &Run) -> Result<(), String> {
    let mut table = Table::new(&[
        "scene", "detector", "truth", "found", "true", "right", "drawn",
    ]);
    let size = if run.quick {
        UVec2::new(160, 90)
    } else {
        UVec2::new(480, 270)
    };
    let scenes = if run.quick { &SCENES[..1] } else { &SCENES };
    for &scene in scenes {
        let truth = truth(scene, size);
        let mut rig = Rig::new(Some(scene), size);
        rig.unlight();
        rig.wear(&Wear::Nothing);
        rig.headless.step(4);
        let plain = rig.headless.picture();
        for (name, style) in detectors() {
            rig.wear(&Wear::style(style));
            rig.headless.step(4);
            let lines = mask(&plain, &rig.headless.picture());
            for (what, kinds) in [("silhouettes", &[0][..]), ("every line", &[0, 1, 2])] {
                let wanted = truth.any(kinds);
                let (found, all) = truth.recall(&wanted, &lines);
                let (right, drawn) = truth.precision(&wanted, &lines);
                table.push(&[&scene.name(), &name, &what, &found, &all, &right, &drawn]);
            }
        }
        run.say(&format!("{}: lines scored", scene.name()));
    }
    run.save("line_scores", &table)
}

/// A smaller picture: each pixel is the mean, in linear light, of `by` x `by` pixels.
fn shrunk(picture: &image::RgbaImage, by: u32) -> Vec<[u8; 3]> {
    use bevy_comics_testkit::reference::color::{srgb_decode, srgb_encode};
    let (w, h) = (picture.width() / by, picture.height() / by);
    let mut pixels = Vec::new();
    for y in 0..h {
        for x in 0..w {
            let mut sum = [0.0; 3];
            for j in 0..by {
                for i in 0..by {
                    let p = picture.get_pixel(x * by + i, y * by + j);
                    let light = srgb_decode([0, 1, 2].map(|k| f64::from(p.0[k]) / 255.0));
                    sum = [0, 1, 2].map(|k| sum[k] + light[k] / f64::from(by * by));
                }
            }
            pixels.push(srgb_encode(sum).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8));
        }
    }
    pixels
}

fn bands(softness: f32) -> ComicStyle {
    ComicStyle::new().with(ToneBands {
        softness,
        ..default()
    })
}

fn soft_outlines(scale: f32) -> ComicStyle {
    outlines(Outlines {
        creases: None,
        objects: None,
        width: 2.0 * scale,
        ..default()
    })
}

fn soft_contours(scale: f32, softness: f32) -> ComicStyle {
    ComicStyle::new().with(Contours {
        softness,
        width: 2.0 * scale,
        ..default()
    })
}

/// The error of each method against the same style at eight times the resolution, which
/// stands for the exact mean over a pixel.
fn smooth(run: &Run) -> Result<(), String> {
    const REFERENCE: u32 = 8;
    let size = if run.quick {
        UVec2::new(80, 45)
    } else {
        UVec2::new(240, 135)
    };
    let mut table = Table::new(&["what", "method", "flip", "codes"]);
    let picture = |size: UVec2, style: ComicStyle| {
        let mut rig = Rig::new(Some(BuiltIn::Teapot), size);
        rig.wear(&Wear::style(style));
        rig.headless.step(4);
        rig.headless.picture()
    };
    type Look = fn(f32) -> ComicStyle;
    let looks: [(&str, Look, Look); 3] = [
        ("tone bands", |_| bands(0.0), |_| bands(1.0)),
        (
            "contours",
            |scale| soft_contours(scale, 0.0),
            |scale| soft_contours(scale, 0.5),
        ),
        ("silhouettes", soft_outlines, soft_outlines),
    ];
    for (what, hard, derivative) in looks {
        let truth = shrunk(
            &picture(size * REFERENCE, hard(REFERENCE as f32)),
            REFERENCE,
        );
        for (method, style, factor) in [
            ("hard", hard(1.0), 1),
            ("derivative", derivative(1.0), 1),
            ("2x2 samples", hard(2.0), 2),
        ] {
            if what == "silhouettes" && method == "hard" {
                // They have no hard form.
                continue;
            }
            let got = shrunk(&picture(size * factor, style), factor);
            let squares: f64 = truth
                .iter()
                .zip(&got)
                .flat_map(|(a, b)| (0..3).map(move |k| f64::from(a[k]) - f64::from(b[k])))
                .map(|d| d * d)
                .sum();
            let rms = (squares / (3 * truth.len()) as f64).sqrt();
            table.push(&[
                &what,
                &method,
                &format!("{:.5}", capture::flip(size, &truth, &got)),
                &format!("{rms:.3}"),
            ]);
        }
    }
    run.save("smoothing_errors", &table)
}

pub fn measure(run: &Run) -> Result<(), String> {
    score(run)?;
    smooth(run)?;
    let size = if run.quick {
        UVec2::new(320, 180)
    } else {
        UVec2::new(1280, 720)
    };
    let mut times = rig::times();
    let mut rig = Rig::new(Some(BuiltIn::Teapot), size);
    rig.unlight();
    let mut variants: Vec<(String, Wear)> = detectors()
        .into_iter()
        .map(|(name, style)| (name, Wear::style(style)))
        .collect();
    for (name, style) in [
        ("default comic", default_comic()),
        ("tone bands hard", bands(0.0)),
        ("tone bands derivative", bands(1.0)),
        ("contours hard", soft_contours(1.0, 0.0)),
        ("contours derivative", soft_contours(1.0, 0.5)),
    ] {
        variants.push((name.to_owned(), Wear::style(style)));
    }
    rig::record(run, &mut times, "lines", "teapot", &mut rig, &variants);
    // Twice the width and height: the cost of 2x2 samples.
    let mut fine = Rig::new(Some(BuiltIn::Teapot), size * 2);
    fine.unlight();
    let variants = [
        ("tone bands hard".to_owned(), Wear::style(bands(0.0))),
        (
            "contours hard".to_owned(),
            Wear::style(soft_contours(2.0, 0.0)),
        ),
        ("silhouettes".to_owned(), Wear::style(soft_outlines(2.0))),
    ];
    rig::record(run, &mut times, "2x2", "teapot", &mut fine, &variants);
    run.save("line_times", &times)
}
