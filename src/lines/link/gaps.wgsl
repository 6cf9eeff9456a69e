#define_import_path bevy_comics::lines::gaps

// Gaps of at most three cracks in runs of lines, see close_gaps.wgsl.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::planes::{FOUND_EAST, FOUND_SOUTH}
#import bevy_comics::lines::read_planes::{column_bit, column_window}

// The cracks that are missing in gaps of at most `longest` cracks. `before` and `after`: the
// cracks of lines one, two and three further back and on along the run.
fn gaps_between(before: vec3<u32>, after: vec3<u32>, longest: i32) -> u32 {
    let one = before.x & after.x;
    let two = (before.x & after.y) | (before.y & after.x);
    let three = (before.x & after.z) | (before.y & after.y) | (before.z & after.x);
    return select(0u, one, longest > 0) | select(0u, two, longest > 1) | select(0u, three, longest > 2);
}

// From a crack to the nearest found one along its run. `found`: bits 0 to 6 are the cracks from
// three before to three behind it. Of two at the same distance, the first; 0 if there is
// none.
fn source_step(found: u32) -> i32 {
    let back = 4 - i32(firstLeadingBit(((found & 7u) << 1u) | 1u));
    let on = i32(firstTrailingBit((found >> 4u) | 8u)) + 1;
    let step = select(on, -back, back <= on);
    return select(step, 0, (found & 0x77u) == 0u || (found & 8u) != 0u);
}

// The crack that a crack of a line is like: itself, or if it closes a gap, the nearest found
// one of its run.
fn source_of(g: Grid, crack: vec3<i32>) -> vec3<i32> {
    if crack.z == 0 {
        let found = column_window(g, FOUND_EAST, crack.x, crack.y - 3) & 0x7fu;
        return crack + vec3(0, source_step(found), 0);
    }
    var found = 0u;
    for (var i = 0; i < 7; i++) {
        found |= column_bit(g, FOUND_SOUTH, crack.x + i - 3, crack.y) << u32(i);
    }
    return crack + vec3(source_step(found), 0, 0);
}
