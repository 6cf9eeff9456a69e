//! Focus in the picture of a camera.

use bevy_comics::effect::EffectTarget;
use bevy_comics_testkit::reference::focus::{SKY, Scene};

use crate::{
    halftone::covered,
    pictures::assert_later_pass_matches_the_reference,
    prelude::*,
    walls::{towards_the_sky, unit_per_pixel},
};

const STYLES: [FocusStyle; 4] = [
    FocusStyle::Blur,
    FocusStyle::Offset,
    FocusStyle::Paint,
    FocusStyle::Dots,
];

pub fn at(distance: f32, style: FocusStyle) -> Focus {
    Focus {
        at: FocusAt::Distance,
        style,
        distance,
        ..default()
    }
}

/// Compares every pixel with the reference, in perspective views.
fn assert_matches_the_reference(
    small: &mut Small,
    s: Focus,
    focus_at: f64,
    viewport: Option<[u32; 4]>,
) {
    let before = ComicStyle::new().with(Desaturation::default());
    assert_later_pass_matches_the_reference(small, &before, s, viewport, |view, sheet, nudge| {
        let [left, top, ..] = view.viewport;
        let distance = |[x, y]: [usize; 2]| {
            let of = |sample| match view.depth(left + x as u32, top + y as u32, sample) {
                0.0 => SKY,
                raw => 0.1 / raw,
            };
            (0..view.samples).map(of).fold(SKY, f64::min)
        };
        let scene = Scene {
            sheet,
            distance: &distance,
            focus_at,
            reference: None,
            scale: 1.0,
            nudge: 1.0 + nudge,
        };
        scene.focused(&s)
    });
}

#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        for style in STYLES {
            let s = Focus {
                clear: 0.1,
                ramp: 0.6,
                radius: 7.5,
                ..at(5.0, style)
            };
            assert_matches_the_reference(&mut small, s, 5.0, None);
        }
    }
}

#[test]
fn a_viewport_is_a_picture_of_its_own() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let viewport = [11, 5, 43, 30];
    small.see_in(viewport);
    for style in STYLES {
        assert_matches_the_reference(&mut small, at(5.0, style), 5.0, Some(viewport));
    }
}

/// A background that shows through keeps nothing of the picture.
#[test]
fn a_transparent_background_stays() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    small.camera_settings().clear_color = Color::NONE.into();
    for style in STYLES {
        assert_matches_the_reference(&mut small, at(4.0, style), 4.0, None);
        let (read, wrote) = small.pass();
        for (read, wrote) in read.pixels.iter().zip(&wrote.pixels) {
            assert_eq!(read[3], wrote[3]);
            assert!(read[3] > 0.0 || *wrote == [0.0; 4], "{style:?}: {wrote:?}");
        }
    }
}

/// A red figure before stripes of blue and green.
pub fn figure(small: &mut Small, near: f32, far: f32) {
    small.clear();
    small.insert((Transform::IDENTITY, Projection::default()));
    let scale = |distance: f32| distance * (std::f32::consts::PI / 8.0).tan();
    let red = Transform::from_xyz(0.0, 0.0, -near);
    let size = 0.8 * scale(near);
    small.put(
        Rectangle::new(size, size),
        unlit(Color::linear_rgb(1.0, 0.0, 0.0)),
        red,
    );
    for i in -20..20 {
        let color = if i % 2 == 0 {
            Color::linear_rgb(0.0, 1.0, 0.0)
        } else {
            Color::linear_rgb(0.0, 0.0, 1.0)
        };
        let width = 0.2 * scale(far);
        let stripe = Transform::from_xyz(width * i as f32, 0.0, -far);
        small.put(
            Rectangle::new(width, 4.0 * scale(far)),
            unlit(color),
            stripe,
        );
    }
}

/// A sharp figure before something that is out of focus: it is unchanged, and with it, under MSAA,
/// its border, which is part figure. Gives the largest code of red beside it, and the number of
/// pixels that change.
fn bleeding(small: &mut Small, style: FocusStyle) -> (u8, usize) {
    let plain = small.shot(&ComicStyle::new());
    let s = Focus {
        radius: 8.0,
        ..at(5.0, style)
    };
    let picture = small.shot(&ComicStyle::new().with(s));
    assert!(small.ran(ComicsStage::of::<Focus>()));
    let (mut inside, mut changed, mut red) = (0, 0, 0);
    for (a, b) in plain.pixels().zip(picture.pixels()) {
        if a.0[0] > 0 {
            assert_eq!(a, b, "{style:?}: the figure");
            inside += 1;
        } else {
            red = red.max(b.0[0]);
            changed += usize::from(a != b);
        }
    }
    assert!(inside > 200, "{style:?}: {inside}");
    (red, changed)
}

/// Truth: not a trace of a sharp figure is beside it. Painted, that is so over an even background:
/// areas that reach over its outline vary, so they do not count; over stripes, where all areas
/// vary, some do.
#[test]
fn a_sharp_figure_does_not_bleed() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        figure(&mut small, 5.0, 60.0);
        for style in [FocusStyle::Blur, FocusStyle::Offset] {
            let (red, changed) = bleeding(&mut small, style);
            assert!(red == 0 && changed > 1000, "{style:?}, {msaa:?}: {red}");
        }
        bleeding(&mut small, FocusStyle::Paint);
        let blue = unlit(Color::linear_rgb(0.0, 0.0, 1.0));
        let before_the_stripes = Transform::from_xyz(0.0, 0.0, -50.0);
        small.put(Rectangle::new(200.0, 200.0), blue, before_the_stripes);
        let (red, _) = bleeding(&mut small, FocusStyle::Paint);
        assert_eq!(red, 0, "painted, {msaa:?}");
    }
}

/// Truth: what is out of focus in front stays inside its outline, over a sharp background.
#[test]
fn an_unsharp_figure_keeps_its_outline() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    figure(&mut small, 5.0, 60.0);
    let plain = small.shot(&ComicStyle::new());
    let blurred = small.shot(&ComicStyle::new().with(at(60.0, FocusStyle::Blur)));
    for (a, b) in plain.pixels().zip(blurred.pixels()) {
        assert!(a.0[0] == 255 || a == b, "the background");
    }
}

/// Blurred stripes are even, and more so the farther they are from the focus.
#[test]
fn blur_grows_with_the_distance_from_the_focus() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    figure(&mut small, 5.0, 60.0);
    let mut contrast = |focus_at: f32| {
        let s = at(focus_at, FocusStyle::Blur);
        let picture = small.shot(&ComicStyle::new().with(s));
        let greens: Vec<f64> = (6..66).map(|x| linear(&picture, x, 4)[1]).collect();
        let mean = greens.iter().sum::<f64>() / greens.len() as f64;
        greens.iter().map(|g| (g - mean).powi(2)).sum::<f64>()
    };
    let found = [60.0, 35.0, 28.0, 10.0].map(&mut contrast);
    assert!(found.is_sorted_by(|a, b| a > b), "{found:?}");
    assert!(found[3] < 0.1 * found[0], "{found:?}");
}

/// The focus follows an object, wherever it moves, and stays at its own distance while there
/// is none.
#[test]
fn the_focus_follows_an_object() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    let hero = small.world().spawn(Transform::default()).id();
    let own = Focus {
        distance: 3.0,
        ..default()
    };
    let with_target = |small: &mut Small, distance: f32| {
        let camera = small.camera;
        let eye = *small.world().get::<Transform>(camera).expect("placed");
        let place = eye.transform_point(Vec3::new(0.4, 0.2, -distance));
        let moved = Transform::from_translation(place);
        small.world().entity_mut(hero).insert(moved);
        small.shot(&ComicStyle::new().with(own))
    };
    small.insert(EffectTarget::new(hero));
    let mut seen = Vec::new();
    for distance in [2.0, 5.0, 40.0] {
        let followed = with_target(&mut small, distance);
        let fixed = ComicStyle::new().with(at(distance, FocusStyle::Blur));
        let fixed = small.shot(&fixed);
        // The distance is rounded on its way through the world.
        assert!(apart(&followed, &fixed) <= 1, "{distance}");
        seen.push(followed);
    }
    assert!(seen[0] != seen[1] && seen[1] != seen[2]);
    let behind = with_target(&mut small, -5.0);
    let fixed = small.shot(&ComicStyle::new().with(at(3.0, FocusStyle::Blur)));
    assert_eq!(behind, fixed);
}

/// The middle of the view is as sharp as without the effect, be it a thing or the sky.
#[test]
fn the_middle_of_the_view_is_in_focus() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let style = ComicStyle::new().with(Focus {
        at: FocusAt::Center,
        ..default()
    });
    for distance in [5.0, 50.0] {
        figure(&mut small, distance, 600.0);
        let plain = small.shot(&ComicStyle::new());
        let picture = small.shot(&style);
        let middle = plain
            .pixels()
            .zip(picture.pixels())
            .filter(|(a, _)| a.0[0] == 255);
        assert!(middle.into_iter().all(|(a, b)| a == b), "{distance}");
        assert_ne!(plain, picture);
    }
}

/// A thin wire before the middle does not take the focus, and a new distance is approached.
#[test]
fn the_focus_of_the_middle_is_steady() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let style = ComicStyle::new().with(Focus {
        at: FocusAt::Center,
        ..default()
    });
    // All pixels but those near the wire.
    let beside = |picture: &image::RgbaImage| {
        let [left, right] =
            [0, 46].map(|x| image::imageops::crop_imm(picture, x, 0, 26, 48).to_image());
        (left, right)
    };
    figure(&mut small, 5.0, 600.0);
    let far = small.shot(&style);
    let wire = (Cuboid::new(0.017, 4.0, 0.001), unlit(Color::BLACK));
    let wire = small.put(wire.0, wire.1, Transform::from_xyz(0.0087, 0.0, -1.0));
    let with_wire = small.shot(&style);
    assert!(with_wire != far, "the wire is seen");
    assert!(beside(&with_wire) == beside(&far));
    small.world().despawn(wire);

    small.clear();
    figure(&mut small, 50.0, 600.0);
    // 4 frames of a 60th of a second: the focus is still nearer than the figure.
    small.headless.step(4);
    let first = small.picture();
    assert!(
        first.get_pixel(36, 24).0[0] > 100,
        "{:?}",
        first.get_pixel(36, 24)
    );
    small.wait(2.0);
    let last = small.picture();
    assert!(first != last);
    small.restart(Msaa::Off);
    figure(&mut small, 50.0, 600.0);
    assert!(small.shot(&style) == last);
}

/// Orthographic views: the reference is 1.2 times the height, here 48 pixels of one unit.
#[test]
fn an_orthographic_view_has_a_focus() {
    let mut small = towards_the_sky(UVec2::new(72, 48));
    small.insert(Projection::Orthographic(OrthographicProjection {
        far: 500.0,
        ..unit_per_pixel(UVec2::new(72, 48))
    }));
    let stripes = |small: &mut Small, distance: f32| {
        small.clear();
        for i in 0..9 {
            let color = Color::linear_rgb(0.0, 1.0, 0.0);
            let stripe = Transform::from_xyz(8.0 * i as f32 - 32.0, 0.0, -distance);
            small.put(Rectangle::new(4.0, 100.0), unlit(color), stripe);
        }
        let back = Transform::from_xyz(0.0, 0.0, -distance - 0.01);
        small.put(Rectangle::new(100.0, 100.0), unlit(Color::BLACK), back);
        let plain = small.shot(&ComicStyle::new());
        let s = ComicStyle::new().with(at(100.0, FocusStyle::Blur));
        (plain, small.shot(&s))
    };
    let reference = 0.5 * 48.0 / 22.5f32.to_radians().tan();
    for sharp in [100.0, 100.0 - 0.14 * reference, 100.0 + 0.14 * reference] {
        let (plain, picture) = stripes(&mut small, sharp);
        assert_eq!(plain, picture, "{sharp}");
    }
    for far in [100.0 - 0.9 * reference, 100.0 + 1.2 * reference] {
        let (plain, picture) = stripes(&mut small, far);
        let green = |p: &image::RgbaImage| linear(p, 36, 24)[1];
        assert_eq!(green(&plain), 1.0);
        assert!(green(&picture) < 0.7, "{far}: {}", green(&picture));
    }
}

#[test]
fn lines_stay_sharp() {
    let mut small = Small::new(UVec2::new(64, 44), Msaa::Off);
    let bare = covered(&mut small, &ComicStyle::new());
    let s = ComicStyle::new().with(at(3.0, FocusStyle::Blur));
    assert_eq!(bare, covered(&mut small, &s));
}

/// Numbers out of range, and light beyond all displays: nothing that is no number.
#[test]
fn extreme_values_are_finite() {
    let mut small = Small::new(UVec2::new(33, 21), Msaa::Off);
    small.insert(Hdr);
    let bright = Color::linear_rgb(60000.0, 1e9, 1e-30);
    small.put(
        Sphere::new(0.6),
        unlit(bright),
        Transform::from_xyz(0.0, 1.0, 2.0),
    );
    for style in STYLES {
        for x in [f32::NAN, 1e30] {
            let s = Focus {
                at: FocusAt::Center,
                style,
                distance: x,
                clear: if x.is_nan() { x } else { 0.0 },
                ramp: x,
                radius: x,
                cell_size: x,
            };
            for at in [FocusAt::Center, FocusAt::Distance] {
                small
                    .insert((Focus { at, ..s }, Outlines::default()))
                    .settle();
                let (_, after) = small.pass();
                let finite = after.pixels.iter().flatten().all(|v| v.is_finite());
                assert!(finite, "{style:?}, {x}");
            }
        }
    }
}
