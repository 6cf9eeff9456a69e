//! Halftone: mean tones, moire, continuity, and pictures against the reference.

use bevy::anti_alias::contrast_adaptive_sharpening::ContrastAdaptiveSharpening;
use bevy_comics_testkit::{
    reference::{
        color,
        halftone::{Plate, inked, plate_tones},
    },
    screens::{
        PERIODS, color_error, colors, grey_inks, ideal, in_phase, largest_jump, mean, moire,
        moire_of_inks, tone_error,
    },
};

use crate::{pictures::assert_pass_matches_the_reference, prelude::*};

fn ideal_spot(shape: ScreenShape, period: f32) -> Halftone {
    Halftone {
        mode: HalftoneMode::Spot,
        shape,
        cell_size: period,
        ..ideal()
    }
}

/// 11 tones, 6 shapes, 5 periods, 4 angles: the mean of a flat area is its tone. Fewer are rendered, by
/// `rendered_flats_have_their_tone`.
#[test]
#[ignore = "long: 1,320 flat areas in double precision"]
fn flat_fields_have_their_tone() {
    let mut worst = Vec::new();
    for shape in SHAPES {
        for period in PERIODS {
            let most = tone_error(shape, period);
            let exact = [ScreenShape::Round, ScreenShape::Line, ScreenShape::Diamond];
            let limit = if exact.contains(&shape) { 0.005 } else { 0.01 };
            println!("{shape:?}, {period} px: {most:?} (error, tone, degrees)");
            worst.push((shape, period, most, limit));
        }
    }
    worst.retain(|(_, _, (error, _, _), limit)| error.abs() > *limit);
    assert!(worst.is_empty(), "{worst:#?}");
}

fn with_black(black_generation: f32) -> Halftone {
    Halftone {
        black_generation,
        ..ideal()
    }
}

/// 20 colours, at three fractions of black, are divided among ideal inks without a rest.
#[test]
fn ideal_inks_print_every_colour() {
    for s in [0.0, 0.5, 1.0].map(with_black) {
        for light in colors() {
            let separated = inked(&s, plate_tones(&s, light));
            for c in 0..3 {
                let apart = (separated[c] - light[c]).abs();
                assert!(apart < 1e-9, "{light:?}: {separated:?}");
            }
        }
    }
}

/// 20 colours and three greys, with half of the black and with the plates of the effect. With real
/// inks, the mean light is that of independent screens (Demichel), which needs the phase of black:
/// where three inks take away the same light, the screens of cyan, magenta and black would not be
/// independent.
#[test]
fn flat_colours_have_their_light_and_need_the_phase_of_black() {
    let real = grey_inks(with_black(0.5));
    let off = color_error(&real, Plate::all(&real, 1.0));
    assert!(off < 0.01, "{off}");
    assert_needs_phase(color_error(&real, in_phase(&real)));
}

/// The same at three fractions of black, and with ideal inks, of which the mean light is the colour.
#[test]
#[ignore = "long: three fractions of black, in double precision"]
fn flat_colours_have_their_light_at_every_fraction_of_black() {
    let mut without = 0.0;
    for s in [0.0, 0.5, 1.0].map(with_black) {
        for s in [s, grey_inks(s)] {
            let off = color_error(&s, Plate::all(&s, 1.0));
            assert!(off < 0.01, "black {}: {off}", s.black_generation);
        }
        let real = grey_inks(s);
        without = f64::max(without, color_error(&real, in_phase(&real)));
    }
    assert_needs_phase(without);
}

fn assert_needs_phase(without: f64) {
    println!("without the phase of black: {without}");
    assert!(
        without > 0.01,
        "{without}: the phase of black is not needed"
    );
}

/// No pixel changes by more than 0.1 when the tone changes by 1 / 1024.
#[test]
fn no_pixel_jumps() {
    assert_no_jumps(&[2.5, 6.0, 40.0]);
}

#[test]
#[ignore = "long: five periods, in double precision"]
fn no_pixel_jumps_at_any_period() {
    assert_no_jumps(&PERIODS);
}

fn assert_no_jumps(periods: &[f64]) {
    for shape in SHAPES {
        for &period in periods {
            let most = largest_jump(shape, period);
            println!("{shape:?}, {period} px: {most:?} (jump, tone)");
            assert!(most.0 <= 0.1, "{shape:?}, {period} px: {most:?}");
        }
    }
}

/// A slow gradient and a zone plate: what is left of the print minus the picture below
/// half of the screen's frequency is less than 1 % of the power of the screen.
#[test]
fn there_is_no_moire() {
    assert_no_moire(&[(4.0, 15.0), (6.0, 45.0)]);
}

#[test]
#[ignore = "long: three angles of two periods, in double precision"]
fn there_is_no_moire_at_any_angle() {
    let angles = [0.0, 15.0, 45.0].map(|degrees| [(4.0, degrees), (6.0, degrees)]);
    assert_no_moire(angles.as_flattened());
}

/// `screens`: periods in pixels, and degrees.
fn assert_no_moire(screens: &[(f64, f64)]) {
    for shape in SHAPES {
        for &(period, degrees) in screens {
            for zones in [false, true] {
                let moire = moire(shape, period, degrees, zones);
                assert!(
                    moire < 0.01,
                    "{shape:?}, {period} px, {degrees} degrees, zones {zones}: {moire}"
                );
            }
        }
    }
}

/// The same of a grey print with four inks, whose screens beat with each other.
#[test]
fn four_screens_do_not_beat() {
    for black_generation in [0.0, 0.5, 1.0] {
        let s = Halftone {
            black_generation,
            ..Halftone::default()
        };
        for zones in [false, true] {
            let moire = moire_of_inks(&s, zones);
            println!("black {black_generation}, zones {zones}: {moire}");
            assert!(
                moire < 0.01,
                "black {black_generation}, zones {zones}: {moire}"
            );
        }
    }
}

/// A camera that sees one colour alone.
pub fn flat(options: HeadlessOptions, light: [f32; 3]) -> Small {
    let mut small = Small::with(options, Msaa::Off);
    small.clear();
    fill(&mut small, Color::linear_rgb(light[0], light[1], light[2]));
    small
}

pub fn fill(small: &mut Small, color: Color) {
    let entity = small.camera;
    let mut camera = small.world().get_mut::<Camera>(entity).expect("a camera");
    camera.clear_color = color.into();
}

/// The mean light of a picture in a style.
fn mean_light(small: &mut Small, style: &ComicStyle) -> [f64; 3] {
    small.style(style);
    small.settle();
    let picture = small.picture();
    let (width, height) = picture.dimensions();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    [0, 1, 2].map(|c| mean(pixels.clone().map(|(x, y)| linear(&picture, x, y)[c])))
}

/// Size of flat pictures.
const FLAT: UVec2 = UVec2::new(144, 144);

/// Rendered: every shape, in one ink. A code of the display is up to 0.009 in light, but the
/// rounding of many different coverages cancels.
#[test]
fn rendered_flats_have_their_tone() {
    let mut small = flat(options(FLAT), [0.5; 3]);
    for (period, tone) in [(4.0, 0.3), (6.0, 0.85), (12.0, 0.6)] {
        let light = 1.0 - tone;
        fill(&mut small, Color::linear_rgb(light, light, light));
        let want = mean_light(&mut small, &ComicStyle::new())[0];
        for shape in SHAPES {
            let style = ComicStyle::new().with(ideal_spot(shape, period));
            let found = mean_light(&mut small, &style)[0];
            assert!(small.ran(ComicsStage::of::<Halftone>()));
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
    let mut small = flat(options(FLAT), [0.5; 3]);
    for light in [
        [0.8, 0.3, 0.1],
        [0.1, 0.4, 0.7],
        [0.25, 0.25, 0.25],
        [0.6, 0.6, 0.05],
    ] {
        fill(&mut small, Color::linear_rgb(light[0], light[1], light[2]));
        let want = mean_light(&mut small, &ComicStyle::new());
        for mode in [HalftoneMode::Cmyk, HalftoneMode::Rgb] {
            let style = ComicStyle::new().with(Halftone { mode, ..ideal() });
            let found = mean_light(&mut small, &style);
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
    let mut small = flat(options(FLAT), [0.5; 3]);
    for tone in [0.1, 0.3, 0.5, 0.8] {
        fill(&mut small, Color::linear_rgb(tone, tone, tone));
        let s = Halftone {
            mode: HalftoneMode::Duotone,
            cyan: Color::srgb(0.95, 0.45, 0.2),
            ..ideal()
        };
        let light = mean_light(&mut small, &ComicStyle::new().with(s));
        let found = color::luminance(light);
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
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
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
                at_near: 1.0,
                at_far: 0.3,
                gain: 0.1,
                shadows_only_below: 0.7,
                ..default()
            };
            let what = format!("{mode:?}, {shape:?}, {sampling:?}");
            assert_pass_matches_the_reference(&mut small, &screened(s), None, &what);
        }
    }
    assert_eq!(small.errors(), 0);
}

/// Screens begin in the middle of a viewport, and nothing is printed outside of it.
#[test]
fn viewports_are_pages_or_parts_of_one() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    let viewport = [11, 5, 29, 20];
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
                at_near: 0.5,
                ..default()
            };
            let what = format!("{anchor:?}, {sampling:?}");
            assert_pass_matches_the_reference(&mut small, &screened(s), Some(viewport), &what);
        }
    }
}

/// A period in logical pixels, at any scale factor, is that many physical pixels times the
/// factor.
#[test]
fn periods_are_logical() {
    let size = UVec2::new(96, 64);
    let mut small = Small::new(size, Msaa::Off);
    let mut shot = |scale_factor: f32, period: f32| {
        small.headless.resize(size, scale_factor);
        small.restart(Msaa::Off);
        small.style(&ComicStyle::new().with(Halftone {
            cell_size: period,
            ..default()
        }));
        small.settle();
        small.picture()
    };
    assert_eq!(shot(1.0, 12.0), shot(3.0, 4.0));
    let ten = shot(1.0, 10.0);
    assert_eq!(ten, shot(1.25, 8.0));
    assert_ne!(ten, shot(1.0, 8.0));
}

/// Too fine for the screen: plain tones, the picture itself with ideal inks. Settings out of
/// their ranges are those at the end of it, or the defaults.
#[test]
fn impossible_periods_show_a_picture() {
    let options = HeadlessOptions {
        scale_factor: 0.1,
        ..options(UVec2::new(48, 32))
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
                cell_size: period,
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
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let bare = covered(&mut small, &ComicStyle::new());
    let printed = covered(&mut small, &ComicStyle::new().with(Halftone::default()));
    assert!(bare.iter().filter(|covered| **covered).count() > 100);
    assert_eq!(bare, printed);
}

/// FXAA, SMAA and sharpening would change dots and grain: printed views are styled after them.
/// Lines without a print are still smoothed.
#[test]
fn dots_and_grain_are_drawn_after_anti_aliasing() {
    let sharp = || ContrastAdaptiveSharpening {
        enabled: true,
        ..default()
    };
    let filter = |small: &mut Small, which: usize| {
        let mut camera = small.camera_mut();
        match which {
            0 => camera.insert(Fxaa::default()),
            1 => camera.insert(Smaa::default()),
            _ => camera.insert(sharp()),
        };
    };
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let mut picture = |style: &ComicStyle, filters: &[usize]| {
        small.restart(Msaa::Off);
        small.clear();
        fill(&mut small, Color::linear_rgb(0.55, 0.4, 0.25));
        for which in filters {
            filter(&mut small, *which);
        }
        small.style(style);
        small.settle();
        assert_eq!(small.errors(), 0);
        small.picture()
    };
    let dots = ComicStyle::new().with(ideal_spot(ScreenShape::Round, 6.0));
    let grain = ComicStyle::new().with(Paper {
        grain: 1.0,
        size: 2.0,
        ..default()
    });
    let plain = picture(&ComicStyle::new(), &[]);
    for style in [dots, grain] {
        let bare = picture(&style, &[]);
        assert_ne!(bare, plain);
        for filters in [&[0][..], &[1], &[2], &[0, 2], &[1, 2]] {
            assert_eq!(picture(&style, filters), bare, "{filters:?}: {style:?}");
        }
    }
    // Each of them does something here.
    small.restart(Msaa::Off);
    small.style(&ComicStyle::new().with(Outlines::default()));
    let mut before = small.settle().picture();
    for which in 0..3 {
        filter(&mut small, which);
        let after = small.settle().picture();
        assert_ne!(after, before, "filter {which}");
        before = after;
    }
}

/// Effects of all stages at once, with surface lines, MSAA, and an object's own colours.
#[test]
fn all_stages_work_together() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let style = screened(Halftone {
            sampling: ScreenSampling::Cell,
            tints: 0,
            ..default()
        })
        .with(ToneBands::default());
        assert_pass_matches_the_reference(&mut small, &style, None, &format!("{msaa:?}"));
        assert_eq!(small.errors(), 0);
    }
}
