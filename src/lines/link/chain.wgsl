#define_import_path bevy_comics::lines::chain

// Follows a line from crack to crack.
//
// A crack is the pixel that has it (x, y) and its side (z): 0 to the east, 1 to the south. A
// corner is a point where four pixels meet: (x, y) is the top left corner of the pixel
// (x, y).

#import bevy_comics::lines::bend::diagonal_bend
#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::read_planes::cracks_at

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

// The unit vectors along a crack and across it, and its center.
fn along_crack(crack: vec3<i32>) -> vec2<f32> {
    return select(vec2(0.0, 1.0), vec2(1.0, 0.0), crack.z == 1);
}

fn crack_center(crack: vec3<i32>) -> vec2<f32> {
    return 0.5 * vec2<f32>(first_corner(crack) + last_corner(crack));
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
    // The sum of their centers, and the center of the last.
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
    let last = crack_center(three);
    return Three(crack_center(one) + crack_center(two) + last, last, three.z >= 0);
}

// Where a line leaves a crack, from the mean of the centers of seven cracks in a row and
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
    let away = (back.sum + on.sum - 6.0 * crack_center(crack)) / 7.0;
    let slope = rise / run;
    let offset = dot(away, across) - slope * dot(away, along);
    return select(otherwise, vec2(offset, slope), abs(offset) <= 0.49);
}

// Cracks of a diagonal run that is followed. A line along a shorter one says less than the mean of
// seven, and all cracks of a longer one have to agree that it is.
const SHORTEST_DIAGONAL: i32 = 7;
const LONGEST_DIAGONAL: i32 = 31;

// A diagonal run of cracks to the east and to the south in turns, seen from one of them in one
// direction.
struct Stairs {
    // Cracks, the first one included.
    count: i32,
    // Whether the line goes on with two cracks of a kind, so that the next run is beside this one.
    doubled: bool,
    // 1 if the diagonal goes to the south-east, -1 to the north-east; 0 for a single crack.
    sense: i32,
}

// `way`: 1 for the direction of the last corner of the crack, -1 for that of the first; `most`:
// cracks that are looked at.
fn stairs(g: Grid, crack: vec3<i32>, corner: vec2<i32>, way: i32, most: i32) -> Stairs {
    let along = vec2<i32>(along_crack(crack));
    var here = crack;
    var at = corner;
    var sense = 0;
    for (var count = 1; count <= most; count++) {
        let next = next_crack(g, here, at);
        if next.z < 0 {
            return Stairs(count, false, sense);
        }
        let behind = other_corner(next, at);
        let step = way * (behind - at);
        let ahead = step.x * along.x + step.y * along.y;
        let aside = step.x * along.y + step.y * along.x;
        sense = select(sense, aside, count == 1 && next.z != here.z);
        let onward = ahead == 1 || aside * sense == 1;
        if next.z == here.z || !onward {
            return Stairs(count, onward, sense);
        }
        here = next;
        at = behind;
    }
    return Stairs(most + 1, false, sense);
}

// On which side of a diagonal run the next one begins. `way`: 1 for the end behind the crack, -1
// for that before it.
fn stairs_side(end: Stairs, sense: i32, way: i32) -> i32 {
    // The first and the last crack are of one kind if their number is odd.
    return select(way, -way, (end.count & 1) == 1) * sense;
}

// Where a line leaves a crack of short runs: see line_bend in bend.wgsl. By its diagonal run if the
// next runs are on different sides of it, otherwise by the mean of seven cracks; `otherwise` if
// there are none.
fn stairs_bend(g: Grid, crack: vec3<i32>, otherwise: vec2<f32>) -> vec2<f32> {
    let on = stairs(g, crack, last_corner(crack), 1, LONGEST_DIAGONAL);
    if !on.doubled {
        return mean_bend(g, crack, otherwise);
    }
    let back = stairs(g, crack, first_corner(crack), -1, LONGEST_DIAGONAL + 1 - on.count);
    let sense = select(on.sense, back.sense, on.sense == 0);
    let side = stairs_side(on, sense, 1);
    let crosses = stairs_side(back, sense, -1) * side == -1 && back.sense * on.sense >= 0;
    let count = back.count + on.count - 1;
    if !back.doubled || !crosses || count < SHORTEST_DIAGONAL {
        return mean_bend(g, crack, otherwise);
    }
    return diagonal_bend(vec2<u32>(vec2(back.count, on.count)), f32(sense), f32(side));
}
