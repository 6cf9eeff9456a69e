//! The middle of a line and the pixel that owns it, packed into 32 bits.

use super::*;

/// Whatever way a line leaves its crack, the owner comes back exactly, and the middle within half
/// of a 512th of a pixel.
#[test]
fn middles_and_owners_come_back() {
    let crack = (0u8..2, 0u8..2, -33i8..=33);
    let moved = (-0.5f32..=0.5, -0.5f32..=0.5, -0.35f32..=0.35);
    let row = (crack, moved).prop_map(|((south, mine, down), (bend, shift, along))| {
        let [south, mine] = [south, mine].map(f32::from);
        [south, mine, f32::from(down), bend, shift, along]
    });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::edge::{
                owner_step, pack_middle, unpack_middle, unpack_owner,
             }",
            "let south = u(0u) == 1u;
             let crack = u(1u) * 8u;
             let row = i32(i(2u));
             let across = 0.5 + i(3u) + i(4u);
             let middle = select(vec2(across, i(5u)), vec2(i(5u), across), south)
                 + vec2(0.0, f32(row));
             let owner = owner_step(crack, south) + vec2(0, row);
             let packed = pack_middle(middle, owner, south);
             let away = abs(unpack_middle(packed) - middle);
             let found_south = (packed & 0x8000u) != 0u;
             return vec4(max(away.x, away.y), f32(found_south), vec2<f32>(unpack_owner(packed)));",
            rows,
        );
        for (row, [away, found_south, x, y]) in rows.iter().zip(results) {
            let [south, mine, down, ..] = *row;
            let other = 1.0 - mine;
            assert_eq!(found_south, south, "{row:?}");
            let owner = [(1.0 - south) * other, down + south * other];
            assert_eq!([x, y], owner, "{row:?}");
            assert!(away <= 0.5 / 512.0 + 1e-5, "{row:?}: {away}");
        }
    });
}
