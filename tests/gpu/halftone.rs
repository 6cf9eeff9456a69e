//! Halftone: mean tones, moire, continuity, and pictures against the reference.

use bevy::anti_alias::contrast_adaptive_sharpening::ContrastAdaptiveSharpening;
use bevy_comics_testkit::{
    reference::{
        color,
        halftone::{Plate, inked, plate_tones},
    },
    screens::{
        CELL_SIZES, color_error, colors, gray_inks, ideal, in_phase, largest_jump, mean, moire,
        moire_of_inks, tone_error,
    },
};

use crate::{pictures::assert_pass_matches_the_reference, prelude::*};

const SAMPLINGS: [ScreenSampling; 2] = [ScreenSampling::Pixel, ScreenSampling::Cell];

/// 11 tones, 6 shapes, 5 sizes of cells, 4 angles: the mean of a flat area is its tone. Fewer are
/// rendered, by `rendered_flats_have_their_tone`.
#[test]
#[ignore = "long: 1,320 flat areas in double precision"]
fn flat_fields_have_their_tone() {
    let mut worst = Vec::new();
    for shape in SHAPES {
        for cell_size in CELL_SIZES {
            let most = tone_error(shape, cell_size);
            let exact = [ScreenShape::Round, ScreenShape::Line, ScreenShape::Diamond];
            let limit = if exact.contains(&shape) { 0.005 } else { 0.01 };
            println!("{shape:?}, {cell_size} px: {most:?} (error, tone, degrees)");
            worst.push((shape, cell_size, most, limit));
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

/// 20 colors, at three fractions of black, are divided among ideal inks without a rest.
#[test]
fn ideal_inks_print_every_color() {
    for s in [0.0, 0.5, 1.0].map(with_black) {
        for light in colors() {
            let separated = inked(&s, plate_tones(&s, light));
            let apart = [0, 1, 2].map(|c| (separated[c] - light[c]).abs());
            assert!(apart.iter().all(|c| *c < 1e-9), "{light:?}: {separated:?}");
        }
    }
}

/// 20 colors and three grays, with half of the black and with the plates of the effect. With real
/// inks, the mean light is that of independent screens (Demichel), which needs the phase of black:
/// where three inks take away the same light, the screens of cyan, magenta and black would not be
/// independent.
#[test]
fn flat_colors_have_their_light_and_need_the_phase_of_black() {
    assert_colors_have_their_light(&[0.5], &[gray_inks]);
}

/// The same at three fractions of black, and with ideal inks, of which the mean light is the
/// color.
#[test]
#[ignore = "long: three fractions of black, in double precision"]
fn flat_colors_have_their_light_at_every_fraction_of_black() {
    assert_colors_have_their_light(&[0.0, 0.5, 1.0], &[gray_inks, |ideal| ideal]);
}

fn assert_colors_have_their_light(blacks: &[f32], inks: &[fn(Halftone) -> Halftone]) {
    let mut without = 0.0;
    for black in blacks {
        for inked in inks {
            let s = inked(with_black(*black));
            let off = color_error(&s, Plate::all(&s, 1.0));
            assert!(off < 0.01, "black {black}: {off}");
        }
        let real = gray_inks(with_black(*black));
        without = f64::max(without, color_error(&real, in_phase(&real)));
    }
    println!("without the phase of black: {without}");
    assert!(without > 0.01, "{without}: the phase is not needed");
}

/// No pixel changes by more than 0.1 when the tone changes by 1 / 1024.
#[test]
fn no_pixel_jumps() {
    assert_no_jumps(&[2.5, 40.0]);
}

#[test]
#[ignore = "long: five sizes of cells, in double precision"]
fn no_pixel_jumps_at_any_cell_size() {
    assert_no_jumps(&CELL_SIZES);
}

fn assert_no_jumps(cell_sizes: &[f64]) {
    for shape in SHAPES {
        for &cell_size in cell_sizes {
            let most = largest_jump(shape, cell_size);
            println!("{shape:?}, {cell_size} px: {most:?} (jump, tone)");
            assert!(most.0 <= 0.1, "{shape:?}, {cell_size} px: {most:?}");
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
#[ignore = "long: three angles of two sizes of cells, in double precision"]
fn there_is_no_moire_at_any_angle() {
    let angles = [0.0, 15.0, 45.0].map(|degrees| [(4.0, degrees), (6.0, degrees)]);
    assert_no_moire(angles.as_flattened());
}

/// `screens`: sizes of cells in pixels, and degrees.
fn assert_no_moire(screens: &[(f64, f64)]) {
    for shape in SHAPES {
        for &(cell_size, degrees) in screens {
            for zones in [false, true] {
                let moire = moire(shape, cell_size, degrees, zones);
                let what = format!("{shape:?}, {cell_size} px, {degrees} degrees, zones {zones}");
                assert!(moire < 0.01, "{what}: {moire}");
            }
        }
    }
}

/// The same of a gray print with four inks, whose screens beat with each other.
#[test]
fn four_screens_do_not_beat() {
    for black_generation in [0.0, 0.5, 1.0] {
        let s = Halftone {
            black_generation,
            ..default()
        };
        for zones in [false, true] {
            let moire = moire_of_inks(&s, zones);
            println!("black {black_generation}, zones {zones}: {moire}");
            assert!(moire < 0.01, "{black_generation}, {zones}: {moire}");
        }
    }
}

pub fn fill(small: &mut Small, color: Color) {
    let entity = small.camera;
    let mut camera = small.world().get_mut::<Camera>(entity).expect("a camera");
    camera.clear_color = color.into();
}

/// A camera that sees a color alone.
fn flat() -> Small {
    let mut small = Small::new(UVec2::new(144, 144), Msaa::Off);
    small.clear();
    small
}

/// The mean light of a color in linear light, without a style, and printed.
fn mean_lights(small: &mut Small, [r, g, b]: [f32; 3], s: Halftone) -> [[f64; 3]; 2] {
    fill(small, Color::linear_rgb(r, g, b));
    [ComicStyle::new(), ComicStyle::new().with(s)].map(|style| {
        let picture = small.shot(&style);
        let (width, height) = picture.dimensions();
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        [0, 1, 2].map(|c| mean(pixels.clone().map(|(x, y)| linear(&picture, x, y)[c])))
    })
}

fn assert_light_stays(small: &mut Small, light: [f32; 3], s: Halftone) {
    let [want, found] = mean_lights(small, light, s);
    assert!(small.ran(ComicsStage::of::<Halftone>()));
    let apart = [0, 1, 2].map(|c| (found[c] - want[c]).abs());
    let what = format!("{:?}, {:?}, {} px", s.mode, s.shape, s.cell_size);
    assert!(
        apart.iter().all(|c| *c < 0.01),
        "{what}: {found:?}, {want:?}"
    );
}

fn ideal_spot(shape: ScreenShape, cell_size: f32) -> Halftone {
    Halftone {
        mode: HalftoneMode::Spot,
        shape,
        cell_size,
        ..ideal()
    }
}

/// Rendered: every shape, in one ink. A code of the display is up to 0.009 in light, but the
/// rounding of many different coverages cancels.
#[test]
fn rendered_flats_have_their_tone() {
    assert_rendered_flats(FLATS.into_iter().cycle().zip(SHAPES));
}

#[test]
#[ignore = "long: every flat in every shape"]
fn rendered_flats_have_their_tone_in_every_shape() {
    let flats = FLATS.into_iter();
    assert_rendered_flats(flats.flat_map(|flat| SHAPES.map(|shape| (flat, shape))));
}

/// Periods and tones.
const FLATS: [(f32, f32); 3] = [(4.0, 0.3), (6.0, 0.85), (12.0, 0.6)];

fn assert_rendered_flats(cases: impl Iterator<Item = ((f32, f32), ScreenShape)>) {
    let mut small = flat();
    for ((cell_size, tone), shape) in cases {
        assert_light_stays(&mut small, [1.0 - tone; 3], ideal_spot(shape, cell_size));
    }
}

#[test]
fn rendered_colors_have_their_light() {
    let mut small = flat();
    let lights = [
        [0.8, 0.3, 0.1],
        [0.1, 0.4, 0.7],
        [0.25, 0.25, 0.25],
        [0.6, 0.6, 0.05],
    ];
    for light in lights {
        for mode in [HalftoneMode::Cmyk, HalftoneMode::Rgb] {
            assert_light_stays(&mut small, light, Halftone { mode, ..ideal() });
        }
    }
}

/// Two inks have the luminance of the picture, if the second is black.
#[test]
fn a_duotone_has_the_luminance() {
    let mut small = flat();
    let s = Halftone {
        mode: HalftoneMode::Duotone,
        cyan: Color::srgb(0.95, 0.45, 0.2),
        ..ideal()
    };
    for tone in [0.1, 0.3, 0.5, 0.8] {
        let [_, light] = mean_lights(&mut small, [tone; 3], s);
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

/// The whole pass, pixel by pixel, in every mode; in two passes where cells are read. Also with
/// surface lines, tone bands and several samples.
#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    // Both samplings of four inks; of the other modes, the two in turn.
    let [pixel, cell] = SAMPLINGS;
    assert_modes(&mut small, [&SAMPLINGS, &[cell], &[pixel], &[cell]]);
    let sampling = ScreenSampling::Cell;
    let s = Halftone {
        sampling,
        ..default()
    };
    let style = screened(s).with(ToneBands::default());
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        assert_pass_matches_the_reference(&mut small, &style, None, &format!("{msaa:?}"));
    }
    // Light above 1 has the inks of 1.
    small.insert(Hdr);
    fill(&mut small, Color::linear_rgb(40.0, 9.0, 0.5));
    let pixel = screened(Halftone::default());
    assert_pass_matches_the_reference(&mut small, &pixel, None, "light above 1");
}

#[test]
#[ignore = "long: both samplings of every mode"]
fn every_pixel_matches_the_reference_in_every_mode() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    assert_modes(&mut small, [&SAMPLINGS; 4]);
}

/// `samplings`: those of each mode.
fn assert_modes(small: &mut Small, samplings: [&[ScreenSampling]; 4]) {
    let modes = [
        (HalftoneMode::Cmyk, ScreenShape::Euclidean),
        (HalftoneMode::Spot, ScreenShape::Round),
        (HalftoneMode::Duotone, ScreenShape::Line),
        (HalftoneMode::Rgb, ScreenShape::Cross),
    ];
    for ((mode, shape), samplings) in modes.into_iter().zip(samplings) {
        for &sampling in samplings {
            let s = Halftone {
                mode,
                shape,
                sampling,
                at_near: 1.0,
                at_far: 0.3,
                gain: 0.1,
                solid_below: 0.05,
                bare_above: 0.9,
                shadows_only_below: 0.7,
                ..default()
            };
            let what = format!("{mode:?}, {shape:?}, {sampling:?}");
            assert_pass_matches_the_reference(small, &screened(s), None, &what);
        }
    }
}

/// Screens begin in the middle of a viewport, and nothing is printed outside of it.
#[test]
fn viewports_are_pages_or_parts_of_one() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    let viewport = [11, 5, 29, 20];
    small.see_in(viewport);
    for anchor in [ScreenAnchor::View, ScreenAnchor::Window] {
        for sampling in SAMPLINGS {
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

/// Too fine for the screen: plain tones, the picture itself with ideal inks. Settings out of
/// their ranges are those at the end of it, or the defaults.
#[test]
fn impossible_cell_sizes_show_a_picture() {
    let options = HeadlessOptions {
        scale_factor: 0.1,
        ..options(UVec2::new(48, 32))
    };
    let mut small = Small::with(options, Msaa::Off);
    let plain = small.settle().picture();
    let [dots, lines, grains] = [
        ScreenShape::Euclidean,
        ScreenShape::Line,
        ScreenShape::Stochastic,
    ];
    for cell_size in [0.0, f32::NAN, f32::INFINITY, 3e38] {
        for shape in [dots, lines, grains] {
            let s = Halftone {
                cell_size,
                shape,
                ..ideal()
            };
            let picture = small.shot(&ComicStyle::new().with(s));
            // 2.5 and 6 logical pixels, and 40: 4 physical ones.
            if cell_size != 3e38 && shape != grains {
                assert!(apart(&picture, &plain) <= 1, "{cell_size}, {shape:?}");
            } else {
                assert_ne!(picture, plain, "{cell_size}, {shape:?}");
            }
        }
    }
}

/// The pictures before and after the pass keep their opacity, and nothing is printed where nothing
/// is. `least`: pixels of background.
pub fn assert_background_stays(small: &Small, least: usize) {
    let (before, after) = small.pass();
    let mut empty = 0;
    for (before, after) in before.pixels.iter().zip(&after.pixels) {
        assert_eq!(before[3], after[3], "opacity stays");
        if before[3] == 0.0 {
            assert_eq!(*after, [0.0; 4]);
            empty += 1;
        }
    }
    assert!(empty > least, "{empty} pixels of background");
}

/// Nothing is printed where nothing is, and floating-point targets hold finite light.
#[test]
fn backgrounds_stay_transparent_and_light_stays_finite() {
    let mut small = Small::new(size(), Msaa::Off);
    let print = |small: &mut Small, s: Halftone, sampling| {
        small.style(&ComicStyle::new().with(Halftone { sampling, ..s }));
        small.settle();
    };
    fill(&mut small, Color::NONE);
    for sampling in SAMPLINGS {
        print(&mut small, default(), sampling);
        assert_background_stays(&small, 100);
    }
    small.insert(Hdr);
    fill(&mut small, Color::linear_rgb(40.0, 9.0, 0.5));
    for sampling in SAMPLINGS {
        print(&mut small, ideal(), sampling);
        let (_, after) = small.pass();
        let mut values = after.pixels.iter().flatten();
        assert!(values.all(|v| (0.0..=1.001).contains(v)));
    }
}

/// The pixels that a style covers with ink of its outlines entirely: they are black with
/// black lines, and white with white ones.
pub fn covered(small: &mut Small, style: &ComicStyle) -> Vec<bool> {
    let [black, white] = [Color::BLACK, Color::WHITE].map(|color| {
        let outlines = Outlines {
            width: 3.0,
            silhouettes: Some(Silhouettes { color, ..default() }),
            creases: None,
            objects: None,
            ..default()
        };
        small.shot(&style.clone().with(outlines))
    });
    let pairs = black.pixels().zip(white.pixels());
    pairs
        .map(|(black, white)| black.0[..3] == [0; 3] && white.0[..3] == [255; 3])
        .collect()
}

/// Lines are drawn over the effect: they cover the pixels that they cover without it.
pub fn assert_lines_stay(size: UVec2, effect: impl Effect) {
    let mut small = Small::new(size, Msaa::Off);
    let bare = covered(&mut small, &ComicStyle::new());
    let printed = covered(&mut small, &ComicStyle::new().with(effect));
    assert!(bare.iter().filter(|covered| **covered).count() > 100);
    assert_eq!(bare, printed);
}

#[test]
fn lines_stay_sharp() {
    assert_lines_stay(UVec2::new(72, 48), Halftone::default());
}

/// FXAA, SMAA and sharpening would change dots and grain: printed views are styled after them.
/// Lines without a print are still smoothed.
#[test]
fn dots_and_grain_are_drawn_after_anti_aliasing() {
    let filter = |small: &mut Small, which: usize| {
        let sharp = ContrastAdaptiveSharpening {
            enabled: true,
            ..default()
        };
        let mut camera = small.camera_mut();
        match which {
            0 => camera.insert(Fxaa::default()),
            1 => camera.insert(Smaa::default()),
            _ => camera.insert(sharp),
        };
    };
    let mut small = Small::new(size(), Msaa::Off);
    let mut picture = |style: &ComicStyle, filters: &[usize]| {
        small.restart(Msaa::Off);
        small.clear();
        fill(&mut small, Color::linear_rgb(0.55, 0.4, 0.25));
        for which in filters {
            filter(&mut small, *which);
        }
        small.shot(style)
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
    let mut before = small.shot(&ComicStyle::new().with(Outlines::default()));
    for which in 0..3 {
        filter(&mut small, which);
        let after = small.settle().picture();
        assert_ne!(after, before, "filter {which}");
        before = after;
    }
}
