//! Surfaces that are shaded as simpler forms.

use bevy::prelude::*;
use bevy_comics::{CartoonLight, FormShape, Ramp, RampMode, RampStop, ShadedForm};
use bevy_comics_testkit::reference::{color::srgb_encode, light::edge_at};

use crate::{
    ramp::{apart, bright, drawn, put, room, set_light, sun, with},
    small::linear,
};

fn tones(form: Option<ShadedForm>) -> CartoonLight {
    let stops = [
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(0.3, Color::linear_rgb(0.4, 0.4, 0.4)),
        RampStop::new(0.7, Color::WHITE),
    ];
    CartoonLight {
        form,
        ..with(Ramp {
            mode: RampMode::PerLight,
            ..Ramp::new(stops)
        })
    }
}

/// Pixels that differ by more than 8 codes.
fn differ(a: &image::RgbaImage, b: &image::RgbaImage) -> usize {
    let pairs = a.pixels().zip(b.pixels());
    pairs.filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 8).count()
}

/// A ball is its own ellipsoid, also if it is stretched and turned; a limb its own cylinder.
#[test]
fn simple_meshes_are_their_own_forms() {
    let ball = Sphere::new(0.6).mesh().uv(256, 128);
    let limb: Mesh = Cylinder::new(0.3, 1.6)
        .mesh()
        .resolution(256)
        .without_caps()
        .build();
    let stretched =
        Transform::from_scale(Vec3::new(1.3, 0.7, 1.0)).with_rotation(Quat::from_rotation_z(0.6));
    let cases = [
        (FormShape::ellipsoid_of(&ball), ball, stretched),
        (
            FormShape::cylinder_of(&limb),
            limb,
            Transform::from_rotation(Quat::from_rotation_x(0.4)),
        ),
    ];
    for (shape, mesh, at) in cases {
        let mut small = room(UVec2::splat(160), 0.0);
        put(&mut small, mesh, &tones(None), at);
        sun(&mut small, Vec3::new(1.0, 0.5, 0.8), bright(1.0));
        let own = drawn(&mut small);
        let form = |amount| {
            Some(ShadedForm {
                shape: shape.expect("bounds"),
                amount,
                far_amount: amount,
                ..default()
            })
        };
        set_light(&mut small, &tones(form(1.0)));
        // Normals of the mesh are interpolated between vertices, the form's are not.
        let found = differ(&own, &drawn(&mut small));
        assert!(found < 40, "{shape:?}: {found} pixels");
        set_light(&mut small, &tones(form(0.0)));
        assert!(apart(&own, &drawn(&mut small)) == 0, "{shape:?}");
    }
}

/// Grass is as bright as the ground, whichever way it faces; only near the eye, if so asked.
#[test]
fn what_faces_upwards_is_lit_from_above() {
    let up = ShadedForm {
        near: 2.0,
        ratio: 2.0,
        far_amount: 0.0,
        ..default()
    };
    let mut small = room(UVec2::splat(64), 0.0);
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(2.0)).mesh().build();
    put(&mut small, wall, &tones(Some(up)), Transform::IDENTITY);
    sun(&mut small, Vec3::Y, bright(1.0));
    for (distance, wanted) in [(1.5, 1.0), (8.0, 0.0)] {
        small.insert(Transform::from_xyz(0.0, 0.0, distance));
        let found = linear(&drawn(&mut small), 32, 32)[0];
        assert!((found - wanted).abs() < 0.01, "{distance}: {found}");
    }
}

/// A cube of equal sides that is shaded as an ellipsoid has the light of a ball: at each place that of
/// the direction from its middle.
#[test]
fn a_cube_is_shaded_as_a_ball() {
    let cube = Cuboid::from_length(1.0).mesh().build();
    let shape = FormShape::ellipsoid_of(&cube).expect("bounds");
    let form = ShadedForm {
        shape,
        amount: 1.0,
        far_amount: 1.0,
        ..default()
    };
    // Soft tones: how much light arrives, as grey.
    let stops = [
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(0.5, Color::WHITE).soft(1.0),
    ];
    let light = CartoonLight {
        form: Some(form),
        ..with(Ramp {
            mode: RampMode::PerLight,
            ..Ramp::new(stops)
        })
    };
    let size = 160u32;
    let turns = [
        Quat::IDENTITY,
        Quat::from_euler(EulerRot::YXZ, 0.5, 0.4, 0.2),
    ];
    for turn in turns {
        let mut small = room(UVec2::splat(size), 0.0);
        put(
            &mut small,
            cube.clone(),
            &light,
            Transform::from_rotation(turn),
        );
        let to_sun = Vec3::new(1.0, 0.6, 0.9).normalize();
        sun(&mut small, to_sun, bright(1.0));
        let picture = drawn(&mut small);
        let mut looked = 0;
        for (x, y) in (0..size).flat_map(|x| (0..size).map(move |y| (x, y))) {
            let at = |v: u32| (v as f32 + 0.5) / size as f32 * 2.0 - 1.0;
            // The eye is at +Z and far away. Of the six faces, the ray enters through the last one of
            // the three that it meets from outside.
            let from = turn.inverse() * Vec3::new(at(x), -at(y), 5.0);
            let along = turn.inverse() * Vec3::NEG_Z;
            let near = |k: usize| match along[k] == 0.0 {
                true => f32::NEG_INFINITY,
                false => (-0.5 * along[k].signum() - from[k]) / along[k],
            };
            let place = from + along * near(0).max(near(1)).max(near(2));
            // Not at borders of faces, where a pixel has two of them.
            if place.abs().max_element() > 0.501
                || (0..3).filter(|k| place[*k].abs() > 0.48).count() != 1
            {
                continue;
            }
            looked += 1;
            let cosine = f64::from((turn * place).normalize().dot(to_sun));
            let wanted = edge_at(0.5, cosine, 1.0);
            let found = linear(&picture, x, y)[0];
            let codes = 255.0 * (srgb_encode([found; 3])[0] - srgb_encode([wanted; 3])[0]).abs();
            // The edge's place, half a code of the picture, and rounding.
            assert!(codes < 1.5, "({x}, {y}): {found}, not {wanted}");
        }
        assert!(looked > 3000, "{looked}");
    }
}
