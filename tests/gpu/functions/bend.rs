//! How lines run straight through the steps of cracks.

use bevy_comics_testkit::reference::bend::{LONGEST, end_sign, line_bend, stored};

use super::*;

const BEND: &str =
    "#import bevy_comics::lines::bend::{end_sign, line_bend, pack_bend, unpack_bend}";

/// All sixteen neighbourhoods of an end, of single cracks and of runs.
#[test]
fn signs_of_ends_are_those_of_the_twin() {
    let rows: Vec<[f32; 2]> = (0..16)
        .flat_map(|bits| [0, 1].map(|single| [bits as f32, single as f32]))
        .collect();
    let results = gpu().evaluate(BEND, "return vec4(end_sign(u(0u), u(1u) == 1u));", &rows);
    for (row, found) in rows.iter().zip(results) {
        let bits = row[0] as u32;
        let sides = [0, 1, 2, 3].map(|i| bits >> i & 1 == 1);
        let want = end_sign(sides, row[1] == 1.0);
        assert_eq!(f64::from(found[0]), want, "{sides:?}, single: {}", row[1]);
    }
}

/// Every place in every run of up to 40 cracks with every pair of ends; packed and
/// unpacked, too.
#[test]
fn bends_are_those_of_the_twin() {
    let mut rows: Vec<[f32; 4]> = Vec::new();
    for length in 1..=40 {
        for place in 1..=length {
            let seen = [place, length + 1 - place].map(|n: usize| n.min(LONGEST) as f32);
            for a in [-1.0, 0.0, 1.0] {
                for b in [-1.0, 0.0, 1.0] {
                    rows.push([seen[0], seen[1], a, b]);
                }
            }
        }
    }
    let results = gpu().evaluate(
        BEND,
        "let bend = line_bend(vec2(u(0u), u(1u)), vec2(i(2u), i(3u)));
         return vec4(bend, unpack_bend(pack_bend(bend)));",
        &rows,
    );
    for (row, found) in rows.iter().zip(results) {
        let [before, after, a, b] = *row;
        let want = line_bend([before as usize, after as usize], [a, b].map(f64::from));
        let want_stored = stored(want);
        for i in 0..2 {
            assert!(
                (f64::from(found[i]) - want[i]).abs() < 1e-6,
                "{row:?}: {found:?}"
            );
            let apart = (f64::from(found[2 + i]) - want_stored[i]).abs();
            assert!(apart < 1e-6, "{row:?}: {found:?}");
        }
    }
}

/// Straight edges of every slope up to 1, as the cracks that pixels make of them: the middles
/// of the lines are near the edge, much nearer than the cracks.
#[test]
fn middles_of_lines_are_near_straight_edges() {
    use bevy_comics_testkit::reference::link::{Place, bend};
    use std::collections::HashSet;

    // Slope, and the largest root mean square of the distance in pixels that is allowed.
    let limits = [
        (0.04, 0.015),
        (0.1, 0.032),
        (0.2, 0.06),
        (0.3, 0.07),
        (0.5, 0.14),
        (0.7, 0.075),
        (0.9, 0.14),
    ];
    for (slope, most) in limits {
        let (mut sum, mut cracks_sum, mut count) = (0.0, 0.0, 0);
        for shift in 0..16 {
            let start = f64::from(shift) / 16.0 + 300.0;
            // A pixel is above the edge if its centre is.
            let above = |x: i64, y: i64| y as f64 + 0.5 < start + slope * (x as f64 + 0.5);
            let mut cracks: HashSet<Place> = HashSet::new();
            for x in -80..280 {
                for y in 200..600 {
                    if above(x, y) != above(x + 1, y) {
                        cracks.insert(([x, y], 0));
                    }
                    if above(x, y) != above(x, y + 1) {
                        cracks.insert(([x, y], 1));
                    }
                }
            }
            for place @ ([x, y], side) in cracks.iter().filter(|(p, _)| (0..200).contains(&p[0])) {
                let [offset, _] = bend(&cracks, *place);
                let across = 0.5 + offset;
                let middle = |across: f64| match side {
                    0 => [*x as f64 + 0.5 + across, *y as f64 + 0.5],
                    _ => [*x as f64 + 0.5, *y as f64 + 0.5 + across],
                };
                let distance = |[x, y]: [f64; 2]| (start + slope * x - y) / slope.hypot(1.0);
                sum += distance(middle(across)).powi(2);
                cracks_sum += distance(middle(0.5)).powi(2);
                count += 1;
            }
        }
        let root = |sum: f64| (sum / f64::from(count)).sqrt();
        println!(
            "slope {slope}: {:.3} px, cracks {:.3} px",
            root(sum),
            root(cracks_sum)
        );
        assert!(root(sum) <= most, "slope {slope}: {}", root(sum));
        assert!(root(sum) < root(cracks_sum), "slope {slope}");
    }
}
