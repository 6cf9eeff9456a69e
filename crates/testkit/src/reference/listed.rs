//! Reference of `lines/tiles/listed.wgsl`: which cell of the list each invocation has.

/// Workgroups in a row of a dispatch, and invocations of a workgroup.
const GROUPS: u32 = 1024;
const GROUP: u32 = 32;

/// Every invocation of `rows` whole rows of workgroups, in the order in which they take cells from
/// the list: column and row of its workgroup, and its index there.
pub fn invocations(rows: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..rows)
        .flat_map(|y| (0..GROUPS).flat_map(move |x| (0..GROUP).map(move |place| [x, y, place])))
}

/// The first pixel of a cell of 4 x 8 pixels. `word`: its column, and its row in the upper half.
pub fn first_pixel(word: u32) -> [u32; 2] {
    [4 * (word % 65536), 8 * (word / 65536)]
}
