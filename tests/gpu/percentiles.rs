//! Percentiles of orthographic views: the bins against their reference, the percentiles against
//! sorted depths. Ranges of views of both kinds that a speck does not stretch.

use bevy_comics_testkit::reference::{histogram::Bins, smoothing::Smoothing};

use crate::{
    prelude::*,
    range::{SHAPES, reduce_and_count},
    smoothing::{Outliers, SMOOTH, frame, percentiles, run},
    walls::wall,
};

const ORTHOGRAPHIC: Smoothing = Smoothing {
    offset: None,
    ..SMOOTH
};

/// Depths of a view: most of them between two distances, a fraction of them outliers at
/// the ends of a wider range.
fn table(random: &mut Random, main: [f32; 2], wide: [f32; 2], outliers: f32) -> Vec<f32> {
    let between = |[near, far]: [f32; 2], t: f32| far + (near - far) * t;
    (0..30_000)
        .map(|_| match random.unit() {
            x if x < 0.5 * outliers => wide[0],
            x if x < outliers => wide[1],
            _ => between(main, random.unit()),
        })
        .collect()
}

fn extremes(table: &[f32]) -> [f32; 2] {
    [
        table.iter().copied().fold(0.0, f32::max),
        table.iter().copied().fold(1.0, f32::min),
    ]
}

/// Ranges of raw depth: all of it, and a ten-thousandth in various places (ten units of
/// 1e5).
const PLACES: [[f32; 2]; 4] = [
    [0.98, 0.01],
    [0.99985, 0.99975],
    [0.5001, 0.5],
    [0.0002, 0.0001],
];

#[test]
fn every_shape_counts_in_the_bins_of_the_window() {
    let mut random = Random::new(4);
    for window in PLACES {
        let [near, far] = window;
        let length = near - far;
        let size = [150, 200];
        let wide = [(near + 0.3 * length).min(1.0), far * 0.9];
        let mut depths = table(&mut random, window, wide, 0.01);
        depths[7] = 0.0;
        depths[8] = f32::NAN;
        let mut sorted: Vec<f32> = depths.iter().copied().filter(|d| *d > 0.0).collect();
        sorted.sort_by(f32::total_cmp);
        let valid = sorted.len() as u32;
        for shape in SHAPES {
            let defs: Vec<&str> = (shape.iter().copied())
                .chain(["HISTOGRAM", "ORTHOGRAPHIC"])
                .collect();
            let (_, counted) = reduce_and_count(&defs, &depths, (size, [0, 0, 150, 200]), window);
            assert_eq!(counted[256], valid, "{shape:?}, {window:?}");
            assert_eq!(counted[..256].iter().sum::<u32>(), valid);
            // The depths below every edge: those that the reference finds there, but for
            // depths that rounding brings across. The shader's differences are exact or
            // rounded once; its product, root and factor have a few ulp: 8 in all, of the
            // distance from the end of the window.
            let bins = Bins::Window(window.map(f64::from));
            let mut sum = 0;
            for bin in 1..256 {
                sum += counted[bin - 1];
                let edge = bins.edge(bin);
                let from_end = (edge - f64::from(far)).min(f64::from(near) - edge);
                let slack = 8.0 * f64::from(f32::EPSILON) * from_end;
                let below = |edge: f64| sorted.partition_point(|d| f64::from(*d) < edge) as u32;
                let (least, most) = (below(edge - slack), below(edge + slack));
                assert!(
                    (least..=most).contains(&sum),
                    "{shape:?}, {window:?}, bin {bin}: {sum}, not {least} to {most}"
                );
            }
        }
    }
}

#[test]
fn percentiles_are_those_of_the_sorted_depths() {
    let mut random = Random::new(8);
    for main in PLACES {
        // The outliers stretch the range to 1, 3 and 20 times its length.
        for stretch in [1.0f32, 3.0, 20.0] {
            let by = 0.5 * (stretch - 1.0) * (main[0] - main[1]);
            let wide = [(main[0] + by).min(1.0), (main[1] - by).max(1e-6)];
            let mut sorted = table(&mut random, main, wide, 0.006);
            sorted.sort_by(f32::total_cmp);
            let ends = extremes(&sorted).map(f64::from);
            for fraction in [0.005f32, 0.02, 0.1] {
                let bins = Bins::Window(ends);
                let [got, reference] = percentiles(&ORTHOGRAPHIC, bins, fraction, &sorted);
                let rank = (f64::from(fraction) * sorted.len() as f64) as usize;
                let exact = [sorted[sorted.len() - 1 - rank], sorted[rank]].map(f64::from);
                let length = ends[0] - ends[1];
                // Three units in the last place of a depth.
                let rounding = 3.0 * 2f64.powi(-24) * ends[0];
                for end in 0..2 {
                    let off = (got[end] - reference[end]).abs();
                    // A bin is 1/128 of the range or less.
                    let apart = (got[end] - exact[end]).abs();
                    assert!(
                        off <= rounding + 1e-6 * length && apart <= length / 128.0 + rounding,
                        "{main:?}, {stretch} times, {fraction}: {got:?} for {reference:?}, {exact:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_window_of_another_view_gives_a_range_within_the_extremes() {
    let mut random = Random::new(2);
    for main in PLACES {
        let depths = table(&mut random, main, main, 0.0);
        let ends = extremes(&depths);
        for window in [[0.0; 2], [0.3; 2], [0.3, 0.2], [1.0, 1e-6], [main[0]; 2]] {
            let (_, words) = reduce_and_count(
                &["BARRIER_FREE", "HISTOGRAM", "ORTHOGRAPHIC"],
                &depths,
                ([150, 200], [0, 0, 150, 200]),
                window,
            );
            let outliers = Outliers {
                fraction: 0.01,
                bins: &words[..256],
                total: words[256],
                window,
            };
            let found = frame(ends[0], ends[1], 0.0);
            // The second frame replaces the first.
            let drawn = run(&ORTHOGRAPHIC, &[found; 2], Some(outliers));
            for [near, far] in drawn.into_iter().flatten() {
                let [near, far] = [near, far].map(f32::from_bits);
                assert!(
                    ends[1] <= far && far <= near && near <= ends[0],
                    "{main:?} in {window:?}: {near} to {far}"
                );
            }
        }
    }
}

/// An orthographic view from 0 to 1e5 units, 10 units high.
fn orthographic() -> Projection {
    Projection::Orthographic(OrthographicProjection {
        near: 0.0,
        far: 1e5,
        scaling_mode: ScalingMode::FixedVertical {
            viewport_height: 10.0,
        },
        ..OrthographicProjection::default_3d()
    })
}

/// A wall across a view at a distance of 20 and 24 units, and a speck close to the camera.
/// `speck`: half of its size, which is 0.4 % of the picture.
fn walls(projection: Projection, speck: f32) -> Small {
    let mut small = Small::new(UVec2::new(160, 100), Msaa::Off);
    small.clear();
    wall(&mut small, [-8.0, -10.0], [0.0, 10.0], 20.0);
    wall(&mut small, [0.0, -10.0], [8.0, 10.0], 24.0);
    wall(&mut small, [-speck; 2], [speck; 2], 2.0);
    small.insert((
        projection,
        Transform::IDENTITY,
        DepthHistogram::default(),
        VisibleDepthRange::default(),
    ));
    small
}

fn histogram(small: &Small) -> &DepthHistogram {
    let world = small.headless.app.world();
    let histogram = world.get::<DepthHistogram>(small.camera);
    histogram.expect("asked for")
}

/// Fails unless the drawn range is that of the walls, seen from so much farther away, within a bin.
fn assert_drawn_with_the_walls(small: &Small, away: f32, bin: impl Fn(f32) -> f32) {
    let (near, far) = histogram(small).drawn.expect("a range");
    for (found, distance) in [(near, 20.0 + away), (far, 24.0 + away)] {
        assert!(
            (found - distance).abs() < bin(distance),
            "{near} to {far}, {away} away"
        );
    }
}

#[test]
fn a_speck_does_not_stretch_a_range() {
    // A step of raw depth is 0.006 units, a bin 0.8 % of the 22 units between the speck
    // and the farther wall.
    assert_speck_is_left_out(walls(orthographic(), 0.4), 1000.0, |_| 0.2);
    // As high as the other view 20 units away; a bin is an eighth of an octave of the depth.
    let projection = PerspectiveProjection {
        fov: 2.0 * 0.25f32.atan(),
        ..default()
    };
    let small = walls(Projection::Perspective(projection), 0.04);
    assert_speck_is_left_out(small, 20.0, |distance| distance / 8.0);
}

fn assert_speck_is_left_out(mut small: Small, away: f32, bin: impl Fn(f32) -> f32) {
    let map = |smoothing| DepthMap {
        smoothing: Some(RangeSmoothing {
            outliers: 0.02,
            ..smoothing
        }),
        ..default()
    };
    let style = ComicStyle::default().with(Colorization::default());
    small.style(&with_map(style, map(RangeSmoothing::OFF)));
    small.settle();
    assert_drawn_with_the_walls(&small, 0.0, &bin);

    // With slow smoothing a new view starts with its percentiles, not with its extremes.
    let slow = RangeSmoothing {
        expand: 60.0,
        shrink: 60.0,
        ..RangeSmoothing::OFF
    };
    small.insert((map(slow), Transform::from_xyz(0.0, 0.0, away)));
    small.cut();
    small.settle();
    assert_drawn_with_the_walls(&small, away, &bin);
}

#[test]
fn the_histogram_of_an_orthographic_view_tells_its_depths() {
    let mut small = walls(orthographic(), 0.4);
    small.settle();
    let range = small.range().and_then(VisibleDepthRange::distances);
    let (near, far) = range.expect("geometry");
    let bins = &histogram(&small).bins;
    let all: u32 = bins.iter().map(|bin| bin.count).sum();
    assert_eq!(all, 160 * 100);
    assert_eq!([bins[0].near, bins[bins.len() - 1].far], [near, far]);
    assert!(bins.windows(2).all(|pair| pair[0].far == pair[1].near));
    // What is counted is where the geometry is, within a bin.
    for bin in bins.iter().filter(|bin| bin.count > 0) {
        assert!(bin.far - bin.near <= (far - near) / 128.0 + 0.01, "{bin:?}");
        let there = [2.0, 20.0, 24.0]
            .iter()
            .any(|d| bin.near - 0.01 <= *d && *d <= bin.far + 0.01);
        assert!(there, "{bin:?}");
    }
    let speck = bins.iter().filter(|bin| bin.near < 2.5 && 1.5 < bin.far);
    let speck: u32 = speck.map(|bin| bin.count).sum();
    assert_eq!(speck, 8 * 8, "at ten pixels per unit");
}
