//! The copy of the normal prepass: a whole pass, because it computes nothing.

use bevy_comics_testkit::drawing::Target;

use super::{bound::texture, toon::Numbers, *};
use crate::{prelude::*, shaders::shader};

/// The format of the engine's prepass.
const FORMAT: TextureFormat = TextureFormat::Rgb10a2Unorm;
const SIZE: [u32; 2] = [19, 7];

/// Codes of ten bits, and two of alpha.
fn codes(n: &mut Numbers) -> Vec<[u32; 4]> {
    (0..SIZE[0] * SIZE[1])
        .map(|_| {
            let [r, g, b] = [0; 3].map(|_| (1023.0 * n.part()).round() as u32);
            [r, g, b, (3.0 * n.part()).round() as u32]
        })
        .collect()
}

/// What the numbers of a texel stand for.
fn levels([r, g, b, a]: [u32; 4]) -> [f32; 4] {
    [(r, 1023.0), (g, 1023.0), (b, 1023.0), (a, 3.0)].map(|(code, most)| code as f32 / most)
}

/// Copies a texture and compares all samples with these codes.
fn assert_copies(
    source: &wgpu::TextureView,
    samples: &[Vec<[u32; 4]>],
    definitions: &[Definition],
    declared: &str,
) {
    let target = Target {
        format: FORMAT,
        size: SIZE,
        samples: samples.len() as u32,
    };
    let text = shader("objects/transparent/copy_normals.wgsl");
    let copy = gpu().drawn(
        target,
        (&text, "copy_normal"),
        definitions,
        &[texture(0, source)],
    );
    let declared = format!("@group(0) @binding(2) var copied: {declared};");
    let body = "return textureLoad(copied, vec2(i32(i(0u)), i32(i(1u))), i32(i(2u)));";
    let rows: Vec<[f32; 3]> = (0..samples.len() as u32)
        .flat_map(|sample| {
            let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
            places.map(move |[x, y]| [x, y, sample].map(|k| k as f32))
        })
        .collect();
    let results = gpu().evaluate_texture(&copy, &declared, body, &rows);
    for ((row, found), codes) in rows.iter().zip(results).zip(samples.iter().flatten()) {
        for (found, want) in found.into_iter().zip(levels(*codes)) {
            assert!((found - want).abs() < 1e-5, "{row:?}: {found}, not {want}");
        }
    }
}

#[test]
fn normals_are_copied() {
    let codes = codes(&mut Numbers::new(51));
    let bytes: Vec<u8> = (codes.iter())
        .flat_map(|[r, g, b, a]| (r | (g << 10) | (b << 20) | (a << 30)).to_le_bytes())
        .collect();
    let source = gpu().texture_of(FORMAT, [SIZE[0], SIZE[1], 1], &bytes);
    assert_copies(&source, &[codes], &[], "texture_2d<f32>");
}

/// Every sample has a normal of its own.
#[test]
fn normals_of_all_samples_are_copied() {
    let mut n = Numbers::new(52);
    let samples: Vec<Vec<[u32; 4]>> = (0..4).map(|_| codes(&mut n)).collect();
    let layers: Vec<Vec<[f32; 4]>> = (samples.iter())
        .map(|codes| codes.iter().map(|codes| levels(*codes)).collect())
        .collect();
    let source = gpu().multisampled(FORMAT, SIZE, &layers);
    let declared = "texture_multisampled_2d<f32>";
    let definitions = [("MULTISAMPLED", None), ("SAMPLE_SHADING", None)];
    assert_copies(&source, &samples, &definitions, declared);
    // Where a shader cannot be run for each sample, all have the normal of the first.
    let first = vec![samples[0].clone(); 4];
    assert_copies(&source, &first, &definitions[..1], declared);
}
