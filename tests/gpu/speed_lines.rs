//! Speed lines in the picture of a camera.

use bevy_comics::effect::EffectTarget;
use bevy_comics_testkit::reference::speed_lines::Drawing;

use crate::{
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(192, 128);

/// A white wall that fills the picture.
fn page() -> Small {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-200.0, -200.0], [200.0, 200.0], 100.0);
    small
}

/// The ink of every pixel, row by row.
fn ink(picture: &image::RgbaImage) -> Vec<f64> {
    let (width, height) = picture.dimensions();
    (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| 1.0 - linear(picture, x, y)[0])
        .collect()
}

/// The largest difference of a picture from its reference, in linear light.
fn apart(picture: &image::RgbaImage, drawing: &Drawing) -> f64 {
    apart_at(picture, drawing, 1)
}

/// The same of every pixel with a number that is a multiple of `step`.
fn apart_at(picture: &image::RgbaImage, drawing: &Drawing, step: usize) -> f64 {
    let found = ink(picture);
    let width = picture.width() as usize;
    let of = |(i, ink): (usize, &f64)| {
        let at = [i % width, i / width].map(|v| v as f64 + 0.5);
        (ink - drawing.coverage(at)).abs()
    };
    let pixels = found.iter().enumerate().step_by(step);
    pixels.map(of).fold(0.0, f64::max)
}

fn still(kind: SpeedLineKind) -> SpeedLines {
    SpeedLines {
        kind,
        rate: 0.0,
        count: 60,
        width: 5.0,
        ..default()
    }
}

fn drawing(settings: SpeedLines, size: UVec2, center: [f64; 2]) -> Drawing {
    Drawing {
        settings,
        size: [size.x, size.y].map(f64::from),
        scale: 1.0,
        center,
        number: 0,
    }
}

/// A code of the display is at most 0.009 of the light.
const CODE: f64 = 0.009;

/// Every pixel, at every scale factor, in a viewport that is a part of the picture, on HDR
/// cameras: lines are where they should be, and nothing else changes.
#[test]
fn every_pixel_matches_the_reference() {
    let mut small = page();
    for (scale, hdr) in [(1.0, false), (1.25, false), (3.0, false), (1.0, true)] {
        small.headless.resize(SIZE, scale);
        let target = small.headless.render_target();
        small.insert(target);
        if hdr {
            small.insert(Hdr);
        }
        for kind in [SpeedLineKind::Radial, SpeedLineKind::Parallel] {
            small.insert(still(kind)).settle();
            assert!(small.ran(ComicsStage::of::<SpeedLines>()));
            let picture = small.picture();
            let want = Drawing {
                scale: f64::from(scale),
                ..drawing(still(kind), SIZE, [96.0, 64.0])
            };
            assert!(apart(&picture, &want) < CODE, "{kind:?}, {scale}, {hdr}");
            assert!(
                ink(&picture).iter().sum::<f64>() > 50.0,
                "{kind:?}: there is ink"
            );
        }
        assert_eq!(small.errors(), 0);
    }
}

/// Few and many, narrow and wide, dry and wet lines, from places in the picture and beside it.
#[test]
fn lines_of_every_kind_match_the_reference() {
    // No divisor of the width, so that all columns take part.
    assert_lines_of_every_kind(5);
}

#[test]
#[ignore = "long: every pixel; quick test speed_lines::lines_of_every_kind_match_the_reference"]
fn lines_of_every_kind_match_the_reference_at_every_pixel() {
    assert_lines_of_every_kind(1);
}

fn assert_lines_of_every_kind(step: usize) {
    let mut small = page();
    for kind in [SpeedLineKind::Radial, SpeedLineKind::Parallel] {
        let dry = SpeedLines {
            count: 20,
            width: 40.0,
            inner: 0.0,
            angle: 37.0,
            center: Vec2::new(0.1, 0.5),
            dry_brush: 0.4,
            ..still(kind)
        };
        let wide = SpeedLines {
            count: 400,
            inner: 0.9,
            angle: -90.0,
            center: Vec2::new(1.6, 0.5),
            dry_brush: 0.0,
            ..dry
        };
        let narrow = SpeedLines {
            width: 1.0,
            inner: 0.2,
            angle: 180.0,
            center: Vec2::new(-1.0, 0.5),
            ..wide
        };
        for lines in [dry, wide, narrow] {
            small.insert(lines).settle();
            let center = (lines.center * SIZE.as_vec2()).to_array().map(f64::from);
            let apart = apart_at(&small.picture(), &drawing(lines, SIZE, center), step);
            // Places are rounded to 1e-4 pixels, a few times over. Streaks of a dry brush are five
            // times as steep as the edges of lines.
            let streaks = if lines.dry_brush > 0.0 { 1e-2 } else { 0.0 };
            assert!(apart < CODE + streaks, "{lines:?}: {apart}");
        }
    }
    assert_eq!(small.errors(), 0);
}

/// In the right half of a split screen the lines are those of a screen of that size.
#[test]
fn a_viewport_is_a_picture_of_its_own() {
    let mut small = page();
    let half = UVec2::new(SIZE.x / 2, SIZE.y);
    small.see_in([half.x, 0, half.x, half.y]);
    small.insert(still(SpeedLineKind::Radial)).settle();
    let picture = small.picture();
    let right = image::imageops::crop_imm(&picture, half.x, 0, half.x, half.y).to_image();
    let want = drawing(still(SpeedLineKind::Radial), half, [48.0, 64.0]);
    assert!(apart(&right, &want) < CODE);
}

/// Six different drawings in half a second of 30 frames, and none between them; none at all
/// while the game is paused.
#[test]
fn twelve_drawings_a_second() {
    let mut small = page();
    small.insert(SpeedLines::default()).settle();
    let mut last = small.picture();
    let mut seen = vec![last.clone()];
    let mut changes = Vec::new();
    for frame in 0..30 {
        small.headless.step(1);
        let next = small.picture();
        if next != last {
            changes.push(frame);
            assert!(!seen.contains(&next), "frame {frame} is an old drawing");
            seen.push(next.clone());
        }
        last = next;
    }
    assert_eq!(changes.len(), 6, "{changes:?}");
    assert!(
        changes.windows(2).all(|pair| pair[1] - pair[0] == 5),
        "{changes:?}"
    );
    small.world().resource_mut::<Time<Virtual>>().pause();
    small.headless.step(1);
    let paused = small.picture();
    for _ in 0..6 {
        small.headless.step(1);
        assert_eq!(small.picture(), paused);
    }
}

/// Lines point at a place of the picture, and at an object: where it is on the screen,
/// before the camera; else at their own place.
#[test]
fn lines_follow_an_object() {
    let mut small = page();
    let lines = SpeedLines {
        center: Vec2::new(0.25, 0.75),
        ..still(SpeedLineKind::Radial)
    };
    small.insert(lines).settle();
    let own = [48.0, 96.0];
    assert!(apart(&small.picture(), &drawing(lines, SIZE, own)) < CODE);
    // One unit per pixel, the origin in the middle.
    let hero = small.put(
        Sphere::new(0.1),
        unlit(Color::WHITE),
        Transform::from_xyz(30.0, 20.0, -50.0),
    );
    let target = EffectTarget {
        entity: hero,
        offset: Vec3::new(2.0, 0.0, 0.0),
    };
    small.insert(target).settle();
    let there = [96.0 + 32.0, 64.0 - 20.0];
    assert!(apart(&small.picture(), &drawing(lines, SIZE, there)) < CODE);
    // Behind a perspective camera.
    small.insert(Projection::default());
    let behind = Transform::from_xyz(3.0, 2.0, 50.0);
    small.world().entity_mut(hero).insert(behind);
    assert!(apart(&small.settle().picture(), &drawing(lines, SIZE, own)) < CODE);
    small.world().despawn(hero);
    assert!(apart(&small.settle().picture(), &drawing(lines, SIZE, own)) < CODE);
    assert_eq!(small.errors(), 0);
}

/// On a transparent background the ink is opaque, and the rest stays transparent.
#[test]
fn ink_is_opaque_on_nothing() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small.camera_settings().clear_color = Color::NONE.into();
    let lines = SpeedLines {
        color: Color::WHITE,
        ..still(SpeedLineKind::Radial)
    };
    small.insert(lines).settle();
    let want = drawing(lines, SIZE, [96.0, 64.0]);
    for (x, y, pixel) in small.picture().enumerate_pixels() {
        let coverage = want.coverage([x, y].map(|v| f64::from(v) + 0.5));
        let alpha = f64::from(pixel.0[3]) / 255.0;
        assert!(
            (alpha - coverage).abs() < 0.006,
            "{x}, {y}: {alpha}, {coverage}"
        );
    }
}

/// More ink the wider the lines are asked, and none with an opacity of 0.
#[test]
fn ink_follows_the_width() {
    let mut small = page();
    let all = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    let mut ink = |lines: SpeedLines| {
        small.insert(lines).settle();
        black_ink(&small.picture(), all.clone())
    };
    let [narrow, wide] = [2.0, 4.0].map(|width| {
        ink(SpeedLines {
            width,
            ..still(SpeedLineKind::Radial)
        })
    });
    assert!((wide / narrow - 2.0).abs() < 0.05, "{narrow}, {wide}");
    // A dry brush leaves out more and more.
    let drier = [0.2, 0.5, 0.8, 1.0].map(|dry| {
        ink(SpeedLines {
            width: 4.0,
            dry_brush: dry,
            ..still(SpeedLineKind::Radial)
        }) / wide
    });
    assert!(drier.is_sorted_by(|a, b| a > b), "{drier:?}");
    assert!(drier[0] > 0.85 && drier[3] < 0.15, "{drier:?}");
    let none = ink(SpeedLines {
        opacity: 0.0,
        ..still(SpeedLineKind::Radial)
    });
    assert!(none < 0.01 * narrow, "{none}");
}
