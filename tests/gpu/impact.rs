//! Impact frames: what they show, for how long, and how often.

use bevy::time::TimeUpdateStrategy;
use bevy_comics::{Impact, ReduceFlashing, diagnostics::ImpactCounts};
use bevy_comics_testkit::headless::FRAME;
use image::RgbaImage;

use crate::{line_scenes::runs, prelude::*};

fn small() -> Small {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    small.settle();
    small
}

fn trigger(small: &mut Small, edit: impl Fn(&mut Impact)) {
    let mut impact = Impact::new(small.camera);
    edit(&mut impact);
    small.world().trigger(impact);
    small.world().flush();
}

fn counted(shown: u32, refused: u32) -> Option<ImpactCounts> {
    Some(ImpactCounts { shown, refused })
}

fn counts_of(small: &Small, camera: Entity) -> Option<ImpactCounts> {
    let world = small.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    diagnostics.impacts.get(&camera).copied()
}

fn counts(small: &Small) -> Option<ImpactCounts> {
    counts_of(small, small.camera)
}

/// Black and white, and no colors, unlike the scene.
fn is_two_tone(picture: &RgbaImage) -> bool {
    let gray = |p: &image::Rgba<u8>| p.0[0] == p.0[1] && p.0[1] == p.0[2];
    let extreme = picture.pixels().filter(|p| matches!(p.0[0], 0 | 255));
    picture.pixels().all(gray) && extreme.count() * 2 > picture.pixels().len()
}

/// From the next frame on, two drawings of five frames each; then the picture is as before,
/// to the bit. The camera has no other effect.
#[test]
fn an_impact_is_two_drawings_and_then_nothing() {
    let mut small = small();
    let before = small.picture();
    trigger(&mut small, |_| {});
    let film = small.film(20);
    assert_eq!(runs(&film), [5, 5, 10]);
    assert!(is_two_tone(&film[0]) && is_two_tone(&film[9]));
    assert_eq!(film[10], before);
    assert_eq!(counts(&small), counted(1, 0));
}

/// The effects of the camera are replaced for the time of the impact, and come back.
#[test]
fn a_style_comes_back() {
    let mut small = small();
    let lines = SpeedLines {
        rate: 0.0,
        color: Color::srgb(1.0, 0.0, 0.0),
        ..default()
    };
    let tones = TwoTone {
        light: Color::srgb(0.2, 1.0, 0.2),
        ..default()
    };
    small.insert((Outlines::default(), lines, tones)).settle();
    let before = small.picture();
    trigger(&mut small, |impact| impact.drawings = 1);
    let film = small.film(12);
    assert_eq!(runs(&film), [5, 7]);
    let red = |p: &image::Rgba<u8>| p.0[0] > 150 && p.0[1] < 50;
    assert!(before.pixels().any(red) && !film[0].pixels().any(red));
    assert_eq!(film[5], before);
    let camera = small.camera;
    let kept = small.world().get::<TwoTone>(camera);
    assert_eq!(kept.expect("its tones").light, tones.light);
}

/// Alternate drawings exchange the tones.
#[test]
fn tones_alternate() {
    let mut small = small();
    trigger(&mut small, |impact| {
        impact.drawings = 3;
        impact.alternate = true;
        impact.lines = None;
    });
    let film = small.film(18);
    assert_eq!(runs(&film), [5, 5, 5, 3]);
    assert_eq!(film[0], film[10]);
    for (a, b) in film[0].pixels().zip(film[5].pixels()) {
        let sum = u32::from(a.0[0]) + u32::from(b.0[0]);
        // Of soft pixels at the edge, light is exchanged, not codes.
        assert!(sum == 255 || a.0[0].clamp(1, 254) == a.0[0], "{a:?}, {b:?}");
    }
}

/// Lines in the color of a tone are exchanged with it: they are as visible on the negative.
#[test]
fn lines_are_exchanged_with_the_tones() {
    let mut small = small();
    small.clear();
    trigger(&mut small, |impact| impact.tones.threshold = 0.0);
    small.headless.step(1);
    let plain = small.picture();
    small.wait(1.0);
    trigger(&mut small, |impact| {
        impact.tones.threshold = 0.0;
        impact.tones.invert = true;
    });
    small.headless.step(1);
    let negative = small.picture();
    for code in [0, 255] {
        let found = plain.pixels().filter(|p| p.0[..3] == [code; 3]);
        assert!(found.count() > 100, "{code}");
    }
    for (x, y, _) in plain.enumerate_pixels() {
        let sum = linear(&plain, x, y)[0] + linear(&negative, x, y)[0];
        // Half a code of rounding in each: up to 0.0046 in white.
        assert!((sum - 1.0).abs() < 0.0092, "({x}, {y}): {sum}");
    }
}

/// Truth: of flashes every 100 ms for three seconds, no second of real time has more than
/// three, wherever it begins. Refused ones change nothing.
#[test]
fn a_fourth_flash_in_a_second_is_refused() {
    let mut small = small();
    let before = small.picture();
    let mut begins = Vec::new();
    // 30 frames are a second, and two frames a drawing.
    let frame_time = TimeUpdateStrategy::ManualDuration(2 * FRAME);
    small.world().insert_resource(frame_time);
    for frame in 0..90usize {
        let shown = counts(&small);
        if frame % 3 == 0 {
            trigger(&mut small, |impact| {
                impact.drawings = 1;
                impact.rate = 24.0;
            });
        }
        small.headless.step(1);
        if counts(&small).map(|c| c.shown) != shown.map(|c| c.shown) {
            begins.push(frame);
            assert!(is_two_tone(&small.picture()), "frame {frame}");
        } else if begins.last().is_none_or(|begin| frame - begin >= 2) {
            assert_eq!(small.picture(), before, "frame {frame}");
        }
    }
    for begin in 0..60 {
        let second = begin..begin + 30;
        let within = begins.iter().filter(|f| second.contains(*f)).count();
        assert!(within <= Impact::MOST_FLASHES, "{begin}: {begins:?}");
    }
    // A flash counts from the frame after its trigger, which is later than that of the test.
    assert_eq!(begins[..4], [0, 3, 6, 33], "{begins:?}");
    assert_eq!(begins.len(), 9);
    assert_eq!(counts(&small), counted(9, 21));
}

/// An impact that alternates counts as two flashes.
#[test]
fn alternating_tones_are_two_flashes() {
    let mut small = small();
    for _ in 0..3 {
        trigger(&mut small, |impact| impact.alternate = true);
    }
    assert_eq!(counts(&small), counted(1, 2));
    trigger(&mut small, |_| {});
    assert_eq!(counts(&small), counted(2, 2));
}

/// Two views of one picture share the limit; a view of another picture has its own.
#[test]
fn views_of_one_picture_share_the_limit() {
    let mut small = small();
    let camera = small.camera;
    let target = small.world().get::<RenderTarget>(camera).cloned();
    let target = target.expect("the target of the camera");
    let elsewhere = RenderTarget::None { size: UVec2::ONE };
    let world = small.world();
    let order = |order| Camera { order, ..default() };
    let beside = world.spawn((Camera3d::default(), order(1), target)).id();
    let apart = world.spawn((Camera3d::default(), order(2), elsewhere)).id();
    for camera in [camera, camera, beside, beside, camera, apart] {
        world.trigger(Impact::new(camera));
        world.flush();
    }
    let counts = [camera, beside, apart].map(|camera| counts_of(&small, camera));
    assert_eq!(counts, [counted(2, 1), counted(1, 1), counted(1, 0)]);
}

/// With reduced flashing the picture loses 20 % of its light, in one drawing, and comes
/// back.
#[test]
fn reduced_flashing_dims() {
    let mut small = small();
    small.insert(StyleWeight(1.0)).settle();
    small.world().insert_resource(ReduceFlashing(true));
    trigger(&mut small, |impact| {
        impact.alternate = true;
        impact.lines = None;
    });
    small.headless.step(1);
    let (before, after) = small.pass();
    for (a, b) in before.pixels.iter().zip(&after.pixels) {
        for c in 0..3 {
            assert!((b[c] - 0.8 * a[c]).abs() < 0.009, "{a:?}, {b:?}");
        }
    }
    let film = small.film(14);
    assert_eq!(runs(&film), [9, 5]);
    // Lines stand still.
    small.wait(1.0);
    trigger(&mut small, |_| {});
    let film = small.film(15);
    assert_eq!(runs(&film), [10, 5]);
}

/// While the game is paused the impact stays, and flashes are counted in real time.
#[test]
fn a_pause_holds_the_impact() {
    let mut small = small();
    trigger(&mut small, |_| {});
    small.headless.step(2);
    small.world().resource_mut::<Time<Virtual>>().pause();
    let film = small.film(90);
    assert_eq!(runs(&film), [90]);
    assert!(is_two_tone(&film[0]));
    for _ in 0..4 {
        trigger(&mut small, |_| {});
    }
    assert_eq!(counts(&small), counted(4, 1));
}

/// Numbers out of range count as the nearest end of their range; what is no camera is left
/// alone.
#[test]
fn extreme_impacts_end() {
    let mut small = small();
    let before = small.picture();
    for rate in [f32::NAN, 0.0, f32::INFINITY] {
        trigger(&mut small, |impact| {
            impact.drawings = u32::MAX;
            impact.rate = rate;
            impact.tones.threshold = f32::NAN;
        });
        // Three drawings at the lowest rate are 0.75 s.
        small.wait(1.0);
        assert_eq!(small.picture(), before, "{rate}");
    }
    let nobody = small.world().spawn_empty().id();
    small.world().trigger(Impact::new(nobody));
    small.headless.step(2);
    assert_eq!(small.picture(), before);
    assert_eq!(counts_of(&small, nobody), None);
}
