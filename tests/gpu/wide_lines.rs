//! Wide lines against an exhaustive search.

use bevy_comics_testkit::reference::{crack::Crack, draw::Cracks, view::View};

use crate::{
    pictures::{assert_pass_matches_the_reference, frame, outlined},
    prelude::*,
};

#[test]
fn wide_lines_match_the_reference() {
    assert_wide_as_reference(&[6.5, 16.0]);
}

#[test]
#[ignore = "long: more widths"]
fn lines_of_more_widths_match_the_reference() {
    assert_wide_as_reference(&[5.0, 8.0, 12.0]);
}

fn assert_wide_as_reference(widths: &[f32]) {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for &width in widths {
        let style = outlined(Outlines { width, ..default() });
        assert_pass_matches_the_reference(&mut small, &style, None, &format!("{width} px"));
    }
}

/// Over all pixels of a scene: the mean difference of ink between the search by columns and
/// an exhaustive search, and the fraction of pixels where it is above two codes.
fn columns_against_exhaustive(small: &mut Small, outlines: Outlines) -> [f64; 2] {
    small.insert(VisibleDepthRange::default());
    small.style(&ComicStyle::new().with(outlines));
    small.settle();
    let depth = small.depth().expect("a prepass");
    let (normals, ids) = (small.normals(), small.object_ids());
    let [width, height] = [depth.width, depth.bits.len() as u32 / depth.width];
    let view = View {
        viewport: [0, 0, width, height],
        samples: depth.samples,
        width,
        depth_bits: &depth.bits,
        frame: frame(small, &DepthMap::default()),
        flip: false,
        normals: normals.as_ref(),
        ids: ids.as_ref(),
        widths: None,
        height: 0.0,
        to_light: [0.0, 1.0, 0.0],
    };
    let cracks = Cracks::new(&outlines, &view, 1.0);
    let (mut sum, mut apart) = (0.0, 0.0);
    let pixels = f64::from(width * height);
    for i in 0..width * height {
        let at = [f64::from(i % width) + 0.5, f64::from(i / width) + 0.5];
        // Of the kinds, the strongest is drawn.
        let strongest = |ink: [f64; 3]| ink.into_iter().fold(0.0, f64::max);
        let found = strongest(cracks.ink(at, 0.0));
        let difference = (found - strongest(cracks.exhaustive_ink(at, 0.0))).abs();
        sum += difference / pixels;
        apart += f64::from(u8::from(difference > 2.0 / 255.0)) / pixels;
    }
    [sum, apart]
}

/// A vertical silhouette whose ink and width change at a row: neither part hides the
/// other, though columns rank cracks by their ink at one height.
#[test]
fn a_faint_part_of_a_wide_line_is_as_wide_as_a_strong_one() {
    const SIZE: i64 = 64;
    for (ink, half_width) in [(0.6, 8.0), (0.3, 8.0), (0.1, 8.0), (1.0, 2.0), (1.0, 4.0)] {
        let crack = |x: i64, y: i64| {
            let below = y >= SIZE / 2;
            let crack = Crack {
                kinds: [true, false, false],
                mine: true,
                ink: if below { ink } else { 1.0 },
                opacity: 1.0,
                half_width: if below { half_width } else { 8.0 },
                certain: true,
                ledge: false,
                bend: [0.0; 2],
                shifts: true,
            };
            [(x == SIZE / 2).then_some(crack), None]
        };
        let cracks = (0..SIZE * SIZE)
            .map(|i| crack(i % SIZE, i / SIZE))
            .collect();
        let cracks = Cracks::from_cracks(cracks, SIZE, 8.0);
        for i in 0..SIZE * SIZE {
            let at = [(i % SIZE) as f64 + 0.5, (i / SIZE) as f64 + 0.5];
            let found = cracks.ink(at, 0.0)[0];
            let want = cracks.exhaustive_ink(at, 0.0)[0];
            assert!(
                (found - want).abs() < 2.0 / 255.0,
                "ink {ink}, half width {half_width}, at {at:?}: {found}, not {want}"
            );
        }
    }
}

/// Columns leave out cracks that others in the same column surpass at its own height. That
/// must not be seen: on average less than a tenth of a code, and more than two codes in at
/// most 1 pixel of 200.
#[test]
fn a_search_by_columns_draws_what_an_exhaustive_search_draws() {
    assert_columns_are_exhaustive(&[4.0]);
}

#[test]
#[ignore = "long: more widths"]
fn a_search_by_columns_draws_lines_of_any_width_as_an_exhaustive_search_does() {
    assert_columns_are_exhaustive(&[3.0, 4.0, 5.0, 8.0, 16.0]);
}

fn assert_columns_are_exhaustive(widths: &[f32]) {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for &width in widths {
        for (width_fade, softness) in [(0.0, 0.5), (0.6, 0.5), (0.0, 1.0)] {
            let outlines = Outlines {
                width,
                width_fade,
                silhouettes: Some(Silhouettes {
                    softness,
                    ..default()
                }),
                creases: Some(Creases {
                    softness,
                    ..default()
                }),
                ..default()
            };
            let [mean, apart] = columns_against_exhaustive(&mut small, outlines);
            println!(
                "{width} px, width_fade {width_fade}, softness {softness}: mean {mean:.6}, apart {apart:.5}"
            );
            assert!(mean < 0.1 / 255.0, "{width} px, {width_fade}: mean {mean}");
            assert!(
                apart < 0.005,
                "{width} px, {width_fade}: {apart} of the pixels"
            );
        }
    }
}
