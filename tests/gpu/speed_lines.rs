//! Speed lines in the picture of a camera.

use bevy_comics::effect::EffectTarget;

use crate::{
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(192, 128);
const KINDS: [SpeedLineKind; 2] = [SpeedLineKind::Radial, SpeedLineKind::Parallel];

/// A white wall that fills the picture.
fn page(size: UVec2) -> Small {
    let mut small = towards_the_sky(size);
    wall(&mut small, [-200.0, -200.0], [200.0, 200.0], 100.0);
    small
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

/// The picture with these lines.
fn drawn(small: &mut Small, lines: SpeedLines) -> image::RgbaImage {
    small.insert(lines).settle();
    assert!(small.ran(ComicsStage::of::<SpeedLines>()));
    small.picture()
}

/// The place of a pixel, from the middle of the picture.
fn from_middle([x, y]: [u32; 2]) -> DVec2 {
    DVec2::new(x.into(), y.into()) + 0.5 - 0.5 * SIZE.as_dvec2()
}

fn all_pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)))
}

/// How many lines a closed path of pixels crosses.
fn crossed(picture: &image::RgbaImage, path: impl Iterator<Item = (u32, u32)>) -> usize {
    let is_inked = |(x, y)| linear(picture, x, y)[0] < 0.98;
    let inked: Vec<bool> = path.map(is_inked).collect();
    let before = |i: usize| inked[(i + inked.len() - 1) % inked.len()];
    (0..inked.len())
        .filter(|i| inked[*i] && !before(*i))
        .count()
}

/// Truth: around a circle there are as many lines as asked. Their widths are 0.2 + 0.8 u^2 of that
/// asked, with u from 0 to 1: 0.467 in the mean, in proportion to the distance from the point.
#[test]
fn lines_towards_a_point_are_as_many_and_as_wide_as_asked() {
    const RING: Range<f64> = 56.0..62.0;
    let mut small = page(SIZE);
    let (mut ink, mut count) = (0.0, 0);
    for seed in 0..8 {
        let lines = SpeedLines {
            seed,
            count: 24,
            inner: 0.0,
            ..still(SpeedLineKind::Radial)
        };
        let picture = drawn(&mut small, lines);
        let is_in_ring = |(x, y): &(u32, u32)| RING.contains(&from_middle([*x, *y]).length());
        ink += black_ink(&picture, all_pixels().filter(is_in_ring));
        let circle = (0..3600).map(|tenth| {
            let away = 60.0 * DVec2::from_angle(f64::from(tenth).to_radians() / 10.0);
            let at = 0.5 * SIZE.as_dvec2() + away;
            (at.x as u32, at.y as u32)
        });
        count += crossed(&picture, circle);
    }
    // Two lines of the largest width may touch.
    assert!((8 * 21..=8 * 24).contains(&count), "{count}");
    let grown = 59.0 / 96f64.hypot(64.0);
    let want = 8.0 * 24.0 * 5.0 * 0.467 * grown * (RING.end - RING.start);
    assert!((ink / want - 1.0).abs() < 0.12, "{ink}, {want}");
}

/// Truth: each of the lines alongside each other begins at one side of the picture.
#[test]
fn parallel_lines_are_as_many_and_as_wide_as_asked() {
    let mut small = page(SIZE);
    let (mut ink, mut count) = (0.0, 0);
    for seed in 0..8 {
        let lines = SpeedLines {
            seed,
            count: 20,
            width: 1.0,
            ..still(SpeedLineKind::Parallel)
        };
        let picture = drawn(&mut small, lines);
        for x in [0, SIZE.x - 1] {
            let side = || (0..SIZE.y).map(move |y| (x, y));
            count += crossed(&picture, side());
            ink += black_ink(&picture, side());
        }
    }
    // Lines may lie in pixels beside each other.
    assert!((8 * 20 - 8..=8 * 20).contains(&count), "{count}");
    let want = 8.0 * 20.0 * 0.467;
    assert!((ink / want - 1.0).abs() < 0.15, "{ink}, {want}");
}

/// Truth: nothing is drawn in the ellipse that stays clear, of either kind, and a lot around it.
#[test]
fn the_middle_stays_clear() {
    let mut small = page(SIZE);
    for kind in KINDS {
        let lines = SpeedLines {
            inner: 0.6,
            width: 40.0,
            ..still(kind)
        };
        let picture = drawn(&mut small, lines);
        // A parallel line is as wide as it is: its middle is outside.
        let is_clear = |(x, y): &(u32, u32)| {
            (from_middle([*x, *y]) / (0.5 * 0.6 * SIZE.as_dvec2())).length() < 0.9
        };
        let inside = black_ink(&picture, all_pixels().filter(is_clear));
        let all = black_ink(&picture, all_pixels());
        assert!(inside < 1e-6 && all > 100.0, "{kind:?}: {inside} of {all}");
    }
}

/// Turned by a right angle, a square picture of parallel lines is the turned picture.
#[test]
fn the_angle_turns_parallel_lines() {
    let mut small = page(UVec2::splat(96));
    let [level, upright] = [0.0, 90.0].map(|angle| {
        let lines = SpeedLines {
            angle,
            ..still(SpeedLineKind::Parallel)
        };
        drawn(&mut small, lines)
    });
    assert_ne!(level, upright);
    assert!(apart(&image::imageops::rotate270(&level), &upright) <= 1);
}

/// In the right half of a split screen the lines are those of a screen of that size; and on HDR
/// cameras they are the same.
#[test]
fn a_viewport_is_a_picture_of_its_own() {
    let half = UVec2::new(SIZE.x / 2, SIZE.y);
    let (mut small, mut alone) = (page(SIZE), page(half));
    small.see_in([half.x, 0, half.x, half.y]);
    alone.insert(Hdr);
    for kind in KINDS {
        let picture = drawn(&mut small, still(kind));
        let right = image::imageops::crop_imm(&picture, half.x, 0, half.x, half.y).to_image();
        assert!(
            apart(&right, &drawn(&mut alone, still(kind))) <= 1,
            "{kind:?}"
        );
    }
}

/// Six different drawings in half a second of 30 frames, and none between them; none at all
/// while the game is paused.
#[test]
fn twelve_drawings_a_second() {
    let mut small = page(SIZE);
    let mut film = vec![drawn(&mut small, SpeedLines::default())];
    film.extend(small.film(30));
    let drawings: Vec<_> = film.chunk_by(|a, b| a == b).collect();
    assert_eq!(drawings.len(), 7);
    assert!(drawings[1..6].iter().all(|drawing| drawing.len() == 5));
    let others: HashSet<&[u8]> = drawings.iter().map(|d| d[0].as_raw().as_slice()).collect();
    assert_eq!(others.len(), 7, "an old drawing");
    small.world().resource_mut::<Time<Virtual>>().pause();
    let paused = small.film(7);
    assert!(paused.iter().all(|picture| *picture == paused[0]));
}

/// Lines point at a place of the picture, and at an object: where it is on the screen,
/// before the camera; else at their own place.
#[test]
fn lines_follow_an_object() {
    let mut small = page(SIZE);
    let towards = |at: Vec2| SpeedLines {
        center: at / SIZE.as_vec2(),
        ..still(SpeedLineKind::Radial)
    };
    let lines = towards(Vec2::new(48.0, 96.0));
    // One unit per pixel, the origin in the middle.
    let there = drawn(&mut small, towards(Vec2::new(96.0 + 32.0, 64.0 - 20.0)));
    let own = drawn(&mut small, lines);
    assert!(apart(&there, &own) > 100);
    let hero = small.put(
        Sphere::new(0.1),
        unlit(Color::WHITE),
        Transform::from_xyz(30.0, 20.0, -50.0),
    );
    let target = EffectTarget {
        entity: hero,
        offset: Vec3::new(2.0, 0.0, 0.0),
    };
    small.insert(target);
    assert!(apart(&drawn(&mut small, lines), &there) <= 1);
    // Behind a perspective camera.
    small.insert(Projection::default());
    let behind = Transform::from_xyz(3.0, 2.0, 50.0);
    small.world().entity_mut(hero).insert(behind);
    assert!(apart(&drawn(&mut small, lines), &own) <= 1);
    small.world().despawn(hero);
    assert!(apart(&drawn(&mut small, lines), &own) <= 1);
}

/// On a transparent background the ink is as opaque as it covers a page, and the rest stays
/// transparent.
#[test]
fn ink_is_opaque_on_nothing() {
    let lines = still(SpeedLineKind::Radial);
    let page = drawn(&mut page(SIZE), lines);
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small.camera_settings().clear_color = Color::NONE.into();
    let white = SpeedLines {
        color: Color::WHITE,
        ..lines
    };
    for (x, y, pixel) in drawn(&mut small, white).enumerate_pixels() {
        let coverage = 1.0 - linear(&page, x, y)[0];
        let alpha = f64::from(pixel.0[3]) / 255.0;
        // Of both pictures, a code of rounding; of the page, it is up to 0.009 of the light.
        assert!(
            (alpha - coverage).abs() < 0.011,
            "{x}, {y}: {alpha}, {coverage}"
        );
    }
}

/// More ink the wider the lines are asked, and none with an opacity of 0.
#[test]
fn ink_follows_the_width() {
    let mut small = page(SIZE);
    let mut ink = |lines: SpeedLines| {
        small.insert(lines).settle();
        black_ink(&small.picture(), all_pixels())
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
