//! Surfaces that are shaded as simpler forms.

use bevy_comics_testkit::reference::toon::reflected::{Lights, Surface, reflected};

use crate::{
    prelude::*,
    ramp::{bright, drawn, put, room, set_light, sun, with},
    ramp_pixels::arriving,
};

fn tones(form: Option<ShadingProxy>) -> ToonLight {
    let stops = [
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(0.3, Color::linear_rgb(0.4, 0.4, 0.4)),
        RampStop::new(0.7, Color::WHITE),
    ];
    ToonLight {
        proxy: form,
        ..with(Ramp {
            mode: RampMode::PerLight,
            ..Ramp::new(stops)
        })
    }
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
        (ProxyShape::ellipsoid_of(&ball), ball, stretched),
        (
            ProxyShape::cylinder_of(&limb),
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
            Some(ShadingProxy {
                shape: shape.expect("bounds"),
                amount,
                amount_at_far: amount,
                ..default()
            })
        };
        set_light(&mut small, &tones(form(1.0)));
        // Normals of the mesh are interpolated between vertices, the form's are not.
        let found = differ(&own, &drawn(&mut small), 8);
        assert!(found < 40, "{shape:?}: {found} pixels");
        set_light(&mut small, &tones(form(0.0)));
        assert!(apart(&own, &drawn(&mut small)) == 0, "{shape:?}");
    }
}

/// Grass is as bright as the ground, whichever way it faces; only near the eye, if so asked.
#[test]
fn what_faces_upwards_is_lit_from_above() {
    let up = ShadingProxy {
        from: 2.0,
        ratio: 2.0,
        amount_at_far: 0.0,
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

const CUBE: f64 = 0.55;

fn turned() -> Quat {
    Quat::from_euler(EulerRot::YXZ, 0.7, 0.5, 0.3)
}

/// The normal of a ball through the place of a cube that a pixel of 160 by 160 shows, if it does,
/// and its change over a pixel on the same face, as found from a neighbor (1: right, down; -1:
/// left, up).
fn ball_on_cube(x: u32, y: u32, beside: [f64; 2]) -> Option<Surface> {
    let rotation = turned().as_dquat();
    let back = rotation.inverse();
    let down = back * DVec3::NEG_Z;
    // The ray through a place of the picture, which is 2 units high.
    let from = |x: f64, y: f64| back * DVec3::new(x / 80.0 - 1.0, 1.0 - y / 80.0, 5.0);
    let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
    let ray = from(x, y);
    // It enters through the last of the three faces that are turned towards it.
    let reach = |axis: usize, ray: DVec3| (-CUBE * down[axis].signum() - ray[axis]) / down[axis];
    let face = (0..3).max_by(|a, b| reach(*a, ray).total_cmp(&reach(*b, ray)))?;
    let on_face = |ray: DVec3| ray + reach(face, ray) * down;
    if on_face(ray).abs().max_element() > CUBE + 1e-9 {
        return None;
    }
    let normal = |x, y| (rotation * on_face(from(x, y))).normalize();
    let here = normal(x, y);
    let [right, down] = beside;
    Some(Surface {
        base: DVec3::ONE,
        normal: here,
        steps: [
            right * (normal(x + right, y) - here),
            down * (normal(x, y + down) - here),
        ],
        to_eye: DVec3::Z,
        detail: 1.0,
    })
}

/// Truth: a cube that is shaded as a ball has the tones of the ball at every pixel, also at the
/// borders of its faces.
#[test]
fn a_cube_as_a_ball_has_its_tones() {
    let shape = ProxyShape::Ellipsoid {
        center: Vec3::ZERO,
        half_size: Vec3::splat(0.8),
    };
    let light = tones(Some(ShadingProxy { shape, ..default() }));
    let mut small = room(UVec2::splat(160), 0.0);
    let at = Transform::from_rotation(turned());
    let size = 2.0 * CUBE as f32;
    put(&mut small, Cuboid::new(size, size, size), &light, at);
    let to = Vec3::new(1.0, 0.5, 0.3);
    sun(&mut small, to, bright(1.0));
    let picture = drawn(&mut small);
    let lights = Lights {
        suns: vec![arriving((to, 1.0))],
        around: DVec3::ZERO,
        exposure: f64::from(Exposure::default().exposure()),
    };
    let mut seen = 0;
    for (x, y) in (0..160).flat_map(|x| (0..160).map(move |y| (x, y))) {
        // Derivatives are found from either neighbor.
        let sides = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let tones = sides.map(|side| {
            let s = ball_on_cube(x, y, side)?;
            Some(reflected(&light, &s, &lights).x)
        });
        let [Some(a), Some(b), Some(c), Some(d)] = tones else {
            continue;
        };
        seen += 1;
        let (low, high) = (a.min(b).min(c).min(d), a.max(b).max(c).max(d));
        let found = linear(&picture, x, y)[0];
        // The row of the derivative may be the neighbor's too, which changes it as much as the
        // choice of the neighbor does. Half a code near white is 0.0046 in linear light.
        let slack = 0.0046 + high - low;
        assert!(
            (low - slack..=high + slack).contains(&found),
            "({x}, {y}): {found}, not {low} to {high}"
        );
    }
    assert!(seen > 10_000, "{seen}");
}
