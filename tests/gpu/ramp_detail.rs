//! The second axis of ramps: where tones change, against its definition.

use bevy_comics_testkit::reference::{detail, toon::tones::Tones};
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{MODES, apart, bright, drawn, put, room, set_light, sun, with},
};

const ORANGE: Color = Color::linear_rgb(0.9, 0.4, 0.1);
const BLUE: Color = Color::linear_rgb(0.1, 0.2, 0.8);

/// A ramp of one tone that becomes another one.
pub fn two_tones(axis: DetailAxis, mode: RampMode) -> ToonLight {
    with(Ramp {
        mode,
        blend: RampBlend::Absolute,
        keep_intensity: 1.0,
        detail: Some(RampDetail {
            plain: vec![RampStop::new(0.0, BLUE)],
            axis,
        }),
        ..Ramp::new([RampStop::new(0.0, ORANGE)])
    })
}

/// Largest difference of a pixel from the colour at a detail, in codes of linear light.
pub fn off(picture: &RgbaImage, x: u32, y: u32, amount: f64) -> f64 {
    let light = two_tones(DetailAxis::Constant(1.0), RampMode::PerLight);
    let tones = Tones::new(&light.ramp.expect("a ramp"), amount);
    let found = DVec3::from_array(linear(picture, x, y));
    (found - tones.at(1.0, 0.0)).abs().max_element() * 255.0
}

/// Checks that with all or no detail, one of the ramps alone is drawn.
fn check_ends(modes: &[RampMode]) {
    let stops = [
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(0.3, ORANGE).soft(0.1),
        RampStop::new(0.7, Color::WHITE),
    ];
    let plain = [RampStop::new(0.0, BLUE), RampStop::new(0.5, Color::WHITE)];
    let mut small = room(UVec2::splat(96), 0.1);
    let ball = Sphere::new(0.9).mesh().uv(64, 32);
    put(&mut small, ball, &ToonLight::default(), Transform::IDENTITY);
    sun(&mut small, Vec3::new(1.0, 0.6, 0.7), bright(0.8));
    for mode in modes.iter().copied() {
        let ramp = |stops: &[RampStop], detail| Ramp {
            mode,
            detail,
            ..Ramp::new(stops.iter().copied())
        };
        let mixed = |amount| {
            let plain = plain.to_vec();
            let axis = DetailAxis::Constant(amount);
            ramp(&stops, Some(RampDetail { plain, axis }))
        };
        set_light(&mut small, &with(mixed(1.0)));
        let full = drawn(&mut small);
        set_light(&mut small, &with(mixed(0.0)));
        let none = drawn(&mut small);
        set_light(&mut small, &with(mixed(0.5)));
        let half = drawn(&mut small);
        set_light(&mut small, &with(ramp(&stops, None)));
        assert!(apart(&full, &drawn(&mut small)) <= 1, "{mode:?}");
        set_light(&mut small, &with(ramp(&plain, None)));
        assert!(apart(&none, &drawn(&mut small)) <= 1, "{mode:?}");
        assert!(apart(&half, &full) > 20 && apart(&half, &none) > 20);
    }
}

#[test]
fn the_ends_are_both_ramps() {
    check_ends(&MODES[..1]);
}

#[test]
#[ignore = "long: the pipelines of every mode"]
fn the_ends_are_both_ramps_in_every_mode() {
    check_ends(&MODES);
}

/// A wall at several distances, in both projections, and in a world a thousand times as large.
#[test]
fn depth_and_focus_are_their_formulas() {
    let wall = || Plane3d::new(Vec3::Z, Vec2::splat(400.0)).mesh().build();
    let mut small = room(UVec2::splat(32), 0.0);
    for scale in [1.0f32, 1000.0] {
        let axes = [
            DetailAxis::Depth {
                from: 2.0 * scale,
                ratio: 8.0,
            },
            DetailAxis::Focus {
                distance: 5.0 * scale,
                clear: 0.2,
                ratio: 3.0,
            },
        ];
        for orthographic in [false, true] {
            small.clear();
            small.insert(Transform::IDENTITY);
            let far = 1000.0 * scale;
            small.insert(if orthographic {
                Projection::Orthographic(OrthographicProjection {
                    far,
                    ..OrthographicProjection::default_3d()
                })
            } else {
                Projection::Perspective(PerspectiveProjection { far, ..default() })
            });
            let first = two_tones(axes[0], RampMode::LightFraction);
            let at = Transform::from_scale(Vec3::splat(scale));
            let wall = put(&mut small, wall(), &first, at);
            sun(&mut small, Vec3::Z, bright(1.0));
            small.headless.step(2);
            let mut seen = [0usize; 2];
            for axis in axes {
                set_light(&mut small, &two_tones(axis, RampMode::LightFraction));
                for z in [1.0f32, 2.0, 3.0, 5.0, 6.5, 9.0, 16.0, 40.0] {
                    small
                        .world()
                        .entity_mut(wall)
                        .insert(at.with_translation(Vec3::new(0.0, 0.0, -z * scale)));
                    small.headless.step(1);
                    let picture = small.picture();
                    let wanted = detail::detail(axis, f64::from(z * scale));
                    let off = off(&picture, 16, 16, wanted);
                    assert!(off < 2.0, "{axis:?}, {z} of {scale}: {off} codes");
                    seen[0] += usize::from(wanted == 0.0);
                    seen[1] += usize::from(wanted == 1.0);
                }
            }
            assert_eq!(small.errors(), 0);
            assert!(seen.iter().all(|n| *n > 1));
        }
    }
}

/// Checks a ball under a light from the eye: both axes depend on the normal alone.
fn check_rims_and_highlights(modes: &[RampMode]) {
    let mut small = room(UVec2::splat(160), 0.0);
    let axis = DetailAxis::Rim { power: 1.5 };
    let light = two_tones(axis, RampMode::PerLight);
    let ball = Sphere::new(0.95).mesh().uv(128, 64);
    put(&mut small, ball, &light, Transform::IDENTITY);
    sun(&mut small, Vec3::Z, bright(1.0));
    let check = |small: &mut Small, mode, axis: DetailAxis| {
        set_light(small, &two_tones(axis, mode));
        let picture = drawn(small);
        for x in 80..146 {
            let place = (f64::from(x) + 0.5 - 80.0) / (0.95 * 80.0);
            let up = 0.5 / (0.95 * 80.0);
            let cosine = (1.0 - place * place - up * up).sqrt();
            // The light comes from the eye: its reflection is twice as far away.
            let cosine = match axis {
                DetailAxis::Highlight { .. } => 2.0 * cosine * cosine - 1.0,
                _ => cosine,
            };
            let off = off(&picture, x, 80, detail::detail(axis, cosine));
            assert!(off < 4.0, "{mode:?}, {axis:?}, {x}: {off} codes");
        }
    };
    for mode in modes.iter().copied() {
        check(&mut small, mode, axis);
        check(&mut small, mode, DetailAxis::Highlight { power: 6.0 });
    }
}

#[test]
fn rims_and_highlights_are_their_formulas() {
    check_rims_and_highlights(&MODES[1..2]);
}

#[test]
#[ignore = "long: the pipelines of every mode"]
fn rims_and_highlights_are_their_formulas_in_every_mode() {
    check_rims_and_highlights(&MODES);
}
