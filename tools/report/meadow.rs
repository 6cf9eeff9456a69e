//! How much of a meadow the lines of each preset cover.

use bevy::prelude::*;
use bevy_comics::{
    ComicStyle, Outlines, effects::Equations, lines::LineColor, presets, style::Preset,
};
use bevy_comics_testkit::scenes::BuiltIn;
use image::RgbaImage;

use crate::{
    Run,
    ink::whiten,
    rig::{Drawn, Rig},
    table::{Table, largest},
};

/// Side of the areas of which the one with most ink is reported, in pixels.
const AREA: u32 = 32;

/// The lines of a preset alone, in black.
fn lines_alone(preset: Preset) -> Option<(Outlines, ComicStyle)> {
    let style = preset.style();
    let mut lines = *style.get::<Outlines>()?;
    lines.color = LineColor::Ink;
    if let Some(kind) = &mut lines.silhouettes {
        kind.color = Color::BLACK;
    }
    if let Some(kind) = &mut lines.creases {
        kind.color = Color::BLACK;
    }
    if let Some(kind) = &mut lines.objects {
        kind.color = Color::BLACK;
    }
    let mut alone = ComicStyle::new();
    alone.depth_map = style.depth_map;
    Some((lines, alone))
}

fn is_faithful(lines: &Outlines) -> bool {
    let silhouettes = lines.silhouettes.map(|kind| kind.equations);
    let creases = lines.creases.map(|kind| kind.equations);
    [silhouettes, creases].contains(&Some(Equations::Faithful))
}

/// The fractions of the meadow's areas that black lines on white cover: the meadow is the lower
/// 5/12 of the picture.
fn covered(picture: &RgbaImage) -> Vec<f64> {
    let (width, height) = picture.dimensions();
    let first = height * 7 / 12;
    let cover = |x, y| 1.0 - linear(picture.get_pixel(x, y).0[1]);
    let mut areas = Vec::new();
    for top in (first..=height.saturating_sub(AREA)).step_by(AREA as usize) {
        for left in (0..=width.saturating_sub(AREA)).step_by(AREA as usize) {
            let sum: f64 = (0..AREA * AREA)
                .map(|i| cover(left + i % AREA, top + i / AREA))
                .sum();
            areas.push(sum / f64::from(AREA * AREA));
        }
    }
    areas
}

/// The light of a code of sRGB.
fn linear(code: u8) -> f64 {
    f64::from(Color::srgb_u8(code, code, code).to_linear().red)
}

pub fn measure(run: &Run) -> Result<(), String> {
    let size = if run.quick {
        UVec2::new(160, 90)
    } else {
        UVec2::new(640, 360)
    };
    let mut rig = Rig::new(Some(BuiltIn::Mountains), size);
    whiten(&mut rig);
    let mut table = Table::new(&[
        "preset",
        "form",
        "budget",
        "mean",
        "most",
        "mean_free",
        "most_free",
    ]);
    for preset in run.some(1, presets::ALL.iter().copied()) {
        let Some((lines, alone)) = lines_alone(preset) else {
            continue;
        };
        let free = Outlines {
            ink_budget: 1.0,
            ..lines
        };
        let [own, free] = [lines, free].map(|lines| {
            rig.set_drawn(&Drawn::style(alone.clone().with(lines)));
            rig.headless.step(4);
            let areas = covered(&rig.headless.picture());
            let mean = areas.iter().sum::<f64>() / areas.len().max(1) as f64;
            [mean, largest(&areas)].map(|part| format!("{part:.4}"))
        });
        let form = if is_faithful(&lines) {
            "faithful"
        } else {
            "corrected"
        };
        table.push(&[
            &preset.name(),
            &form,
            &lines.ink_budget,
            &own[0],
            &own[1],
            &free[0],
            &free[1],
        ]);
        run.say(&format!("{}: ink of the meadow measured", preset.name()));
    }
    run.save("meadow_ink", &table)
}
