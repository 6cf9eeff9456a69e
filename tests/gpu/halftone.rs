//! Halftone: mean tones, moire, continuity, and pictures against the twin.

use std::f64::consts::TAU;

use bevy::{
    anti_alias::fxaa::Fxaa,
    camera::{Hdr, Viewport},
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::{
    ComicStyle, ComicsStage, DepthMap, DepthMapping, Halftone, HalftoneMode, Outlines,
    ScreenAnchor, ScreenSampling, ScreenShape, Silhouettes, ToneBands,
};
use bevy_comics_testkit::{
    headless::HeadlessOptions,
    reference::{
        color,
        halftone::{Plate, inked, plate_cover, plate_tones},
    },
    studio::with_map,
};

use crate::{
    functions::halftone::SHAPES,
    pictures::assert_pass_is_its_twin,
    small::{Small, linear, options},
};

/// The angles of the plates.
const ANGLES: [f64; 4] = [15.0, 75.0, 0.0, 45.0];
const PERIODS: [f64; 5] = [3.0, 4.0, 6.0, 8.0, 12.5];

/// Thresholds of grains by column and row: each of 256 classes as often as the others.
fn tile(x: i64, y: i64) -> f64 {
    let i = (y.rem_euclid(64) * 64 + x.rem_euclid(64)) as u32;
    (f64::from(i.wrapping_mul(37) & 255) + 0.5) / 256.0
}

fn plate(degrees: f64, period: f64) -> Plate {
    Plate {
        degrees,
        period,
        phase: 0.0,
        number: 0,
        spread: 0.0,
        height: 0.0,
    }
}

/// Inks and paper that print exactly the light that the plates ask for.
pub fn ideal() -> Halftone {
    Halftone {
        cyan: Color::srgb(0.0, 1.0, 1.0),
        magenta: Color::srgb(1.0, 0.0, 1.0),
        yellow: Color::srgb(1.0, 1.0, 0.0),
        black: Color::BLACK,
        paper: Color::WHITE,
        ..default()
    }
}

fn ideal_spot(shape: ScreenShape, period: f32) -> Halftone {
    Halftone {
        mode: HalftoneMode::Spot,
        shape,
        period,
        ..ideal()
    }
}

/// Pixels of a square whose side is a multiple of the period, around where screens begin.
fn square(period: f64) -> impl Iterator<Item = [f64; 2]> + Clone {
    let side = (period * (250.0 / period).floor()).round() as i32;
    (0..side)
        .flat_map(move |y| (0..side).map(move |x| [x, y].map(|v| f64::from(v - side / 2) + 0.25)))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
    sum / f64::from(count)
}

/// 11 tones, 6 shapes, 5 periods, 4 angles: the mean of a flat area is its tone.
#[test]
fn flat_fields_have_their_tone() {
    let mut worst = Vec::new();
    for shape in SHAPES {
        for period in PERIODS {
            let mut most = (0.0, 0.0, 0.0);
            for degrees in ANGLES {
                for tone in (0..=10).map(|i| f64::from(i) / 10.0) {
                    let cover = plate_cover(shape, plate(degrees, period), tone, &tile);
                    let error = mean(square(period).map(cover)) - tone;
                    if error.abs() > f64::abs(most.0) {
                        most = (error, tone, degrees);
                    }
                }
            }
            let exact = [ScreenShape::Round, ScreenShape::Line, ScreenShape::Diamond];
            let limit = match (period, exact.contains(&shape)) {
                (3.0, _) => 0.015,
                (_, true) => 0.005,
                (_, false) => 0.01,
            };
            println!("{shape:?}, {period} px: {most:?} (error, tone, degrees)");
            worst.push((shape, period, most, limit));
        }
    }
    worst.retain(|(_, _, (error, _, _), limit)| error.abs() > *limit);
    assert!(worst.is_empty(), "{worst:#?}");
}

/// The mean light of a print of a flat colour, with this phase of the black plate.
fn printed_mean(s: &Halftone, tones: [f64; 4], phase: f64) -> [f64; 3] {
    let plates = Plate::all(s, 1.0);
    let covers: [_; 4] = std::array::from_fn(|i| {
        let phase = if i == 3 { phase } else { 0.0 };
        plate_cover(s.shape, Plate { phase, ..plates[i] }, tones[i], &tile)
    });
    let prints = square(6.0).map(|place| inked(s, std::array::from_fn(|i| covers[i](place))));
    let (sum, count) = prints.fold(([0.0; 3], 0.0), |(sum, count), print| {
        ([0, 1, 2].map(|c| sum[c] + print[c]), count + 1.0)
    });
    sum.map(|v| v / count)
}

fn largest_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max)
}

/// 20 colours, at three fractions of black. With ideal inks, the mean light is the colour.
/// With real ones, it is that of independent screens (Demichel), which needs the phase of
/// black: where three inks take away the same light, the screens of cyan, magenta and black
/// would not be independent.
#[test]
fn flat_colours_have_their_light_and_need_the_phase_of_black() {
    let colors = (0..20u32).map(|i| {
        let part = |k: u32| f64::from((i * 7 + 3) * k % 19) / 18.0;
        [part(5), part(11), part(13)]
    });
    let mut without = 0.0;
    let greys = [0.25, 0.4, 0.6].map(|v| [v; 3]);
    for light in colors.chain(greys) {
        for black_generation in [0.0, 0.5, 1.0] {
            let s = Halftone {
                black_generation,
                ..ideal()
            };
            let tones = plate_tones(&s, light);
            let off = largest_difference(printed_mean(&s, tones, 0.25), light);
            assert!(off < 0.01, "{light:?}, black {black_generation}: {off}");
            // Inks that each take some of all light away.
            let grey = Color::linear_rgb(0.2, 0.2, 0.2);
            let real = Halftone {
                cyan: grey,
                magenta: grey,
                yellow: Color::WHITE,
                ..s
            };
            let independent = inked(&real, tones);
            let off = |phase| largest_difference(printed_mean(&real, tones, phase), independent);
            assert!(
                off(0.25) < 0.01,
                "{light:?}, black {black_generation}: {}",
                off(0.25)
            );
            without = f64::max(without, off(0.0));
        }
    }
    println!("without the phase of black: {without}");
    assert!(
        without > 0.01,
        "{without}: the phase of black is not needed"
    );
}

/// No pixel changes by more than 0.1 when the tone changes by 1 / 1024.
#[test]
fn no_pixel_jumps() {
    for shape in SHAPES {
        for period in PERIODS.into_iter().chain([2.5, 40.0]) {
            let places: Vec<_> = (0..300)
                .map(|i| [f64::from(i) * 1.618 % 50.0, f64::from(i) * 2.414 % 50.0])
                .collect();
            let mut before = vec![0.0; places.len()];
            let mut most = (0.0, 0.0);
            for step in 0..=1024 {
                let tone = f64::from(step) / 1024.0;
                let cover = plate_cover(shape, plate(15.0, period), tone, &tile);
                for (place, before) in places.iter().zip(&mut before) {
                    let k = cover(*place);
                    if (k - *before).abs() > most.0 {
                        most = ((k - *before).abs(), tone);
                    }
                    *before = k;
                }
            }
            println!("{shape:?}, {period} px: {most:?} (jump, tone)");
            assert!(most.0 <= 0.1, "{shape:?}, {period} px: {most:?}");
        }
    }
}

/// A slow gradient and a zone plate: what is left of the print minus the picture below
/// half of the screen's frequency is less than 1 % of the power of the screen.
#[test]
fn there_is_no_moire() {
    const SIDE: usize = 240;
    for shape in SHAPES {
        for period in [4.0, 6.0] {
            for degrees in [0.0, 15.0, 45.0] {
                for zones in [false, true] {
                    let tone = |x: f64, y: f64| {
                        if zones {
                            // At the border: a period of 12 cells.
                            let frequency = 1.0 / (12.0 * period);
                            let square = (x * x + y * y) / (SIDE as f64 / 2.0);
                            0.5 + 0.35 * (0.5 * TAU * frequency * square).cos()
                        } else {
                            0.5 + x / SIDE as f64
                        }
                    };
                    let mut rest = vec![0.0; SIDE * SIDE];
                    for (i, rest) in rest.iter_mut().enumerate() {
                        let [x, y] =
                            [i % SIDE, i / SIDE].map(|v| v as f64 + 0.25 - SIDE as f64 / 2.0);
                        // As the picture stores it: 8 bits.
                        let tone = (tone(x, y).clamp(0.0, 1.0) * 255.0).round() / 255.0;
                        *rest = plate_cover_once(shape, degrees, period, tone, [x, y]) - tone;
                    }
                    let power = mean(rest.iter().map(|v| v * v));
                    let slow = blurred(&rest, SIDE, 1.2 * period);
                    let margin = (3.0 * period) as usize;
                    let inside = (margin..SIDE - margin)
                        .flat_map(|y| (margin..SIDE - margin).map(move |x| y * SIDE + x));
                    let moire = mean(inside.map(|i| slow[i] * slow[i])) / power;
                    assert!(
                        moire < 0.01,
                        "{shape:?}, {period} px, {degrees} degrees, zones {zones}: {moire}"
                    );
                }
            }
        }
    }
}

fn plate_cover_once(
    shape: ScreenShape,
    degrees: f64,
    period: f64,
    tone: f64,
    place: [f64; 2],
) -> f64 {
    // The threshold of a tile without order has power at all frequencies.
    let even = |x: i64, y: i64| blue(x, y);
    plate_cover(shape, plate(degrees, period), tone, &even)(place)
}

/// Thresholds without slow parts: the golden ratio along a lattice (Roberts 2018).
fn blue(x: i64, y: i64) -> f64 {
    (0.754_877_666 * x as f64 + 0.569_840_291 * y as f64).rem_euclid(1.0)
}

/// A Gaussian blur of a square picture.
fn blurred(picture: &[f64], side: usize, sigma: f64) -> Vec<f64> {
    let reach = (3.0 * sigma) as i64;
    let weights: Vec<f64> = (-reach..=reach)
        .map(|d| (-0.5 * (d as f64 / sigma).powi(2)).exp())
        .collect();
    let total: f64 = weights.iter().sum();
    let pass = |from: &[f64], dx: i64, dy: i64| -> Vec<f64> {
        (0..side * side)
            .map(|i| {
                let (x, y) = ((i % side) as i64, (i / side) as i64);
                let last = side as i64 - 1;
                let at = |d: i64| {
                    let (x, y) = (x + d * dx, y + d * dy);
                    from[(y.clamp(0, last) * side as i64 + x.clamp(0, last)) as usize]
                };
                let sum = (-reach..=reach).zip(&weights).map(|(d, w)| w * at(d));
                sum.sum::<f64>() / total
            })
            .collect()
    };
    pass(&pass(picture, 1, 0), 0, 1)
}

/// A camera that sees one colour alone.
pub fn flat(options: HeadlessOptions, light: [f32; 3]) -> Small {
    let mut small = Small::with(options, Msaa::Off);
    small.clear();
    fill(&mut small, Color::linear_rgb(light[0], light[1], light[2]));
    small
}

fn fill(small: &mut Small, color: Color) {
    let entity = small.camera;
    let mut camera = small.world().get_mut::<Camera>(entity).expect("a camera");
    camera.clear_color = color.into();
}

/// The mean light of a picture.
fn mean_light(small: &mut Small) -> [f64; 3] {
    let picture = small.picture();
    let (width, height) = picture.dimensions();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    [0, 1, 2].map(|c| mean(pixels.clone().map(|(x, y)| linear(&picture, x, y)[c])))
}

/// Rendered: every shape, in one ink. A code of the display is up to 0.009 in light, but the
/// rounding of many different coverages cancels.
#[test]
fn rendered_flats_have_their_tone() {
    let mut small = flat(options(UVec2::new(240, 240)), [0.5; 3]);
    for shape in SHAPES {
        for (period, tone) in [(4.0, 0.3), (6.0, 0.85), (12.0, 0.6)] {
            fill(
                &mut small,
                Color::linear_rgb(1.0 - tone, 1.0 - tone, 1.0 - tone),
            );
            small.style(&ComicStyle::new());
            small.settle();
            let want = mean_light(&mut small)[0];
            small.style(&ComicStyle::new().with(ideal_spot(shape, period)));
            small.settle();
            assert!(small.ran(ComicsStage::of::<Halftone>()));
            let found = mean_light(&mut small)[0];
            assert!(
                (found - want).abs() < 0.01,
                "{shape:?}, {period} px, {tone}: {found}, {want}"
            );
        }
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn rendered_colours_have_their_light() {
    let mut small = flat(options(UVec2::new(240, 240)), [0.5; 3]);
    for light in [
        [0.8, 0.3, 0.1],
        [0.1, 0.4, 0.7],
        [0.25, 0.25, 0.25],
        [0.6, 0.6, 0.05],
    ] {
        for mode in [HalftoneMode::Cmyk, HalftoneMode::Rgb] {
            fill(&mut small, Color::linear_rgb(light[0], light[1], light[2]));
            small.style(&ComicStyle::new());
            small.settle();
            let want = mean_light(&mut small);
            small.style(&ComicStyle::new().with(Halftone { mode, ..ideal() }));
            small.settle();
            let found = mean_light(&mut small);
            for c in 0..3 {
                assert!(
                    (found[c] - want[c]).abs() < 0.01,
                    "{mode:?}, {light:?}: {found:?}, {want:?}"
                );
            }
        }
    }
}

/// Two inks have the luminance of the picture, if the second is black.
#[test]
fn a_duotone_has_the_luminance() {
    let mut small = flat(options(UVec2::new(240, 240)), [0.5; 3]);
    for tone in [0.1, 0.3, 0.5, 0.8] {
        fill(&mut small, Color::linear_rgb(tone, tone, tone));
        let s = Halftone {
            mode: HalftoneMode::Duotone,
            cyan: Color::srgb(0.95, 0.45, 0.2),
            ..ideal()
        };
        small.style(&ComicStyle::new().with(s));
        small.settle();
        let found = color::luminance(mean_light(&mut small));
        assert!((found - f64::from(tone)).abs() < 0.012, "{tone}: {found}");
    }
}

fn screened(s: Halftone) -> ComicStyle {
    let style = ComicStyle::new().with(s).with(Outlines::default());
    let map = DepthMap {
        mapping: DepthMapping::MinMax,
        ..default()
    };
    with_map(style, map)
}

/// The whole pass, pixel by pixel, in every mode; in two passes where cells are read.
#[test]
fn every_pixel_is_its_twins() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for (mode, shape) in [
        (HalftoneMode::Cmyk, ScreenShape::Euclidean),
        (HalftoneMode::Spot, ScreenShape::Round),
        (HalftoneMode::Duotone, ScreenShape::Line),
        (HalftoneMode::Rgb, ScreenShape::Cross),
    ] {
        for sampling in [ScreenSampling::Pixel, ScreenSampling::Cell] {
            let s = Halftone {
                mode,
                shape,
                sampling,
                near: 1.0,
                far: 0.3,
                gain: 0.1,
                below: 0.7,
                ..default()
            };
            let what = format!("{mode:?}, {shape:?}, {sampling:?}");
            assert_pass_is_its_twin(&mut small, &screened(s), None, &what);
        }
    }
    assert_eq!(small.errors(), 0);
}

/// Screens begin in the middle of a viewport, and nothing is printed outside of it.
#[test]
fn viewports_are_pages_or_parts_of_one() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let viewport = [11, 5, 43, 30];
    small.insert(Camera {
        clear_color: Color::srgb(0.3, 0.5, 0.8).into(),
        viewport: Some(Viewport {
            physical_position: UVec2::new(viewport[0], viewport[1]),
            physical_size: UVec2::new(viewport[2], viewport[3]),
            ..default()
        }),
        ..default()
    });
    for anchor in [ScreenAnchor::View, ScreenAnchor::Window] {
        for sampling in [ScreenSampling::Pixel, ScreenSampling::Cell] {
            let s = Halftone {
                anchor,
                sampling,
                near: 0.5,
                ..default()
            };
            let what = format!("{anchor:?}, {sampling:?}");
            assert_pass_is_its_twin(&mut small, &screened(s), Some(viewport), &what);
        }
    }
}

/// A period in logical pixels, at any scale factor, is that many physical pixels times the
/// factor.
#[test]
fn periods_are_logical() {
    let shot = |scale_factor: f32, period: f32| {
        let options = HeadlessOptions {
            scale_factor,
            ..options(UVec2::new(96, 64))
        };
        let mut small = Small::with(options, Msaa::Off);
        small.style(&ComicStyle::new().with(Halftone {
            period,
            ..default()
        }));
        small.settle();
        small.picture()
    };
    assert_eq!(shot(1.0, 12.0), shot(3.0, 4.0));
    assert_eq!(shot(1.0, 10.0), shot(1.25, 8.0));
    assert_ne!(shot(1.0, 10.0), shot(1.0, 8.0));
}

/// Too fine for the screen: plain tones, the picture itself with ideal inks. Settings out of
/// their ranges are those at the end of it, or the defaults.
#[test]
fn impossible_periods_show_a_picture() {
    let options = HeadlessOptions {
        scale_factor: 0.1,
        ..options(UVec2::new(96, 64))
    };
    let mut small = Small::with(options, Msaa::Off);
    small.settle();
    let plain = small.picture();
    let apart = |a: &image::RgbaImage, b: &image::RgbaImage| {
        let pairs = a.as_raw().iter().zip(b.as_raw());
        pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    };
    for period in [0.0, f32::NAN, f32::INFINITY, 3e38] {
        for shape in [
            ScreenShape::Euclidean,
            ScreenShape::Line,
            ScreenShape::Stochastic,
        ] {
            let s = Halftone {
                period,
                shape,
                ..ideal()
            };
            small.style(&ComicStyle::new().with(s));
            small.settle();
            // 2.5 and 6 logical pixels, and 40: 4 physical ones.
            if period != 3e38 && shape != ScreenShape::Stochastic {
                assert!(apart(&small.picture(), &plain) <= 1, "{period}, {shape:?}");
            } else {
                assert_ne!(small.picture(), plain, "{period}, {shape:?}");
            }
        }
    }
    assert_eq!(small.errors(), 0);
}

/// Nothing is printed where nothing is, and floating-point targets hold finite light.
#[test]
fn backgrounds_stay_transparent_and_light_stays_finite() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for sampling in [ScreenSampling::Pixel, ScreenSampling::Cell] {
        fill(&mut small, Color::NONE);
        let s = Halftone {
            sampling,
            ..default()
        };
        small.style(&ComicStyle::new().with(s));
        small.settle();
        let (before, after) = small.pass();
        let mut empty = 0;
        for (before, after) in before.pixels.iter().zip(&after.pixels) {
            assert_eq!(before[3], after[3], "opacity stays");
            if before[3] == 0.0 {
                assert_eq!(after[..3], [0.0; 3]);
                empty += 1;
            }
        }
        assert!(empty > 100, "{empty} pixels of background");
    }
    small.insert(Hdr);
    fill(&mut small, Color::linear_rgb(40.0, 9.0, 0.5));
    for sampling in [ScreenSampling::Pixel, ScreenSampling::Cell] {
        let s = Halftone {
            sampling,
            ..ideal()
        };
        small.style(&ComicStyle::new().with(s));
        small.settle();
        let (_, after) = small.pass();
        let ok = after.pixels.iter().flatten();
        assert!(ok.copied().all(|v| (0.0..=1.001).contains(&v)));
    }
    assert_eq!(small.errors(), 0);
}

/// The pixels that a style covers with ink of its outlines entirely: they are black with
/// black lines, and white with white ones.
pub fn covered(small: &mut Small, style: &ComicStyle) -> Vec<bool> {
    let mut shot = |color: Color| {
        let outlines = Outlines {
            width: 3.0,
            silhouettes: Some(Silhouettes { color, ..default() }),
            creases: None,
            objects: None,
            ..default()
        };
        small.style(&style.clone().with(outlines));
        small.settle();
        small.picture()
    };
    let (black, white) = (shot(Color::BLACK), shot(Color::WHITE));
    let pairs = black.pixels().zip(white.pixels());
    pairs
        .map(|(black, white)| black.0[..3] == [0; 3] && white.0[..3] == [255; 3])
        .collect()
}

/// Lines are drawn over the print: they cover the pixels that they cover without one.
#[test]
fn lines_stay_sharp() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let bare = covered(&mut small, &ComicStyle::new());
    let printed = covered(&mut small, &ComicStyle::new().with(Halftone::default()));
    assert!(bare.iter().filter(|covered| **covered).count() > 100);
    assert_eq!(bare, printed);
}

/// FXAA would smear the dots: printed views are styled after it. Lines without a print are
/// still smoothed.
#[test]
fn dots_are_drawn_after_fxaa() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    small.clear();
    let picture = |small: &mut Small, style: &ComicStyle| {
        small.style(style);
        small.settle();
        small.picture()
    };
    let dots = ComicStyle::new().with(ideal_spot(ScreenShape::Round, 6.0));
    let bare = picture(&mut small, &dots);
    small.insert(Fxaa::default());
    assert_eq!(picture(&mut small, &dots), bare);
    // FXAA does something here.
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let lines = ComicStyle::new().with(Outlines::default());
    let bare = picture(&mut small, &lines);
    small.insert(Fxaa::default());
    assert_ne!(picture(&mut small, &lines), bare);
}

/// Effects of all stages at once, with surface lines, MSAA, and an object's own colours.
#[test]
fn all_stages_work_together() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut small = Small::new(UVec2::new(72, 48), msaa);
        let style = screened(Halftone {
            sampling: ScreenSampling::Cell,
            tints: 0,
            ..default()
        })
        .with(ToneBands::default());
        assert_pass_is_its_twin(&mut small, &style, None, &format!("{msaa:?}"));
        assert_eq!(small.errors(), 0);
    }
}
