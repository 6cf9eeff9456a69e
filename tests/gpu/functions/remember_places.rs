//! What the memory of lines reads around a pixel, and of the last frame.

use bevy_comics_testkit::{
    reference::remember::{At, inside, past_at, past_nearest, square},
    wgsl::without_stage,
};

use super::{
    bound::{floats, texture},
    toon::Numbers,
    *,
};
use crate::{prelude::*, shaders::shader};

const DEPTH: [Definition; 1] = [("DEPTH", None)];

/// The size of the viewport, whose textures are larger.
const VIEWPORT: At = [13, 9];
const SIZE: [u32; 2] = [16, 12];

/// The shader, whose entry point is a plain function.
fn source() -> String {
    without_stage(&shader("lines/memory/remember.wgsl"))
}

/// Random texels of the last frame.
fn texels(n: &mut Numbers) -> Vec<[f32; 4]> {
    (0..SIZE[0] * SIZE[1])
        .map(|_| [0; 4].map(|_| if n.once_in(4) { 0.0 } else { n.part() }))
        .collect()
}

fn texel(texels: &[[f32; 4]], at: At) -> [f64; 4] {
    let [x, y] = inside(VIEWPORT, at);
    texels[(y * i64::from(SIZE[0]) + x) as usize].map(f64::from)
}

/// In grids that are larger and smaller than 5 x 5 pixels, up to five pixels apart, and where there is
/// only sky.
#[test]
fn depths_around_a_pixel_match_the_reference() {
    const WIDTH: u32 = 40;
    const HEIGHT: u32 = 30;
    let mut n = Numbers::new(21);
    let depths: Vec<f32> = (0..WIDTH * HEIGHT)
        .map(|k| {
            if k % WIDTH > 24 || n.once_in(3) {
                0.0
            } else {
                n.part()
            }
        })
        .collect();
    let view = floats([WIDTH, HEIGHT], &depths);
    let mut rows = vec![];
    for [left, top, width, height] in [[3, 2, 35, 25], [1, 1, 1, 1], [6, 27, 3, 2], [0, 0, 40, 1]] {
        for [x, y] in (-1..=height).flat_map(|y| (-1..=width).map(move |x| [x, y])) {
            let row = |spacing| [x, y, spacing, left, top, width, height].map(|k| k as f32);
            rows.extend([1, 2, 5].map(row));
        }
    }
    let body = "line_pass.grid.rect = vec4(i32(i(3u)), i32(i(4u)), i32(i(5u)), i32(i(6u)));
        line_pass.memory.spacing = i32(i(2u));
        let around = depths_around(vec2(i32(i(0u)), i32(i(1u))));
        return vec4(around.nearest, around.wide, vec2<f32>(around.pixel));";
    let entries = [texture(2, &view)];
    let results = gpu().evaluate_bound(&DEPTH, &entries, &source(), body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let [x, y, spacing, left, top, width, height] = row.map(|k| k as i64);
        let place = |at: At| {
            let [x, y] = inside([width, height], at);
            [left + x, top + y]
        };
        let depth = |[x, y]: At| f64::from(depths[(y * i64::from(WIDTH) + x) as usize]);
        let nearest = |reach: i64| {
            let around = square([x, y], reach, spacing).map(place);
            around.map(depth).fold(0.0, f64::max)
        };
        let [near, wide] = [found[0], found[1]].map(f64::from);
        assert_eq!([near, wide], [nearest(1), nearest(2)], "{row:?}");
        let pixel = [found[2] as i64, found[3] as i64];
        let is_near = square([x, y], 2, spacing).any(|at| place(at) == pixel);
        assert!(is_near, "{row:?}: {pixel:?}");
        assert_eq!(depth(pixel), wide, "{row:?}: {pixel:?}");
    }
}

/// Inside and outside of the viewport, between pixels, and at their centres, where it is that of one
/// pixel.
#[test]
fn ink_of_the_last_frame_matches_the_reference() {
    let mut n = Numbers::new(22);
    let texels = texels(&mut n);
    let view = gpu().texture(SIZE, &texels);
    let mut rows: Vec<[f32; 2]> = (0..4096)
        .map(|_| [0; 2].map(|_| (64.0 * n.within(-2.0, 16.0)).floor() / 64.0))
        .collect();
    let centres = (-2..11).flat_map(|y| (-2..15).map(move |x| [x, y]));
    rows.extend(centres.map(|centre| centre.map(|k| k as f32 + 0.5)));
    let body = "line_pass.seen.viewport = vec4(5, 7, 13, 9);
        return vec4(past_at(vec2(i(0u), i(1u))), 0.0);";
    let entries = [texture(25, &view)];
    let results = gpu().evaluate_bound(&DEPTH, &entries, &source(), body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let is_centre = row.iter().all(|p| (p - 0.5).fract() == 0.0);
        let want = past_at(row.map(f64::from), |at| {
            let [a, b, c, _] = texel(&texels, at).map(|stored| 1.0 - (1.0 - stored).powi(2));
            [a, b, c]
        });
        // Rounding of 16 products, whose sum is below 2; at a centre, of one.
        let slack = if is_centre { 2e-7 } else { 4e-6 };
        for (found, want) in found.into_iter().zip(want) {
            let off = (f64::from(found) - want).abs();
            assert!(off < slack, "{row:?}: {found}, not {want}");
        }
    }
}

/// Grids that are coarser and finer than the viewport; the distance is at least a pixel.
#[test]
fn nearest_depths_of_the_last_frame_match_the_reference() {
    let mut n = Numbers::new(23);
    let texels = texels(&mut n);
    let view = gpu().texture(SIZE, &texels);
    let mut rows = vec![];
    for scale in [[1.0, 1.0], [0.5, 0.5], [1.9, 1.9], [0.75, 1.5], [3.0, 0.25]] {
        for spacing in [1, 2, 3, 5] {
            for [x, y] in (0..9).flat_map(|y| (0..13).map(move |x| [x, y])) {
                let [x, y, spacing] = [x, y, spacing].map(|k: i32| k as f32);
                rows.push([x, y, spacing, scale[0], scale[1]]);
            }
        }
    }
    let body = "line_pass.seen.viewport = vec4(5, 7, 13, 9);
        line_pass.memory.spacing = i32(i(2u));
        line_pass.grid.from_viewport = vec4(i(3u), i(4u), 0.25, -0.25);
        return vec4(past_nearest(vec2(i32(i(0u)), i32(i(1u)))));";
    let entries = [texture(26, &view)];
    let results = gpu().evaluate_bound(&DEPTH, &entries, &source(), body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let pixel = [row[0] as i64, row[1] as i64];
        let scale = [row[3], row[4]].map(f64::from);
        let want = past_nearest(pixel, row[2] as i64, scale, |at| texel(&texels, at)[0]);
        assert_eq!(f64::from(found[0]), want, "{row:?}");
    }
}

/// A fraction of what the projection makes of a raw depth.
#[test]
fn jumps_between_surfaces_match_the_reference() {
    let mut n = Numbers::new(24);
    let rows: Vec<[f32; 4]> = (0..1024)
        .map(|_| {
            let [depth, jump, constant] = [0; 3].map(|_| n.part());
            let factor = f32::from(u8::from(n.once_in(2)));
            [depth, jump, factor, constant]
        })
        .collect();
    let body = "line_pass.settings.jump = i(1u);
        line_pass.settings.reference_factor = i(2u);
        line_pass.settings.reference_constant = i(3u);
        return vec4(jump_at(i(0u)));";
    let results = gpu().evaluate_bound(&DEPTH, &[], &source(), body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let [depth, jump, factor, constant] = row.map(f64::from);
        let want = jump * (factor * depth + constant);
        let off = (f64::from(found[0]) - want).abs();
        assert!(off <= 3e-7 * want, "{row:?}: {}, not {want}", found[0]);
    }
}
