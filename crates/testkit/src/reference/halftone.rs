//! Reference of `effects/halftone/halftone.wgsl`.

use bevy::math::{UVec2, UVec4};
use bevy_comics::{
    Halftone,
    effect::linear_rgb,
    effects::{HalftoneMode, ScreenAnchor, ScreenSampling, ScreenShape},
};

use super::{Rgb, Rgba, color, mix, screen, sheet::Sheet, similarity::Similarity, smoothstep};

/// Where a screen is read: the plate's angle, the size of a cell in pixels, the phase in cells.
#[derive(Clone, Copy, Debug)]
pub struct Plate {
    pub degrees: f64,
    pub cell_size: f64,
    pub phase: f64,
    /// Number of the plate: 0 cyan, 1 magenta, 2 yellow, 3 black.
    pub number: i32,
    /// How far edges of ink are displaced at most, in pixels, and the height of the sheet.
    pub ink_bleed: f64,
    pub height: f64,
}

impl Plate {
    /// The plates of an effect at a scale factor.
    pub fn all(s: &Halftone, scale: f64) -> [Self; 4] {
        let angles = [s.cyan_angle, s.magenta_angle, s.yellow_angle, s.black_angle];
        std::array::from_fn(|i| Self {
            degrees: f64::from(angles[i]),
            cell_size: f64::from(s.cell_size) * scale,
            phase: if i == 3 { 0.25 } else { 0.0 },
            number: i as i32,
            ink_bleed: 0.0,
            height: 0.0,
        })
    }

    /// Cells of a place in pixels.
    pub fn cell(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.degrees.to_radians().sin_cos();
        [(cos * x + sin * y), (cos * y - sin * x)].map(|v| v / self.cell_size + self.phase)
    }
}

/// Coverages by a plate of one tone: a function of the place in pixels. `tile`: threshold of
/// a grain by column and row, 0 to 1.
pub fn plate_cover<'a>(
    shape: ScreenShape,
    plate: Plate,
    tone: f64,
    tile: &'a dyn Fn(i64, i64) -> f64,
) -> Box<dyn Fn([f64; 2]) -> f64 + 'a> {
    let t = tone.clamp(screen::LEAST, 1.0 - screen::LEAST);
    let moved = screen::edges(shape, t) * plate.ink_bleed / plate.cell_size;
    let printed = t - moved.min(0.9 * t.min(1.0 - t)) * plate.height;
    let (sin, cos) = plate.degrees.to_radians().sin_cos();
    let cell_size = plate.cell_size;
    // The width of a pixel across lines along x or y of the cell.
    let across = (sin.abs() + cos.abs()) / cell_size;
    let shaped: Box<dyn Fn([f64; 2]) -> f64> = match shape {
        ScreenShape::Round => Box::new(move |p| screen::disc(plate.cell(p), printed, cell_size)),
        ScreenShape::Euclidean => {
            Box::new(move |p| screen::euclidean(plate.cell(p), printed, cell_size))
        }
        ScreenShape::Line => Box::new(move |p| screen::line(plate.cell(p)[0], printed, across)),
        ScreenShape::Diamond => {
            Box::new(move |p| screen::diamond(plate.cell(p), printed, cell_size))
        }
        ScreenShape::Cross => {
            Box::new(move |p| screen::cross_lines(plate.cell(p), printed, across))
        }
        ScreenShape::Stochastic => Box::new(move |p| {
            let size = (cell_size / 3.0).max(1.0);
            stochastic(p, size, printed, |x, y| {
                let number = i64::from(plate.number);
                tile(x + 19 * number, y + 37 * number)
            })
        }),
        other => panic!("no reference of {other:?}"),
    };
    Box::new(move |place| {
        let k = shaped(place);
        if tone < screen::LEAST {
            k * tone / screen::LEAST
        } else if tone > 1.0 - screen::LEAST {
            1.0 - (1.0 - k) * (1.0 - tone) / screen::LEAST
        } else {
            k
        }
    })
}

/// Coverages by a plate of one tone that follows an object: a function of the pixel in the
/// render target.
pub fn followed_cover<'a>(
    shape: ScreenShape,
    plate: Plate,
    follows: &Similarity,
    tone: f64,
    tile: &'a dyn Fn(i64, i64) -> f64,
) -> Box<dyn Fn([f64; 2]) -> f64 + 'a> {
    let grains = shape == ScreenShape::Stochastic;
    let octave = |size: f64| {
        let plate = Plate {
            degrees: plate.degrees + follows.turn,
            cell_size: plate.cell_size * if grains { 1.0 } else { size },
            ..plate
        };
        let shown = smoothstep(1.5, 2.5, plate.cell_size);
        let cover = plate_cover(shape, plate, tone, tile);
        move |place| {
            if grains {
                cover(place)
            } else {
                mix(tone, cover(place), shown)
            }
        }
    };
    let (own, other) = (octave(follows.size), octave(follows.other));
    let (origin, fade) = (follows.origin, follows.fade);
    Box::new(move |at| {
        let place = [0, 1].map(|i| at[i] - origin[i]);
        mix(own(place), other(place), fade)
    })
}

/// The mean over the pixel around a place of grains of a size.
fn stochastic([x, y]: [f64; 2], size: f64, tone: f64, tile: impl Fn(i64, i64) -> f64) -> f64 {
    let spans = [x, y].map(|v| {
        let (low, high) = ((v - 0.5) / size, (v + 0.5) / size);
        let first = low.floor();
        let second = ((high - first - 1.0) / (high - low)).clamp(0.0, 1.0);
        (first as i64, [1.0 - second, second])
    });
    let [(column, across), (row, down)] = spans;
    let mut sum = 0.0;
    for (j, down) in down.into_iter().enumerate() {
        for (i, across) in across.into_iter().enumerate() {
            let threshold = tile(column + i as i64, row + j as i64);
            sum += down * across * screen::grain(tone, threshold);
        }
    }
    sum
}

/// The tones of the plates for a color in linear light.
pub fn plate_tones(s: &Halftone, linear: Rgb) -> [f64; 4] {
    let [solid_below, bare_above] = [s.solid_below, s.bare_above].map(f64::from);
    let span = (bare_above - solid_below).max(0.05);
    let c = linear.map(|c| {
        let level = (c.clamp(0.0, 1.0).sqrt() - solid_below) / span;
        level.clamp(0.0, 1.0).powi(2)
    });
    let dark = 1.0 - color::luminance(c);
    let tones = match s.mode {
        HalftoneMode::Cmyk => color::separated(c, f64::from(s.black_generation)),
        HalftoneMode::Spot => [0.0, 0.0, 0.0, dark],
        HalftoneMode::Duotone => {
            let ink = linear_rgb(s.cyan).to_array().map(f64::from);
            let pivot = (1.0 - color::luminance(ink)).clamp(0.05, 0.95);
            [dark / pivot, 0.0, 0.0, (dark - pivot) / (1.0 - pivot)]
        }
        HalftoneMode::Rgb => [c[0], c[1], c[2], 0.0],
        other => panic!("no reference of {other:?}"),
    };
    tones.map(|tone| {
        let tone = screen::tinted(tone.clamp(0.0, 1.0), s.tints);
        screen::gained(tone, f64::from(s.gain))
    })
}

/// The light of inks on paper.
pub fn inked(s: &Halftone, k: [f64; 4]) -> Rgb {
    if s.mode == HalftoneMode::Rgb {
        return [k[0], k[1], k[2]];
    }
    let light = |ink| linear_rgb(ink).to_array().map(f64::from);
    let inks = [s.cyan, s.magenta, s.yellow, s.black].map(light);
    let paper = light(s.paper);
    std::array::from_fn(|c| (0..4).fold(paper[c], |light, i| light * mix(1.0, inks[i][c], k[i])))
}

pub fn screen_amount(s: &Halftone, linear: Rgb, d: f64) -> f64 {
    let below = f64::from(s.shadows_only_below);
    let shade = 1.0 - smoothstep(below, below + 0.1, color::lightness(linear));
    mix(f64::from(s.at_near), f64::from(s.at_far), d) * shade
}

/// Where the screens begin, in pixels of the target.
pub fn center(s: &Halftone, viewport: UVec4, target: UVec2) -> [f64; 2] {
    let [first, size] = match s.anchor {
        ScreenAnchor::View | ScreenAnchor::Object => {
            [[viewport.x, viewport.y], [viewport.z, viewport.w]]
        }
        ScreenAnchor::Window => [[0, 0], target.to_array()],
        other => panic!("no reference of {other:?}"),
    };
    [0, 1].map(|i| f64::from(first[i] + size[i] / 2) + 0.25)
}

/// What a screen reads besides its pixel.
pub struct Cells<'a> {
    /// Where the screens begin, in pixels of the target.
    pub center: [f64; 2],
    /// The sheet that is printed on.
    pub sheet: Sheet,
    /// The picture at a place: a color multiplied by its opacity, and the opacity.
    pub picture: &'a dyn Fn([f64; 2]) -> Rgba,
}

/// The mean color of four places in the cell of a plate around a pixel at `at`.
fn cell_color(plate: Plate, cells: &Cells, at: [f64; 2], own: Rgb) -> Rgb {
    let place = [0, 1].map(|i| at[i] - cells.center[i]);
    let middle = plate.cell(place).map(f64::round);
    let (sin, cos) = plate.degrees.to_radians().sin_cos();
    let mut sum = [0.0; 3];
    for [u, v] in [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]] {
        let [u, v] = [middle[0] + u, middle[1] + v].map(|w| (w - plate.phase) * plate.cell_size);
        let place = [cos * u - sin * v, sin * u + cos * v];
        let found = (cells.picture)([0, 1].map(|i| cells.center[i] + place[i]));
        for (c, sum) in sum.iter_mut().enumerate() {
            *sum += 0.25 * (found[c] + (1.0 - found[3]) * own[c]);
        }
    }
    sum
}

/// The print of a pixel, at a scale factor of 1: `picture` is its color multiplied by its
/// opacity, and the opacity; `at` its center in pixels of the target; `d` its depth map. Not
/// of grains.
pub fn halftone(s: &Halftone, picture: Rgba, at: [f64; 2], d: f64, cells: &Cells) -> Rgb {
    let alpha = picture[3];
    let linear = [0, 1, 2].map(|c| picture[c] / alpha.max(1e-3));
    let own = plate_tones(s, linear);
    let amount = screen_amount(s, linear, d);
    let place = [0, 1].map(|i| at[i] - cells.center[i]);
    let k = std::array::from_fn(|i| {
        let plate = Plate {
            ink_bleed: 0.5 * cells.sheet.ink_bleed,
            height: cells.sheet.under(at).height,
            ..Plate::all(s, 1.0)[i]
        };
        let tone = match s.sampling {
            ScreenSampling::Cell => plate_tones(s, cell_color(plate, cells, at, linear))[i],
            _ => own[i],
        };
        let cover = plate_cover(s.shape, plate, tone, &|_, _| 0.5);
        mix(tone, cover(place), amount)
    });
    let print = inked(s, k);
    std::array::from_fn(|c| mix(picture[c], print[c] * alpha, f64::from(s.opacity)))
}
