//! The sheet: its height, and ink on it.

use bevy_comics_testkit::reference::sheet::{Sheet, bristles, height};

use super::*;

const SHEET: &str = "#import bevy_comics::effect::sheet::{bristles, sheet_height}
    #import bevy_comics::lines::sheet::{Sheet, dry_ink, height_under, spread_width}";

#[test]
fn the_height_of_the_sheet_matches_the_reference() {
    let row = (0.0f32..=4000.0, 0.0f32..=4000.0, 0u16..=300, -1.0f32..=1.0)
        .prop_map(|(x, y, sheet, dry)| [x, y, f32::from(sheet), dry.abs(), dry]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            SHEET,
            "return vec4(sheet_height(vec2(i(0u), i(1u)), u(2u)), bristles(i(3u), i(4u)), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let want = height([row[0], row[1]].map(f64::from), row[2] as u32);
            // Noise of slope 3 per 1.5 pixels, at places that are rounded to 5e-4.
            let apart = (f64::from(found[0]) - want).abs();
            assert!(apart < 4e-3, "{row:?}: {found:?}, {want}");
            let left = bristles(f64::from(row[3]), f64::from(row[4]));
            assert!((f64::from(found[1]) - left).abs() < 1e-5, "{row:?}");
        }
    });
}

/// Truth: heights are as often above 0 as below, so that what is added to a tone is 0 in
/// the mean; and they vary.
#[test]
fn the_sheet_is_level() {
    for sheet in 0..6 {
        let heights: Vec<f64> = (0..90_000)
            .map(|n| {
                let at = [n % 300, n / 300].map(|v| f64::from(v) + 0.5);
                height(at, sheet)
            })
            .collect();
        let count = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / count;
        let square = heights.iter().map(|h| h * h).sum::<f64>() / count;
        // 625 grains of the coarsest octave, with a deviation of 0.2.
        assert!(mean.abs() < 0.03, "{sheet}: {mean}");
        assert!((0.3..0.7).contains(&square.sqrt()), "{sheet}: {square}");
    }
}

/// Places, spreads and widths of every size: a line never vanishes, and never turns inside out.
#[test]
fn the_width_of_a_line_on_the_sheet_matches_the_reference() {
    let half_width = prop_oneof![4 => 0.0f32..16.0, 1 => select(vec![0.0, 0.25, 0.3, 1.0])];
    let row = (
        (0.0f32..2000.0, 0.0f32..2000.0),
        0.0f32..6.0,
        half_width,
        0.5f32..8.0,
        0u16..=300,
    )
        .prop_map(|((x, y), spread, half_width, grain, seed)| {
            [x, y, spread, half_width, grain, f32::from(seed)]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            SHEET,
            "let s = Sheet(vec2(100.0, 50.0), i(2u), 0.0, 1.0 / i(4u), 1.0, u(5u), 0u);
             let height = height_under(s, vec2(i(0u), i(1u)));
             return vec4(height, spread_width(s, i(3u), height), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [x, y, spread, half_width, grain, _] = row.map(f64::from);
            let sheet = Sheet {
                spread,
                grain,
                seed: row[5] as u32,
                ..Sheet::SMOOTH
            };
            let on = sheet.under([x + 100.0, y + 50.0]);
            let want = on.half_width(half_width);
            let apart = (f64::from(found[0]) - on.height).abs();
            assert!(apart < 8e-3, "{row:?}: {found:?}, {}", on.height);
            // The width is the height times half the spread.
            let apart = (f64::from(found[1]) - want).abs();
            assert!(apart < 1e-5 + 4e-3 * spread, "{row:?}: {found:?}, {want}");
            let part = if half_width > 0.0 {
                want / half_width
            } else {
                1.0
            };
            assert!(
                (0.25 - 1e-9..=1.75 + 1e-9).contains(&part),
                "{row:?}: {part}"
            );
            assert!((want - half_width).abs() <= 0.5 * spread + 1e-9, "{row:?}");
        }
    });
}

/// Lines of every direction and width.
#[test]
fn the_ink_of_a_dry_brush_matches_the_reference() {
    let row = (
        (0.0f32..2000.0, 0.0f32..2000.0),
        -3.15f32..3.15,
        0.0f32..8.0,
        (0.0f32..=1.0, 1.0f32..3.0),
        0u16..=300,
    )
        .prop_map(|((x, y), angle, half_width, (dry, unit), seed)| {
            [x, y, angle, half_width, dry, unit, f32::from(seed)]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            SHEET,
            "let s = Sheet(vec2(100.0, 50.0), 0.0, i(4u), 1.0, i(5u), u(6u), 0u);
             let along = 0.7 * vec2(cos(i(2u)), sin(i(2u)));
             return vec4(dry_ink(s, vec2(i(0u), i(1u)), along, i(3u)), along, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [x, y, _, half_width, dry_brush, unit, _] = row.map(f64::from);
            let sheet = Sheet {
                dry_brush,
                unit,
                seed: row[6] as u32,
                ..Sheet::SMOOTH
            };
            let along = [found[1], found[2]].map(f64::from);
            let want = sheet
                .under([x + 100.0, y + 50.0])
                .dry_ink(along, half_width);
            // Bristles have a slope of 2.5, noise of 3 per 1.6 pixels, at places that are rounded
            // to 5e-4; the adapter's arctangent may be off by 2.5e-4, a 400th of a direction.
            let apart = (f64::from(found[0]) - want).abs();
            assert!(apart < 0.02, "{row:?}: {found:?}, {want}");
        }
    });
}

/// Truth: streaks run along the line. They are eight times as long as wide; from pixel to pixel,
/// ink changes at least 2.5 times as fast across the line as along it, because a streak is hardly
/// wider than a pixel.
#[test]
fn streaks_run_along_the_line() {
    let sheet = Sheet {
        dry_brush: 0.5,
        ..Sheet::SMOOTH
    };
    for degrees in [0.0f64, 11.25, 37.0, 90.0, 133.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let ink = |place| sheet.under(place).dry_ink([cos, sin], 5.0);
        // Mean of the squared change over a pixel along and across.
        let change = |[dx, dy]: [f64; 2]| {
            let places = (0..40_000).map(|n| [f64::from(n % 200) + 0.5, f64::from(n / 200) + 0.5]);
            let changes = places.map(|[x, y]| (ink([x + dx, y + dy]) - ink([x, y])).powi(2));
            changes.sum::<f64>() / 40_000.0
        };
        let (along, across) = (change([cos, sin]), change([-sin, cos]));
        let ratio = (across / along).sqrt();
        println!("{degrees} degrees: {ratio:.1} times as fast across");
        assert!(ratio > 2.5, "{degrees}: {ratio}");
    }
}
