//! Surfaces that are shaded as simpler forms.

use bevy::prelude::*;
use bevy_comics::{CartoonLight, FormShape, Ramp, RampMode, RampStop, ShadedForm};

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
