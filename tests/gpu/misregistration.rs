//! Plates out of register.

use bevy_comics_testkit::reference::misregistration::strays;

use crate::{halftone::covered, pictures::assert_pass_matches_the_reference, prelude::*};

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

fn shot(small: &mut Small, style: &ComicStyle) -> image::RgbaImage {
    small.style(style);
    small.settle();
    small.picture()
}

fn apart(a: &image::RgbaImage, b: &image::RgbaImage) -> u8 {
    let pairs = a.as_raw().iter().zip(b.as_raw());
    pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// A code of rounding: the picture between the passes has 11 bits.
#[test]
fn plates_in_register_are_the_picture() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let plain = shot(&mut small, &ComicStyle::new());
    for black_generation in [0.0, 0.5, 1.0] {
        let s = Misregistration {
            black_generation,
            ..STILL
        };
        let picture = shot(&mut small, &ComicStyle::new().with(s));
        assert!(small.ran(ComicsStage::of::<Misregistration>()));
        assert!(apart(&picture, &plain) <= 1);
    }
}

/// Without black, each plate is a channel of the picture, moved: by whole pixels exactly, by
/// parts of one as bilinear.
#[test]
fn a_moved_plate_is_the_moved_picture() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let colors = shot(&mut small, &ComicStyle::new());
    for (channel, s) in [
        (
            0,
            Misregistration {
                cyan: Vec2::new(3.0, -2.0),
                ..STILL
            },
        ),
        (
            1,
            Misregistration {
                magenta: Vec2::new(3.0, -2.0),
                ..STILL
            },
        ),
        (
            2,
            Misregistration {
                yellow: Vec2::new(3.0, -2.0),
                ..STILL
            },
        ),
    ] {
        let s = Misregistration {
            black_generation: 0.0,
            ..s
        };
        let moved = shot(&mut small, &ComicStyle::new().with(s));
        let mut changed = 0;
        for y in 2..60 {
            for x in 4..90 {
                for c in 0..3 {
                    let from = if c == channel { (x - 3, y + 2) } else { (x, y) };
                    let want = colors.get_pixel(from.0, from.1).0[c];
                    let found = moved.get_pixel(x, y).0[c];
                    assert!(found.abs_diff(want) <= 1, "{channel}: ({x}, {y})");
                }
                changed += usize::from(moved.get_pixel(x, y) != colors.get_pixel(x, y));
            }
        }
        assert!(changed > 200, "{changed}");
    }
    // Half a pixel: the mean of two.
    let s = Misregistration {
        cyan: Vec2::new(0.5, 0.0),
        black_generation: 0.0,
        ..STILL
    };
    let moved = shot(&mut small, &ComicStyle::new().with(s));
    for y in 1..63 {
        for x in 1..95 {
            let [a, b] = [x - 1, x].map(|x| linear(&colors, x, y)[0]);
            let found = linear(&moved, x, y)[0];
            assert!((found - 0.5 * (a + b)).abs() < 0.01, "({x}, {y})");
        }
    }
}

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
    assert_pass_matches_the_reference(&mut small, &style, None, "whole");
    let screened = style.clone().with(Halftone::default());
    assert_pass_matches_the_reference(&mut small, &screened, None, "screened");
    let strayed = style.clone().with(Misregistration {
        drift: 3.0,
        ..default()
    });
    assert_pass_matches_the_reference(&mut small, &strayed, None, "strayed");
    let viewport = [11, 5, 43, 30];
    let entity = small.camera;
    let mut camera = small.world().get_mut::<Camera>(entity).expect("a camera");
    camera.viewport = Some(Viewport {
        physical_position: UVec2::new(viewport[0], viewport[1]),
        physical_size: UVec2::new(viewport[2], viewport[3]),
        ..default()
    });
    assert_pass_matches_the_reference(&mut small, &style, Some(viewport), "viewport");
    assert_eq!(small.errors(), 0);
}

/// Three passes: the plates are moved, then cells of the moved picture are read.
#[test]
fn cells_read_the_moved_picture() {
    let mut small = Small::new(UVec2::new(40, 28), Msaa::Off);
    let style = ComicStyle::new()
        .with(Misregistration::default())
        .with(Halftone {
            sampling: ScreenSampling::Cell,
            ..default()
        })
        .with(Outlines::default());
    assert_pass_matches_the_reference(&mut small, &style, None, "three passes");
    assert_eq!(small.errors(), 0);
}

/// Lines cover the pixels that they cover without the effect, though the colours beside them
/// are moved.
#[test]
fn lines_stay_in_place() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let s = Misregistration {
        cyan: Vec2::new(6.0, 0.3),
        magenta: Vec2::new(-0.5, 6.0),
        ..default()
    };
    let bare = covered(&mut small, &ComicStyle::new());
    let moved = covered(&mut small, &ComicStyle::new().with(s));
    assert!(bare.iter().filter(|covered| **covered).count() > 100);
    assert_eq!(bare, moved);
}

/// The split view compares with the unstyled picture, and debug views are those of one
/// pass.
#[test]
fn comparisons_and_debug_views_see_through_the_passes() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let plain = shot(&mut small, &ComicStyle::new());
    let style = ComicStyle::new()
        .with(Desaturation::default())
        .with(Misregistration::default());
    let styled = shot(&mut small, &style);
    small.insert(SplitView::default());
    small.settle();
    let split = small.picture();
    for y in 0..64 {
        assert_eq!(split.get_pixel(20, y), plain.get_pixel(20, y));
        assert_eq!(split.get_pixel(80, y), styled.get_pixel(80, y));
    }
    let camera = small.camera;
    small.world().entity_mut(camera).remove::<SplitView>();
    for view in [
        DebugView::DepthMap,
        DebugView::Saturation,
        DebugView::RawRange,
    ] {
        let alone = ComicStyle::new().with(Desaturation::default());
        small.insert(view);
        let one = shot(&mut small, &alone);
        let two = shot(&mut small, &style);
        assert_eq!(one, two, "{view:?}");
    }
    assert_eq!(small.errors(), 0);
}

/// A page lasts until a cut, or for one drawing; the plates of each lie in places of their own.
#[test]
fn plates_drift_from_page_to_page() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    let pages = |small: &mut Small, rate: f32| {
        let s = Misregistration {
            drift: 4.0,
            rate,
            ..STILL
        };
        let mut film = vec![shot(small, &ComicStyle::new().with(s))];
        for _ in 0..30 {
            small.headless.step(1);
            film.push(small.picture());
        }
        film.chunk_by(|a, b| a == b).count()
    };
    assert_eq!(pages(&mut small, 0.0), 1);
    // A new page in every fifth frame.
    assert_eq!(pages(&mut small, 12.0), 7);
    let strayed = ComicStyle::new().with(Misregistration {
        drift: 4.0,
        ..STILL
    });
    let before = shot(&mut small, &strayed);
    let camera = small.camera;
    small.world().trigger(CameraCut { entity: camera });
    small.settle();
    assert_ne!(small.picture(), before);
    assert_eq!(small.errors(), 0);
}

/// Every axis of every plate strays by up to the drift to either side, evenly, and on its own.
#[test]
fn plates_stray_evenly() {
    let pages = 4000;
    let mut sums = [[0.0; 6]; 6];
    let mut most: f64 = 0.0;
    for page in 0..pages {
        let strays = strays(page / 50, page % 50);
        let axes: Vec<f64> = strays.into_iter().flatten().collect();
        for (i, a) in axes.iter().enumerate() {
            most = most.max(a.abs());
            for (j, b) in axes.iter().enumerate() {
                sums[i][j] += a * b / f64::from(pages);
            }
        }
    }
    assert!((0.99..=1.0).contains(&most), "{most}");
    for (i, row) in sums.iter().enumerate() {
        for (j, found) in row.iter().enumerate() {
            // The square of an even number from -1 to 1 is 1/3 in the mean. Means of 4000
            // products deviate by 0.3 / 63.
            let want = if i == j { 1.0 / 3.0 } else { 0.0 };
            assert!((found - want).abs() < 0.025, "{i}, {j}: {found}");
        }
    }
}

/// The opacity of a transparent camera stays, and nothing is printed where nothing is, however far
/// the plates are moved.
#[test]
fn a_transparent_background_stays() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        small.insert(Camera {
            clear_color: Color::NONE.into(),
            ..default()
        });
        let far = Misregistration {
            cyan: Vec2::new(6.0, 0.3),
            magenta: Vec2::new(-0.5, -5.0),
            yellow: Vec2::new(-7.0, -0.7),
            black: Vec2::new(3.0, 0.0),
            ..default()
        };
        let style = ComicStyle::new().with(Desaturation::default()).with(far);
        assert_pass_matches_the_reference(&mut small, &style, None, "transparent");
        let (read, wrote) = small.pass();
        let mut empty = 0;
        for (read, wrote) in read.pixels.iter().zip(&wrote.pixels) {
            assert_eq!(read[3], wrote[3], "opacity stays");
            if read[3] == 0.0 {
                assert_eq!(*wrote, [0.0; 4]);
                empty += 1;
            }
        }
        assert!(empty > 300, "{empty} pixels of background");
        assert_eq!(small.errors(), 0);
    }
}

/// HDR: what is brighter than white is printed as white, and a bright light beside a plate does
/// not spread. Numbers out of range are those at its end, or the defaults.
#[test]
fn light_and_settings_out_of_range_are_finite() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    small.insert(Hdr);
    let bright = Color::linear_rgb(60000.0, 1e9, 1e-30);
    let at = Transform::from_xyz(0.0, 1.0, 2.0);
    small.put(Sphere::new(0.6), unlit(bright), at);
    let mut shown = Vec::new();
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, 1e30, 32.0] {
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
        let inside = after.pixels.iter().flatten();
        assert!(inside.copied().all(|v| (0.0..=1.0).contains(&v)), "{x}");
        // Every page is another one at these rates.
        small.insert(Misregistration { rate: 0.0, ..s }).settle();
        shown.push(small.pass().1.pixels);
    }
    let [_, infinite, _, _, huge, end] = &shown[..] else {
        panic!("six pictures");
    };
    assert!(huge == end, "1e30 is the end of the ranges");
    assert!(infinite != end, "infinity is the default");
    assert_eq!(small.errors(), 0);
}
