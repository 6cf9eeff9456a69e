//! Plates out of register.

use crate::{
    halftone::{assert_background_stays, assert_lines_stay, fill},
    line_scenes::runs,
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

/// The offset of plates that are moved by whole pixels.
const BY: Vec2 = Vec2::new(3.0, -2.0);

/// These channels of a picture are moved by [`BY`], the others are not.
fn assert_moved(plain: &image::RgbaImage, moved: &image::RgbaImage, channels: &[usize]) {
    let mut changed = 0;
    for (x, y) in (2..60).flat_map(|y| (4..90).map(move |x| (x, y))) {
        let (own, from) = (plain.get_pixel(x, y), plain.get_pixel(x - 3, y + 2));
        let found = moved.get_pixel(x, y);
        let want = |c: usize| if channels.contains(&c) { from } else { own }[c];
        let is_near = (0..3).all(|c| found[c].abs_diff(want(c)) <= 1);
        assert!(is_near, "{channels:?}: ({x}, {y})");
        changed += usize::from(found != own);
    }
    assert!(changed > 200, "{changed}");
}

/// Without black, each plate is a channel of the picture, moved: by whole pixels exactly, by
/// parts of one as bilinear. With all of it black, a gray picture is the black plate.
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
        assert_moved(&colors, &moved(channel, BY), &[channel]);
    }
    // Half a pixel: the mean of two.
    let moved = moved(0, Vec2::new(0.5, 0.0));
    for (x, y) in (1..63).flat_map(|y| (1..95).map(move |x| (x, y))) {
        let [a, b] = [x - 1, x].map(|x| linear(&colors, x, y)[0]);
        let found = linear(&moved, x, y)[0];
        assert!((found - 0.5 * (a + b)).abs() < 0.01, "({x}, {y})");
    }
    small.clear();
    fill(&mut small, Color::WHITE);
    let gray = unlit(Color::srgb(0.3, 0.3, 0.3));
    small.put(Cuboid::from_length(3.0), gray, Transform::IDENTITY);
    let plain = small.shot(&ComicStyle::new());
    let black = Misregistration {
        black: BY,
        black_generation: 1.0,
        ..STILL
    };
    let moved = small.shot(&ComicStyle::new().with(black));
    assert_moved(&plain, &moved, &[0, 1, 2]);
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
        film.extend(small.film(30));
        runs(&film).len()
    };
    assert_eq!(pages(&mut small, 0.0), 1);
    // A new page in every fifth frame.
    assert_eq!(pages(&mut small, 12.0), 7);
    let before = small.shot(&strayed(0.0));
    small.cut();
    assert_ne!(small.settle().picture(), before);
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
        fill(&mut small, Color::NONE);
        small.style(&style).settle();
        assert_background_stays(&small, 300);
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
}
