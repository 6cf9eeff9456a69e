//! Lines along diagonal runs of cracks, where cracks to the east and to the south take turns.

use crate::{
    outlines::put,
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::towards_the_sky,
};

const SIZE: UVec2 = UVec2::splat(72);

fn silhouettes(width: f32) -> Outlines {
    Outlines {
        width,
        ..Outlines::SILHOUETTES
    }
}

/// A wall with one side through the middle of the picture, in a direction.
fn half_plane(small: &mut Small, degrees: f32) {
    small.clear();
    let turn = Quat::from_rotation_z(degrees.to_radians());
    let middle = Vec3::new(0.0, 0.23, -10.0) + turn * Vec3::new(0.0, -200.0, 0.0);
    let at = Transform::from_translation(middle).with_rotation(turn);
    put(small, Rectangle::new(400.0, 400.0), Color::WHITE, at);
}

/// Every pixel of lines in all directions near the diagonals, whose runs are short, long, longer
/// than is looked, and without an end.
#[test]
fn lines_near_diagonals_match_the_reference() {
    assert_near_diagonals(&[-6.3, 0.0, 0.9]);
}

#[test]
#[ignore = "long: more directions"]
fn lines_near_diagonals_in_more_directions_match_the_reference() {
    assert_near_diagonals(&[-9.0, -6.3, -3.1, -1.2, 0.0, 0.9, 2.2, 4.4, 7.9]);
}

fn assert_near_diagonals(directions: &[f32]) {
    let mut small = towards_the_sky(SIZE);
    for quarter in [0.0, 90.0, 180.0, 270.0] {
        for from_diagonal in directions {
            let degrees = quarter + 45.0 + from_diagonal;
            half_plane(&mut small, degrees);
            let what = format!("{degrees} degrees");
            let style = outlined(silhouettes(2.0));
            assert_pass_matches_the_reference(&mut small, &style, None, &what);
        }
    }
    assert_eq!(small.errors(), 0);
}

/// The same where the runs belong to curves and corners: discs, and squares on their corners.
#[test]
fn lines_of_discs_and_corners_match_the_reference() {
    let mut small = towards_the_sky(SIZE);
    for radius in [11.0, 14.0, 21.7, 30.3] {
        small.clear();
        let at = Transform::from_xyz(0.31, -0.17, -10.0);
        put(&mut small, Circle::new(radius), Color::WHITE, at);
        let turned = at
            .with_translation(Vec3::new(0.1, 0.4, -5.0))
            .with_rotation(Quat::from_rotation_z(0.8));
        let side = 0.9 * radius;
        put(&mut small, Rectangle::new(side, side), Color::WHITE, turned);
        for width in [1.0, 3.0] {
            let style = outlined(silhouettes(width));
            let what = format!("radius {radius}, {width} px");
            assert_pass_matches_the_reference(&mut small, &style, None, &what);
        }
    }
    assert_eq!(small.errors(), 0);
}
