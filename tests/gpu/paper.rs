//! Paper in the picture of a camera.

use bevy_comics::effects::PaperAnchor;
use bevy_comics_testkit::reference::paper;
use image::imageops;

use crate::{
    halftone::fill,
    line_scenes::runs,
    prelude::*,
    walls::{towards_the_sky, wall},
};

/// A wall of one color that fills the picture.
fn flat(size: UVec2, light: f32) -> Small {
    let mut small = towards_the_sky(size);
    wall(&mut small, [-600.0, -600.0], [600.0, 600.0], 100.0);
    paint(&mut small, light);
    small
}

/// Gives the wall another gray.
fn paint(small: &mut Small, light: f32) {
    let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
    for (_, material) in materials.iter_mut() {
        *material = unlit(Color::linear_rgb(light, light, light));
    }
}

/// Every pixel of the fused pass equals its reference, at every scale factor, in HDR with light
/// above 1, and with a background that shows through.
#[test]
fn every_pixel_matches_the_reference() {
    let strong = Paper {
        grain: 1.0,
        shading: 0.3,
        size: 2.0,
        ..default()
    };
    let mut small = Small::new(size(), Msaa::Off);
    for (settings, scale, hdr) in [
        (Paper::default(), 1.0, false),
        (Paper::default(), 1.25, false),
        (strong, 3.0, false),
        (strong, 1.0, true),
    ] {
        small.headless.resize(size(), scale);
        small.restart(Msaa::Off);
        small.insert(settings);
        fill(&mut small, Color::NONE);
        if hdr {
            small.insert(Hdr);
            fill(&mut small, Color::linear_rgb(3.0, 1.2, 0.4));
        }
        small.settle();
        assert!(small.ran(ComicsStage::of::<Paper>()));
        let (picture, shown) = small.pass();
        for (i, (source, found)) in picture.pixels.iter().zip(&shown.pixels).enumerate() {
            let at = [i as u32 % size().x, i as u32 / size().x].map(|v| f64::from(v) + 0.5);
            let want = paper::paper(&settings, source.map(f64::from), at, f64::from(scale), 0);
            for c in 0..3 {
                let want = want[c].clamp(0.0, if hdr { f64::MAX } else { 1.0 });
                let apart = (f64::from(found[c]) - want).abs();
                assert!(apart < 0.009, "{settings:?}, {at:?}: {found:?}, {want:?}");
            }
            assert_eq!(source[3], found[3]);
        }
    }
}

/// Truth: the mean light of a flat area stays within 1 %, from black to the white of the
/// paper, while its pixels vary.
#[test]
fn the_mean_tone_stays() {
    assert_mean_tone_stays([0, 1, 5, 9, 10]);
}

#[test]
#[ignore = "long: eleven tones"]
fn the_mean_tone_stays_at_every_tone() {
    assert_mean_tone_stays(std::array::from_fn::<u8, 11, _>(|tone| tone as u8));
}

/// Tones in tenths.
fn assert_mean_tone_stays<const N: usize>(tones: [u8; N]) {
    let page = UVec2::new(256, 192);
    let mut small = flat(page, 1.0);
    small.insert(Hdr);
    for grain in [Paper::default().grain, 1.0] {
        let settings = Paper {
            grain,
            color: Color::WHITE,
            ..default()
        };
        for tone in tones {
            let light = f32::from(tone) / 10.0;
            paint(&mut small, light);
            small.insert(settings).settle();
            let (before, after) = small.pass();
            let count = after.pixels.len() as f64;
            let mean = |p: &[[f32; 4]]| p.iter().map(|p| f64::from(p[0])).sum::<f64>() / count;
            let (was, is) = (mean(&before.pixels), mean(&after.pixels));
            assert!((is - was).abs() < 0.01, "{grain}, {light}: {was}, {is}");
            let square = |p: &[f32; 4]| (f64::from(p[0]) - is).powi(2);
            let spread = after.pixels.iter().map(square).sum::<f64>() / count;
            // Heights deviate by about 0.4; shading adds to it.
            let least = f64::from(grain * light * (1.0 - light)) * 0.3;
            assert!(spread.sqrt() >= least, "{grain}, {light}: {spread}");
        }
    }
    // On the screen too, where light above 1 is lost.
    let white = Paper {
        color: Color::WHITE,
        ..default()
    };
    small.camera_mut().remove::<Hdr>();
    small.insert(white).settle();
    let picture = small.picture();
    let lost = black_ink(&picture, picture.enumerate_pixels().map(|(x, y, _)| (x, y)));
    let mean = 1.0 - lost / f64::from(page.x * page.y);
    assert!((mean - 1.0).abs() < 0.01, "{mean}");
}

/// Both halves of a split screen are on one sheet, which is that of the whole screen.
#[test]
fn a_split_screen_is_one_sheet() {
    let mut small = flat(size(), 0.4);
    small.insert(Paper::default()).settle();
    let whole = small.picture();
    let half = UVec2::new(size().x / 2, size().y);
    let part = |left: u32, order: isize| Camera {
        viewport: Some(Viewport {
            physical_position: UVec2::new(left, 0),
            physical_size: half,
            ..default()
        }),
        order,
        ..default()
    };
    small.insert(part(0, 0));
    let target = small.headless.render_target();
    let other = crate::small::camera(target, Msaa::Off);
    let straight = (
        Transform::IDENTITY,
        Projection::Orthographic(crate::walls::unit_per_pixel(half)),
    );
    let second = small.world().spawn((other, Paper::default())).id();
    small
        .world()
        .entity_mut(second)
        .insert((straight, part(half.x, 1)));
    assert_eq!(small.settle().picture(), whole);
}

/// With a sheet of its own, a viewport shows what a picture of its size does: grain, rough lines
/// and dots, and dry brushes. On the window's sheet it does not.
#[test]
fn a_view_can_have_its_own_sheet() {
    let part = UVec2::new(44, 30);
    let place = UVec2::new(23, 9);
    let target = UVec2::new(72, 48);
    let style = |anchor: PaperAnchor, dots: bool| {
        let outlines = Outlines {
            width: 5.0,
            ..default()
        };
        let paper = Paper {
            grain: 0.8,
            ink_bleed: 1.5,
            dry_brush: 0.5,
            anchor,
            ..default()
        };
        let style = ComicStyle::new().with(outlines).with(paper);
        with_option(style, dots.then(Halftone::default))
    };
    let mut alone = Small::new(part, Msaa::Off);
    let mut small = Small::new(target, Msaa::Off);
    small.insert(Camera {
        clear_color: Color::srgb(0.3, 0.5, 0.8).into(),
        viewport: Some(Viewport {
            physical_position: place,
            physical_size: part,
            ..default()
        }),
        ..default()
    });
    for dots in [false, true] {
        for anchor in [PaperAnchor::View, PaperAnchor::Window] {
            let style = style(anchor, dots);
            let (whole, picture) = (alone.shot(&style), small.shot(&style));
            let inside = imageops::crop_imm(&picture, place.x, place.y, part.x, part.y);
            let same = inside.to_image() == whole;
            assert_eq!(same, anchor == PaperAnchor::View, "{anchor:?}, dots {dots}");
        }
    }
}

/// The sheet stays for all time, or for one drawing.
#[test]
fn sheets_change_at_their_rate() {
    let mut small = flat(UVec2::new(48, 32), 0.4);
    // A new one in every fifth frame.
    for (rate, sheets) in [(0.0, 1), (12.0, 7)] {
        small.insert(Paper { rate, ..default() }).settle();
        let mut film = vec![small.picture()];
        film.extend(small.film(30));
        let found = runs(&film).len();
        assert_eq!(found, sheets, "{rate}");
    }
}

/// Settings out of range, of paper and of speed lines, draw what the nearest end of their range
/// draws, and nothing that is no number.
#[test]
fn extreme_values_are_finite() {
    let mut small = flat(UVec2::new(96, 64), 1.0);
    small.insert(Hdr);
    for x in [f32::NAN, f32::INFINITY, -1e30, 0.0, 1e30] {
        let paper = Paper {
            grain: x,
            shading: x,
            size: x,
            rate: x,
            ..default()
        };
        for kind in [SpeedLineKind::Radial, SpeedLineKind::Parallel] {
            let lines = SpeedLines {
                kind,
                center: Vec2::splat(x),
                angle: x,
                count: u32::MAX,
                inner: x,
                width: x,
                dry_brush: x,
                rate: x,
                seed: u32::MAX,
                ..default()
            };
            small.insert((paper, lines)).settle();
            let (_, after) = small.pass();
            let is_finite = after.pixels.iter().flatten().all(|v| v.is_finite());
            assert!(is_finite, "{x}, {kind:?}");
        }
    }
}
