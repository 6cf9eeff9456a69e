//! The second axis of ramps: where tones change, against its definition.

use bevy_comics_testkit::reference::{detail, toon::tones::Tones};
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{bright, drawn, put, room, set_light, sun, with},
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

/// Largest difference of a pixel from the color at a detail, in codes of linear light.
pub fn off(picture: &RgbaImage, x: u32, y: u32, amount: f64) -> f64 {
    let light = two_tones(DetailAxis::Constant(1.0), RampMode::PerLight);
    let tones = Tones::new(&light.ramp.expect("a ramp"), amount);
    let found = DVec3::from_array(linear(picture, x, y));
    (found - tones.at(1.0, 0.0)).abs().max_element() * 255.0
}

/// With all or no detail, one of the ramps alone is drawn, also if they have not as many stops.
#[test]
fn the_ends_are_both_ramps() {
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
    let ramp = |stops: &[RampStop], detail| Ramp {
        detail,
        ..Ramp::new(stops.iter().copied())
    };
    let mixed = |amount| {
        let plain = plain.to_vec();
        let axis = DetailAxis::Constant(amount);
        ramp(&stops, Some(RampDetail { plain, axis }))
    };
    let ramps = [
        mixed(1.0),
        mixed(0.0),
        mixed(0.5),
        ramp(&stops, None),
        ramp(&plain, None),
    ];
    let [all, none, half, first, second] = ramps.map(|ramp| {
        set_light(&mut small, &with(ramp));
        drawn(&mut small)
    });
    assert!(apart(&all, &first) <= 1);
    assert!(apart(&none, &second) <= 1);
    assert!(apart(&half, &all) > 20 && apart(&half, &none) > 20);
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
            assert!(seen.iter().all(|n| *n > 1));
        }
    }
}
