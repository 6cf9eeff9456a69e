//! Lines under temporal anti-aliasing: the engine moves depth by a part of a pixel in
//! every frame, and the lines stay at the edges that they belong to.

use bevy::render::camera::TemporalJitter;
use bevy_comics::effects::IsoField;

use crate::{
    outlines::{ink, put, removed},
    prelude::*,
    upscaled::override_main_pass,
};

/// Width and height of the picture in pixels.
const SIZE: usize = 120;

/// The offsets of the engine's temporal anti-aliasing, frame by frame.
const HALTON: [Vec2; 8] = [
    Vec2::new(0.0, 0.0),
    Vec2::new(0.0, -0.16666666),
    Vec2::new(-0.25, 0.16666669),
    Vec2::new(0.25, -0.3888889),
    Vec2::new(-0.375, -0.055555552),
    Vec2::new(0.125, 0.2777778),
    Vec2::new(-0.125, -0.2777778),
    Vec2::new(0.375, 0.055555582),
];

/// How far the measured middle of a line may be from its place. The ink of two pixels,
/// each at most 1.5 pixels from the middle of a line of 2 pixels, is rounded: by 0.004 in
/// the texture of ink, and by 0.0045 in the picture of 8 bits.
const MEASURED: f32 = 2.0 * 1.5 * (0.004 + 0.0045) / 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    X,
    Y,
}

impl Axis {
    fn of(self, v: Vec2) -> f32 {
        match self {
            Self::X => v.x,
            Self::Y => v.y,
        }
    }
}

/// A perspective view of a wall with one straight side.
fn wall() -> (Small, Entity) {
    let mut small = Small::new(UVec2::splat(SIZE as u32), Msaa::Off);
    let wall = put_wall(&mut small, place(Axis::X, 60.0));
    (small, wall)
}

fn put_wall(small: &mut Small, at: Transform) -> Entity {
    small.clear();
    // 90 degrees, at a distance of half of the picture's height: a unit is a pixel.
    small.insert((
        Transform::IDENTITY,
        Projection::Perspective(PerspectiveProjection {
            fov: std::f32::consts::FRAC_PI_2,
            ..default()
        }),
    ));
    put(small, Rectangle::new(800.0, 800.0), Color::WHITE, at)
}

/// The place of a wall whose side is `at` pixels from the left or the top of the picture.
fn place(axis: Axis, at: f32) -> Transform {
    let half = 0.5 * SIZE as f32;
    Transform::from_translation(match axis {
        Axis::X => Vec3::new(at - half - 400.0, 0.0, -half),
        Axis::Y => Vec3::new(0.0, half - at - 400.0, -half),
    })
}

/// The middle of the line in pixels from the left or the top.
fn middle(ink: &[f32], axis: Axis) -> f32 {
    let across = |i: usize| match axis {
        Axis::X => ink[SIZE / 2 * SIZE + i],
        Axis::Y => ink[i * SIZE + SIZE / 2],
    };
    let sum: f32 = (0..SIZE).map(across).sum();
    let moment: f32 = (0..SIZE).map(|i| across(i) * (i as f32 + 0.5)).sum();
    assert!(sum > 1.0, "no line");
    moment / sum
}

fn lines() -> Outlines {
    Outlines {
        width: 2.0,
        ..Outlines::SILHOUETTES
    }
}

/// The ink of a frame that is moved by an offset.
fn ink_at(small: &mut Small, offset: Vec2) -> Vec<f32> {
    small.insert(TemporalJitter { offset });
    small.headless.step(1);
    removed(small)
}

/// The engine draws an edge at `at - offset`. The nearest border of pixels has the line,
/// which is moved back by the offset. So it is at most half a pixel of the depth texture
/// from the edge.
fn expected(at: f32, offset: f32, texel: f32) -> f32 {
    let drawn = at / texel - offset;
    let border = (drawn + 0.5).floor();
    let tie = 0.5 - (drawn - border).abs();
    assert!(
        tie > 0.015,
        "the edge runs through centers of pixels: {tie}"
    );
    (border + offset) * texel
}

/// Fails unless the line is where it should be for every offset. The means of the places for each
/// axis and edge.
fn assert_lines_stay(main_pass: Option<UVec2>, texel: f32, edges: &[f32]) -> Vec<(Axis, f32, f32)> {
    let (mut small, wall) = wall();
    if main_pass.is_some() {
        override_main_pass(&mut small, main_pass);
    }
    ink(&mut small, lines());
    let mut means = Vec::new();
    for axis in [Axis::X, Axis::Y] {
        for &at in edges {
            small.world().entity_mut(wall).insert(place(axis, at));
            let found = HALTON.map(|offset| {
                let x = middle(&ink_at(&mut small, offset), axis);
                let right = expected(at, axis.of(offset), texel);
                assert!((right - at).abs() <= 0.5 * texel);
                assert!(
                    (x - right).abs() <= MEASURED,
                    "{axis:?} {at}, offset {offset}: {x}, not {right}"
                );
                x
            });
            means.push((axis, at, found.iter().sum::<f32>() / 8.0));
        }
    }
    means
}

#[test]
fn lines_stay_at_their_edge_under_jitter() {
    assert_means_stay(&[60.03, 60.42]);
}

#[test]
#[ignore = "long: more places; quick test jitter::lines_stay_at_their_edge_under_jitter"]
fn lines_stay_at_edges_of_more_places_under_jitter() {
    assert_means_stay(&[60.03, 60.3, 60.42, 60.7]);
}

fn assert_means_stay(edges: &[f32]) {
    for (axis, at, mean) in assert_lines_stay(None, 1.0, edges) {
        // The mean of the rounding errors of the eight offsets: the largest over
        // all positions of an edge is 0.125 px across and 0.174 px down.
        let most = if axis == Axis::X { 0.125 } else { 0.174 };
        assert!(
            (mean - at).abs() <= most + MEASURED,
            "{axis:?} {at}: {mean}"
        );
    }
}

/// The same where the main pass has a lower resolution: offsets are in its pixels.
#[test]
fn lines_stay_at_their_edge_under_jitter_of_a_smaller_main_pass() {
    let half = UVec2::splat(SIZE as u32 / 2);
    assert_lines_stay(Some(half), 2.0, &[60.3, 61.16]);
}

#[test]
fn lines_stay_at_their_edge_under_temporal_anti_aliasing() {
    let (mut small, _) = wall();
    for axis in [Axis::X, Axis::Y] {
        for at in [60.03, 60.3] {
            // A new camera, without the history of the wall in its old place.
            small.restart(Msaa::Off);
            small.insert(TemporalAntiAliasing::default());
            put_wall(&mut small, place(axis, at));
            ink(&mut small, lines());
            for _ in 0..8 {
                small.headless.step(1);
                let error = middle(&removed(&small), axis) - at;
                assert!(error.abs() <= 0.5 + MEASURED, "{axis:?} {at}: {error}");
            }
        }
    }
}

/// Strokes and lines of equal height lie on surfaces: in a still view they stand still, while the engine moves depth.
#[test]
fn strokes_and_iso_lines_stand_still() {
    let size = UVec2::new(192, 128);
    for style in [
        ComicStyle::new().with(Hatching::default()),
        ComicStyle::new().with(IsoLines {
            field: IsoField::Height,
            step: 0.2,
            ..default()
        }),
    ] {
        let mut small = Small::new(size, Msaa::Off);
        small.clear();
        // At the rim of an object, the depth of another surface is drawn in some frames.
        let ground = Plane3d::default().mesh().size(400.0, 400.0);
        small.put(
            ground,
            unlit(Color::srgb(0.4, 0.4, 0.4)),
            Transform::IDENTITY,
        );
        let down = Transform::from_xyz(0.0, 3.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y);
        small.insert((TemporalAntiAliasing::default(), down));
        small.style(&style);
        small.headless.step(30);
        let still = small.picture();
        for _ in 0..8 {
            small.headless.step(1);
            let picture = small.picture();
            let pixels = picture.pixels().zip(still.pixels());
            let change = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
                (0..3).map(|c| a.0[c].abs_diff(b.0[c])).max()
            };
            let changes: Vec<_> = pixels.filter_map(change).collect();
            // The border of a stroke is a pixel wide: it moves by less than a sixteenth of a pixel.
            let most = changes.iter().max();
            assert!(most < Some(&16), "{style:?}: {most:?}");
        }
    }
}
