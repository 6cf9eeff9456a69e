//! Detail by the visible range against its definition in distances.

use bevy_comics_testkit::{device::gpu, reference::detail};
use proptest::prelude::{Strategy, any};

use super::for_batches;

const IMPORT: &str = "#import bevy_comics::toon::visible::{ViewRange, detail_in_range}";
/// Both ends of the range, offset, floor, far plane, extent, flags, unit; depth and distance.
const BODY: &str =
    "let r = ViewRange(vec4(i(0u), i(1u), i(2u), i(3u)), vec4(i(4u), i(5u), i(6u), i(7u)));
     return vec4(detail_in_range(r, i(8u), i(9u)));";

#[derive(Clone, Copy, Debug)]
enum Lens {
    Infinite,
    Finite,
    Orthographic,
    Oblique,
}

const LENSES: [Lens; 4] = [
    Lens::Infinite,
    Lens::Finite,
    Lens::Orthographic,
    Lens::Oblique,
];

/// A view from 0.1 to 1000 units, in this unit, with a range, and a distance.
fn row(lens: Lens, unit: f64, [near, far, z]: [f64; 3]) -> [f32; 10] {
    let (low, high) = (0.1 * unit, 1000.0 * unit);
    let offset = low / (high - low);
    let raw = |z: f64| match lens {
        Lens::Infinite => low / z,
        Lens::Finite => low * (1.0 + offset) / z - offset,
        Lens::Orthographic => (high - z) / (high - low),
        // The shader has a unit of its own, see `raw.wgsl`.
        Lens::Oblique => 1.0 / (16384.0 * z),
    };
    let [near, far, depth] = [near, far, z].map(raw);
    let (mut scale, mut flags) = ([0.0; 2], 2.0);
    if matches!(lens, Lens::Orthographic) {
        (scale, flags) = ([high, high - low], 3.0);
    }
    let shift = if matches!(lens, Lens::Finite) {
        offset
    } else {
        0.0
    };
    let (own, depth) = match lens {
        // The depth of the pixel means nothing there.
        Lens::Oblique => (1.0 / 16384.0, 0.123),
        _ => (0.0, depth),
    };
    [
        near, far, shift, 1e-6, scale[0], scale[1], flags, own, depth, z,
    ]
    .map(|x| x as f32)
}

/// Truth: in all projections, and worlds of every size.
#[test]
fn detail_is_the_logarithm_of_the_distance() {
    let rows = (1.0f64..20.0, 1.3f64..10.0, -0.2f64..1.2, any::<bool>());
    for lens in LENSES {
        for_batches(
            rows.clone().prop_map(move |(near, ratio, at, large)| {
                let unit = if large { 1000.0 } else { 1.0 };
                let z = near * ratio.powf(at);
                let all = [near, near * ratio, z].map(|z| z * unit);
                row(lens, unit, all)
            }),
            |rows| {
                for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, BODY, rows)) {
                    let unit = if row[9] > 800.0 { 1000.0 } else { 1.0 };
                    let z = |raw: f32| distance(lens, unit, raw);
                    let depth = if matches!(lens, Lens::Oblique) {
                        f64::from(row[9])
                    } else {
                        z(row[8])
                    };
                    let reference = detail::in_range(depth, z(row[0]), z(row[1]));
                    // An orthographic depth is a distance within 2^-24 of 1000 units, as a fraction of
                    // one unit or more, for a logarithm of at least ln(1.3): 6e-5 / 0.26, at two ends.
                    let wrong = (f64::from(found[0]) - reference).abs();
                    assert!(
                        wrong < 5e-4,
                        "{lens:?}, {row:?}: {} is not {reference}",
                        found[0]
                    );
                }
            },
        );
    }
}

/// The distance of a raw depth.
fn distance(lens: Lens, unit: f64, raw: f32) -> f64 {
    let (low, high, raw) = (0.1 * unit, 1000.0 * unit, f64::from(raw));
    let offset = f64::from((low / (high - low)) as f32);
    match lens {
        Lens::Infinite => low / raw,
        Lens::Finite => low * (1.0 + offset) / (raw + offset),
        Lens::Orthographic => high - raw * (high - low),
        Lens::Oblique => 1.0 / (16384.0 * raw),
    }
}

/// The ends are 1 and 0 exactly, more distance is never more detail, and without a range there is all.
#[test]
fn detail_begins_and_ends_exactly() {
    for lens in LENSES {
        for unit in [1.0, 1000.0] {
            let (near, far): (f64, f64) = (3.0 * unit, 47.0 * unit);
            let at = |step: i32| near * (far / near).powf(f64::from(step) / 64.0);
            let rows: Vec<_> = (-8..=72)
                .map(|k| row(lens, unit, [near, far, at(k)]))
                .collect();
            let found: Vec<f32> = (gpu().evaluate(IMPORT, BODY, &rows).iter())
                .map(|v| v[0])
                .collect();
            assert_eq!((found[0], found[8]), (1.0, 1.0), "{lens:?}");
            assert_eq!((found[72], found[80]), (0.0, 0.0), "{lens:?}");
            assert!(found.is_sorted_by(|a, b| a >= b), "{lens:?}: {found:?}");
            assert!(
                found[40] > 0.45 && found[40] < 0.55,
                "{lens:?}: {}",
                found[40]
            );
        }
    }
    let none = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.01, 10.0];
    assert_eq!(gpu().evaluate(IMPORT, BODY, &[none])[0][0], 1.0);
}
