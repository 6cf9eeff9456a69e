//! Gaps in lines: closed up to the length that is asked for, and no further.

use bevy_comics_testkit::truth::fragments;

use crate::{
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::{towards_the_sky, towards_the_sky_again, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

/// Lines of a pixel, inside of the things that they belong to.
fn thin(bridge: u32) -> Outlines {
    Outlines {
        width: 1.0,
        gap_closing: bridge,
        ..Outlines::SILHOUETTES
    }
}

fn drawn(small: &mut Small, outlines: Outlines) -> image::RgbaImage {
    small.style(&ComicStyle::new().with(outlines));
    small.settle();
    small.picture()
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
    assert_gaps_close(&[(false, &[2, 3, 4]), (true, &[3])]);
}

#[test]
#[ignore = "long: gaps of every length in both directions"]
fn wires_with_gaps_of_any_length_look_like_whole_ones() {
    assert_gaps_close(&[(false, &[1, 2, 3, 4]), (true, &[1, 2, 3, 4])]);
}

/// Whether a wire is upright, and the lengths of gaps.
fn assert_gaps_close(wires: &[(bool, &[u32])]) {
    let mut small = towards_the_sky(SIZE);
    for &(upright, gaps) in wires {
        dashed(&mut small, 0.0, upright, Color::WHITE);
        let whole = drawn(&mut small, thin(0));
        let ink = mask(&whole).into_iter().filter(|ink| *ink).count();
        assert_eq!(ink, 48, "a line of 48 pixels");
        for &gap in gaps {
            dashed(&mut small, gap as f32, upright, Color::WHITE);
            let before = drawn(&mut small, thin(0));
            assert!(before != whole);
            for bridge in 1..=3 {
                let found = drawn(&mut small, thin(bridge));
                let want = if bridge >= gap { &whole } else { &before };
                let length = mask(want).into_iter().filter(|ink| *ink).count();
                let differ = mask(&found)
                    .iter()
                    .zip(mask(want))
                    .filter(|(a, b)| **a != *b)
                    .count();
                // The last piece is cut where the whole wire ends.
                assert!(
                    differ <= if bridge >= gap { 8 } else { 0 },
                    "upright {upright}, gap {gap}, bridge {bridge}: {differ} of {length}"
                );
                let parts = fragments(&mask(&found), SIZE.x as usize, 1000);
                let pieces = fragments(&mask(&before), SIZE.x as usize, 1000);
                assert!(pieces >= 4);
                let want = if bridge >= gap { 1 } else { pieces };
                assert_eq!(parts, want, "upright {upright}, gap {gap}, bridge {bridge}");
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
            let angle = f32::atan(slope)
                + if upright {
                    std::f32::consts::FRAC_PI_2
                } else {
                    0.0
                };
            small.put(
                Rectangle::new(50.0, thickness),
                unlit(Color::WHITE),
                Transform::from_xyz(0.31, 0.17, -100.0).with_rotation(Quat::from_rotation_z(angle)),
            );
            let parts = |small: &mut Small, bridge| {
                let picture = drawn(small, thin(bridge));
                fragments(&mask(&picture), SIZE.x as usize, 1000)
            };
            let [open, closed] = [0, 3].map(|bridge| parts(&mut small, bridge));
            println!("slope {slope}, {thickness} px, upright {upright}: {open} -> {closed}");
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
            let outlines = |bridge| Outlines {
                width,
                weight,
                gap_closing: bridge,
                color,
                ink_budget: 1.0,
                ..Outlines::SILHOUETTES
            };
            let pictures = [0.0, 3.0].map(|gap| {
                dashed(&mut small, gap, false, Color::srgb(0.9, 0.5, 0.2));
                small.world().spawn((KeyLight, light, Object));
                drawn(&mut small, outlines(3))
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
    assert_closed_as_reference(&[(3, &LINES[0]), (2, &LINES[1])]);
}

#[test]
#[ignore = "long: gaps of every length in every kind of line"]
fn closed_gaps_of_all_lines_match_the_reference() {
    let cases = LINES
        .each_ref()
        .map(|lines| [(1, lines), (2, lines), (3, lines)]);
    assert_closed_as_reference(cases.as_flattened());
}

/// Width, weight and continuity of lines.
type Lines = (f32, LineWeight, f32);

const LINES: [Lines; 3] = [
    (2.0, LineWeight::EVEN, 8.0),
    (1.0, LineWeight::EVEN, 0.0),
    (
        5.0,
        LineWeight {
            outer: 1.4,
            inner: 0.6,
            taper: 9.0,
            perspective: 0.5,
            ..LineWeight::EVEN
        },
        12.0,
    ),
];

fn assert_closed_as_reference(cases: &[(u32, &Lines)]) {
    let mut small = Small::new(UVec2::new(101, 70), Msaa::Off);
    put_wires(&mut small);
    for &(bridge, &(width, weight, continuity)) in cases {
        let outlines = Outlines {
            gap_closing: bridge,
            width,
            weight,
            hysteresis: continuity,
            hysteresis_ratio: 0.3,
            silhouettes: Some(Silhouettes {
                threshold: 0.1,
                ..default()
            }),
            ..default()
        };
        let what = format!("bridge {bridge}, {width} px");
        assert_pass_matches_the_reference(&mut small, &outlined(outlines), None, &what);
    }
    assert_eq!(small.errors(), 0);
}
