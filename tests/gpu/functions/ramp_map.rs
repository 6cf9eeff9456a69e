//! Tones of painted ramps: sums against areas, and against many samples.

use bevy_comics_testkit::reference::{Rgb, ramp_map};

use super::{toon::Numbers, *};

const IMPORT: &str = "#import bevy_comics::toon::ramp_map::{map_row, map_shadowed, map_tone}
    @group(0) @binding(2) var sums: texture_2d<f32>;";

/// Rows of tones that look random, as the crate rounds them.
fn painted(width: u32, height: u32) -> Vec<Vec<Rgb>> {
    let mut numbers = Numbers::new(u64::from(width + 7 * height));
    let texel =
        |n: &mut Numbers| [(); 3].map(|()| f64::from((n.part() * 16384.0).round()) / 16384.0);
    let row = |_| (0..width).map(|_| texel(&mut numbers)).collect();
    (0..height).map(row).collect()
}

/// The texture of sums: column k is the sum of the first k tones.
fn sums(rows: &[Vec<Rgb>]) -> wgpu::TextureView {
    let mut texels = Vec::new();
    for row in rows {
        let mut sum = [0.0; 3];
        for color in row.iter().chain([&[0.0; 3]]) {
            texels.push([sum[0] as f32, sum[1] as f32, sum[2] as f32, 1.0]);
            sum = std::array::from_fn(|c| sum[c] + color[c]);
        }
    }
    gpu().texture([rows[0].len() as u32 + 1, rows.len() as u32], &texels)
}

/// How much light arrives, its change over a pixel, what of it shadows leave, and the detail.
fn places(count: usize) -> Vec<[f32; 4]> {
    let mut n = Numbers::new(3);
    let mut place = |_| {
        let width = match n.once_in(3) {
            true => 0.0,
            false => 10f32.powf(n.within(-3.0, -0.3)),
        };
        let lit = match n.once_in(3) {
            true => f32::from(u8::from(n.once_in(2))),
            false => n.part(),
        };
        let detail = match n.once_in(4) {
            true => n.part().round(),
            false => n.part(),
        };
        [n.within(-1.0, 1.2), width, lit, detail]
    };
    (0..count).map(&mut place).collect()
}

#[test]
fn tones_of_painted_ramps_are_areas_of_their_texels() {
    for (width, height) in [(2, 1), (5, 1), (64, 3), (257, 16), (1024, 2)] {
        let rows = painted(width, height);
        let places = places(8192);
        let found = |call: &str| {
            let body = format!("let row = map_row(sums, i(3u)); return vec4({call}, row);");
            gpu().evaluate_texture(&sums(&rows), IMPORT, &body, &places)
        };
        let [tones, shadowed] = [
            found("map_tone(sums, row, i(0u), i(1u))"),
            found("map_shadowed(sums, row, i(0u), i(1u), i(2u))"),
        ];
        let mut undecided = 0;
        for (k, place) in places.iter().enumerate() {
            let [arriving, over, lit, detail] = place.map(f64::from);
            let row = (1.0 - detail) * f64::from(height - 1);
            assert!((f64::from(tones[k][3]) - row).abs() < 1e-5);
            // The ends of a pixel are right to two roundings of numbers up to 1.5; sums are exact.
            let place_off = 2.0 * 1.5 * 2f64.powi(-23);
            let column = arriving * f64::from(width);
            let edge = (column - column.round()).abs() / f64::from(width);
            if over == 0.0 && edge < place_off {
                undecided += 1;
                continue;
            }
            // Roundings of the mean, and of the part between two rows.
            let rest = 4e-6 + 1e-6 * f64::from(height);
            let slack = rest + if over > 0.0 { place_off / over } else { 0.0 };
            let references = [
                ramp_map::tone(&rows, detail, arriving, over),
                ramp_map::shadowed(&rows, detail, arriving, over, lit),
            ];
            for (found, reference) in [tones[k], shadowed[k]].into_iter().zip(references) {
                for c in 0..3 {
                    let off = (f64::from(found[c]) - reference[c]).abs();
                    assert!(
                        off < slack,
                        "{width}x{height}, {place:?}: {found:?}, not {reference:?}"
                    );
                }
            }
        }
        assert!(undecided < 40, "{undecided}");
    }
}

/// Truth: the mean of 1024 samples of the nearest texel. The places of pixels are such that no
/// sample lies on both sides of an edge, so that the mean is exact.
#[test]
fn tones_of_painted_ramps_are_the_mean_of_1024_samples() {
    let count = 256;
    let rows = painted(count, 1);
    let mut n = Numbers::new(5);
    let mut place = |_| {
        // In texels: a power of two from a quarter to 128.
        let over = (n.within(-2.49, 7.49).round()).exp2();
        let sample = over / 1024.0;
        let low = (n.within(-20.0, 270.0) / sample).round() * sample;
        [low, over]
    };
    let pixels: Vec<[f32; 2]> = (0..4096).map(&mut place).collect();
    let body = "let over = i(1u) / 256.0;
         return vec4(map_tone(sums, 0.0, i(0u) / 256.0 + 0.5 * over, over), 0.0);";
    let results = gpu().evaluate_texture(&sums(&rows), IMPORT, body, &pixels);
    let mut worst = 0.0f64;
    for (pixel, found) in pixels.iter().zip(results) {
        let [low, over] = pixel.map(f64::from);
        let mut mean = [0.0; 3];
        for k in 0..1024 {
            let at = low + over * (f64::from(k) + 0.5) / 1024.0;
            let texel = at.floor().clamp(0.0, f64::from(count) - 1.0) as usize;
            mean = std::array::from_fn(|c| mean[c] + rows[0][texel][c] / 1024.0);
        }
        for c in 0..3 {
            let off = (f64::from(found[c]) - mean[c]).abs();
            assert!(off < 1e-4, "{pixel:?}: {found:?}, not {mean:?}");
            worst = worst.max(off);
        }
    }
    println!("off by up to {worst:.1e}");
}
