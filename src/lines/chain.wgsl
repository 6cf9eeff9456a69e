#define_import_path bevy_comics::lines::chain

// Follows a line from crack to crack.
//
// A crack is the pixel that has it (x, y) and its side (z): 0 to the east, 1 to the south. A
// corner is a point where four pixels meet: (x, y) is the top left corner of the pixel
// (x, y).

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::planes::{LINKED_EAST, LINKED_SOUTH}
#import bevy_comics::lines::read_planes::column_window

// In place of a crack's side: no line, or several lines, go on at a corner.
const END: i32 = -1;
const JUNCTION: i32 = -2;

// The corners that a crack ends at.
fn first_corner(crack: vec3<i32>) -> vec2<i32> {
    return crack.xy + select(vec2(1, 0), vec2(0, 1), crack.z == 1);
}

fn last_corner(crack: vec3<i32>) -> vec2<i32> {
    return crack.xy + 1;
}

// The unit vectors along a crack and across it, and its centre.
fn along_crack(crack: vec3<i32>) -> vec2<f32> {
    return select(vec2(0.0, 1.0), vec2(1.0, 0.0), crack.z == 1);
}

fn crack_centre(crack: vec3<i32>) -> vec2<f32> {
    return 0.5 * vec2<f32>(first_corner(crack) + last_corner(crack));
}

// Which of the four cracks at a corner are parts of lines: bit 0 and 1 above and below the
// corner, bit 2 and 3 to the left and right of it.
fn cracks_at(g: Grid, corner: vec2<i32>) -> u32 {
    let before = corner - 1;
    let rows = column_window(g, LINKED_EAST, before.x, before.y) & 3u;
    let left = column_window(g, LINKED_SOUTH, before.x, before.y) & 1u;
    let right = column_window(g, LINKED_SOUTH, corner.x, before.y) & 1u;
    return rows | (left << 2u) | (right << 3u);
}

// The number of a crack among those at one of its corners, and the crack of a number.
fn number_at(corner: vec2<i32>, crack: vec3<i32>) -> u32 {
    return select(select(0u, 1u, crack.y == corner.y), select(2u, 3u, crack.x == corner.x), crack.z == 1);
}

fn numbered_crack(corner: vec2<i32>, number: u32) -> vec3<i32> {
    let before = vec2(select(1, 0, number == 3u), select(1, 0, number == 1u));
    return vec3(corner - before, i32(number >> 1u));
}

// The crack in which a line goes on at the corner of a crack; END or JUNCTION as its side
// if there is none, or more than one.
fn next_crack(g: Grid, crack: vec3<i32>, corner: vec2<i32>) -> vec3<i32> {
    let others = cracks_at(g, corner) & ~(1u << number_at(corner, crack));
    let next = numbered_crack(corner, firstTrailingBit(others | 16u) & 3u);
    let count = countOneBits(others);
    return vec3(next.xy, select(select(JUNCTION, END, count == 0u), next.z, count == 1u));
}

// The other corner of a crack.
fn other_corner(crack: vec3<i32>, corner: vec2<i32>) -> vec2<i32> {
    return first_corner(crack) + last_corner(crack) - corner;
}

// Cracks from a crack to the end of its line in one direction, but at most `most`. Lines do
// not end at the border of the grid, nor where they meet others.
fn cracks_to_end(g: Grid, crack: vec3<i32>, corner: vec2<i32>, most: i32) -> i32 {
    var at = corner;
    var next = crack;
    for (var i = 0; i < most; i++) {
        next = next_crack(g, next, at);
        if next.z < 0 {
            let border = any(at <= vec2(0)) || any(at >= g.rect.zw);
            return select(most, i, next.z == END && !border);
        }
        at = other_corner(next, at);
    }
    return most;
}

// The three cracks that a line goes on in behind a corner of a crack.
struct Three {
    // The sum of their centres, and the centre of the last.
    sum: vec2<f32>,
    last: vec2<f32>,
    // Whether there are three.
    complete: bool,
}

fn next_three(g: Grid, crack: vec3<i32>, corner: vec2<i32>) -> Three {
    let one = next_crack(g, crack, corner);
    if one.z < 0 {
        return Three(vec2(0.0), vec2(0.0), false);
    }
    let behind = other_corner(one, corner);
    let two = next_crack(g, one, behind);
    if two.z < 0 {
        return Three(vec2(0.0), vec2(0.0), false);
    }
    let three = next_crack(g, two, other_corner(two, behind));
    let last = crack_centre(three);
    return Three(crack_centre(one) + crack_centre(two) + last, last, three.z >= 0);
}

// Where a line leaves a crack, from the mean of the centres of seven cracks in a row and
// the direction from the first to the last of them: x offset, y slope, see line_bend in
// bend.wgsl. `otherwise` if there are no seven, or if they run across the crack.
fn mean_bend(g: Grid, crack: vec3<i32>, otherwise: vec2<f32>) -> vec2<f32> {
    let back = next_three(g, crack, first_corner(crack));
    let on = next_three(g, crack, last_corner(crack));
    let along = along_crack(crack);
    let across = along.yx;
    let run = dot(on.last - back.last, along);
    let rise = dot(on.last - back.last, across);
    if !back.complete || !on.complete || abs(rise) >= 1.9 * abs(run) {
        return otherwise;
    }
    let away = (back.sum + on.sum - 6.0 * crack_centre(crack)) / 7.0;
    let slope = rise / run;
    let offset = dot(away, across) - slope * dot(away, along);
    return select(otherwise, vec2(offset, slope), abs(offset) <= 0.49);
}
