//! Gaps in lines that are closed.

use bevy_comics_testkit::reference::{
    crack::Crack,
    gaps::{gaps, source},
    link::Place,
};

use super::*;
use crate::prelude::*;

const GAPS: &str = "#import bevy_comics::lines::gaps::{gaps_between, source_step}";

/// Bits as cracks of a column, to the east of pixels.
fn column(bits: u32) -> HashSet<Place> {
    let rows = (0..32).filter(|row| bits >> row & 1 == 1);
    rows.map(|row| ([0, row], 0)).collect()
}

/// Random columns: those of the reference, and by counting, every gap that is short enough is
/// closed and no other one.
#[test]
fn gaps_are_closed_up_to_their_length() {
    let row = (0u32..=0xffff, 0u32..=0xffff, 0u32..=3)
        .prop_map(|(high, low, longest)| [high, low, longest].map(|n| n as f32));
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            GAPS,
            "let b = (u(0u) << 16u) | u(1u);
             let closed = gaps_between(vec3(b << 1u, b << 2u, b << 3u), vec3(b >> 1u, b >> 2u, b >> 3u), i32(u(2u)));
             let all = b | closed;
             return vec4(f32(all >> 16u), f32(all & 0xffffu), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [high, low, longest] = row.map(|n| n as u32);
            let bits = high << 16 | low;
            let found = (found[0] as u32) << 16 | found[1] as u32;
            let want = gaps(&column(bits), longest);
            assert_eq!(column(found & !bits), want, "{bits:032b}, {longest}");
            // Truth: what is left of gaps, between the first crack and the last.
            let text = format!("{found:b}");
            let inside = text.trim_matches('0');
            let short = inside.split('1').map(str::len);
            assert!(
                short
                    .clone()
                    .all(|zeros| zeros == 0 || zeros > longest as usize),
                "{bits:032b}, {longest}: {found:032b}"
            );
            let before = format!("{bits:b}");
            let long = |text: &str| {
                let runs = text.trim_matches('0').split('1').map(str::len);
                runs.filter(|zeros| *zeros > longest as usize).count()
            };
            assert_eq!(long(&before), long(&text), "{bits:032b}, {longest}");
        }
    });
}

/// All 128 cases: a crack is like the nearest found one.
#[test]
fn a_crack_in_a_gap_is_like_the_nearest_one() {
    let rows: Vec<[f32; 1]> = (0..128).map(|bits| [bits as f32]).collect();
    let results = gpu().evaluate(
        GAPS,
        "return vec4(f32(source_step(u(0u))), 0.0, 0.0, 0.0);",
        &rows,
    );
    let crack = Crack {
        kinds: [true, false, false],
        mine: true,
        ink: 1.0,
        opacity: 1.0,
        half_width: 1.0,
        certain: true,
        ledge: false,
        bend: [0.0; 2],
        shifts: true,
    };
    for (bits, found) in (0u32..128).zip(results) {
        let cracks: HashMap<Place, Crack> = column(bits)
            .into_iter()
            .map(|place| (place, crack))
            .collect();
        let ([_, row], _) = source(&cracks, ([0, 3], 0));
        assert_eq!(found[0] as i64, row - 3, "{bits:07b}");
        // Truth: none is nearer.
        let away = (row - 3).abs();
        assert!(
            (1 - away..away).all(|n| bits >> (3 + n) & 1 == 0),
            "{bits:07b}"
        );
    }
}
