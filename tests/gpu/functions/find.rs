//! The rules of cracks on random pictures, in the fragment shader, which is run as a function.
//! `cracks.rs` compares the compute passes, which share the rules, on models.

use bevy_comics::lines::{CreaseSource, LineEdge};
use bevy_comics_testkit::{
    reference::{crack::crack, map::Projection, view::View},
    wgsl::without_stage,
};

use super::{
    bound::{floats, pairs, texture},
    toon::Numbers,
    *,
};
use crate::{cracks::is_rounded, shaders::shader};

/// No step of a `Picture` is at a limit of these: a few would be at round numbers.
fn outlines() -> Outlines {
    Outlines {
        silhouettes: Some(Silhouettes {
            threshold: 0.287,
            ..Silhouettes::default()
        }),
        creases: Some(Creases::default()),
        objects: Some(ObjectEdges::default()),
        width: 1.5,
        hysteresis: 0.0,
        response: LineResponse::Ink,
        ..Outlines::default()
    }
}

/// Of the view. Some folds of normals are where depth bends by less.
const LEAST_BEND: f64 = 0.217;

/// What the shader takes of the outlines: ramps of the ink that begin and end at half of the
/// softness of the edge limit.
fn settings(s: &Outlines) -> String {
    let (silhouettes, creases) = (
        s.silhouettes.unwrap_or_default(),
        s.creases.unwrap_or_default(),
    );
    let ramp = |limit: f32, softness: f32| {
        let half = softness * limit.min(1.0 - limit);
        [limit - half, limit + half]
    };
    let [low, high] = ramp(silhouettes.edge_limit, silhouettes.softness);
    let [crease_low, crease_high] = ramp(creases.edge_limit, creases.softness);
    let k = 0.5 * silhouettes.threshold;
    let crease_k = (0.5 * creases.angle).to_radians().sin();
    let half_width = 0.5 * s.width;
    format!(
        "line_pass.settings.silhouette_low = {low:?};
         line_pass.settings.silhouette_high = {high:?};
         line_pass.settings.silhouette_k = {k:?};
         line_pass.settings.crease_low = {crease_low:?};
         line_pass.settings.crease_high = {crease_high:?};
         line_pass.settings.crease_k = {crease_k:?};
         line_pass.settings.half_width = {half_width:?};
         line_pass.settings.scale = 1.0;
         line_pass.settings.reference_factor = 1.0;
         line_pass.settings.jump = {:?};
         line_pass.settings.found_sections = {}u;
         line_pass.settings.normal_creases = {}u;
         line_pass.settings.bend = {LEAST_BEND:?};
         line_pass.settings.owner_direction = vec3(0.02, 0.90, 0.42);
         line_pass.settings.ink_part = 1.0;",
        silhouettes.threshold,
        u32::from(creases.source != CreaseSource::Normals),
        u32::from(creases.source != CreaseSource::Meshes)
    )
}

/// Both words in halves, which are exact as numbers. The fragment: i(0), i(1); the grid: from i(2)
/// on.
const FOUND: &str = "
    line_pass.grid.rect = vec4(i32(i(2u)), i32(i(3u)), i32(i(4u)), i32(i(5u)));
    let words = find(vec4(i(0u) + 0.5, i(1u) + 0.5, 0.0, 1.0));
    let halves = vec4(words.x & 0xffffu, words.x >> 16u, words.y & 0xffffu, words.y >> 16u);
    return vec4<f32>(halves);";

/// Grids in one picture: x, y, width and height. Some are smaller than what a crack depends on;
/// around them are other pixels.
const GRIDS: [[u32; 4]; 7] = [
    [2, 1, 1, 1],
    [5, 3, 2, 3],
    [9, 0, 4, 4],
    [1, 9, 5, 9],
    [11, 8, 13, 7],
    [0, 20, 24, 20],
    [3, 42, 6, 1],
];

/// Every pixel of every grid.
fn rows() -> Vec<[f32; 6]> {
    let mut rows = vec![];
    for [left, top, width, height] in GRIDS {
        for [x, y] in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
            rows.push([x, y, left, top, width, height].map(|k| k as f32));
        }
    }
    rows
}

/// No two pairs of them are at the same angle, and one pair is at 60.03 degrees. The last one is
/// too short to be a normal.
const NORMALS: [[f32; 3]; 7] = [
    [0.1, 0.2, 0.9],
    [0.65, -0.1, 0.7],
    [-0.3, 0.85, 0.35],
    [-0.5, -0.55, 0.6],
    [0.2, 0.1, -0.95],
    [0.4, 0.35, 0.5],
    [0.1, -0.1, 0.15],
];

fn pick<T: Copy>(n: &mut Numbers, of: &[T]) -> T {
    of[((n.part() * of.len() as f32) as usize).min(of.len() - 1)]
}

/// A picture that looks random.
struct Picture {
    depths: Vec<f32>,
    /// Texels of the prepass.
    normals: Vec<[f32; 4]>,
    /// What these stand for.
    facing: FloatImage,
    /// Ids; and the slot and the section.
    ids: IdImage,
}

impl Picture {
    const SIZE: [u32; 2] = [26, 44];

    /// Fields of 8 x 8 pixels are planes with steps, or steps alone. All depths and their
    /// differences are exact in single precision.
    fn new(n: &mut Numbers) -> Self {
        let [width, height] = Self::SIZE;
        let (mut depths, mut normals, mut ids) = (vec![], vec![], vec![]);
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
            let slot_section = pick(n, &[0u32, 1, 0x0102, 0x0203, 0xc801, 0xff00]);
            depths.push(depth as f32 / 256.0);
            // The texel of the sky is cleared to 1.
            let is_sky = depth == 0;
            normals.push(if is_sky { [1.0; 4] } else { [a, b, c, 1.0] });
            ids.push([pick(n, &[0u32, 1, 1, 2, 70_000]), slot_section]);
        }
        let facing = normals.iter().map(|texel| texel.map(|c| 2.0 * c - 1.0));
        Self {
            facing: FloatImage {
                width,
                height,
                pixels: facing.collect(),
            },
            ids: IdImage {
                width,
                height,
                pixels: ids,
            },
            depths,
            normals,
        }
    }

    /// A grid in perspective. Without `surfaces`, only depth is there.
    fn view<'a>(&'a self, depth_bits: &'a [u32], grid: [u32; 4], surfaces: bool) -> View<'a> {
        View {
            viewport: grid,
            samples: 1,
            width: Self::SIZE[0],
            depth_bits,
            frame: Frame {
                projection: Projection::Perspective { offset: 0.0 },
                ends: None,
                logarithmic: false,
                floor: 0.0,
                sky_gap: 0.0,
            },
            flip: false,
            normals: surfaces.then_some(&self.facing),
            ids: surfaces.then_some(&self.ids),
            widths: None,
            height: 0.0,
            least_bend: LEAST_BEND,
            to_light: [0.0, 0.0, 1.0],
            right: [1.0, 0.0, 0.0],
        }
    }
}

/// Compares the cracks of all pixels. Returns how many run along silhouettes, creases and borders
/// of objects.
fn assert_matches_the_reference(
    picture: &Picture,
    outlines: &Outlines,
    names: &[&str],
) -> [u32; 3] {
    let definitions: Vec<Definition> = names.iter().map(|name| (*name, None)).collect();
    let surfaces = names.contains(&"OBJECT_IDS");
    let depths = floats(Picture::SIZE, &picture.depths);
    let normals = gpu().texture(Picture::SIZE, &picture.normals);
    let objects = pairs(Picture::SIZE, &picture.ids.pixels);
    let mut entries = vec![texture(2, &depths)];
    if names.contains(&"NORMALS") {
        entries.push(texture(7, &normals));
    }
    if surfaces {
        entries.push(texture(8, &objects));
    }
    let source = without_stage(&shader("lines/find/find.wgsl"));
    let body = settings(outlines) + FOUND;
    let rows = rows();
    let results = gpu().evaluate_bound(&definitions, &entries, &source, &body, &rows);
    let depth_bits: Vec<u32> = picture.depths.iter().map(|depth| depth.to_bits()).collect();
    let mut kinds = [0; 3];
    for (row, halves) in rows.iter().zip(results) {
        let [x, y, left, top, width, height] = row.map(|k| k as u32);
        let view = picture.view(&depth_bits, [left, top, width, height], surfaces);
        let pixel = [left + x, top + y].map(i64::from);
        for side in [0, 1] {
            let word = halves[2 * side] as u32 | ((halves[2 * side + 1] as u32) << 16);
            let what = format!("{names:?}, {row:?}, {side}");
            let Some(want) = crack(outlines, &view, pixel, side, 1.0) else {
                assert_eq!(word, 0, "{what}");
                continue;
            };
            // Its line is straight: an offset and a slope of 0.
            is_rounded(word, 0x8080, &want, &what);
            for (count, is) in kinds.iter_mut().zip(want.kinds) {
                *count += u32::from(is);
            }
        }
    }
    kinds
}

/// What all lines are found with, but for creases at the edges of meshes alone.
const ALL: [&str; 9] = [
    "DEPTH",
    "EXCESS",
    "SILHOUETTES",
    "NORMALS",
    "OBJECT_IDS",
    "CREASES",
    "OBJECT_EDGES",
    "SECTIONS",
    "BENDS",
];

/// Also at the borders of grids, and in grids that are smaller than what a crack depends on.
#[test]
fn cracks_of_fragments_match_the_reference() {
    let mut n = Numbers::new(81);
    let all = outlines();
    let silhouettes = Outlines {
        creases: None,
        objects: None,
        ..all
    };
    for source in [
        CreaseSource::Normals,
        CreaseSource::Meshes,
        CreaseSource::Both,
    ] {
        let picture = Picture::new(&mut n);
        let creases = Creases {
            source,
            ..Creases::default()
        };
        let all = Outlines {
            creases: Some(creases),
            ..all
        };
        let without = source == CreaseSource::Meshes;
        let is_read = |name: &&str| !(without && ["NORMALS", "BENDS"].contains(name));
        let names: Vec<&str> = ALL.into_iter().filter(is_read).collect();
        let kinds = assert_matches_the_reference(&picture, &all, &names);
        // Without normals, few borders of these pictures are confirmed.
        let least = [50, if without { 5 } else { 50 }, 50];
        assert!(kinds.iter().zip(least).all(|(k, l)| *k > l), "{kinds:?}");
        let [count, ..] = assert_matches_the_reference(&picture, &silhouettes, &names[..3]);
        assert!(count > 50, "{count}");
    }
}

/// Hard lines belong to the larger object, to the surface that faces above or the camera, to the
/// one in front, or to the larger section.
#[test]
fn owners_of_hard_lines_match_the_reference() {
    let picture = Picture::new(&mut Numbers::new(82));
    let hard = Outlines {
        edge: LineEdge::Hard,
        ..outlines()
    };
    let names = [&ALL[..], &["HARD"]].concat();
    let kinds = assert_matches_the_reference(&picture, &hard, &names);
    assert!(kinds.iter().all(|count| *count > 50), "{kinds:?}");
}
