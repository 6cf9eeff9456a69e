//! The cells of the list, one for each invocation.

use super::{
    bound::{buffer, words},
    toon::Numbers,
    *,
};

/// Lists that end at the ends of workgroups of 32 and of rows of 1024 workgroups, or next to them.
/// Behind the end are cells of earlier frames, which no invocation has.
#[test]
fn every_invocation_has_its_cell_of_the_list() {
    let mut n = Numbers::new(7);
    // Column and row of the workgroup, and the place there, in the order of the list.
    let rows: Vec<[f32; 3]> = (0..2 * 1024 * 32)
        .map(|index| [index / 32 % 1024, index / 32 / 1024, index % 32].map(|k| k as f32))
        .collect();
    let list: Vec<[u32; 2]> = (0..rows.len())
        .map(|_| [0, 0].map(|_| (65535.0 * n.part()) as u32))
        .collect();
    let packed: Vec<u32> = list.iter().map(|[x, y]| x | (y << 16)).collect();
    let cells = words(&packed);
    for count in [0u32, 1, 31, 32, 33, 32_767, 32_768, 32_769, 65_535, 65_536] {
        // Workgroups across and down, 1, and the number of cells.
        let groups = count.div_ceil(32);
        let counts = words(&[groups.min(1024), groups.div_ceil(1024), 1, count]);
        let results = gpu().evaluate_bound(
            &[],
            &[buffer(16, &counts), buffer(17, &cells)],
            "#import bevy_comics::lines::listed::listed_cell",
            "let cell = listed_cell(vec3(u(0u), u(1u), 0u), u(2u));
             return vec4(vec2<f32>(cell), 0.0, 0.0);",
            &rows,
        );
        for (index, found) in results.into_iter().enumerate() {
            if index >= count as usize {
                assert!(found[0] < 0.0, "{index} of {count}: {found:?}");
                continue;
            }
            // Cells are 4 pixels wide and 8 high.
            let first_pixel = [4 * list[index][0], 8 * list[index][1]].map(|k| k as f32);
            assert_eq!([found[0], found[1]], first_pixel, "{index} of {count}");
        }
    }
}
