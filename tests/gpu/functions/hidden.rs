//! Which pixels of marked objects are hidden in the picture.

use bevy_comics_testkit::reference::hidden::{HIDDEN, in_front};

use super::{
    bound::{floats, pairs, texture},
    toon::Numbers,
    *,
};
use crate::prelude::*;

const MARKED: &str = "#import bevy_comics::depth::view::view
    #import bevy_comics::lines::hidden::marked_object
    #import bevy_comics::lines::pass::line_pass";

const SIZE: [u32; 2] = [24, 18];

/// The threshold of silhouettes, and the factor and the constant of its reference: in perspective
/// with and without a far plane, and in an orthographic view.
const JUMPS: [[f32; 3]; 4] = [
    [0.02, 1.0, 0.0],
    [0.3, 1.0, 0.01],
    [1.0, 0.0, 0.05],
    [1e-6, 1.0, 0.0],
];

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

/// An object and its marks at each pixel: none, with a style, with a section.
fn objects(n: &mut Numbers) -> Vec<[u32; 2]> {
    pixels()
        .map(|_| {
            let id = if n.once_in(4) { 0.0 } else { 1e6 * n.part() };
            [id as u32, (65535.0 * n.part()) as u32]
        })
        .collect()
}

/// What the picture shows at a pixel, as raw depth: that of the texture, or of an oblique
/// projection, whose view depths are 1 over what is affine on the screen, in half units.
fn shown(oblique: bool, [x, y]: [u32; 2], texel: f32) -> f64 {
    let texel = f64::from(texel);
    if !oblique || texel <= 0.0 {
        return texel;
    }
    let part = |k: u32, size: u32| (f64::from(k) + 0.5) / f64::from(size);
    let [ndc_x, ndc_y] = [2.0 * part(x, SIZE[0]) - 1.0, 1.0 - 2.0 * part(y, SIZE[1])];
    (0.5 * (0.125 * ndc_x + 0.25 * ndc_y + texel)).min(1.0)
}

/// The view and its jumps.
fn view([jump, factor, constant]: [f32; 3]) -> String {
    let [width, height] = SIZE;
    format!(
        "view.raw.view_z = vec4(0.0, 0.0, 0.0, -1.0);
         view.raw.view_w = vec4(0.125, 0.25, 1.0, 0.0);
         view.raw.ndc = vec4(2.0 / {width}.0, -2.0 / {height}.0, -1.0, 1.0);
         view.raw.nearest = 0.5;
         line_pass.settings.jump = {jump:?};
         line_pass.settings.reference_factor = {factor:?};
         line_pass.settings.reference_constant = {constant:?};
         let found = marked_object(vec2(i32(i(0u)), i32(i(1u))), i(2u));
         return vec4(f32(found.x), f32(found.y & 0xffffu), f32(found.y >> 16u), 0.0);"
    )
}

/// Objects at depths around the one at which they are hidden, at the depth of the picture, at the
/// near plane, and at no depth.
fn rows(n: &mut Numbers, jump: [f32; 3], picture: impl Fn([u32; 2]) -> f64) -> Vec<[f32; 3]> {
    let [jump, factor, constant] = jump.map(f64::from);
    let mut rows = vec![];
    for pixel in pixels() {
        let picture = picture(pixel);
        let border = (picture - 0.1 * jump * constant) / (1.0 + 0.1 * jump * factor);
        let near = border.max(0.0) * f64::from(n.within(0.9999, 1.0001));
        let owns = [near, picture, f64::from(n.part()), 0.0, 1.0];
        let [x, y] = pixel.map(|k| k as f32);
        rows.extend(owns.map(|own| [x, y, own as f32]));
    }
    rows
}

/// Compares all rows. `texels`: of the depth of the picture.
fn assert_matches_the_reference(
    n: &mut Numbers,
    definitions: &[Definition],
    picture: &wgpu::TextureView,
    texels: &[f32],
) {
    let oblique = definitions.iter().any(|(name, _)| *name == "OBLIQUE");
    let at = |[x, y]: [u32; 2]| (y * SIZE[0] + x) as usize;
    let depth = |pixel| shown(oblique, pixel, texels[at(pixel)]);
    let objects = objects(n);
    let ids = pairs(SIZE, &objects);
    let entries = [texture(8, &ids), texture(27, picture)];
    for jump in JUMPS {
        let rows = rows(n, jump, depth);
        let results = gpu().evaluate_bound(definitions, &entries, MARKED, &view(jump), &rows);
        let mut counts = [0, 0];
        for (row, found) in rows.iter().zip(results) {
            let pixel = [row[0] as u32, row[1] as u32];
            let [id, marks] = objects[at(pixel)];
            let own = f64::from(row[2]);
            let [threshold, factor, constant] = jump.map(f64::from);
            let front = in_front(depth(pixel), own, threshold, [factor, constant]);
            assert_eq!([found[0], found[1]], [id as f32, marks as f32], "{row:?}");
            // Six roundings; an oblique depth is right to 1e-7 as a part of 1.
            let rounding = if oblique {
                1e-6
            } else {
                4e-7 * (own + depth(pixel) + constant)
            };
            if front.abs() <= rounding {
                continue;
            }
            let bit = f64::from(found[2]) * 65536.0;
            let want = if front > 0.0 { HIDDEN } else { 0 };
            assert_eq!(bit, f64::from(want), "{row:?}, {jump:?}: {front}");
            counts[usize::from(front > 0.0)] += 1;
        }
        assert!(counts.iter().all(|count| *count > 400), "{counts:?}");
    }
}

/// Depths of the picture: none, the near plane, close to it, and any.
fn texels(n: &mut Numbers) -> Vec<f32> {
    pixels()
        .map(|_| match (n.part() * 8.0) as u32 {
            0 => 0.0,
            1 => 1.0,
            2 => 1.0 - 1e-6,
            _ => n.within(0.4, 1.0),
        })
        .collect()
}

#[test]
fn hidden_pixels_match_the_reference() {
    let mut n = Numbers::new(41);
    for definitions in [
        &[("OBJECT_IDS", None)][..],
        &[("OBJECT_IDS", None), ("OBLIQUE", None)],
    ] {
        let texels = texels(&mut n);
        assert_matches_the_reference(&mut n, definitions, &floats(SIZE, &texels), &texels);
    }
}

/// Of a multisampled picture, the first sample counts.
#[test]
fn hidden_pixels_of_a_multisampled_picture_match_the_reference() {
    let mut n = Numbers::new(42);
    let samples: Vec<Vec<f32>> = (0..4).map(|_| texels(&mut n)).collect();
    let layers: Vec<Vec<[f32; 4]>> = (samples.iter())
        .map(|texels| texels.iter().map(|depth| [*depth, 0.0, 0.0, 1.0]).collect())
        .collect();
    let picture = gpu().multisampled(TextureFormat::R32Float, SIZE, &layers);
    let definitions = [("OBJECT_IDS", None), ("MULTISAMPLED_PICTURE", None)];
    assert_matches_the_reference(&mut n, &definitions, &picture, &samples[0]);
}
