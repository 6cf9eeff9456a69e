//! What lines cost; error and cost of the anti-aliasing of bands and lines.

use bevy::prelude::*;
use bevy_comics::{ComicStyle, Contours, Outlines, ToneBands};

use bevy_comics_testkit::{scenes::BuiltIn, work::default_comic};

use crate::{
    Run, capture,
    rig::{self, Drawn, Rig},
    scores::{detectors, score},
    table::Table,
};

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
    ComicStyle::new().with(Outlines {
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
        rig.set_drawn(&Drawn::style(style));
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
    for (what, hard, derivative) in run.some(1, looks) {
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
    let mut variants: Vec<(String, Drawn)> = run
        .some(2, detectors())
        .into_iter()
        .map(|(name, style)| (name, Drawn::style(style)))
        .collect();
    for (name, style) in [
        ("default comic", default_comic()),
        ("tone bands hard", bands(0.0)),
        ("tone bands derivative", bands(1.0)),
        ("contours hard", soft_contours(1.0, 0.0)),
        ("contours derivative", soft_contours(1.0, 0.5)),
    ] {
        variants.push((name.to_owned(), Drawn::style(style)));
    }
    rig::record(run, &mut times, "lines", "teapot", &mut rig, &variants);
    // Twice the width and height: the cost of 2x2 samples.
    let mut fine = Rig::new(Some(BuiltIn::Teapot), size * 2);
    fine.unlight();
    let variants = [
        ("tone bands hard".to_owned(), Drawn::style(bands(0.0))),
        (
            "contours hard".to_owned(),
            Drawn::style(soft_contours(2.0, 0.0)),
        ),
        ("silhouettes".to_owned(), Drawn::style(soft_outlines(2.0))),
    ];
    rig::record(run, &mut times, "2x2", "teapot", &mut fine, &variants);
    run.save("line_times", &times)
}
