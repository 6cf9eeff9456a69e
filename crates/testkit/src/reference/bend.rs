//! Reference of `lines/link/bend.wgsl`: how a line runs straight through the steps of cracks.

/// Cracks of a run that are seen from one of them, itself included.
pub const LONGEST: usize = 32;

/// The direction in which the cracks go on at the end of a run. `sides`: whether there are
/// cracks across the run: two before the end's corner, two after it.
pub fn end_sign(sides: [bool; 4], single: bool) -> f64 {
    match (sides[1], sides[2]) {
        (true, false) if single || !sides[0] => -1.0,
        (false, true) if single || !sides[3] => 1.0,
        _ => 0.0,
    }
}

/// Offset and slope of the line along a crack. `seen`: cracks of the run up to this one and
/// from this one on; `signs`: see [`end_sign`].
pub fn line_bend(seen: [usize; 2], signs: [f64; 2]) -> [f64; 2] {
    let [before, after] = seen.map(|n| n as f64 - 0.5);
    let cut = seen.map(|n| n >= LONGEST);
    let [a, b] = [0, 1].map(|i| if cut[i] { 0.0 } else { 0.5 * signs[i] });
    let longest = LONGEST as f64;
    match cut {
        [true, true] => [0.0, 0.0],
        [true, false] => [b * (1.0 - after / longest), b / longest],
        [false, true] => [a * (1.0 - before / longest), -a / longest],
        [false, false] if a * b > 0.0 => {
            let half = 0.5 * (before + after);
            if before < after {
                [a * (1.0 - before / half), -a / half]
            } else if before > after {
                [b * (1.0 - after / half), b / half]
            } else {
                [0.0, 0.0]
            }
        }
        [false, false] => {
            let slope = (b - a) / (before + after);
            [a + slope * before, slope]
        }
    }
}

/// The same along a diagonal run, whose cracks and whose distance from the next runs are sqrt(1/2)
/// pixels. `sense`: 1 if the diagonal goes to the south-east, -1 to the north-east; `side`: on
/// which side of it the run behind the crack is, 1 or -1; that before it is on the other side.
pub fn diagonal_bend(seen: [usize; 2], sense: f64, side: f64) -> [f64; 2] {
    let [offset, slope] = line_bend(seen, [-side, side]);
    // The line through the place `offset` beside the diagonal, in the crack's frame.
    let half = 0.5f64.sqrt();
    let [along, beside] = [[half, sense * half], [-sense * half, half]];
    let direction = [0, 1].map(|i| along[i] + slope * beside[i]);
    let place = beside.map(|part| half * offset * part);
    let slope = direction[1] / direction[0];
    let offset = place[1] - slope * place[0];
    [offset.clamp(-0.49, 0.49), slope]
}

/// Offset and slope as they are stored.
pub fn stored([offset, slope]: [f64; 2]) -> [f64; 2] {
    [
        (offset * 256.0).round() / 256.0,
        (slope * 64.0).round() / 64.0,
    ]
}
