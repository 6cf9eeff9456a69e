//! The middle of a line and the pixel that owns it, packed into 32 bits.

use super::*;

/// Whatever way a line leaves its crack, the owner comes back exactly, and the middle within half
/// of a 512th of a pixel.
#[test]
fn middles_and_owners_come_back() {
    let row = (
        (0u32..2, 0u32..2, -33i32..=33),
        (-0.5f32..=0.5, -0.5f32..=0.5, -0.35f32..=0.35),
    )
        .prop_map(|((south, mine, row), (bend, shift, along))| {
            [south, mine, (row + 64) as u32, 0]
                .map(|n| n as f32)
                .into_iter()
                .chain([bend, shift, along])
                .collect::<Vec<f32>>()
                .try_into()
                .expect("seven numbers")
        });
    for_batches(row, |rows: &[[f32; 7]]| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::edge::{
                owner_step, pack_middle, unpack_middle, unpack_owner,
             }",
            "let south = u(0u) == 1u;
             let crack = u(1u) * 8u;
             let row = i32(u(2u)) - 64;
             let across = 0.5 + i(4u) + i(5u);
             let middle = select(vec2(across, i(6u)), vec2(i(6u), across), south)
                 + vec2(0.0, f32(row));
             let owner = owner_step(crack, south) + vec2(0, row);
             let packed = pack_middle(middle, owner, south);
             let away = abs(unpack_middle(packed) - middle);
             let wrong = any(unpack_owner(packed) != owner) || ((packed & 0x8000u) != 0u) != south;
             return vec4(max(away.x, away.y), f32(wrong), vec2<f32>(unpack_owner(packed)));",
            rows,
        );
        for (row, [away, wrong, x, y]) in rows.iter().zip(results) {
            let [south, mine, down, ..] = *row;
            let other = 1.0 - mine;
            assert_eq!(wrong, 0.0, "{row:?}");
            assert_eq!(
                [x, y],
                [(1.0 - south) * other, down - 64.0 + south * other],
                "{row:?}"
            );
            assert!(away <= 0.5 / 512.0 + 1e-5, "{row:?}: {away}");
        }
    });
}
