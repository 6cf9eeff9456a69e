//! Coverages of screens.

use bevy_comics_testkit::reference::{
    blue_noise::blue_noise,
    halftone::{Plate, plate_cover},
};

use super::*;
use crate::prelude::*;

const HALFTONE: &str =
    "#import bevy_comics::effects::halftone::{Halftone, page_screen, plate_cover}";

/// Places up to 2000 pixels from the middle, tones with both ends, cells from 2 to 40 pixels; and
/// the middles of the smallest dots, from which ink bleeds.
/// The slope of a coverage is up to one per pixel, and places are exact to an eighth of a
/// thousandth there.
#[test]
fn coverages_of_all_shapes_match_the_reference() {
    let tone = prop_oneof![
        4 => 0.0f32..=1.0,
        1 => select(vec![0.0, 1.0, 0.5, 0.01, 0.995, 0.785, 0.786, 1.0 / 32.0, 31.0 / 32.0]),
    ];
    let anywhere = (
        (-2000.0f32..2000.0, -2000.0f32..2000.0),
        tone,
        2.0f32..40.0,
        -180.0f32..180.0,
        0u32..4,
        (0.0f32..3.0, -1.0f32..=1.0),
    );
    let small_dots = (
        (-0.5f32..0.5, -0.5f32..0.5),
        0.02f32..0.1,
        2.0f32..6.0,
        -180.0f32..180.0,
        0u32..4,
        (2.0f32..3.0, prop_oneof![Just(1.0f32), 0.5f32..=1.0]),
    );
    let row = prop_oneof![3 => anywhere, 1 => small_dots].prop_map(
        |((x, y), tone, cell_size, degrees, plate, (ink_bleed, height))| {
            [
                x,
                y,
                tone,
                cell_size,
                degrees,
                plate as f32,
                ink_bleed,
                height,
            ]
        },
    );
    for shape in SHAPES {
        let number = shape as u32;
        for_batches(row.clone(), |rows| {
            let results = gpu().evaluate(
                HALFTONE,
                &format!(
                    "var s: Halftone;
                     let turn = i(4u) * 0.017453292519943295;
                     s.cosines = vec4(cos(turn)) / i(3u);
                     s.sines = vec4(sin(turn)) / i(3u);
                     s.cell_size = i(3u);
                     s.grain = max(i(3u) / 3.0, 1.0);
                     s.shape = {number}u;
                     s.ink_bleed = i(6u);
                     let on = page_screen(s, i(7u));
                     let k = plate_cover(s, on, vec2(i(0u), i(1u)), i32(i(5u)), i(2u));
                     return vec4(k, s.cosines.x, s.sines.x, 0.0);"
                ),
                rows,
            );
            for (row, found) in rows.iter().zip(results) {
                let ink_bleed = f64::from(row[6]);
                // The angle as the adapter's cosine has it: its error would move places
                // far away by pixels.
                let degrees = f64::from(found[2]).atan2(f64::from(found[1])).to_degrees();
                let scale = f64::from(found[1]).hypot(f64::from(found[2]));
                let plate = Plate {
                    degrees,
                    cell_size: 1.0 / scale,
                    phase: if row[5] == 3.0 { 0.25 } else { 0.0 },
                    number: row[5] as i32,
                    ink_bleed,
                    height: f64::from(row[7]),
                };
                let tone = f64::from(row[2]);
                let place = [0, 1].map(|i| f64::from(row[i]));
                let want = plate_cover(shape, plate, tone, &blue_noise)(place);
                let apart = (f64::from(found[0]) - want).abs();
                assert!(apart < 0.01, "{shape:?}, {row:?}: {found:?}, {want}");
            }
        });
    }
}
