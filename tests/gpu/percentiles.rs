//! Percentiles of orthographic views: the bins against their reference, the percentiles
//! against sorted depths.

use bevy_comics_testkit::reference::histogram::Bins;

use crate::{
    prelude::*,
    range::{SHAPES, reduce_and_count},
    smoothing::{Outliers, SMOOTH, frame, run},
};

const ORTHOGRAPHIC: bevy_comics_testkit::reference::smoothing::Smoothing =
    bevy_comics_testkit::reference::smoothing::Smoothing {
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
        let valid = depths.iter().filter(|d| **d > 0.0).count() as u32;
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
                let below = |edge: f64| {
                    let inside = |d: &&f32| **d > 0.0 && f64::from(**d) < edge;
                    depths.iter().filter(inside).count() as u32
                };
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
            let depths = table(&mut random, main, wide, 0.006);
            let ends = extremes(&depths);
            let bins = Bins::Window(ends.map(f64::from));
            let (counts, total) = bins.count(depths.iter().copied());
            let mut sorted = depths.clone();
            sorted.sort_by(f32::total_cmp);
            for fraction in [0.005f32, 0.02, 0.1] {
                let outliers = Outliers {
                    fraction,
                    bins: &counts,
                    total,
                    window: ends,
                };
                let found = [frame(ends[0], ends[1], 0.0)];
                let got = run(&ORTHOGRAPHIC, &found, Some(outliers))[0]
                    .expect("geometry")
                    .map(f32::from_bits);
                let rank = (f64::from(fraction) * f64::from(total)) as usize;
                let exact = [sorted[sorted.len() - 1 - rank], sorted[rank]];
                let reference =
                    bins.percentiles(&counts, total, f64::from(fraction), ends.map(f64::from));
                let length = f64::from(ends[0]) - f64::from(ends[1]);
                for end in 0..2 {
                    let what = format!("{main:?}, {stretch} times, {fraction}, end {end}");
                    // Three units in the last place of a depth.
                    let rounding = 3.0 * 2f64.powi(-24) * f64::from(ends[0]);
                    assert!(
                        (f64::from(got[end]) - reference[end]).abs() <= rounding + 1e-6 * length,
                        "{what}: {} for {}",
                        got[end],
                        reference[end]
                    );
                    // A bin is 1/128 of the range or less.
                    let apart = (f64::from(got[end]) - f64::from(exact[end])).abs();
                    assert!(
                        apart <= length / 128.0 + rounding,
                        "{what}: {} is {} of the range from {}",
                        got[end],
                        apart / length,
                        exact[end]
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

/// A wall across an orthographic view from 0 to 1e5 units, at a distance of 20 and 24
/// units, and a speck of 0.4 % of the picture close to the camera.
fn walls() -> Small {
    let size = UVec2::new(160, 100);
    let mut small = Small::with(options(size), Msaa::Off);
    small.clear();
    for (x, width, distance) in [(-4.0, 8.0, 20.0), (4.0, 8.0, 24.0), (0.0, 0.8, 2.0)] {
        let height = if width < 1.0 { 0.8 } else { 20.0 };
        small.put(
            Rectangle::new(width, height),
            unlit(Color::WHITE),
            Transform::from_xyz(x, 0.0, -distance),
        );
    }
    small.insert((
        Projection::Orthographic(OrthographicProjection {
            near: 0.0,
            far: 1e5,
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 10.0,
            },
            ..OrthographicProjection::default_3d()
        }),
        Transform::IDENTITY,
        DepthHistogram::default(),
        VisibleDepthRange::default(),
    ));
    small
}

fn drawn(small: &Small) -> [f32; 2] {
    let world = small.headless.app.world();
    let histogram = world
        .get::<DepthHistogram>(small.camera)
        .expect("asked for");
    let (near, far) = histogram.drawn.expect("a range");
    [near, far]
}

#[test]
fn a_speck_does_not_stretch_an_orthographic_range() {
    let mut small = walls();
    let map = DepthMap {
        smoothing: Some(RangeSmoothing {
            outliers: 0.02,
            ..RangeSmoothing::OFF
        }),
        ..default()
    };
    let style = with_map(ComicStyle::default().with(Colorization::default()), map);
    small.style(&style);
    small.settle();
    // A step of raw depth is 0.006 units, a bin 0.8 % of the 22 units between the speck
    // and the farther wall.
    let [near, far] = drawn(&small);
    assert!(
        (near - 20.0).abs() < 0.2 && (far - 24.0).abs() < 0.2,
        "{near} to {far}"
    );

    // With slow smoothing a new view starts with its percentiles, not with its extremes.
    let slow = RangeSmoothing {
        outliers: 0.02,
        expand: 60.0,
        shrink: 60.0,
        ..RangeSmoothing::OFF
    };
    small.insert(DepthMap {
        smoothing: Some(slow),
        ..default()
    });
    small.insert(Transform::from_xyz(0.0, 0.0, 1000.0));
    let entity = small.camera;
    small.world().commands().trigger(CameraCut { entity });
    small.world().flush();
    small.settle();
    let [near, far] = drawn(&small);
    assert!(
        (near - 1020.0).abs() < 0.2 && (far - 1024.0).abs() < 0.2,
        "{near} to {far} after a cut"
    );
    assert_eq!(small.errors(), 0);
}

#[test]
fn the_histogram_of_an_orthographic_view_tells_its_depths() {
    let mut small = walls();
    small.settle();
    let world = small.headless.app.world();
    let histogram = world
        .get::<DepthHistogram>(small.camera)
        .expect("asked for");
    let all: u32 = histogram.bins.iter().map(|bin| bin.count).sum();
    assert_eq!(all, 160 * 100);
    let (near, far) = small
        .range()
        .and_then(VisibleDepthRange::distances)
        .expect("geometry");
    let bins = &histogram.bins;
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
    let at = |d: f32| -> u32 {
        let near = |bin: &&bevy_comics::depth::DepthBin| bin.near - 0.5 < d && d < bin.far + 0.5;
        bins.iter().filter(near).map(|bin| bin.count).sum()
    };
    assert_eq!(at(2.0), 8 * 8, "the speck, at ten pixels per unit");
}
