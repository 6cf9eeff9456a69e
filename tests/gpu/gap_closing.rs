//! Gaps in lines: closed up to the length that is asked for, and no further.

use bevy_comics_testkit::truth::fragments;

use crate::{
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::{towards_the_sky, towards_the_sky_again, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

/// Lines of a pixel, inside of the things that they belong to.
fn thin(gap_closing: u32) -> Outlines {
    Outlines {
        width: 1.0,
        gap_closing,
        ..Outlines::SILHOUETTES
    }
}

/// Pixels that are not white.
fn mask(picture: &image::RgbaImage) -> Vec<bool> {
    let pixels = picture.pixels();
    pixels.map(|pixel| pixel.0[0] < 128).collect()
}

/// A white wall, and in front of it an upright or level wire of one pixel, in pieces of eight
/// pixels with gaps.
fn dashed(small: &mut Small, gap: f32, upright: bool, color: Color) {
    towards_the_sky_again(small, Msaa::Off);
    wall(small, [-60.0, -40.0], [60.0, 40.0], 900.0);
    let mut from = -24.0_f32;
    while from < 24.0 {
        let to = (from + 8.0).min(24.0);
        let ends = if upright {
            [[5.0, from], [6.0, to]]
        } else {
            [[from, 5.0], [to, 6.0]]
        };
        let [low, high] = ends.map(Vec2::from);
        small.put(
            Rectangle::from_size(high - low),
            unlit(color),
            Transform::from_translation((0.5 * (low + high)).extend(-100.0)),
        );
        from = to + gap;
    }
}

/// Truth: with its gaps closed, a dashed wire looks like a whole one; gaps that are longer than
/// asked look like before.
#[test]
fn a_wire_with_short_gaps_looks_like_a_whole_one() {
    // Whether the wire is upright, and the lengths of gaps.
    let wires: [(bool, &[u32]); 2] = [(false, &[1, 2, 3, 4]), (true, &[3])];
    let mut small = towards_the_sky(SIZE);
    for (upright, gaps) in wires {
        dashed(&mut small, 0.0, upright, Color::WHITE);
        let whole = small.outlined(thin(0));
        let ink = mask(&whole).into_iter().filter(|ink| *ink).count();
        assert_eq!(ink, 48, "a line of 48 pixels");
        for &gap in gaps {
            dashed(&mut small, gap as f32, upright, Color::WHITE);
            let before = small.outlined(thin(0));
            assert!(before != whole);
            let pieces = fragments(&mask(&before), SIZE.x as usize, 1000);
            assert!(pieces >= 4);
            for gap_closing in 1..=3 {
                let found = mask(&small.outlined(thin(gap_closing)));
                let is_closed = gap_closing >= gap;
                let want = mask(if is_closed { &whole } else { &before });
                let differ = found.iter().zip(want).filter(|(a, b)| **a != *b).count();
                let parts = fragments(&found, SIZE.x as usize, 1000);
                // The last piece is cut where the whole wire ends.
                let (most, want) = if is_closed { (8, 1) } else { (0, pieces) };
                assert!(
                    differ <= most && parts == want,
                    "upright {upright}, gap {gap}, gap_closing {gap_closing}: {differ}, {parts} of {want}"
                );
            }
        }
    }
}

/// Wires thinner than a pixel, at small angles to the rows or columns of pixels: whole where
/// their gaps are at most three pixels long.
#[test]
fn thin_wires_at_small_angles_are_whole() {
    let mut small = towards_the_sky(SIZE);
    for (slope, thickness) in [(0.2, 0.7), (0.25, 0.6), (0.34, 0.5)] {
        for upright in [false, true] {
            towards_the_sky_again(&mut small, Msaa::Off);
            wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 900.0);
            let turn = if upright {
                std::f32::consts::FRAC_PI_2
            } else {
                0.0
            };
            small.put(
                Rectangle::new(50.0, thickness),
                unlit(Color::WHITE),
                Transform::from_xyz(0.31, 0.17, -100.0)
                    .with_rotation(Quat::from_rotation_z(f32::atan(slope) + turn)),
            );
            let parts = |small: &mut Small, gap_closing| {
                let picture = small.outlined(thin(gap_closing));
                fragments(&mask(&picture), SIZE.x as usize, 1000)
            };
            let [open, closed] = [0, 3].map(|gap_closing| parts(&mut small, gap_closing));
            assert!(open >= 5, "{open}");
            assert_eq!(closed, 1, "slope {slope}, upright {upright}");
        }
    }
}

/// What closes a gap is as wide, strong and lit as the line that it continues: as if the wire
/// were whole.
#[test]
fn closed_gaps_are_like_the_line_beside_them() {
    let mut small = towards_the_sky(SIZE);
    let weight = LineWeight {
        outer: 1.5,
        inner: 0.5,
        shade: 0.5,
        lit: 0.7,
        ..LineWeight::EVEN
    };
    let light = Transform::default().looking_to(Vec3::new(-0.3, -0.2, -1.0), Vec3::Y);
    for width in [2.0, 6.0] {
        for color in [
            LineColor::Ink,
            LineColor::Surface {
                darken: 0.5,
                saturate: 1.0,
            },
        ] {
            let outlines = |gap_closing| Outlines {
                width,
                weight,
                gap_closing,
                color,
                ink_budget: 1.0,
                ..Outlines::SILHOUETTES
            };
            let pictures = [0.0, 3.0].map(|gap| {
                dashed(&mut small, gap, false, Color::srgb(0.9, 0.5, 0.2));
                small.world().spawn((KeyLight, light, Object));
                small.outlined(outlines(3))
            });
            let [whole, closed] = pictures.map(|picture| {
                // The middle of a gap, without the row in which the wire shows beside thin lines.
                let rows = (20..36).filter(|row| *row != 26);
                let across = rows.flat_map(|y| linear(&picture, 55, y));
                across.collect::<Vec<f64>>()
            });
            let apart = (whole.iter().zip(&closed)).map(|(a, b)| (a - b).abs());
            let most = apart.fold(0.0, f64::max);
            assert!(
                most < 0.01,
                "{width} px, {color:?}: {whole:.2?}, {closed:.2?}"
            );
            assert!(whole.iter().any(|light| *light < 0.9), "{whole:.2?}");
        }
    }
}

/// Wires of about 0.6 pixels in several directions, in front of each other.
fn put_wires(small: &mut Small) {
    for i in 0..9 {
        let turned = Quat::from_rotation_z(0.05 + 0.21 * i as f32);
        let place = Vec3::new(
            0.4 * (i % 3) as f32 - 0.3,
            0.35 * (i / 3) as f32,
            0.1 * i as f32,
        );
        small.put(
            Cuboid::new(5.0, 0.045, 0.045),
            unlit(Color::srgb(0.8, 0.6, 0.3)),
            Transform::from_translation(place).with_rotation(turned),
        );
    }
}

/// Every pixel, with gaps in rows, columns, and at the borders of cells and words.
#[test]
fn closed_gaps_match_the_reference() {
    assert_closed_gaps([CLOSED[0], CLOSED[2]]);
}

#[test]
#[ignore = "long: thin lines too; quick test gap_closing::closed_gaps_match_the_reference"]
fn closed_gaps_of_thin_lines_match_the_reference() {
    assert_closed_gaps(CLOSED);
}

/// Lengths of gaps, widths, weights, and hysteresis.
const CLOSED: [(u32, f32, LineWeight, f32); 3] = [
    (3, 2.0, LineWeight::EVEN, 8.0),
    (2, 1.0, LineWeight::EVEN, 0.0),
    (1, 5.0, UNEVEN, 12.0),
];

const UNEVEN: LineWeight = LineWeight {
    outer: 1.4,
    inner: 0.6,
    taper: 9.0,
    perspective: 0.5,
    ..LineWeight::EVEN
};

fn assert_closed_gaps(cases: impl IntoIterator<Item = (u32, f32, LineWeight, f32)>) {
    let mut small = Small::new(UVec2::new(101, 70), Msaa::Off);
    put_wires(&mut small);
    for (gap_closing, width, weight, hysteresis) in cases {
        let outlines = Outlines {
            gap_closing,
            width,
            weight,
            hysteresis,
            hysteresis_ratio: 0.3,
            silhouettes: Some(Silhouettes {
                threshold: 0.1,
                ..default()
            }),
            ..default()
        };
        let what = format!("gaps of {gap_closing}, {width} px");
        assert_pass_matches_the_reference(&mut small, &outlined(outlines), None, &what);
    }
}
