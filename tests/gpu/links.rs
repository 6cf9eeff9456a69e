//! Whether lines are whole: dashes of responses around the threshold, and short pieces.

use bevy_comics_testkit::reference::{
    crack::Crack,
    link::{Place, linked, without_short_pieces},
};

use crate::{
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
};

/// A crack with a response: certain from 1 on, and there at all from `level` on.
fn crack(response: f64, level: f64) -> Option<Crack> {
    (response >= level).then_some(Crack {
        kinds: [true, false, false],
        mine: true,
        ink: 1.0,
        opacity: 1.0,
        half_width: 1.0,
        certain: response >= 1.0,
        ledge: false,
        bend: [0.0; 2],
        shifts: true,
    })
}

/// Responses along an edge: a first-order autoregression with this mean, a deviation of
/// 12 % of it and a correlation of 0.6 from pixel to pixel.
fn responses(mean: f64, count: usize) -> Vec<f64> {
    let mut random = Random::new(0);
    // The sum of twelve numbers in [0, 1) is nearly normal, with variance 1.
    let mut normal = move || (0..12).map(|_| f64::from(random.unit())).sum::<f64>() - 6.0;
    let mut value = 0.0;
    let found = (0..count).map(|_| {
        value = 0.6 * value + 0.8 * normal();
        mean * (1.0 + 0.12 * value)
    });
    found.collect()
}

/// Pieces of line for each 100 cracks of a straight edge.
fn dashes(mean: f64, level: f64, steps: i32) -> f64 {
    const LENGTH: i64 = 20_000;
    let cracks: HashMap<Place, Crack> = responses(mean, LENGTH as usize)
        .into_iter()
        .zip(0..)
        .filter_map(|(response, x)| Some((([x, 0], 1), crack(response, level)?)))
        .collect();
    let lines = linked(&cracks, steps);
    let starts =
        (0..LENGTH).filter(|x| lines.contains(&([*x, 0], 1)) && !lines.contains(&([x - 1, 0], 1)));
    100.0 * starts.count() as f64 / LENGTH as f64
}

/// Around the threshold, continuing along weak cracks leaves less than a tenth of the
/// dashes; well above it there are hardly any.
#[test]
fn lines_of_responses_around_the_threshold_are_whole() {
    for (mean, most) in [(1.05, 0.3), (1.0, 0.6), (0.95, 1.4)] {
        let alone = dashes(mean, 0.5, 0);
        let continued = dashes(mean, 0.5, 8);
        println!("mean {mean}: {alone:.2} dashes per 100 px, continued {continued:.2}");
        assert!(alone > 8.0, "mean {mean}: {alone}");
        assert!(continued < most, "mean {mean}: {continued}");
        assert!(
            continued < 0.15 * alone,
            "mean {mean}: {continued}, {alone}"
        );
    }
}

/// Pieces of fewer cracks than asked are left out, around corners too.
#[test]
fn pieces_of_fewer_cracks_than_asked_are_left_out() {
    // Three in a row, an L of two, a single one, a U of three, and a staircase of seven.
    let stairs: Vec<Place> = (0..7)
        .map(|i| ([40 + i / 2, 40 + i / 2 + i % 2], 1 - i as usize % 2))
        .collect();
    let pieces: [&[Place]; 5] = [
        &[([1, 1], 1), ([2, 1], 1), ([3, 1], 1)],
        &[([10, 10], 0), ([10, 10], 1)],
        &[([20, 20], 0)],
        &[([30, 30], 0), ([30, 30], 1), ([29, 30], 0)],
        &stairs,
    ];
    let all = pieces
        .iter()
        .flat_map(|piece| piece.iter().copied())
        .collect();
    for min_length in 1..=8 {
        let kept = without_short_pieces(&all, [64, 64], min_length);
        for piece in pieces {
            let there = piece.iter().filter(|place| kept.contains(*place)).count();
            let is_kept = piece.len() >= min_length as usize;
            let want = if is_kept { piece.len() } else { 0 };
            assert_eq!(there, want, "{piece:?}, {min_length}");
        }
    }
}

/// Outlines with many weak edges.
fn weak(hysteresis: f32) -> Outlines {
    Outlines {
        hysteresis,
        hysteresis_ratio: 0.1,
        silhouettes: Some(Silhouettes {
            threshold: 0.3,
            edge_limit: 0.9,
            ..default()
        }),
        creases: Some(Creases {
            angle: 120.0,
            edge_limit: 0.9,
            ..default()
        }),
        objects: None,
        ..default()
    }
}

/// Views of sizes that no word, block, cell or tile divides, and views that are smaller than each.
#[test]
fn lines_match_the_reference_in_views_of_odd_sizes() {
    assert_views_of_sizes(&[[61, 37], [131, 33], [1, 1], [2, 3], [13, 7]]);
}

#[test]
#[ignore = "long: a larger view; quick test links::lines_match_the_reference_in_views_of_odd_sizes"]
fn lines_match_the_reference_in_a_larger_view_of_odd_size() {
    assert_views_of_sizes(&[[97, 65]]);
}

fn assert_views_of_sizes(sizes: &[[u32; 2]]) {
    let mut small = Small::new(UVec2::new(61, 37), Msaa::Off);
    for &size in sizes {
        small.headless.resize(size.into(), 1.0);
        small.restart(Msaa::Off);
        for outlines in [Outlines::default(), weak(8.0)] {
            let what = format!("{size:?}, {} px", outlines.hysteresis);
            assert_pass_matches_the_reference(&mut small, &outlined(outlines), None, &what);
        }
    }
}

/// Distances of more than one pass, and of parts of passes.
#[test]
fn lines_continue_as_far_as_asked() {
    let cases = [(0.0, 2), (7.0, 1), (8.0, 3), (9.0, 7), (23.5, 2), (32.0, 3)];
    assert_continued_as_reference(UVec2::new(61, 37), cases);
}

#[test]
#[ignore = "long: every distance with every `min_length`"]
fn lines_continue_as_far_as_asked_with_any_min_length() {
    let distances = [0.0, 1.0, 7.0, 8.0, 9.0, 16.0, 23.5, 32.0];
    let with_lengths = |hysteresis| [1, 2, 3, 7].map(|min_length| (hysteresis, min_length));
    let cases = distances.into_iter().flat_map(with_lengths);
    assert_continued_as_reference(UVec2::new(96, 64), cases);
}

fn assert_continued_as_reference(size: UVec2, cases: impl IntoIterator<Item = (f32, u32)>) {
    let mut small = Small::new(size, Msaa::Off);
    for (hysteresis, min_length) in cases {
        let outlines = Outlines {
            min_length,
            ..weak(hysteresis)
        };
        let what = format!("{hysteresis} px, min_length {min_length}");
        assert_pass_matches_the_reference(&mut small, &outlined(outlines), None, &what);
    }
}
