//! What the walk down four columns of the grid finds at the borders of pixels.

use bevy_comics_testkit::reference::{
    hidden::{HIDDEN, in_front},
    normal,
    rows::{Border, across, border},
};

use super::{
    bound::{floats, pairs, texture},
    toon::Numbers,
    *,
};
use crate::prelude::*;

/// Grids in one picture: x, y, width and height. They are narrower than a block of four columns, as
/// wide, and wider; around them are other pixels.
pub const GRIDS: [[u32; 4]; 7] = [
    [2, 1, 1, 1],
    [5, 3, 2, 3],
    [9, 0, 4, 4],
    [1, 9, 5, 9],
    [11, 8, 13, 7],
    [0, 20, 24, 20],
    [3, 42, 6, 1],
];

/// Depths, normals and objects of a picture.
pub struct Picture {
    pub depths: Vec<f32>,
    /// Texels of the prepass.
    pub normals: Vec<[f32; 4]>,
    /// Ids; and marks, which are a slot and a section.
    pub objects: Vec<[u32; 2]>,
}

/// No two pairs of them are at the same angle, and one pair is at 60.03 degrees. The last one is too
/// short to be a normal.
const NORMALS: [[f32; 3]; 7] = [
    [0.1, 0.2, 0.9],
    [0.65, -0.1, 0.7],
    [-0.3, 0.85, 0.35],
    [-0.5, -0.55, 0.6],
    [0.2, 0.1, -0.95],
    [0.4, 0.35, 0.5],
    [0.1, -0.1, 0.15],
];

/// The texel of the sky.
const CLEARED: [f32; 4] = [1.0; 4];

fn pick<T: Copy>(n: &mut Numbers, of: &[T]) -> T {
    of[((n.part() * of.len() as f32) as usize).min(of.len() - 1)]
}

impl Picture {
    pub const SIZE: [u32; 2] = [26, 44];

    /// Fields of 8 x 8 pixels are planes with steps, or steps alone. All depths and their
    /// differences are exact in single precision.
    pub fn new(n: &mut Numbers) -> Self {
        let [width, height] = Self::SIZE;
        let mut picture = Self {
            depths: vec![],
            normals: vec![],
            objects: vec![],
        };
        let mut facing = NORMALS[0];
        for [x, y] in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
            let plane = 16 + 3 * x + y + pick(n, &[0u32, 0, 0, 0, 1, 20]);
            let level = 32 * pick(n, &[0u32, 1, 2, 3, 4, 5, 6, 7, 8]);
            let is_plane = (x / 8 + y / 8) % 2 == 0;
            let depth = if is_plane { plane } else { level };
            let depth = if n.once_in(12) { 0 } else { depth };
            if n.once_in(2) {
                facing = pick(n, &NORMALS);
            }
            let [a, b, c] = facing.map(|c| 0.5 * c + 0.5);
            let texel = if depth == 0 { CLEARED } else { [a, b, c, 1.0] };
            let marks = pick(n, &[0u32, 1, 0x0102, 0x0203, 0xc801, 0xff00]);
            picture.depths.push(depth as f32 / 256.0);
            picture.normals.push(texel);
            picture
                .objects
                .push([pick(n, &[0u32, 1, 1, 2, 70_000]), marks]);
        }
        picture
    }

    /// The border between a pixel of a grid and a neighbour. `shown`: depths of the picture that
    /// hides marked objects.
    fn border(
        &self,
        grid: [u32; 4],
        pixel: [i64; 2],
        side: usize,
        shown: Option<&[f32]>,
    ) -> Border {
        let [left, top, width, height] = grid.map(i64::from);
        let row = i64::from(Self::SIZE[0]);
        let at = across([width, height], pixel, side)
            .map(|[x, y]| ((top + y) * row + left + x) as usize);
        let facing = |i: usize| {
            let [x, y, z, _] = self.normals[i].map(f64::from);
            normal::decode([x, y, z])
        };
        let depth = |i: usize| f64::from(self.depths[i]);
        let object = |i: usize| {
            let [id, marks] = self.objects[i];
            let is_hidden = shown.is_some_and(|shown| {
                in_front(shown[i].into(), depth(i), JUMP.into(), [1.0, 0.0]) > 0.0
            });
            [id, if is_hidden { marks | HIDDEN } else { marks }]
        };
        border(at.map(depth), at.map(facing), at.map(object))
    }
}

/// The jump that separates two surfaces, as a fraction of the depth.
const JUMP: f32 = 0.5;

/// Numbers of a border, and of both with the depths before them.
const OF_A_BORDER: u32 = 11;
const NUMBERS: u32 = 1 + 2 * OF_A_BORDER;

/// Walks down to a row. Which of the numbers is returned: i(2); the grid: from i(3) on.
const WALK: &str = "#import bevy_comics::lines::pass::line_pass
    #import bevy_comics::lines::rows::{Above, Borders, Found, four_columns, step_down}
    fn number(b: Borders, n: u32) -> vec4<f32> {
        switch n {
            case 0u: { return b.here; }
            case 1u: { return b.there; }
            case 2u: { return b.excess; }
            case 3u: { return vec4<f32>(b.outdone); }
            case 4u: { return b.folds; }
            case 5u: { return vec4<f32>(b.ridge); }
            case 6u: { return vec4<f32>(b.rim); }
            case 7u: { return vec4<f32>(b.object_here); }
            case 8u: { return vec4<f32>(b.object_there); }
            case 9u: { return vec4<f32>(b.marks_here); }
            default: { return vec4<f32>(b.marks_there); }
        }
    }";

fn body() -> String {
    format!(
        "line_pass.settings.jump = {JUMP:?};
         line_pass.settings.reference_factor = 1.0;
         let grid = vec4(i32(i(3u)), i32(i(4u)), i32(i(5u)), i32(i(6u)));
         let columns = four_columns(grid, i32(i(0u)));
         var above: Above;
         var found: Found;
         for (var k = -5; k <= 0; k++) {{
             found = step_down(&above, columns, i32(i(1u)) + k);
         }}
         let n = u(2u);
         if n == 0u {{ return found.before; }}
         if n > {OF_A_BORDER}u {{ return number(found.south, n - 1u - {OF_A_BORDER}u); }}
         return number(found.east, n - 1u);"
    )
}

/// Every block of four columns down to three rows below its grid, and every number.
fn rows() -> Vec<[f32; 7]> {
    let mut rows = vec![];
    for [left, top, width, height] in GRIDS {
        for (x, y) in (0..width)
            .step_by(4)
            .flat_map(|x| (0..height + 3).map(move |y| (x, y)))
        {
            let row = |number| [x, y, number, left, top, width, height].map(|k| k as f32);
            rows.extend((0..NUMBERS).map(row));
        }
    }
    rows
}

fn number(b: &Border, n: u32) -> f64 {
    let [here, there] = b.objects;
    match n {
        0 => b.depths[1],
        1 => b.depths[2],
        2 => b.excess,
        3 => f64::from(u8::from(b.outdone)),
        4 => b.fold.unwrap_or(-1.0),
        5 => f64::from(u8::from(b.ridge)),
        6 => f64::from(u8::from(b.rim)),
        7 => here[0].into(),
        8 => there[0].into(),
        9 => here[1].into(),
        _ => there[1].into(),
    }
}

/// The definition without which a number is 0.
fn needed(n: u32) -> Option<&'static str> {
    match n {
        2 | 3 => Some("EXCESS"),
        4..=6 => Some("NORMALS"),
        7.. => Some("OBJECT_IDS"),
        _ => None,
    }
}

/// Compares all numbers at all borders. Returns how many of each are above 0.
fn assert_matches_the_reference(
    n: &mut Numbers,
    definitions: &[&str],
) -> [u32; OF_A_BORDER as usize] {
    let picture = Picture::new(n);
    let size = Picture::SIZE;
    let has = |name: &str| definitions.contains(&name);
    // The picture shows nothing, or what is in front of everything.
    let shown: Vec<f32> = (picture.depths.iter())
        .map(|_| f32::from(u8::from(n.once_in(2))))
        .collect();
    let [depths, shown_depths] = [&picture.depths, &shown].map(|texels| floats(size, texels));
    let normals = gpu().texture(size, &picture.normals);
    let objects = pairs(size, &picture.objects);
    let mut entries = vec![texture(2, &depths)];
    let others = [
        ("NORMALS", 7, &normals),
        ("OBJECT_IDS", 8, &objects),
        ("MARKS", 27, &shown_depths),
    ];
    for (_, binding, view) in others.into_iter().filter(|&(name, ..)| has(name)) {
        entries.push(texture(binding, view));
    }
    let with: Vec<Definition> = definitions.iter().map(|name| (*name, None)).collect();
    let rows = rows();
    let results = gpu().evaluate_bound(&with, &entries, WALK, &body(), &rows);
    let shown = has("MARKS").then_some(&shown[..]);
    let mut positive = [0; OF_A_BORDER as usize];
    for (row, found) in rows.iter().zip(results) {
        let [x, y, n, left, top, width, height] = row.map(|k| k as u32);
        // The depth before the pixel, or one of the numbers to the east or south.
        let (side, n) = match n.checked_sub(1) {
            None => (0, None),
            Some(n) => (n / OF_A_BORDER, Some(n % OF_A_BORDER)),
        };
        // Not asked for by the bounds.
        if has("BOUNDS") && matches!(n, Some(3 | 5 | 6)) {
            continue;
        }
        for (lane, found) in (0i64..).zip(found) {
            let up = if side == 1 { 3 } else { 0 };
            let pixel = [i64::from(x) + lane, i64::from(y) - up];
            let grid = [left, top, width, height];
            let at = picture.border(grid, pixel, side as usize, shown);
            let want = n.map_or(at.depths[0], |n| {
                let is_known = needed(n).is_none_or(has);
                if is_known { number(&at, n) } else { 0.0 }
            });
            // Normals have rounding errors.
            let slack = if n == Some(4) { 1e-5 } else { 0.0 };
            let off = (f64::from(found) - want).abs();
            assert!(
                off <= slack,
                "{definitions:?}, {row:?}, {lane}: {found}, not {want}"
            );
            if let Some(n) = n {
                positive[n as usize] += u32::from(found > 0.0);
            }
        }
    }
    positive
}

/// At and outside of the borders of the grid, too.
#[test]
fn borders_of_pixels_match_the_reference() {
    let mut n = Numbers::new(71);
    let all = &["DEPTH", "EXCESS", "NORMALS", "OBJECT_IDS"];
    let positive = assert_matches_the_reference(&mut n, all);
    assert!(positive.iter().all(|count| *count > 20), "{positive:?}");
    let others: [&[&str]; 6] = [
        &["DEPTH"],
        &["DEPTH", "EXCESS"],
        &["DEPTH", "NORMALS"],
        &["DEPTH", "OBJECT_IDS"],
        &["DEPTH", "OBJECT_IDS", "MARKS"],
        &["DEPTH", "EXCESS", "NORMALS", "OBJECT_IDS", "BOUNDS"],
    ];
    for definitions in others {
        assert_matches_the_reference(&mut n, definitions);
    }
}

/// Four columns and their neighbours: two to the west, and three to the east.
#[test]
fn columns_of_a_block_are_inside_of_the_grid() {
    let body = "let grid = vec4(i32(i(1u)), i32(i(2u)), i32(i(3u)), i32(i(4u)));
        let c = four_columns(grid, i32(i(0u)));
        if i(5u) == 0.0 { return vec4<f32>(vec4(c.west, c.east.xy)); }
        if i(5u) == 1.0 { return vec4<f32>(c.own); }
        return vec4<f32>(vec4(c.east.z, c.last, c.origin.x + 1000 * c.origin.y));";
    let import = "#import bevy_comics::lines::rows::four_columns";
    let mut rows = vec![];
    for width in (1..14).chain([4095, 4096, 4097, 16_384]) {
        let last_block = (width - 1) / 4;
        for block in (0..4).chain([last_block - 1, last_block]) {
            if (0..=last_block).contains(&block) {
                let row = |which| [4 * block, 5, 9, width, 77, which].map(|k| k as f32);
                rows.extend([0, 1, 2].map(row));
            }
        }
    }
    for (row, found) in rows.iter().zip(gpu().evaluate(import, body, &rows)) {
        let [x, _, _, width, height, which] = *row;
        let at = |step: f32| (x + step).clamp(0.0, width - 1.0);
        let want = match which as u32 {
            0 => [at(-2.0), at(-1.0), at(4.0), at(5.0)],
            1 => [at(0.0), at(1.0), at(2.0), at(3.0)],
            _ => [at(6.0), width - 1.0, height - 1.0, 9005.0],
        };
        assert_eq!(found, want, "{row:?}");
    }
}
