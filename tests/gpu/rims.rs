//! Rims of surfaces that are seen so obliquely that their depth changes by more from pixel to pixel
//! than at the rim.

use bevy_comics_testkit::scenes::shape::Shape;

use crate::{line_truth::empty, outlines::put, prelude::*, walls};

const SIZE: UVec2 = UVec2::new(120, 120);

/// A perspective view down -z, of which the pixel at (x, y) shows the world at the distance `d` at
/// ((x - 60) / 60 * d, (60 - y) / 60 * d): the side of a block, four pixels wide, whose rim is in
/// front of a wall, and which leans. The depth of the side changes by 10 % from pixel to pixel, and
/// at its rim by 5 %.
fn side(small: &mut Small, lean: f32, shift: f32) {
    empty(small);
    walls::wall(small, [-60.0, -60.0], [60.0, 60.0], 14.8);
    let at = |x: f32, up: f32, distance: f32| {
        Vec3::new(x + shift + lean * up, up, -60.0) * (distance / 60.0)
    };
    let corners = [
        at(-4.0, 90.0, 10.0),
        at(-4.0, -90.0, 10.0),
        at(0.0, -90.0, 14.0),
        at(0.0, 90.0, 14.0),
    ];
    let mut shape = Shape::default();
    shape.polygon(&corners, [1.0; 4]);
    put(small, shape.into_mesh(), Color::WHITE, Transform::IDENTITY);
}

/// Truth: the side has one silhouette on its left and one on its right in every row. Before, the
/// right one was a silhouette in half of the rows only, and a crease or an object edge in the
/// others.
#[test]
fn a_rim_is_one_silhouette() {
    let mut small = Small::new(SIZE, Msaa::Off);
    for lean in [0.07f32, 0.13, 0.21] {
        for shift in [0.0, 0.4] {
            side(&mut small, lean, shift);
            small.style(&ComicStyle::new().with(Outlines::default()));
            small.settle();
            let cracks = small.cracks().expect("lines");
            for y in 20..100 {
                let row = &cracks.words[y * 120..(y + 1) * 120];
                let silhouettes = row.iter().filter(|[east, _]| east & 1 != 0).count();
                assert_eq!(silhouettes, 2, "{lean}, {shift}: row {y}");
            }
        }
    }
}

/// So its width does not change along it: with creases and object edges of half the width, the
/// right line is as wide as the left one.
#[test]
fn a_rim_has_one_width() {
    let mut small = Small::new(SIZE, Msaa::Off);
    side(&mut small, 0.13, 0.2);
    let thin = LineWeight {
        crease: 0.5,
        object: 0.5,
        ..LineWeight::EVEN
    };
    small.style(&ComicStyle::new().with(Outlines {
        weight: thin,
        ..default()
    }));
    small.settle();
    let cracks = small.cracks().expect("lines");
    let mut widths = BTreeSet::new();
    for y in 20..100 {
        let row = &cracks.words[y * 120..(y + 1) * 120];
        widths.extend(
            row.iter()
                .filter(|[east, _]| *east != 0)
                .map(|[east, _]| east >> 20),
        );
    }
    assert_eq!(widths.len(), 1, "{widths:?}");
}
