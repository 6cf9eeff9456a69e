#define_import_path bevy_comics::lines::bend

// How a line runs straight through the steps of cracks. Pure functions.
//
// Along a run of cracks in a row (or column), the line goes from the end of the run to its
// other end; where the next run is one row further, its end is half a pixel towards that row
// (morphological anti-aliasing, Reshetov 2009).

// Cracks of a run that are seen from one of them, itself included: a run that goes on is
// cut there.
const LONGEST: u32 = 32u;

// The direction in which the cracks go on at the end of a run: 1 or -1, or 0 if they do
// not, or in both directions. `sides`: bits of the cracks across the run that may touch its
// end: two before the end's corner, two after it. A step has one crack: with more, the end
// is a corner, unless the run itself is a `single` crack.
fn end_sign(sides: u32, single: bool) -> f32 {
    let before = (sides & 2u) != 0u && (single || (sides & 1u) == 0u);
    let after = (sides & 4u) != 0u && (single || (sides & 8u) == 0u);
    let both = (sides & 6u) == 6u;
    return select(f32(after) - f32(before), 0.0, both);
}

// Where the line along a crack leaves it: x, its offset from the crack's center across the
// crack, -0.5 to 0.5 pixels; y, its slope, -1 to 1. `seen`: cracks of the run up to this one
// and from this one on; `signs`: see end_sign.
fn line_bend(seen: vec2<u32>, signs: vec2<f32>) -> vec2<f32> {
    let t = vec2<f32>(seen) - 0.5;
    let cut = seen >= vec2(LONGEST);
    let ends = 0.5 * select(signs, vec2(0.0), cut);
    if any(cut) {
        // How long the run is, is unknown: the end that is seen, if any, bends the line as
        // far as it is seen.
        let way = 1.0 / f32(LONGEST);
        let bends = ends * (1.0 - t * way);
        return vec2(bends.x + bends.y, (ends.y - ends.x) * way);
    }
    let whole = t.x + t.y;
    if ends.x * ends.y > 0.0 {
        // Both ends on one side: an arc, which touches the cracks in the middle.
        let half_way = 0.5 * whole;
        let nearer = min(t.x, t.y);
        let slope = select(ends.y, -ends.x, t.x < t.y) / half_way;
        return vec2(ends.x * (1.0 - nearer / half_way), select(slope, 0.0, t.x == t.y));
    }
    let slope = (ends.y - ends.x) / whole;
    return vec2(ends.x + slope * t.x, slope);
}

// The same along a diagonal run, in which cracks to the east and to the south take turns, with the
// next runs on different sides of it. Its centers lie on a diagonal, sqrt(1/2) pixels apart, and the
// next runs are sqrt(1/2) pixels beside it: in these units, with the diagonal in place of the row,
// the line goes from end to end as along any run. `sense`: 1 if the diagonal goes to the
// south-east, -1 to the north-east; `side`: 1 or -1, as in end_sign, of the end behind the crack.
fn diagonal_bend(seen: vec2<u32>, sense: f32, side: f32) -> vec2<f32> {
    let t = vec2<f32>(seen) - 0.5;
    let slope = side / (t.x + t.y);
    let offset = 0.5 * (t.x - t.y) * slope;
    // Turned from the diagonal's frame into that of the crack.
    let bend = vec2(offset, sense + slope) / (1.0 - sense * slope);
    return vec2(clamp(bend.x, -0.49, 0.49), bend.y);
}

// Packs offset and slope into 16 bits, in steps that no line of fewer than 64 cracks has its
// middles halfway between.
fn pack_bend(bend: vec2<f32>) -> u32 {
    let bytes = vec2<u32>(round(bend * vec2(256.0, 64.0)) + 128.0);
    return bytes.x | (bytes.y << 8u);
}

// 0x8080 stands for none: the line runs along the crack.
fn unpack_bend(packed: u32) -> vec2<f32> {
    let bytes = vec2(packed & 255u, (packed >> 8u) & 255u);
    return (vec2<f32>(bytes) - 128.0) / vec2(256.0, 64.0);
}
