//! Tones of the picture that are brought into a range before effects divide them.

use bevy_comics::effects::HatchingSource;
use bevy_comics_testkit::{
    device::gpu,
    reference::{
        histogram::Bins,
        tone_range::{self, brought, line, number},
    },
};

use crate::{
    halftone::fill,
    pictures::check,
    prelude::*,
    ramp::{bright, room, sun},
    range::{SHAPES, reduce_texture},
    smoothing::{Outliers, SMOOTH, frame, run},
};

/// As found in each single frame.
const AT_ONCE: ToneRange = ToneRange {
    outliers: 0.05,
    dark: 0.1,
    light: 0.9,
    max_gain: 8.0,
    smoothing: None,
    amount: 1.0,
};

/// A pixel of any light, from below black to above what half floats hold. None is so near to the
/// edge of a bin that rounding decides: a few units in the last place of 24 bits.
fn any_pixel(random: &mut Random) -> [f32; 4] {
    loop {
        let light = random.range(-19.0, 17.0).exp2();
        let mut pixel = [0.0, 0.0, 0.0, 1.0];
        for part in &mut pixel[..3] {
            *part = light * random.unit();
        }
        match random.unit() {
            x if x < 0.05 => pixel = [0.0, 0.0, 0.0, 1.0],
            x if x < 0.1 => pixel[3] = random.pick(&[0.0, 0.3, 0.7, 2.0, f32::NAN]),
            x if x < 0.13 => pixel[0] = random.pick(&[f32::NAN, f32::INFINITY]),
            x if x < 0.16 => pixel = [-light, -light, -light, 1.0],
            _ => {}
        }
        let bins = [0.99999, 1.00001].map(|by: f32| {
            let [r, g, b, a] = pixel;
            let found = number([r * by, g * by, b * by, a]);
            (found > 0.0).then(|| Bins::Octaves.bin_of(found))
        });
        if bins[0] == bins[1] {
            return pixel;
        }
    }
}

/// One pixel of four in a rectangle.
fn counted(pixels: &[[f32; 4]], width: u32, [x, y, w, h]: [u32; 4]) -> Vec<[f32; 4]> {
    let rows = (y..y + h).step_by(2);
    let places = rows.flat_map(|y| (x..x + w).step_by(2).map(move |x| y * width + x));
    places.map(|place| pixels[place as usize]).collect()
}

#[test]
fn every_shape_counts_the_tones_of_any_picture() {
    let mut random = Random::new(7);
    for size in [[1u32, 1], [7, 5], [129, 33], [300, 67]] {
        let pixels: Vec<_> = (0..size[0] * size[1])
            .map(|_| any_pixel(&mut random))
            .collect();
        let texture = gpu().texture(size, &pixels);
        let [x, y] = size.map(|side| side / 3);
        for rect in [[0, 0, size[0], size[1]], [x, y, size[0] - x, size[1] - y]] {
            let seen = counted(&pixels, size[0], rect);
            let numbers = || seen.iter().map(|pixel| number(*pixel));
            let (bins, total) = Bins::Octaves.count(numbers());
            for shape in SHAPES {
                let defs: Vec<&str> = (shape.iter().copied())
                    .chain(["HISTOGRAM", "TONES"])
                    .collect();
                let (found, words) = reduce_texture(&defs, &texture, rect, [0.0; 2]);
                let what = format!("{shape:?} on {size:?}, {rect:?}");
                assert_eq!(words[..256], bins, "{what}");
                assert_eq!(words[256], total, "{what}");
                let wanted = tone_range::percentiles(seen.iter().copied(), 0.05);
                assert_eq!(found.is_some(), wanted.is_some(), "{what}");
                let (Some(found), Some(wanted)) = (found, wanted) else {
                    continue;
                };
                let outliers = Outliers {
                    fraction: 0.05,
                    bins: &words[..256],
                    total: words[256],
                    window: [0.0; 2],
                };
                let [light, dark] = found.map(f32::from_bits);
                let drawn = run(&SMOOTH, &[frame(light, dark, 0.0)], Some(outliers));
                let [light, dark] = drawn[0].expect("tones").map(f32::from_bits);
                for (number, wanted) in [dark, light].into_iter().zip(wanted) {
                    let found = (f64::from(number) * 65536.0).sqrt();
                    assert!(
                        (found / wanted - 1.0).abs() < 1e-5,
                        "{what}: {found}, {wanted}"
                    );
                }
            }
        }
    }
}

/// Whatever was found, tones are finite, gain is limited, and what is in between the ends of the
/// picture's range comes into the range that is asked for.
#[test]
fn any_tone_is_brought_into_the_range() {
    let mut random = Random::new(9);
    let sizes: [f32; 10] = [0.0, 1e-8, 1e-4, 0.01, 0.1, 0.3, 0.5, 1.0, 3.0, 256.0];
    let rows: Vec<[f32; 8]> = (0..4000)
        .map(|_| {
            let ends = [random.pick(&sizes), random.pick(&sizes)];
            let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let color = [(); 3].map(|()| random.pick(&sizes) * random.unit());
            let [dark, light] = [random.range(0.0, 0.4), random.range(0.6, 1.0)];
            let most = random.pick(&[1.0, 3.0, 8.0, 32.0]);
            [dark, light, most, low, high, color[0], color[1], color[2]]
        })
        .collect();
    let imports = "#import bevy_comics::tones::{ToneRange, on_tone_line, tone_line}";
    let found = "let found = tone_line(ToneRange(i(0u), i(1u), i(2u), 1.0), vec2(i(3u), i(4u)));";
    let lines = gpu().evaluate(
        imports,
        &format!("{found} return vec4(found, 0.0, 0.0);"),
        &rows,
    );
    let color = "return vec4(on_tone_line(found, vec3(i(5u), i(6u), i(7u))), 0.0);";
    let colors = gpu().evaluate(imports, &format!("{found} {color}"), &rows);
    for ((row, found), color) in rows.iter().zip(&lines).zip(&colors) {
        let [dark, light, most, low, high, ..] = *row;
        let s = ToneRange {
            dark,
            light,
            max_gain: most,
            ..AT_ONCE
        };
        let ends = [low, high].map(f64::from);
        let wanted = line(&s, (high > 0.0).then_some(ends));
        let [gain, shift, ..] = found.map(f64::from);
        // Both ends are rounded to 24 bits, and so is what is left of them.
        let slack = 1e-6 * (1.0 + gain * ends[1]);
        assert!((gain / wanted[0] - 1.0).abs() < 1e-3, "{row:?}: {gain}");
        assert!(gain <= f64::from(most) * (1.0 + 1e-6), "{row:?}: {gain}");
        assert!((shift - wanted[1]).abs() < 1e-3 + slack, "{row:?}: {shift}");
        if high > 0.0 {
            let [low, high] = ends.map(|end| gain * end + shift);
            let least = f64::from(dark).min(gain * ends[0]) - 1e-4 - slack;
            let largest = f64::from(light) + 1e-4 + slack;
            assert!(low >= least && high <= largest, "{row:?}: {low}, {high}");
        }
        let of_reference = brought([gain, shift], [row[5], row[6], row[7]].map(f64::from));
        let size = of_reference
            .iter()
            .fold(1.0, |most: f64, c| most.max(c.abs()));
        for (found, wanted) in color.iter().zip(of_reference) {
            let apart = (f64::from(*found) - wanted).abs();
            // Squares of sums of two numbers, one of which may be much larger.
            assert!(apart <= 1e-3 * size, "{row:?}: {color:?}, {of_reference:?}");
        }
    }
}

/// Whole pictures, pixel by pixel: in every effect that divides tones and has a reference, in a
/// viewport, with four samples, with light above white, over a background that shows through.
#[test]
fn pictures_in_a_range_match_the_reference() {
    let less = ToneRange {
        outliers: 0.2,
        dark: 0.3,
        light: 0.7,
        max_gain: 1.2,
        amount: 0.6,
        ..AT_ONCE
    };
    let flats = BlackFlats {
        value: Some(0.5),
        ..default()
    };
    let style = |range: ToneRange| ComicStyle::new().with(range);
    let bands = ("bands", style(AT_ONCE).with(ToneBands::default()));
    let cells = Halftone {
        sampling: ScreenSampling::Cell,
        ..default()
    };
    let cases = [
        bands.clone(),
        ("flats", style(less).with(flats)),
        // Flats in a second pass read the unstyled picture in the range.
        ("flats on dots", style(AT_ONCE).with(flats).with(cells)),
    ];
    let named = |(name, style): (&str, ComicStyle)| (name.to_owned(), style);
    let mut small = Small::new(UVec2::new(60, 40), Msaa::Off);
    check(&mut small, None, cases.map(named));
    small.restart(Msaa::Sample4);
    small.camera_settings().clear_color = Color::srgba(0.1, 0.2, 0.3, 0.4).into();
    check(&mut small, None, [named(bands.clone())]);
    small.restart(Msaa::Off);
    let viewport = [13, 7, 35, 27];
    small.see_in(viewport);
    check(&mut small, Some(viewport), [named(bands.clone())]);
    small.restart(Msaa::Off);
    small.insert(Hdr);
    fill(&mut small, Color::linear_rgb(3.0, 2.5, 2.0));
    check(&mut small, None, [named(bands)]);
}

/// Matte walls side by side, from dark to light, in a light that makes white 1. The lightest has half
/// of the picture.
fn lit() -> Small {
    let mut small = room(UVec2::new(96, 64), 0.0);
    small.insert(Hdr);
    for (x, light) in [(-1.25, 0.02), (-0.75, 0.12), (-0.25, 0.2), (0.75, 0.64)] {
        let wall = StandardMaterial {
            base_color: Color::linear_rgb(light, light, light),
            perceptual_roughness: 1.0,
            reflectance: 0.0,
            ..default()
        };
        let width = if x > 0.0 { 1.5 } else { 0.5 };
        let at = Transform::from_xyz(x, 0.0, 0.0);
        small.put(Rectangle::new(width, 2.0), wall, at);
    }
    sun(&mut small, Vec3::Z, bright(1.0));
    small
}

/// Changes the exposure by so many stops from that of [`lit`].
fn expose(small: &mut Small, stops: f32) {
    let ev100 = Exposure::default().ev100 - stops;
    small.insert(Exposure { ev100 });
}

/// Truth: a scene is the same picture at any exposure. At the lowest one, tones need 4.8 times
/// their lightness.
#[test]
fn a_scene_has_the_same_tones_at_any_exposure() {
    let mut small = lit();
    let page = Hatching {
        anchor: HatchingAnchor::Page,
        ..default()
    };
    let styles = [
        ComicStyle::new()
            .with(ToneBands::default())
            .with(BlackFlats::default())
            .with(page),
        ComicStyle::new()
            .with(ToneRamp::default())
            .with(Halftone::default()),
        ComicStyle::new().with(TwoTone::default()),
    ];
    for style in styles {
        let mut shots = |style: &ComicStyle| {
            [0.0, -4.0, 3.0].map(|stops| {
                expose(&mut small, stops);
                small.cut();
                small.shot(style)
            })
        };
        let [before, dark, light] = shots(&style);
        for (name, picture) in [("dark", dark), ("light", light)] {
            let apart = changed(&before, &picture, 8);
            assert!(apart > 0.05, "{style:?}, {name}: it changes by {apart}");
        }
        let [own, dark, light] = shots(&style.clone().with(ToneRange::default()));
        for (name, picture) in [("dark", dark), ("light", light)] {
            // Half floats round each exposure alike, but for the last place of the exposure.
            let apart = changed(&own, &picture, 1);
            assert!(apart < 0.005, "{style:?}, {name}: {apart} of the picture");
        }
    }
}

/// A style that divides tones below what a display shows: the picture is as it was brought.
fn bare(smoothing: Option<RangeSmoothing>) -> ComicStyle {
    let flats = BlackFlats {
        value: Some(1e-3),
        ..default()
    };
    let range = ToneRange {
        smoothing,
        ..default()
    };
    ComicStyle::new().with(flats).with(range)
}

/// The range lags behind a change of light and arrives as that of depths does, and starts anew
/// after a cut.
#[test]
fn the_range_follows_the_light_over_time() {
    let mut small = lit();
    let wanted = small.shot(&bare(None));
    expose(&mut small, -2.0);
    let smooth = bare(Some(RangeSmoothing::default()));
    small.cut();
    assert!(apart(&small.shot(&smooth), &wanted) <= 1, "it starts anew");
    expose(&mut small, 0.0);
    small.headless.step(2);
    // The median of three frames has changed in the second one, and 15 % of two stops are made up.
    assert!(changed(&small.picture(), &wanted, 8) > 0.4, "it lags");
    small.wait(8.0);
    assert!(apart(&small.picture(), &wanted) <= 1, "it arrives");
}

/// Flat pictures stay what they are within the range, or come to its ends; black stays black.
#[test]
fn flat_and_black_pictures_keep_their_tones() {
    let mut small = Small::new(UVec2::splat(32), Msaa::Off);
    small.clear();
    for (light, wanted) in [(0.0, 0.0), (0.05, 0.1), (0.3, 0.3), (0.7, 0.7), (1.0, 0.9)] {
        fill(
            &mut small,
            Color::linear_rgb(light * light, light * light, light * light),
        );
        let picture = small.shot(&bare(None));
        assert!(small.ran(ComicsStage::Tones));
        let found = linear(&picture, 16, 16)[1].sqrt();
        // A code of a dark tone is 0.01 of lightness, and the gain is 8.
        assert!(
            (found - wanted).abs() < 0.03,
            "{light}: {found}, not {wanted}"
        );
    }
}

/// Without an effect that divides tones, nothing is measured and nothing changes.
#[test]
fn styles_that_divide_no_tones_have_no_pass() {
    let mut small = Small::new(size(), Msaa::Off);
    let facing = Hatching {
        source: HatchingSource::Facing,
        ..default()
    };
    let gray = ComicStyle::new().with(Desaturation::default());
    for style in [gray, ComicStyle::new().with(facing)] {
        let before = small.shot(&style);
        let after = small.shot(&style.clone().with(ToneRange::default()));
        assert_eq!(before, after);
        assert!(!small.ran(ComicsStage::Tones));
        let world = small.headless.app.world();
        let stages = &world.resource::<ComicsDiagnostics>().cameras[&small.camera];
        let reason = StageOutcome::Skipped(SkipReason::NoToneStyle);
        assert_eq!(stages.outcome(ComicsStage::of::<ToneRange>()), Some(reason));
        small.shot(&style.with(ToneRange::default()).with(ToneBands::default()));
        assert!(small.ran(ComicsStage::Tones));
    }
}
