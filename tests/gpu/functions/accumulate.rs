//! Ink that is blended with that of the frames before: whole pixels of the fragment shader, which is run as a
//! function.

use bevy_comics_testkit::{
    reference::accumulate::{At, Pixel, ROUNDING, inside, past_at, past_nearest, square},
    wgsl::without_stage,
};

use super::{
    bound::{floats, texture},
    toon::Numbers,
    *,
};
use crate::shaders::shader;

/// The size of the viewport: powers of two, so that motion is exact in pixels.
const SIZE: At = [64, 32];
/// Where the grid begins in the depth texture.
const ORIGIN: At = [3, 2];
/// Pixels of a field of one surface and of a field of ink, in both directions.
const SURFACE: i64 = 7;
const INK: i64 = 4;

/// Raw depths of the sky and of surfaces. The fourth and the fifth meet; all others are apart by
/// a quarter of the depth.
const DEPTHS: [f32; 6] = [0.0, 0.125, 0.25, 0.625, 0.65625, 1.0];

/// By how many pixels of the viewport each surface moves in a frame.
type Motions = [[f32; 2]; 6];

const STILL: Motions = [[0.0; 2]; 6];
/// Slower than what counts as motion.
const SLOW: Motions = [[0.03125, 0.0]; 6];
/// Between pixels and by whole pixels, and out of the picture.
const MOVING: Motions = [
    [0.0, 0.0],
    [1.25, -0.75],
    [-2.0, 1.0],
    [0.5, 0.0],
    [40.0, 3.0],
    [-0.25, -20.0],
];

/// A view in two frames.
struct Scene {
    /// Pixels of the grid per pixel of the viewport, along both axes.
    scale: [f64; 2],
    /// Pixels of the grid between the depths that are compared.
    spacing: i64,
    blend_factor: f32,
    /// What jumps between surfaces are a quarter of: a factor of the depth, and a constant.
    reference: [f32; 2],
    motions: Motions,
    /// The surface in each field, in this frame and in the last one.
    surfaces: Vec<[usize; 2]>,
    /// Stored ink and slots.
    ink: Vec<[f32; 4]>,
    past_ink: Vec<[f32; 4]>,
    /// Of the last frame: frames, missing lines, and how unsteady the surface is.
    counts: Vec<[f32; 3]>,
}

fn index([x, y]: At) -> usize {
    (y * SIZE[0] + x) as usize
}

fn pixels() -> impl Iterator<Item = At> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

fn pick<T: Copy>(n: &mut Numbers, of: &[T]) -> T {
    of[((n.part() * of.len() as f32) as usize).min(of.len() - 1)]
}

/// Ink in half of all fields, and slots.
fn inked(n: &mut Numbers) -> Vec<[f32; 4]> {
    let fields: Vec<bool> = (0..SIZE[0] * SIZE[1] / (INK * INK))
        .map(|_| n.once_in(2))
        .collect();
    let ink = |[x, y]: At| {
        let is_inked = fields[(y / INK * (SIZE[0] / INK) + x / INK) as usize];
        let [a, b, c] = [0; 3].map(|_| if is_inked { n.part() } else { 0.0 });
        [a, b, c, (16.0 * n.part()).floor() / 16.0]
    };
    pixels().map(ink).collect()
}

/// A texture that is larger than the viewport. Shaders read nothing beyond the viewport.
fn larger(texel: impl Fn(At) -> [f32; 4]) -> wgpu::TextureView {
    let size = SIZE.map(|k| k + 5);
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    let is_seen = |at: At| inside(SIZE, at) == at;
    let texels = places.map(|at| if is_seen(at) { texel(at) } else { [1.0; 4] });
    gpu().texture(size.map(|k| k as u32), &texels.collect::<Vec<_>>())
}

impl Scene {
    fn new(n: &mut Numbers, grid: ([f64; 2], i64), blend_factor: f32, motions: Motions) -> Self {
        let (scale, spacing) = grid;
        let all = [0, 1, 2, 3, 4, 5];
        let ink = inked(n);
        let mut past_ink = inked(n);
        for (past, now) in past_ink.iter_mut().zip(&ink) {
            if n.once_in(2) {
                *past = *now;
            }
        }
        let surfaces = (0..50).map(|_| {
            let now = pick(n, &all);
            [now, if n.once_in(2) { now } else { pick(n, &all) }]
        });
        let surfaces = surfaces.collect();
        let counts = pixels().map(|_| {
            [
                pick(n, &[0.0, 1.0, 7.0, 8.0, 40.0, 127.0, 128.0]),
                pick(n, &[0.0, 1.0, 15.0, 16.0]),
                pick(n, &[0.0, 1.0, 16.0, 17.0, 32.0, 33.0, 48.0]),
            ]
        });
        Self {
            scale,
            spacing,
            blend_factor,
            reference: if blend_factor == 0.25 {
                [0.0, 0.5]
            } else {
                [1.0, 0.0]
            },
            motions,
            surfaces,
            counts: counts.collect(),
            ink,
            past_ink,
        }
    }

    /// The surface at a pixel of the grid in this frame.
    fn surface(&self, at: At) -> usize {
        let at = inside(self.grid(), at);
        let [x, y] = [0, 1].map(|k| (at[k] as f64 / self.scale[k]) as i64 / SURFACE);
        self.surfaces[(10 * y + x) as usize][0]
    }

    /// Pixels of the grid.
    fn grid(&self) -> At {
        [0, 1].map(|k| (SIZE[k] as f64 * self.scale[k]) as i64)
    }

    /// Raw depth at a pixel of the last frame.
    fn past_depth(&self, at: At) -> f32 {
        let [x, y] = inside(SIZE, at).map(|k| k / SURFACE);
        DEPTHS[self.surfaces[(10 * y + x) as usize][1]]
    }

    /// What the shader makes of all pixels: ink and slot; then depth and counts.
    fn found(&self) -> Vec<[[f32; 4]; 2]> {
        let whole = [0, 1].map(|k| self.grid()[k] + ORIGIN[k] + 1);
        let surfaces: Vec<usize> = (0..whole[1])
            .flat_map(|y| (0..whole[0]).map(move |x| [x - ORIGIN[0], y - ORIGIN[1]]))
            .map(|at| self.surface(at))
            .collect();
        let depths: Vec<f32> = surfaces.iter().map(|s| DEPTHS[*s]).collect();
        let motion = surfaces.iter().map(|s| {
            let [x, y] = self.motions[*s];
            [x / SIZE[0] as f32, y / SIZE[1] as f32, 9.0, 9.0]
        });
        let past = |at: At| {
            let [frames, missing, unsteady] = self.counts[index(at)];
            let packed = frames + 256.0 * (missing + 32.0 * unsteady);
            [self.past_depth(at), packed, 9.0, 9.0]
        };
        let whole = whole.map(|k| k as u32);
        let depth = floats(whole, &depths);
        let motion = gpu().texture(whole, &motion.collect::<Vec<_>>());
        let past = larger(past);
        let [ink, past_ink] = [&self.ink, &self.past_ink].map(|ink| larger(|at| ink[index(at)]));
        let entries = [
            texture(2, &depth),
            texture(23, &ink),
            texture(24, &motion),
            texture(25, &past_ink),
            texture(26, &past),
        ];
        let rows: Vec<[f32; 3]> = pixels()
            .flat_map(|[x, y]| [0, 1].map(|which| [x, y, which].map(|k| k as f32)))
            .collect();
        let source = without_stage(&shader("lines/history/accumulate.wgsl"));
        let definitions = [("DEPTH", None)];
        let results = gpu().evaluate_bound(&definitions, &entries, &source, &self.body(), &rows);
        results.as_chunks::<2>().0.to_vec()
    }

    /// Positions of the grid are a quarter of a pixel away from those of the viewport.
    fn body(&self) -> String {
        let (spacing, blend_factor) = (self.spacing, self.blend_factor);
        let ([right, down], [grid_width, grid_height]) = (self.scale, self.grid());
        let [factor, constant] = self.reference;
        let [width, height] = SIZE;
        let [left, top] = ORIGIN;
        format!(
            "line_pass.seen.viewport = vec4(5, 7, {width}, {height});
             line_pass.grid.rect = vec4({left}, {top}, {grid_width}, {grid_height});
             line_pass.grid.from_viewport = vec4({right:?}, {down:?}, -0.25, 0.25);
             line_pass.history.spacing = {spacing};
             line_pass.history.blend_factor = {blend_factor:?};
             line_pass.settings.jump = 0.25;
             line_pass.settings.reference_factor = {factor:?};
             line_pass.settings.reference_constant = {constant:?};
             let found = accumulate(vec4(i(0u) + 0.5, i(1u) + 0.5, 0.0, 1.0));
             if i(2u) == 0.0 {{ return found.ink; }}
             return vec4(found.nearest, 0.0, 0.0);"
        )
    }

    /// What the reference knows of a pixel, and the pixel of the last frame.
    fn pixel(&self, at: At) -> (Pixel, At) {
        let ink = |of: &[[f32; 4]], at: At| {
            let stored = of[index(inside(SIZE, at))].map(f64::from);
            [0, 1, 2].map(|k| 1.0 - (1.0 - stored[k]).powi(2))
        };
        let nearby: Vec<[f64; 3]> = square(at, 1, 1).map(|at| ink(&self.ink, at)).collect();
        let extreme = |pick: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|k| nearby.iter().map(|ink| ink[k]).reduce(pick).expect("nine"))
        };
        let center = [0, 1].map(|k| {
            let place = (at[k] as f64 + 0.5) * self.scale[k] + [-0.25, 0.25][k];
            place.floor() as i64
        });
        // Surfaces are in the order of their depths.
        let nearest = |reach: i64| {
            let around = square(center, reach, self.spacing);
            around.map(|at| self.surface(at)).max().expect("nine")
        };
        let moved = self.motions[nearest(2)].map(f64::from);
        let place = [0, 1].map(|k| at[k] as f64 + 0.5 - moved[k]);
        let from = inside(SIZE, place.map(|k| k.floor() as i64));
        let past_depth = |at: At| f64::from(self.past_depth(at));
        let pixel = Pixel {
            now: ink(&self.ink, at),
            least: extreme(f64::min),
            most: extreme(f64::max),
            past: past_at(place, |at| ink(&self.past_ink, at)),
            nearest: DEPTHS[nearest(1)].into(),
            wide: DEPTHS[nearest(2)].into(),
            past_nearest: past_depth(from),
            past_wide: past_nearest(from, self.spacing, self.scale, past_depth),
            counts: self.counts[index(from)].map(f64::from),
            seen: (0..2).all(|k| place[k] >= 0.0 && place[k] < SIZE[k] as f64),
            speed: moved[0].hypot(moved[1]),
            blend_factor: self.blend_factor.into(),
        };
        (pixel, from)
    }
}

/// Whether rounding decides if the ink of the last frame is between that nearby.
fn is_doubtful(pixel: &Pixel) -> bool {
    (0..3).any(|k| {
        let below = pixel.past[k] - (pixel.least[k] - ROUNDING);
        let above = pixel.past[k] - (pixel.most[k] + ROUNDING);
        below.abs().min(above.abs()) < 1e-5
    })
}

/// Compares all pixels of a scene. Counts those where each of six things happened.
fn assert_matches_the_reference(scene: &Scene, tally: &mut [u32; 6]) {
    let mut doubtful = 0;
    for (at, [inks, depths]) in pixels().zip(scene.found()) {
        let (pixel, from) = scene.pixel(at);
        if is_doubtful(&pixel) {
            doubtful += 1;
            continue;
        }
        let [factor, constant] = scene.reference.map(f64::from);
        let expected = pixel.accumulated(|depth| 0.25 * (factor * depth + constant));
        let what = format!("{at:?}: {pixel:?}, {expected:?}");
        for (stored, want) in inks.into_iter().zip(expected.ink) {
            let found = 1.0 - (1.0 - f64::from(stored)).powi(2);
            assert!((found - want).abs() < 1e-5, "{what}: {found}, not {want}");
        }
        let has_ink = pixel.now.iter().any(|ink| *ink > 0.0);
        let (slots, at) = if has_ink {
            (&scene.ink, at)
        } else {
            (&scene.past_ink, from)
        };
        assert_eq!(inks[3], slots[index(at)][3], "{what}");
        let [frames, missing, unsteady] = expected.counts;
        let count = frames.floor() + 256.0 * (missing + 32.0 * unsteady);
        let found = [depths[0], depths[1]].map(f64::from);
        assert_eq!(found, [pixel.nearest, count], "{what}");
        let happened = [
            expected.covered,
            expected.uncovered,
            expected.vanished,
            expected.limited,
            !pixel.seen,
            unsteady > 32.0,
        ];
        for (count, is) in tally.iter_mut().zip(happened) {
            *count += u32::from(is);
        }
    }
    assert!(doubtful < 40, "{doubtful}");
}

/// Views that stand still, drift, and move; with grids that are as fine as the picture, finer, and
/// coarser, as an upscaler's; with jumps as in perspective and in an orthographic view; and without
/// history.
#[test]
fn accumulated_pixels_match_the_reference() {
    let mut n = Numbers::new(31);
    let mut tally = [0; 6];
    for motions in [STILL, SLOW, MOVING] {
        for (grid, blend_factor) in [
            (([1.0, 1.0], 1), 0.125),
            (([1.0, 1.0], 2), 0.25),
            (([2.0, 2.0], 3), 0.125),
            (([0.5, 0.5], 1), 0.125),
            (([2.0, 1.0], 3), 0.25),
            (([1.0, 1.0], 1), 1.0),
        ] {
            let scene = Scene::new(&mut n, grid, blend_factor, motions);
            assert_matches_the_reference(&scene, &mut tally);
        }
    }
    assert!(tally.iter().all(|count| *count > 200), "{tally:?}");
}
