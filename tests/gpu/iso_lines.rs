//! Where lines of equal depth, height and distance lie.

use bevy_comics::{cameras::WorldOrigin, effects::IsoField};

use crate::{
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

fn every_8(field: IsoField) -> IsoLines {
    IsoLines {
        field,
        step: 8.0,
        width: 2.0,
        major: 0,
        ..default()
    }
}

fn draw(small: &mut Small, lines: IsoLines) -> image::RgbaImage {
    small.shot(&ComicStyle::new().with(lines))
}

/// Checks where the middle of the ink near a place along a row of pixels is, and how much there is
/// of it. `slack`: of the place and of the width.
fn assert_line(ink: impl Fn(u32) -> f64, [at, width]: [f64; 2], slack: [f64; 2]) {
    let from = (at - 3.9).floor().max(0.0) as u32;
    let [mut sum, mut moment] = [0.0; 2];
    for x in from..=(at + 3.0) as u32 {
        sum += ink(x);
        moment += ink(x) * (f64::from(x) + 0.5);
    }
    let found = moment / sum;
    assert!((found - at).abs() < slack[0], "at {found}, not {at}");
    assert!(
        (sum - width).abs() < slack[1],
        "at {at}: {sum}, not {width}"
    );
}

fn column(picture: &image::RgbaImage, x: u32) -> impl Fn(u32) -> f64 {
    move |y| 1.0 - linear(picture, x, y)[0]
}

fn row(picture: &image::RgbaImage, y: u32) -> impl Fn(u32) -> f64 {
    move |x| 1.0 - linear(picture, x, y)[0]
}

/// A wall that leans by 60 degrees, seen from the front: heights are rows of pixels.
#[test]
fn heights_are_where_they_are() {
    let mut small = towards_the_sky(SIZE);
    let leaning = wall(&mut small, [-60.0, -80.0], [60.0, 80.0], 300.0);
    let at = Transform::from_xyz(0.0, 0.0, -300.0)
        .with_rotation(Quat::from_rotation_x(60f32.to_radians()));
    small.world().entity_mut(leaning).insert(at);
    // Every third line is heavier, or none.
    for major in [0, 3] {
        let lines = IsoLines {
            major,
            major_width: 4.0,
            ..every_8(IsoField::Height)
        };
        let picture = draw(&mut small, lines);
        for line in -3..=3 {
            let at = 32.0 - 8.0 * f64::from(line);
            let width = match major {
                3 if line % 3 == 0 => 4.0,
                _ => 2.0,
            };
            assert_line(column(&picture, 40), [at, width], [0.02, 0.02]);
        }
    }
}

/// Rings around a point on a wall that faces the camera.
#[test]
fn distances_are_rings() {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 100.0);
    let lines = IsoLines {
        center: Vec3::new(0.0, 0.0, -100.0),
        ..every_8(IsoField::Distance)
    };
    let picture = draw(&mut small, lines);
    for ring in 1..=5 {
        for side in [-1.0, 1.0] {
            // The row of pixels is half a pixel away from the middle of the rings.
            let at = 48.0 + side * ((8.0 * f64::from(ring)).powi(2) - 0.25).sqrt();
            assert_line(row(&picture, 32), [at, 2.0], [0.05, 0.1]);
        }
    }
}

/// The depth map over a wall that turns away from the camera rises evenly: from 0 in the
/// first column to 1 in the last.
#[test]
fn depths_divide_the_range() {
    let mut small = towards_the_sky(SIZE);
    let turned = wall(&mut small, [-200.0, -80.0], [200.0, 80.0], 300.0);
    let at = Transform::from_xyz(0.0, 0.0, -300.0)
        .with_rotation(Quat::from_rotation_y(60f32.to_radians()));
    small.world().entity_mut(turned).insert(at);
    let lines = IsoLines {
        step: 0.1,
        ..every_8(IsoField::Depth)
    };
    let picture = draw(&mut small, lines);
    for line in 1..=9 {
        let at = 0.5 + 95.0 * f64::from(line) / 10.0;
        assert_line(row(&picture, 20), [at, 2.0], [0.02, 0.02]);
    }
}

/// So far away that an f32 has only each eighth unit. Heights are rows of pixels, distances columns: the
/// center is 72 million units to the left, at the depth of the wall.
#[test]
fn lines_far_from_the_origin_are_where_they_are() {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 100.0);
    for (field, origin) in [
        (IsoField::Height, DVec3::new(5e8, 7.2e7 + 3.0, 1e6)),
        (IsoField::Distance, DVec3::new(7.2e7 + 3.0, 0.0, 100.0)),
    ] {
        small.world().insert_resource(WorldOrigin(origin));
        let lines = IsoLines {
            major: 3,
            major_width: 4.0,
            ..every_8(field)
        };
        let picture = draw(&mut small, lines);
        for line in -2..=3 {
            let at = 8.0 * f64::from(line) - 3.0;
            let width = if line % 3 == 0 { 4.0 } else { 2.0 };
            match field {
                IsoField::Height => {
                    assert_line(column(&picture, 40), [32.0 - at, width], [0.02, 0.02]);
                }
                _ => assert_line(row(&picture, 20), [48.0 + at, width], [0.02, 0.02]),
            }
        }
    }
}

/// In perspective: the rows in which a ramp has a height, from the geometry of the view.
#[test]
fn heights_are_right_in_perspective() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small.insert(Transform::from_xyz(0.0, 20.0, 0.0));
    // A ramp that rises by half a unit a unit, away from the camera: y = -z / 2 - 30.
    let slope = 0.5f32.atan();
    let at = Transform::from_xyz(0.0, 20.0, -100.0)
        .with_rotation(Quat::from_rotation_x(slope - std::f32::consts::FRAC_PI_2));
    small.put(Rectangle::new(400.0, 300.0), unlit(Color::WHITE), at);
    let lines = IsoLines {
        step: 20.0,
        ..every_8(IsoField::Height)
    };
    let picture = draw(&mut small, lines);
    let tangent = f64::from(std::f32::consts::FRAC_PI_8).tan();
    for y in [0.0, 20.0, 40.0] {
        let z = 2.0 * (y + 30.0);
        let at = 32.0 - 32.0 * (y - 20.0) / (z * tangent);
        // The height changes less and less from row to row: the distance to the line, from
        // the change at a pixel, is off by a few hundredths.
        assert_line(column(&picture, 48), [at, 2.0], [0.1, 0.1]);
    }
}

/// A floor at the height of a line is not ink, nor is the sky.
#[test]
fn what_does_not_change_has_no_lines() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small
        .insert(Transform::from_xyz(0.0, 5.0, 0.0).looking_to(Vec3::new(0.0, -0.4, -1.0), Vec3::Y));
    let floor = Plane3d::default().mesh().size(800.0, 800.0).build();
    small.put(floor, unlit(Color::WHITE), Transform::IDENTITY);
    let plain = small.settle().picture();
    for field in [IsoField::Height, IsoField::Depth] {
        // No line but that of height 0 is in the picture.
        let lines = IsoLines {
            step: 1000.0,
            ..every_8(field)
        };
        let picture = draw(&mut small, lines);
        assert_eq!(picture, plain, "{field:?}");
    }
    let below = (0..SIZE.x).map(|x| (x, 60));
    assert!(black_ink(&plain, below) < 0.01, "the floor is white");
}

/// A floor to the horizon, in floating-point numbers: nothing on the screen is no number.
/// A level floor has no lines as far as its heights are exact to a ten-thousandth.
#[test]
fn floors_to_the_horizon_are_finite_and_clear() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.insert((
        Transform::from_xyz(0.0, 5.0, 0.0).looking_to(Vec3::NEG_Z, Vec3::Y),
        Hdr,
    ));
    for size in [1e6, 2e3] {
        small.clear();
        let floor = Plane3d::default().mesh().size(size, size).build();
        small.put(floor, unlit(Color::WHITE), Transform::IDENTITY);
        for field in [IsoField::Height, IsoField::Distance, IsoField::Depth] {
            for step in [0.01, 0.5, 100.0] {
                let lines = IsoLines {
                    step,
                    ..every_8(field)
                };
                small.style(&ComicStyle::new().with(lines)).settle();
                let (before, after) = small.pass();
                assert!(
                    after.pixels.iter().flatten().all(|v| v.is_finite()),
                    "{size}, {field:?}, {step}"
                );
                if field == IsoField::Height && step >= 0.5 && size < 1e4 {
                    assert!(before.pixels == after.pixels, "{step}: lines on a floor");
                }
            }
        }
    }
}
