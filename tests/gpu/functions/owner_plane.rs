//! Near, middle and far, and the abstraction, at the pixels that own lines.

use bevy_comics_testkit::reference::map::Projection;
use bevy_comics_testkit::reference::owner_plane::{Creases, Placed, crease_left, depth, weights};

use super::{
    bound::{buffer, floats, pairs, texture, words},
    toon::Numbers,
    *,
};
use crate::prelude::*;

const SIZE: [u32; 2] = [23, 11];
/// Objects of the table, of which the last one stands for all ids behind it.
const OBJECTS: usize = 9;

/// A view whose nearest and farthest geometry are at these raw depths, and its objects.
struct Scene {
    ends: [f32; 2],
    depths: Vec<f32>,
    ids: Vec<[u32; 2]>,
    /// As the shader has them: D + 1, how much pixels follow it, and the dial; or 0.
    table: Vec<[f32; 4]>,
}

impl Scene {
    fn new(n: &mut Numbers) -> Self {
        let ends: [f32; 2] = [0.5, 0.02];
        let count = (SIZE[0] * SIZE[1]) as usize;
        let depth = |n: &mut Numbers| match (n.part() * 12.0) as u32 {
            0 => 0.0,
            1 => ends[0],
            2 => ends[1],
            3 => 1.0,
            4 => 0.01,
            _ => ends[0] * (ends[1] / ends[0]).powf(n.part()),
        };
        let object = |n: &mut Numbers| {
            let whole = [0.0, 1.0, n.part()][((n.part() * 3.0) as usize).min(2)];
            [
                1.0 + n.part(),
                whole,
                n.within(0.0, 2.0),
                n.within(-1.0, 1.0),
            ]
        };
        let mut table: Vec<[f32; 4]> = (0..OBJECTS).map(|_| object(n)).collect();
        // No object, and one that is not known yet.
        table[0] = [0.0; 4];
        table[3] = [0.0, 0.9, 1.7, 0.6];
        Self {
            ends,
            depths: (0..count).map(|_| depth(n)).collect(),
            ids: (0..count)
                .map(|_| [(12.0 * n.part()) as u32, (65535.0 * n.part()) as u32])
                .collect(),
            table,
        }
    }

    fn index(row: &[f32]) -> usize {
        (row[1] as u32 * SIZE[0] + row[0] as u32) as usize
    }

    /// D at a raw depth. `empty`: there is no geometry.
    fn map(&self, raw: f32, empty: bool) -> f64 {
        let frame = Frame {
            projection: Projection::Perspective { offset: 0.0 },
            ends: (!empty).then_some(self.ends.map(f64::from)),
            logarithmic: false,
            floor: 0.0,
            sky_gap: 0.0,
        };
        frame.depth_map(raw.into())[0]
    }

    /// The object at a pixel, if its place is known.
    fn object(&self, pixel: usize) -> Option<Placed> {
        let id = self.ids[pixel][0] as usize;
        let [d, whole, factor, added] = self.table[id.min(OBJECTS - 1)].map(f64::from);
        (d > 0.0).then_some(Placed {
            d: d - 1.0,
            whole,
            dial: [factor, added],
        })
    }

    fn evaluate<const N: usize>(
        &self,
        definitions: &[Definition],
        imports: &str,
        body: &str,
        rows: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        let depths = floats(SIZE, &self.depths);
        let ids = pairs(SIZE, &self.ids);
        let bits: Vec<u32> = (self.table.as_flattened().iter())
            .map(|x| x.to_bits())
            .collect();
        let table = words(&bits);
        let mut entries = vec![texture(2, &depths)];
        if has(definitions, "OBJECT_DEPTHS") {
            entries.extend([texture(8, &ids), buffer(32, &table)]);
        }
        let imports = format!(
            "#import bevy_comics::depth::map::DepthFrame
             #import bevy_comics::depth::view::view
             {imports}"
        );
        let [near, far] = self.ends;
        let body = format!(
            "view.depth = DepthFrame({near:?}, {far:?}, 0.0, 0.0, 0.0, 0.0, 0.0, 0u);
             let at = vec2(i32(i(0u)), i32(i(1u)));
             {body}"
        );
        gpu().evaluate_bound(definitions, &entries, &imports, &body, rows)
    }
}

fn has(definitions: &[Definition], name: &str) -> bool {
    definitions.iter().any(|(known, _)| *known == name)
}

/// Some rows for every pixel, of which the first two numbers are the pixel.
fn rows<const N: usize>(n: &mut Numbers, fill: impl Fn(&mut Numbers) -> [f32; N]) -> Vec<[f32; N]> {
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    pixels
        .flat_map(|pixel| [pixel; 8])
        .map(|[x, y]| {
            let mut row = fill(n);
            row[..2].copy_from_slice(&[x as f32, y as f32]);
            row
        })
        .collect()
}

/// 0, 1, or any number between.
fn part(n: &mut Numbers) -> f32 {
    [0.0, 1.0, n.part()][((n.part() * 3.0) as usize).min(2)]
}

/// Pixel; by objects; borders; softness; flip; raw depths of the borders that are found, or 0 if
/// none are; whether there is no geometry.
type PlaneRow = [f32; 10];

fn plane_row(n: &mut Numbers) -> PlaneRow {
    let [a, b] = [0; 2].map(|_| n.part());
    let [c, d] = [0; 2].map(|_| n.within(0.02, 0.5));
    let softness = if n.once_in(6) {
        0.0
    } else {
        n.within(0.02, 0.5)
    };
    let found = if n.once_in(3) { 0.0 } else { c.max(d) };
    let flip = f32::from(u8::from(n.once_in(2)));
    let empty = f32::from(u8::from(n.once_in(8)));
    let (near, far) = (a.min(b), a.max(b));
    let by_objects = part(n);
    [
        0.0,
        0.0,
        by_objects,
        near,
        far,
        softness,
        flip,
        found,
        c.min(d),
        empty,
    ]
}

/// Bits of the ends are those of `range.wgsl`.
const PLANES: &str = "var p: LineLayers;
    p.by_objects = i(2u);
    p.borders = vec2(i(3u), i(4u));
    p.softness = i(5u);
    view.flip = u(6u);";
const FOUND_BORDERS: &str = "range_keys.z = bitcast<u32>(i(7u));
    range_keys.w = bitcast<u32>(i(8u));";
const FOUND_RANGE: &str = "range_keys.x = select(bitcast<u32>(view.depth.near), 0u, i(9u) == 1.0);
    range_keys.y = 0u - bitcast<u32>(view.depth.far);
    view.depth.near = 0.9;
    view.depth.far = 0.8;";

/// Compares D and the fractions of planes of all rows.
fn assert_planes(n: &mut Numbers, definitions: &[Definition]) {
    let scene = Scene::new(n);
    let [borders, range, objects] =
        ["DEPTH_BORDERS", "VISIBLE_RANGE", "OBJECT_DEPTHS"].map(|name| has(definitions, name));
    let mut imports = "#import bevy_comics::lines::owner_plane::{owner_depth, owner_weights}
        #import bevy_comics::lines::layer_lines::LineLayers\n"
        .to_owned();
    let mut body = PLANES.to_owned();
    if borders || range {
        imports += "#import bevy_comics::depth::view::range_keys\n";
    }
    if borders {
        body += FOUND_BORDERS;
    }
    if range {
        body += FOUND_RANGE;
    }
    body += "return vec4(owner_weights(p, at), owner_depth(at, p.by_objects));";
    let rows = rows(n, plane_row);
    let results = scene.evaluate(definitions, &imports, &body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let pixel = Scene::index(row);
        let empty = range && row[9] == 1.0;
        let object = scene.object(pixel).filter(|_| objects);
        let own = scene.map(scene.depths[pixel], empty);
        let d = depth(own, object, row[2].into());
        let borders = if borders && row[7] != 0.0 {
            [row[7], row[8]].map(|raw| scene.map(raw, empty))
        } else {
            [row[3], row[4]].map(f64::from)
        };
        let softness = f64::from(row[5]);
        // Some roundings of a depth of the map, and of a border: by so much both may be moved.
        let error = 2e-6;
        let what = format!("{definitions:?}, {row:?}, {found:?}");
        assert!((f64::from(found[3]) - d).abs() < error, "{what}: {d}");
        if softness == 0.0 && borders.iter().any(|border| (d - border).abs() < 1e-5) {
            continue;
        }
        let want = weights(borders, softness, d, row[6] == 1.0);
        let slack = error
            + if softness > 0.0 {
                2.0 * 1.5 * error / softness
            } else {
                0.0
            };
        for (found, want) in found.into_iter().zip(want) {
            assert!((f64::from(found) - want).abs() < slack, "{what}: {want}");
        }
    }
}

/// With borders that are set or found, in a range that is set or found, and without geometry.
#[test]
fn planes_of_owners_match_the_reference() {
    let mut n = Numbers::new(61);
    let objects = ["OBJECT_DEPTHS", "OBJECT_IDS"];
    let views: [&[&str]; 4] = [
        &[],
        &["DEPTH_BORDERS"],
        &["VISIBLE_RANGE"],
        &["VISIBLE_RANGE", "DEPTH_BORDERS"],
    ];
    for view in views {
        for more in [&[][..], &objects] {
            let names = [&["DEPTH", "IN_LAYERS"][..], view, more].concat();
            let definitions: Vec<Definition> = names.iter().map(|name| (*name, None)).collect();
            assert_planes(&mut n, &definitions);
        }
    }
}

/// Pixel; by objects; abstraction at both ends, exponent, threshold, opacity, flip.
fn crease_row(n: &mut Numbers) -> [f32; 9] {
    let exponent = [1.0, n.within(0.25, 4.0)][usize::from(n.once_in(2))];
    let flip = f32::from(u8::from(n.once_in(2)));
    let [near, far] = [0; 2].map(|_| part(n));
    let [by_objects, left] = [0; 2].map(|_| part(n));
    let threshold = n.within(1.0, 8.0);
    [
        0.0, 0.0, by_objects, near, far, exponent, threshold, left, flip,
    ]
}

#[test]
fn creases_of_owners_match_the_reference() {
    let mut n = Numbers::new(62);
    let scene = Scene::new(&mut n);
    let imports = "#import bevy_comics::lines::abstraction::LineAbstraction
        #import bevy_comics::lines::owner_plane::crease_left";
    let body = "let a = LineAbstraction(i(3u), i(4u), i(5u), i(6u), i(7u), i(2u), i(8u), 0.0);
        return vec4(crease_left(a, at));";
    let objects = ["OBJECT_DEPTHS", "OBJECT_IDS"];
    for more in [&[][..], &objects] {
        let names = [&["DEPTH", "ABSTRACT_CREASES"][..], more].concat();
        let definitions: Vec<Definition> = names.iter().map(|name| (*name, None)).collect();
        let rows = rows(&mut n, crease_row);
        let results = scene.evaluate(&definitions, imports, body, &rows);
        for (row, found) in rows.iter().zip(results) {
            let pixel = Scene::index(row);
            let [by_objects, near, far, exponent, _, left, _] =
                std::array::from_fn(|k| f64::from(row[2 + k]));
            let creases = Creases {
                ends: [near, far],
                exponent,
                flip: row[8] == 1.0,
                left,
                by_objects,
            };
            let object = scene.object(pixel).filter(|_| !more.is_empty());
            let own = scene.map(scene.depths[pixel], false);
            let at = |d: f64| crease_left(&creases, d, object);
            // A depth of the map is right to 1e-6, and a power of it to 4 times the error of the
            // built-in logarithm, 2e-5; the dial doubles it.
            let slack = (at(own + 1e-6) - at(own - 1e-6)).abs() + 2e-4;
            let off = (f64::from(found[0]) - at(own)).abs();
            assert!(off < slack, "{row:?}: {}, not {}", found[0], at(own));
        }
    }
}
