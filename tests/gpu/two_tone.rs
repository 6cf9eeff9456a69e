//! Two tones in the picture of a camera.

use bevy_comics::effect::linear_rgb;
use bevy_comics_testkit::reference::color;

use crate::{
    prelude::*,
    walls::{towards_the_sky, wall},
};

/// Truth: flat areas are of one tone or the other, on the side of the threshold that their
/// lightness is on.
#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(size(), Msaa::Off);
    for settings in [
        TwoTone {
            threshold: 0.5,
            ..default()
        },
        TwoTone {
            threshold: 0.7,
            invert: true,
            amount: 0.4,
            dark: Color::srgb(0.1, 0.2, 0.6),
            light: Color::srgb(0.9, 0.8, 0.7),
            ..default()
        },
    ] {
        let tones = [settings.dark, settings.light].map(linear_rgb);
        for hdr in [false, true] {
            small.restart(Msaa::Off);
            if hdr {
                small.insert(Hdr);
            }
            small.insert(settings).settle();
            let (picture, shown) = small.pass();
            let mut count = [0; 2];
            for (x, y) in (1..size().y - 1).flat_map(|y| (1..size().x - 1).map(move |x| (x, y))) {
                let index = |x: u32, y: u32| (y * size().x + x) as usize;
                let at = |x: u32, y: u32| picture.pixels[index(x, y)];
                let own = at(x, y);
                let beside = [at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)];
                if beside.iter().any(|other| *other != own) {
                    continue;
                }
                let lightness = color::lightness([own[0], own[1], own[2]].map(f64::from));
                let is_light = (lightness > f64::from(settings.threshold)) != settings.invert;
                let tone = tones[usize::from(is_light)];
                let found = shown.pixels[index(x, y)];
                let mixed = |c: usize| own[c] + (tone[c] - own[c]) * settings.amount;
                let want = [0, 1, 2].map(mixed);
                let apart = (0..3).map(|c| (found[c] - want[c]).abs());
                let apart = apart.fold(0.0, f32::max);
                assert!(apart < 0.009, "{settings:?}, {x}, {y}: {found:?}, {want:?}");
                count[usize::from(want[1] > 0.5)] += 1;
            }
            assert!(count[0] > 500, "{count:?}");
        }
    }
}

/// Truth: where the lightness rises by as much in every pixel, as many pixels as `softness` says
/// are between the tones, up to one at each end that is within a thousandth of a tone.
#[test]
fn edges_are_as_wide_as_they_say() {
    let mut small = towards_the_sky(UVec2::new(96, 8));
    small.insert(Hdr);
    for x in 0..96u8 {
        let light = (f32::from(x) / 96.0).powi(2);
        let at = Transform::from_xyz(f32::from(x) - 47.5, 0.0, -100.0);
        let color = Color::linear_rgb(light, light, light);
        small.put(Rectangle::new(1.0, 8.0), unlit(color), at);
    }
    for softness in [0.0, 4.0, 9.0, 16.0] {
        small.insert(TwoTone {
            softness,
            ..default()
        });
        let (_, shown) = small.settle().pass();
        let row = shown.pixels[..96].iter().map(|pixel| pixel[1]);
        let between = row.filter(|tone| (0.001..0.999).contains(tone)).count();
        let most = softness as usize;
        assert!(
            (most.saturating_sub(1)..=most).contains(&between),
            "{softness}: {between}"
        );
    }
}

/// Truth: a white wall before a darker one, with an outline between them: the two tones and
/// nothing else, away from the border; the border is a straight, smooth edge, and the
/// picture is the same turned inside out.
#[test]
fn lines_stay_smooth() {
    let mut small = towards_the_sky(UVec2::new(96, 64));
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 200.0);
    let slanted = wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 100.0);
    let turned = Transform::from_xyz(-90.0, 0.0, -100.0)
        .with_rotation(Quat::from_rotation_z(0.3))
        .with_scale(Vec3::splat(3.0));
    small.world().entity_mut(slanted).insert(turned);
    let outlines = Outlines {
        width: 3.0,
        ..Outlines::SILHOUETTES
    };
    small.insert(outlines).settle();
    let plain = small.picture();
    let all = || (0..64).flat_map(|y| (0..96).map(move |x| (x, y)));
    let ink = black_ink(&plain, all());
    assert!(ink > 100.0, "{ink}");
    small.insert(TwoTone::default()).settle();
    let toned = small.picture();
    // The ink of the line is kept, but for what is nearly covered: 15 % of a pixel's edge
    // on both sides of a line of 3 pixels.
    let kept = black_ink(&toned, all()) / ink;
    assert!((0.98..1.12).contains(&kept), "{kept}");
    let soft = toned
        .pixels()
        .filter(|p| (40..215).contains(&p.0[0]))
        .count();
    assert!(soft > 60, "{soft} pixels of a soft edge");
    small
        .insert(TwoTone {
            invert: true,
            ..default()
        })
        .settle();
    let inverted = 96.0 * 64.0 - black_ink(&small.picture(), all());
    assert!((inverted / ink / kept - 1.0).abs() < 0.01, "{inverted}");
}
