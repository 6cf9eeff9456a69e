//! Numbers and places of nested marks far from the origin.

use super::*;

/// An integer of so many bits, as two's complement has it.
fn wrapped(number: i128, bits: u32) -> i128 {
    number << (128 - bits) >> (128 - bits)
}

/// The number and the place are those of exact arithmetic, and a mark has one random number at every
/// level.
#[test]
fn places_far_away_are_exact() {
    // A coordinate of the eye in units of 2^-36, up to 2^39; an exponent, and the coordinate from the eye on
    // in units of the level.
    let row = (any::<i64>(), 0u32..24, -12i32..=16, -1000.0f32..1000.0);
    let row = row.prop_map(|(bits, shift, exponent, from_eye)| {
        (i128::from(bits >> 11) << shift, exponent, from_eye)
    });
    for_batches(row, |rows| {
        let inputs: Vec<[f32; 5]> = (rows.iter())
            .map(|(eye, exponent, from_eye)| {
                let whole = (eye >> 24) as i32;
                let halves = [whole >> 16, whole & 0xffff, (eye & 0xff_ffff) as i32];
                let [high, low, rest] = halves.map(|part| part as f32);
                [
                    high,
                    low,
                    rest,
                    from_eye * (*exponent as f32).exp2(),
                    *exponent as f32,
                ]
            })
            .collect();
        let results = gpu().evaluate_alone(
            &[("WORLD_ORIGIN", None)],
            "#import bevy_comics::effect::nested::{Level, mark_of, place_of_split}",
            "let exponent = i32(i(4u));
             let size = bitcast<f32>(u32(exponent + 127) << 23u);
             let eye = vec2((i32(i(0u)) << 16u) | i32(i(1u)), i32(i(2u)));
             let found = place_of_split(i(3u), eye, Level(exponent, size, 0.0));
             let n = found.number;
             let mark = mark_of(n, exponent, 7u);
             let is_same = exponent == -12 || (mark == mark_of(2 * n, exponent - 1, 7u)
                 && mark == mark_of(n + (1 << u32(20 - exponent)), exponent, 7u));
             return vec4(f32(n >> 16u), f32(n & 0xffff), found.at, f32(is_same));",
            &inputs,
        );
        for ((eye, exponent, from_eye), found) in rows.iter().zip(results) {
            let bits = (36 + exponent) as u32;
            let number = wrapped(eye >> bits, (20 - exponent) as u32);
            assert_eq!(found[0] as i128 * 65536 + found[1] as i128, number, "{eye}");
            let rest = (eye - (eye >> bits << bits)) as f64 / (1i128 << bits) as f64;
            // Two roundings of the sum, which is up to 1001.
            let off = f64::from(found[2]) - (rest + f64::from(*from_eye));
            assert!(off.abs() < 1.3e-4, "{eye}, {exponent}: {off}");
            assert_eq!(found[3], 1.0, "{eye}, {exponent}");
        }
    });
}
