//! The cracks that a fragment finds, which is run as a function.

use bevy_comics_testkit::{
    reference::{crack::crack, map::Projection, view::View},
    wgsl::without_stage,
};

use super::{
    bound::{floats, pairs, texture},
    rows::{GRIDS, Picture},
    toon::Numbers,
    *,
};
use crate::{cracks::is_rounded, prelude::*, shaders::shader};

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
         line_pass.settings.ink_part = 1.0;",
        silhouettes.threshold
    )
}

/// Both words in halves, which are exact as numbers. The fragment: i(0), i(1); the grid: from i(2) on.
const FOUND: &str = "
    line_pass.grid.rect = vec4(i32(i(2u)), i32(i(3u)), i32(i(4u)), i32(i(5u)));
    let words = find(vec4(i(0u) + 0.5, i(1u) + 0.5, 0.0, 1.0));
    let halves = vec4(words.x & 0xffffu, words.x >> 16u, words.y & 0xffffu, words.y >> 16u);
    return vec4<f32>(halves);";

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

/// What the reference reads of a picture.
struct Read {
    bits: Vec<u32>,
    normals: FloatImage,
    ids: IdImage,
}

impl Read {
    fn new(picture: &Picture) -> Self {
        let [width, height] = Picture::SIZE;
        Self {
            bits: picture.depths.iter().map(|depth| depth.to_bits()).collect(),
            normals: FloatImage {
                width,
                height,
                pixels: (picture.normals.iter())
                    .map(|texel| texel.map(|c| 2.0 * c - 1.0))
                    .collect(),
            },
            ids: IdImage {
                width,
                height,
                pixels: picture.objects.clone(),
            },
        }
    }

    /// A grid in perspective. Without `surfaces`, only depth is there.
    fn view(&self, grid: [u32; 4], surfaces: bool) -> View<'_> {
        View {
            viewport: grid,
            samples: 1,
            width: Picture::SIZE[0],
            depth_bits: &self.bits,
            frame: Frame {
                projection: Projection::Perspective { offset: 0.0 },
                ends: None,
                logarithmic: false,
                floor: 0.0,
                sky_gap: 0.0,
            },
            flip: false,
            normals: surfaces.then_some(&self.normals),
            ids: surfaces.then_some(&self.ids),
            widths: None,
            height: 0.0,
            to_light: [0.0, 0.0, 1.0],
        }
    }
}

/// Compares the cracks of all pixels. Returns how many run along silhouettes, creases and borders of
/// objects.
fn assert_matches_the_reference(
    picture: &Picture,
    outlines: &Outlines,
    names: &[&str],
) -> [u32; 3] {
    let definitions: Vec<Definition> = names.iter().map(|name| (*name, None)).collect();
    let surfaces = names.contains(&"NORMALS");
    let depths = floats(Picture::SIZE, &picture.depths);
    let normals = gpu().texture(Picture::SIZE, &picture.normals);
    let objects = pairs(Picture::SIZE, &picture.objects);
    let mut entries = vec![texture(2, &depths)];
    if surfaces {
        entries.extend([texture(7, &normals), texture(8, &objects)]);
    }
    let source = without_stage(&shader("lines/find/find.wgsl"));
    let body = settings(outlines) + FOUND;
    let rows = rows();
    let results = gpu().evaluate_bound(&definitions, &entries, &source, &body, &rows);
    let read = Read::new(picture);
    let mut kinds = [0; 3];
    for (row, halves) in rows.iter().zip(results) {
        let [x, y, left, top, width, height] = row.map(|k| k as u32);
        let view = read.view([left, top, width, height], surfaces);
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
    for _ in 0..3 {
        let picture = Picture::new(&mut n);
        let names = [
            "DEPTH",
            "EXCESS",
            "NORMALS",
            "OBJECT_IDS",
            "SILHOUETTES",
            "CREASES",
            "OBJECT_EDGES",
            "SECTIONS",
        ];
        let kinds = assert_matches_the_reference(&picture, &all, &names);
        assert!(kinds.iter().all(|count| *count > 50), "{kinds:?}");
        let names = ["DEPTH", "EXCESS", "SILHOUETTES"];
        let [count, ..] = assert_matches_the_reference(&picture, &silhouettes, &names);
        assert!(count > 50, "{count}");
    }
}
