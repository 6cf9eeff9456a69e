//! Plates out of register.

use bevy_comics_testkit::reference::misregistration::strays;

use crate::{
    halftone::{assert_background_stays, assert_lines_stay},
    pictures::assert_pass_matches_the_reference,
    prelude::*,
};

const STILL: Misregistration = Misregistration {
    cyan: Vec2::ZERO,
    magenta: Vec2::ZERO,
    yellow: Vec2::ZERO,
    black: Vec2::ZERO,
    black_generation: 0.7,
    drift: 0.0,
    rate: 0.0,
    amount: 1.0,
};

/// A code of rounding: the picture between the passes has 11 bits.
#[test]
fn plates_in_register_are_the_picture() {
    let mut small = Small::new(size(), Msaa::Off);
    let plain = small.shot(&ComicStyle::new());
    for black_generation in [0.0, 0.5, 1.0] {
        let s = Misregistration {
            black_generation,
            ..STILL
        };
        let picture = small.shot(&ComicStyle::new().with(s));
        assert!(small.ran(ComicsStage::of::<Misregistration>()));
        assert!(apart(&picture, &plain) <= 1);
    }
}

/// Without black, each plate is a channel of the picture, moved: by whole pixels exactly, by
/// parts of one as bilinear.
#[test]
fn a_moved_plate_is_the_moved_picture() {
    let mut small = Small::new(size(), Msaa::Off);
    let colors = small.shot(&ComicStyle::new());
    let mut moved = |channel: usize, by: Vec2| {
        let mut s = Misregistration {
            black_generation: 0.0,
            ..STILL
        };
        *[&mut s.cyan, &mut s.magenta, &mut s.yellow][channel] = by;
        small.shot(&ComicStyle::new().with(s))
    };
    for channel in 0..3 {
        let moved = moved(channel, Vec2::new(3.0, -2.0));
        let mut changed = 0;
        for (x, y) in (2..60).flat_map(|y| (4..90).map(move |x| (x, y))) {
            let (own, from) = (colors.get_pixel(x, y), colors.get_pixel(x - 3, y + 2));
            let found = moved.get_pixel(x, y);
            let mut want = *own;
            want[channel] = from[channel];
            let is_near = (0..3).all(|c| found[c].abs_diff(want[c]) <= 1);
            assert!(is_near, "{channel}: ({x}, {y})");
            changed += usize::from(found != own);
        }
        assert!(changed > 200, "{changed}");
    }
    // Half a pixel: the mean of two.
    let moved = moved(0, Vec2::new(0.5, 0.0));
    for (x, y) in (1..63).flat_map(|y| (1..95).map(move |x| (x, y))) {
        let [a, b] = [x - 1, x].map(|x| linear(&colors, x, y)[0]);
        let found = linear(&moved, x, y)[0];
        assert!((found - 0.5 * (a + b)).abs() < 0.01, "({x}, {y})");
    }
}

/// The whole pass, also before a screen.
#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let style = ComicStyle::new()
        .with(ToneBands::default())
        .with(Misregistration {
            cyan: Vec2::new(2.25, 0.3),
            black: Vec2::new(0.0, -1.5),
            ..default()
        })
        .with(Outlines::default());
    let strayed = Misregistration {
        drift: 3.0,
        ..default()
    };
    for (style, what) in [
        (style.clone(), "whole"),
        (style.clone().with(Halftone::default()), "screened"),
        (style.clone().with(strayed), "strayed"),
    ] {
        assert_pass_matches_the_reference(&mut small, &style, None, what);
    }
    let viewport = [11, 5, 43, 30];
    small.see_in(viewport);
    assert_pass_matches_the_reference(&mut small, &style, Some(viewport), "viewport");
    assert_eq!(small.errors(), 0);
}

/// Three passes: the plates are moved, then cells of the moved picture are read.
#[test]
fn cells_read_the_moved_picture() {
    let mut small = Small::new(UVec2::new(40, 28), Msaa::Off);
    let cells = Halftone {
        sampling: ScreenSampling::Cell,
        ..default()
    };
    let style = ComicStyle::new()
        .with(Misregistration::default())
        .with(cells)
        .with(Outlines::default());
    assert_pass_matches_the_reference(&mut small, &style, None, "three passes");
    assert_eq!(small.errors(), 0);
}

/// The colors beside lines are moved, the lines are not.
#[test]
fn lines_stay_in_place() {
    let s = Misregistration {
        cyan: Vec2::new(6.0, 0.3),
        magenta: Vec2::new(-0.5, 6.0),
        ..default()
    };
    assert_lines_stay(size(), s);
}

/// The split view compares with the unstyled picture, and debug views are those of one
/// pass.
#[test]
fn comparisons_and_debug_views_see_through_the_passes() {
    let mut small = Small::new(size(), Msaa::Off);
    let plain = small.shot(&ComicStyle::new());
    let alone = ComicStyle::new().with(Desaturation::default());
    let style = alone.clone().with(Misregistration::default());
    let styled = small.shot(&style);
    small.insert(SplitView::default());
    let split = small.settle().picture();
    for y in 0..64 {
        assert_eq!(split.get_pixel(20, y), plain.get_pixel(20, y));
        assert_eq!(split.get_pixel(80, y), styled.get_pixel(80, y));
    }
    small.camera_mut().remove::<SplitView>();
    for view in [
        DebugView::DepthMap,
        DebugView::Saturation,
        DebugView::RawRange,
    ] {
        small.insert(view);
        let one = small.shot(&alone);
        assert_eq!(one, small.shot(&style), "{view:?}");
    }
    assert_eq!(small.errors(), 0);
}

/// A page lasts until a cut, or for one drawing; the plates of each lie in places of their own.
#[test]
fn plates_drift_from_page_to_page() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    let strayed = |rate: f32| {
        ComicStyle::new().with(Misregistration {
            drift: 4.0,
            rate,
            ..STILL
        })
    };
    let pages = |small: &mut Small, rate: f32| {
        let mut film = vec![small.shot(&strayed(rate))];
        for _ in 0..30 {
            small.headless.step(1);
            film.push(small.picture());
        }
        film.chunk_by(|a, b| a == b).count()
    };
    assert_eq!(pages(&mut small, 0.0), 1);
    // A new page in every fifth frame.
    assert_eq!(pages(&mut small, 12.0), 7);
    let before = small.shot(&strayed(0.0));
    small.cut();
    assert_ne!(small.settle().picture(), before);
    assert_eq!(small.errors(), 0);
}

/// Every axis of every plate strays by up to the drift to either side, evenly, and on its own.
#[test]
fn plates_stray_evenly() {
    let pages: Vec<[f64; 6]> = (0..4000)
        .map(|page| {
            let [[a, b], [c, d], [e, f]] = strays(page / 50, page % 50);
            [a, b, c, d, e, f]
        })
        .collect();
    let most = pages
        .iter()
        .flatten()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!((0.99..=1.0).contains(&most), "{most}");
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        let products = pages.iter().map(|axes| axes[i] * axes[j]);
        let found = products.sum::<f64>() / pages.len() as f64;
        // The square of an even number from -1 to 1 is 1/3 in the mean. Means of 4000
        // products deviate by 0.3 / 63.
        let want = if i == j { 1.0 / 3.0 } else { 0.0 };
        assert!((found - want).abs() < 0.025, "{i}, {j}: {found}");
    }
}

/// The opacity of a transparent camera stays, and nothing is printed where nothing is, however far
/// the plates are moved.
#[test]
fn a_transparent_background_stays() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let far = Misregistration {
        cyan: Vec2::new(6.0, 0.3),
        magenta: Vec2::new(-0.5, -5.0),
        yellow: Vec2::new(-7.0, -0.7),
        black: Vec2::new(3.0, 0.0),
        ..default()
    };
    let style = ComicStyle::new().with(Desaturation::default()).with(far);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        crate::halftone::fill(&mut small, Color::NONE);
        assert_pass_matches_the_reference(&mut small, &style, None, "transparent");
        assert_background_stays(&small, 300);
        assert_eq!(small.errors(), 0);
    }
}

/// HDR: what is brighter than white is printed as white, and a bright light beside a plate does
/// not spread. Numbers out of range are those at its end, or the defaults.
#[test]
fn light_and_settings_out_of_range_are_finite() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    small.insert(Hdr);
    let bright = unlit(Color::linear_rgb(60000.0, 1e9, 1e-30));
    let at = Transform::from_xyz(0.0, 1.0, 2.0);
    small.put(Sphere::new(0.6), bright, at);
    let numbers = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, 1e30, 32.0];
    let [_, infinite, _, _, huge, end] = numbers.map(|x| {
        let s = Misregistration {
            cyan: Vec2::splat(x),
            magenta: Vec2::splat(x),
            yellow: Vec2::splat(x),
            black: Vec2::splat(x),
            black_generation: x,
            drift: x,
            rate: x,
            amount: 1.0,
        };
        small.insert(s).settle();
        assert!(small.ran(ComicsStage::of::<Misregistration>()), "{x}");
        let (_, after) = small.pass();
        let mut values = after.pixels.iter().flatten();
        assert!(values.all(|v| (0.0..=1.0).contains(v)), "{x}");
        // Every page is another one at these rates.
        small.insert(Misregistration { rate: 0.0, ..s }).settle();
        small.pass().1.pixels
    });
    assert!(huge == end, "1e30 is the end of the ranges");
    assert!(infinite != end, "infinity is the default");
    assert_eq!(small.errors(), 0);
}
