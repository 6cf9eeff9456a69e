//! Lines that go on beyond their loose ends.

use crate::{
    line_scenes::turned,
    outlines::{ink, put, removed},
    prelude::*,
    walls::{towards_the_sky, wall},
};

/// Width and height of the picture in pixels; a unit of the scene is a pixel.
const SIZE: usize = 96;
const HALF: f32 = 0.5 * SIZE as f32;

/// Silhouettes of one width, also where they crowd.
pub fn lines(width: f32, overshoot: f32, taper: f32) -> Outlines {
    Outlines {
        width,
        overshoot,
        // Lines of full width to their ends.
        hysteresis: 0.0,
        silhouettes: Some(Silhouettes {
            softness: 0.0,
            ..default()
        }),
        weight: LineWeight {
            taper,
            ..LineWeight::EVEN
        },
        ink_budget: 1.0,
        ..Outlines::SILHOUETTES
    }
}

/// A step between two walls, along a line through the middle of the picture. It closes to the
/// right, and its line ends there.
struct ClosingStep {
    small: Small,
    walls: [Entity; 2],
}

impl ClosingStep {
    fn new() -> Self {
        let mut small = towards_the_sky(UVec2::splat(SIZE as u32));
        let walls = [200.0, 400.0].map(|height| {
            let wall = Rectangle::new(400.0, height);
            put(&mut small, wall, Color::WHITE, Transform::IDENTITY)
        });
        let mut step = Self { small, walls };
        step.turn(0.0);
        step
    }

    /// Lets the step close in the direction of an angle.
    fn turn(&mut self, angle: f32) {
        let turned = Quat::from_rotation_z(angle);
        let front = Transform::from_translation(turned * Vec3::new(0.0, 100.0, -50.0));
        let slanted = turned * Quat::from_rotation_y(-30f32.to_radians());
        let back = Transform::from_xyz(0.0, 0.0, -65.0).with_rotation(slanted);
        let [a, b] = self.walls;
        self.small.on(a).insert(front.with_rotation(turned));
        self.small.on(b).insert(back);
    }

    /// The ink of lines after the step was turned.
    fn turned(&mut self, degrees: f32) -> Vec<f32> {
        self.turn(degrees.to_radians());
        self.small.headless.step(1);
        removed(&self.small)
    }
}

/// Sum of ink, and its center, in pixels from the middle of the picture, y up.
fn sum_and_center(ink: &[f32]) -> (f32, Vec2) {
    let mut sum = 0.0;
    let mut moment = Vec2::ZERO;
    for (i, ink) in ink.iter().enumerate() {
        let place = Vec2::new(
            (i % SIZE) as f32 + 0.5 - HALF,
            HALF - (i / SIZE) as f32 - 0.5,
        );
        sum += ink;
        moment += place * *ink;
    }
    (sum, moment / sum.max(1e-6))
}

/// Truth: in every direction, a line of constant width gains the area of its overshoot, along
/// the edge that it goes on from.
#[test]
fn lines_go_on_by_their_overshoot_in_every_direction() {
    const DEGREES: [f32; 9] = [0.0, 8.0, 23.0, 45.0, 63.0, 90.0, 140.0, 205.0, 290.0];
    let mut step = ClosingStep::new();
    for width in [2.0, 4.0] {
        let [short, by_3, by_10] = [0.0, 3.0, 10.0].map(|overshoot| {
            ink(&mut step.small, lines(width, overshoot, 0.0));
            DEGREES.map(|degrees| step.turned(degrees))
        });
        for (overshoot, long) in [(3.0, by_3), (10.0, by_10)] {
            for ((degrees, short), long) in DEGREES.iter().zip(&short).zip(&long) {
                let along = Vec2::from_angle(degrees.to_radians());
                let gained: Vec<f32> = long.iter().zip(short).map(|(a, b)| a - b).collect();
                let (sum, center) = sum_and_center(&gained);
                let what = format!("{degrees} degrees, {width} px, {overshoot}: {sum}, {center}");
                assert!(gained.iter().all(|ink| *ink > -0.02), "{what}: lost");
                assert!((sum / width - overshoot).abs() < 0.5, "{what}");
                // The end of a line lies on a crack, at most half a diagonal of a pixel aside,
                // and its direction is within 5 degrees.
                let most = 0.5f32.sqrt() + 0.5 * overshoot * 5f32.to_radians().tan();
                assert!(along.perp_dot(center).abs() < most, "{what}");
                assert!(along.dot(center) > 15.0, "{what}");
            }
        }
    }
}

/// The blunt end of a line is round: beyond the middle of its last crack, it has the area of half
/// of a disc. The ramp of a pixel adds pi / 24 to it, and a disc that is sampled at the centers of
/// pixels is up to 0.15 pixels smaller or larger at these widths.
#[test]
fn blunt_ends_are_round() {
    let mut step = ClosingStep::new();
    for width in [4.0, 8.0f32] {
        ink(&mut step.small, lines(width, 0.0, 0.0));
        for (degrees, side) in [(0f32, 1), (90.0, 0), (180.0, 1), (270.0, 0)] {
            let along = Vec2::from_angle(degrees.to_radians());
            let all = step.turned(degrees);
            let cracks = step.small.cracks().expect("lines");
            // How far a place is in the direction of the line.
            let ahead = |x: f32, y: f32| along.dot(Vec2::new(x - HALF, HALF - y));
            let across = [[1.0, 0.5], [0.5, 1.0]][side];
            let end = (0..cracks.words.len())
                .filter(|i| cracks.words[*i][side] & 7 != 0)
                .map(|i| ahead((i % SIZE) as f32 + across[0], (i / SIZE) as f32 + across[1]))
                .fold(f32::NEG_INFINITY, f32::max);
            let beyond: f32 = (0..all.len())
                .map(|i| {
                    let away = ahead((i % SIZE) as f32 + 0.5, (i / SIZE) as f32 + 0.5) - end;
                    // The pixels beside the middle of the crack: half of each.
                    all[i] * (0.5 + 0.5 * away.clamp(-1.0, 1.0).round())
                })
                .sum();
            let want = 0.125 * std::f32::consts::PI * width * width;
            let most = std::f32::consts::PI / 24.0 + 0.15;
            let what = format!("{degrees} degrees, {width} px: {beyond}, {want}");
            assert!((beyond - want).abs() < most, "{what}");
        }
    }
}

/// Closed lines have no ends, nor have lines that meet others, nor at the border of the picture.
#[test]
fn only_loose_ends_go_on() {
    let mut small = towards_the_sky(UVec2::splat(SIZE as u32));
    wall(&mut small, [-60.0, -60.0], [60.0, 60.0], 90.0);
    // The rim of a sphere, and two walls that partly hide it and each other.
    let sphere = Sphere::new(20.0).mesh().uv(64, 32);
    let at = Transform::from_xyz(-8.0, 6.0, -60.0);
    put(&mut small, sphere, Color::WHITE, at);
    for at in [
        turned(10.0, -8.0, -30.0, 0.3),
        turned(10.0, -13.0, -20.0, 1.1),
    ] {
        put(&mut small, Rectangle::new(50.0, 14.0), Color::WHITE, at);
    }
    // The steps of pixels beside the rim of the sphere are no lines.
    let rims = |width, overshoot| Outlines {
        silhouettes: Some(Silhouettes {
            threshold: 0.1,
            softness: 0.0,
            ..default()
        }),
        ..lines(width, overshoot, 0.0)
    };
    for width in [2.0, 5.0] {
        let before = ink(&mut small, rims(width, 0.0));
        let after = ink(&mut small, rims(width, 16.0));
        assert!(before.iter().sum::<f32>() > 300.0);
        assert!(before == after, "{width} px: a line went on");
    }
}

/// A line that tapers is thin at the end of its stroke, and wider where it would end without.
#[test]
fn tapered_lines_taper_to_the_end_of_their_stroke() {
    let mut small = ClosingStep::new().small;
    let mut profile = |overshoot, taper| -> Vec<f32> {
        let ink = ink(&mut small, lines(6.0, overshoot, taper));
        let column = |x| (0..SIZE).map(|y| ink[y * SIZE + x]).sum();
        (0..SIZE).map(column).collect()
    };
    let blunt = profile(0.0, 0.0);
    // The end is round: half of the width beyond the last crack.
    let end = blunt.iter().rposition(|width| *width > 0.01);
    let end = end.expect("a line") - 2;
    let [overshoot, taper] = [12.0f32, 20.0];
    let found = profile(overshoot, taper);
    for (x, width) in found.iter().enumerate().take(end + 12).skip(end - 20) {
        // Cracks from the middle of this column to the end of the stroke.
        let left = (end as f32 + overshoot - x as f32 - 0.5).max(0.0);
        let t = (left / taper).min(1.0);
        let want = 6.0 * t * t * (3.0 - 2.0 * t);
        let off = (width - want).abs();
        assert!(off < 0.5, "{x}: {width}, {want}: {found:.2?}");
    }
    assert!(found[end + 13] < 0.05, "{found:.2?}");
}

/// Short lines have short strokes: none is longer than its line.
#[test]
fn strokes_are_not_longer_than_their_lines() {
    let mut small = ClosingStep::new().small;
    // Hides all but a few pixels of the line.
    wall(&mut small, [-382.0, -200.0], [18.0, 200.0], 48.0);
    let [short, long] = [0.0, 16.0]
        .map(|overshoot| -> f32 { ink(&mut small, lines(2.0, overshoot, 0.0)).iter().sum() });
    let gained = (long - short) / 2.0;
    assert!((2.0..8.5).contains(&gained), "{gained}");
}
