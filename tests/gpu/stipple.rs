//! Dots that lie on things.

use std::f64::consts::PI;

use bevy_comics_testkit::reference::stipple::dot_radius;

use crate::{
    hatched_material::assert_marks_stay,
    hatching::{
        Field, PARTS_OF_THE_WAY, SIZE, THREE_FIELDS, WHOLE_WAY, assert_marks_travel, covers, empty,
        every_field, fields_keep_their_mean_tone, flat, largest_change, tone,
    },
    prelude::*,
};

/// Dots of one size in rows, black on white paper.
fn plain() -> Hatching {
    crate::hatching::plain(HatchingKind::Dots)
}

/// Dots of many sizes, which stray.
fn random() -> Hatching {
    Hatching {
        wobble: 1.0,
        pressure: 1.0,
        ..plain()
    }
}

/// Truth: the mean of a flat field has the darkness that its lightness asks for, at every tone,
/// angle and distance, in rows and at random.
#[test]
fn flat_fields_of_dots_keep_their_mean_tone() {
    dots_keep_their_mean_tone(&THREE_FIELDS);
}

#[test]
#[ignore = "long: five tones of four walls"]
fn flat_fields_of_dots_keep_their_mean_tone_on_every_wall() {
    dots_keep_their_mean_tone(&every_field());
}

fn dots_keep_their_mean_tone(fields: &[Field]) {
    // About a thousand dots: a row more or less at the borders is a hundredth.
    fields_keep_their_mean_tone(fields, &[(plain(), 0.02), (random(), 0.02)]);
}

/// A dot: its middle in pixels from the middle of the picture, and its area in pixels.
#[derive(Clone, Copy)]
struct Dot {
    middle: DVec2,
    area: f64,
}

/// Dots of a picture that do not touch its border.
fn dots(covers: &[f64]) -> Vec<Dot> {
    let [width, height] = SIZE.to_array().map(|x| x as usize);
    let mut seen = vec![false; covers.len()];
    let mut found = Vec::new();
    for start in 0..covers.len() {
        if seen[start] || covers[start] < 0.02 {
            continue;
        }
        let (mut area, mut middle, mut inside) = (0.0, DVec2::ZERO, true);
        let mut open = vec![start];
        seen[start] = true;
        while let Some(at) = open.pop() {
            let [x, y] = [at % width, at / width];
            area += covers[at];
            middle += covers[at] * DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
                inside = false;
                continue;
            }
            for next in [at - 1, at + 1, at - width, at + width] {
                if !seen[next] && covers[next] >= 0.02 {
                    seen[next] = true;
                    open.push(next);
                }
            }
        }
        if inside {
            let middle = middle / area - SIZE.as_dvec2() / 2.0;
            found.push(Dot { middle, area });
        }
    }
    found
}

/// Truth, on counted dots: all dots but those that grow have the same area at every distance, there
/// are as many as the tone asks for, and each is where it was when the camera has come to half the
/// distance, where four times as many are on as much of the wall.
#[test]
fn dots_stay_and_more_of_them_grow() {
    assert_dots_stay(&[8.0, 10.5, 14.0]);
}

#[test]
#[ignore = "long: more distances; quick test stipple::dots_stay_and_more_of_them_grow"]
fn dots_stay_and_more_of_them_grow_at_every_distance() {
    assert_dots_stay(&[8.0, 9.0, 10.5, 12.0, 14.0]);
}

fn assert_dots_stay(distances: &[f32]) {
    let mut small = empty();
    let light = 0.4;
    let s = Hatching {
        spacing: 9.0,
        ..plain()
    };
    let varied = Hatching { pressure: 1.0, ..s };
    let area = PI * dot_radius(&s, 9.0).powi(2);
    for &distance in distances {
        let mut far_and_near = |s: Hatching| {
            [distance, 0.5 * distance].map(|distance| {
                small.clear();
                flat(&mut small, light, Transform::from_xyz(0.0, 0.0, -distance));
                dots(&covers(&mut small, s))
            })
        };
        let [far, near] = far_and_near(s);
        assert!(far.len() > 20, "{distance}: {} dots", far.len());
        let largest = far.iter().map(|dot| dot.area / area).fold(0.0, f64::max);
        println!(
            "{distance}: {} and {} dots; largest {largest:.3}",
            far.len(),
            near.len()
        );
        assert!((largest - 1.0).abs() < 0.03, "{distance}: {largest}");
        // Ink of a dot for each whole old one: the tone. Borders take half a dot on each side.
        let ink: f64 = far.iter().map(|dot| dot.area).sum();
        let most = tone(&s, light) * f64::from(SIZE.x * SIZE.y);
        assert!(ink <= 1.02 * most && ink > 0.7 * most, "{ink} of {most}");
        let half = SIZE.as_dvec2() / 2.0 - 12.0;
        let whole = far.iter().filter(|dot| dot.area / area >= 0.97);
        let inside = whole.filter(|dot| !(2.0 * dot.middle).abs().cmpgt(half).any());
        let mut compared = 0;
        for dot in inside {
            compared += 1;
            let off = near
                .iter()
                .map(|other| other.middle.distance(2.0 * dot.middle));
            let nearest = off.fold(f64::MAX, f64::min);
            assert!(nearest < 0.15, "{distance}, {}: {nearest}", dot.middle);
        }
        assert!(compared > 4, "{distance}: {compared}");
        // A dot keeps the size that is its own.
        let [far, near] = far_and_near(varied);
        let pairs: Vec<[f64; 2]> = (far.iter())
            .filter_map(|dot| {
                let is_same = |other: &&Dot| other.middle.distance(2.0 * dot.middle) < 0.15;
                Some([dot.area, near.iter().find(is_same)?.area])
            })
            .collect();
        let kept = pairs
            .iter()
            .filter(|[far, near]| (far / near - 1.0).abs() < 0.05);
        let kept = kept.count();
        let sizes = pairs.iter().map(|[_, near]| near / area);
        let least = sizes.fold(f64::MAX, f64::min);
        println!(
            "{kept} of {} dots keep their size, from {least:.2}",
            pairs.len()
        );
        // Those that still grow do not.
        assert!(
            kept >= compared && least < 0.9,
            "{kept}, {compared}, {least}"
        );
    }
}

/// Truth: no dot appears at once. While the camera comes nearer by 0.5 % in each frame, no pixel
/// changes by more than the motion and the growth of a dot explain.
#[test]
fn dots_grow_while_the_camera_comes_nearer() {
    assert_dots_grow(random(), PARTS_OF_THE_WAY);
}

#[test]
#[ignore = "long: an octave, of dots of one size in rows as well"]
fn dots_grow_through_an_octave() {
    for s in [plain(), random()] {
        assert_dots_grow(s, WHOLE_WAY);
    }
}

fn assert_dots_grow(s: Hatching, way: &[[i32; 2]]) {
    let largest = largest_change(0.2, 25.0, s, way);
    // Within 20 pixels of the middle, things move by 0.1 pixels. While there are x^2 dots for each
    // old one, the newest grows by 2 * 0.005 * x^2 of its area in a frame: the last of three begins
    // at x^2 = 3.
    let growth = 0.03 * PI * dot_radius(&s, 4.0).powi(2);
    assert!(largest < 0.1 + growth, "{largest}, {growth}");
}

/// Truth: dots travel with an object that has a screen.
#[test]
fn dots_travel_with_their_object() {
    assert_marks_travel(random(), Vec3::new(31.7, -8.3, 102.9), 3.0 / 255.0);
}

/// Truth: dots of the toon material stay on a mesh that moves, turns and is stretched.
#[test]
fn dots_stay_on_the_material() {
    let s = Hatching {
        solid_below: 0.0,
        ..random()
    };
    assert_marks_stay(s);
}
