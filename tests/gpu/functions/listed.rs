//! The cells of the list, one for each invocation.

use bevy_comics_testkit::reference::listed::{first_pixel, invocations};

use super::{
    bound::{buffer, words},
    toon::Numbers,
    *,
};

const LISTED: &str = "#import bevy_comics::lines::listed::listed_cell";
const BODY: &str = "let cell = listed_cell(vec3(u(0u), u(1u), 0u), u(2u));
    return vec4(vec2<f32>(cell), 0.0, 0.0);";

/// Lists that end at the ends of workgroups and of rows of workgroups, or next to them. Behind the
/// end are cells of earlier frames, which no invocation has.
#[test]
fn every_invocation_has_its_cell_of_the_list() {
    let mut n = Numbers::new(7);
    let rows: Vec<[f32; 3]> = invocations(2)
        .map(|invocation| invocation.map(|k| k as f32))
        .collect();
    let list: Vec<u32> = (0..rows.len())
        .map(|_| {
            let [column, row] = [0, 0].map(|_| (65535.0 * n.part()) as u32);
            column | (row << 16)
        })
        .collect();
    let cells = words(&list);
    for count in [0u32, 1, 31, 32, 33, 32_767, 32_768, 32_769, 65_535, 65_536] {
        // Workgroups across and down, 1, and the number of cells.
        let groups = count.div_ceil(32);
        let counts = words(&[groups.min(1024), groups.div_ceil(1024), 1, count]);
        let entries = [buffer(16, &counts), buffer(17, &cells)];
        let results = gpu().evaluate_bound(&[], &entries, LISTED, BODY, &rows);
        for (index, (row, found)) in rows.iter().zip(results).enumerate() {
            if index >= count as usize {
                assert!(found[0] < 0.0, "{row:?} of {count}: {found:?}");
                continue;
            }
            let pixel = first_pixel(list[index]).map(|k| k as f32);
            assert_eq!([found[0], found[1]], pixel, "{row:?} of {count}");
        }
    }
}
