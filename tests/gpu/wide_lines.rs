//! Lines of which pixels search many cracks: wide ones, against an exhaustive search, and those
//! along diagonal runs, where cracks to the east and to the south take turns.

use bevy_comics_testkit::reference::draw::Cracks;

use crate::{
    line_scenes::{silhouettes, turned},
    outlines::put,
    pictures::{assert_pass_matches_the_reference, outlined, view_of},
    prelude::*,
    walls::towards_the_sky,
};

#[test]
fn wide_lines_match_the_reference() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for width in [6.5, 16.0] {
        let style = outlined(Outlines { width, ..default() });
        assert_pass_matches_the_reference(&mut small, &style, None, &format!("{width} px"));
    }
}

/// Runs near the axes are longer than the longest that is measured. Runs near the diagonals are
/// short, long, longer than is looked, and without an end; those of discs, and of squares on their
/// corners, end at curves and corners.
#[test]
fn lines_near_diagonals_match_the_reference() {
    // Each angle in one quarter of both kinds.
    let [some, others] = [&[-44.0, 0.0][..], &[-6.3, 0.9][..]];
    let quarters = [(0.0, some), (90.0, others), (180.0, others), (270.0, some)];
    let discs = [(11.0, 1.0), (14.0, 3.0), (21.7, 1.0), (30.3, 3.0)];
    assert_runs(quarters, discs);
}

#[test]
#[ignore = "long: every angle in every quarter"]
fn lines_near_diagonals_match_the_reference_in_every_quarter() {
    let angles = &[-44.0, -6.3, 0.0, 0.9][..];
    let radii = [11.0, 14.0, 21.7, 30.3].into_iter();
    let discs = radii.flat_map(|radius| [(radius, 1.0), (radius, 3.0)]);
    let quarters = [0.0, 90.0, 180.0, 270.0];
    assert_runs(quarters.map(|quarter| (quarter, angles)), discs);
}

/// `quarters`: degrees, and from their diagonals; `discs`: radii, and widths of lines.
fn assert_runs(quarters: [(f32, &[f32]); 4], discs: impl IntoIterator<Item = (f32, f32)>) {
    let mut small = towards_the_sky(UVec2::splat(72));
    for (quarter, angles) in quarters {
        for from_diagonal in angles {
            let degrees: f32 = quarter + 45.0 + from_diagonal;
            small.clear();
            let turn = Quat::from_rotation_z(degrees.to_radians());
            let middle = Vec3::new(0.0, 0.23, -10.0) + turn * Vec3::new(0.0, -200.0, 0.0);
            let at = Transform::from_translation(middle).with_rotation(turn);
            put(&mut small, Rectangle::from_length(400.0), Color::WHITE, at);
            let (style, what) = (outlined(silhouettes(2.0)), format!("{degrees} degrees"));
            assert_pass_matches_the_reference(&mut small, &style, None, &what);
        }
    }
    for (radius, width) in discs {
        small.clear();
        let at = Transform::from_xyz(0.31, -0.17, -10.0);
        put(&mut small, Circle::new(radius), Color::WHITE, at);
        let square = Rectangle::from_length(0.9 * radius);
        put(
            &mut small,
            square,
            Color::WHITE,
            turned(0.1, 0.4, -5.0, 0.8),
        );
        let (style, what) = (
            outlined(silhouettes(width)),
            format!("{radius}, {width} px"),
        );
        assert_pass_matches_the_reference(&mut small, &style, None, &what);
    }
}

/// Over all pixels of a scene: the mean difference of ink between the search by columns and
/// an exhaustive search, and the fraction of pixels where it is above two codes.
fn columns_against_exhaustive(small: &mut Small, outlines: Outlines) -> [f64; 2] {
    small.insert(VisibleDepthRange::default());
    small.outlined(outlines);
    let prepass = small.prepass().expect("a prepass");
    let [width, height] = small.headless.options.size.to_array();
    let view = view_of(small, &prepass, &DepthMap::default(), [0, 0, width, height]);
    let cracks = Cracks::new(&outlines, &view, 1.0);
    let (mut sum, mut apart) = (0.0, 0.0);
    let pixels = f64::from(width * height);
    for i in 0..width * height {
        let at = [f64::from(i % width) + 0.5, f64::from(i / width) + 0.5];
        // Of the kinds, the strongest is drawn.
        let strongest = |ink: [f64; 3]| ink.into_iter().fold(0.0, f64::max);
        let found = strongest(cracks.ink(at, 0.0));
        let difference = (found - strongest(cracks.exhaustive_ink(at, 0.0))).abs();
        sum += difference / pixels;
        apart += f64::from(u8::from(difference > 2.0 / 255.0)) / pixels;
    }
    [sum, apart]
}

/// Columns leave out cracks that others in the same column surpass at its own height. That
/// must not be seen: on average less than a tenth of a code, and more than two codes in at
/// most 1 pixel of 200.
#[test]
fn a_search_by_columns_draws_what_an_exhaustive_search_draws() {
    assert_columns_are_exhaustive(&[4.0]);
}

#[test]
#[ignore = "long: more widths"]
fn a_search_by_columns_draws_lines_of_any_width_as_an_exhaustive_search_does() {
    assert_columns_are_exhaustive(&[3.0, 4.0, 5.0, 8.0, 16.0]);
}

fn assert_columns_are_exhaustive(widths: &[f32]) {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for &width in widths {
        for (width_fade, softness) in [(0.0, 0.5), (0.6, 0.5), (0.0, 1.0)] {
            let silhouettes = Silhouettes {
                softness,
                ..default()
            };
            let creases = Creases {
                softness,
                ..default()
            };
            let outlines = Outlines {
                width,
                width_fade,
                silhouettes: Some(silhouettes),
                creases: Some(creases),
                ..default()
            };
            let [mean, apart] = columns_against_exhaustive(&mut small, outlines);
            let what = format!("{width} px, {width_fade}, {softness}");
            assert!(mean < 0.1 / 255.0, "{what}: mean {mean}");
            assert!(apart < 0.005, "{what}: {apart} of the pixels");
        }
    }
}
