//! Dots that lie on things.

use std::f64::consts::PI;

use bevy_comics_testkit::reference::{color, hatching::Hatch, stipple::dot_radius};

use crate::{
    hatched_material::{self, assert_same, frames, seen_from, studio},
    hatching::{FOV, LIGHTS, SIZE, WALLS, come_nearer, covers, empty, flat, mean, tilted},
    prelude::*,
    ramp::put,
};

/// Dots of one size in rows, black on white paper.
fn plain() -> Hatching {
    Hatching {
        marks: HatchingMarks::Dots,
        ..crate::hatching::plain()
    }
}

fn tone(s: &Hatching, light: f32) -> f64 {
    let hatch = Hatch {
        settings: s,
        scale: 1.0,
        drawing: 0,
    };
    hatch.tone(color::lightness([f64::from(light); 3]))
}

/// Truth: the mean of a flat field has the darkness that its lightness asks for, at every tone, angle
/// and distance, in rows and at random.
#[test]
fn flat_fields_of_dots_keep_their_mean_tone() {
    fields_keep_their_mean_tone(&[0.003, 0.15, 0.75], &[WALLS[1], WALLS[3]]);
}

#[test]
#[ignore = "long: five tones of four walls"]
fn flat_fields_of_dots_keep_their_mean_tone_on_every_wall() {
    fields_keep_their_mean_tone(&LIGHTS, &WALLS);
}

fn fields_keep_their_mean_tone(lights: &[f32], walls: &[(f32, f32)]) {
    let mut small = empty();
    let mut worst = [0.0f64; 2];
    for &light in lights {
        for &(degrees, distance) in walls {
            small.clear();
            flat(&mut small, light, tilted(degrees, distance));
            for (random, worst) in [0.0, 1.0].into_iter().zip(&mut worst) {
                let s = Hatching {
                    wobble: random,
                    pressure: random,
                    ..plain()
                };
                let want = tone(&s, light);
                let got = mean(&covers(&mut small, s));
                *worst = worst.max((got - want).abs());
                println!("light {light}, {degrees} degrees, random {random}: {got:.3}, {want:.3}");
            }
        }
    }
    println!("mean tone off by up to {worst:.3?}");
    // About a thousand dots: a row more or less at the borders is a hundredth.
    assert!(worst[0] < 0.02 && worst[1] < 0.02, "{worst:?}");
    assert_eq!(small.errors(), 0);
}

/// Dots of a picture that do not touch its border: the middle, in pixels from the middle of the picture,
/// and the area.
fn dots(covers: &[f64]) -> Vec<(DVec2, f64)> {
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
            found.push((middle / area - SIZE.as_dvec2() / 2.0, area));
        }
    }
    found
}

/// Truth, on counted dots: all dots but those that grow have the same area at every distance, there are
/// as many as the tone asks for, and each is where it was when the camera has come to half the distance,
/// where four times as many are on as much of the wall.
#[test]
fn dots_stay_and_more_of_them_grow() {
    let mut small = empty();
    let light = 0.4;
    let s = Hatching {
        spacing: 9.0,
        ..plain()
    };
    let varied = Hatching { pressure: 1.0, ..s };
    let tone = tone(&s, light);
    let area = PI * dot_radius(&s, 9.0).powi(2);
    for distance in [8.0, 9.0, 10.5, 12.0, 14.0] {
        let [far, near] = [distance, 0.5 * distance].map(|distance| {
            small.clear();
            flat(&mut small, light, Transform::from_xyz(0.0, 0.0, -distance));
            dots(&covers(&mut small, s))
        });
        assert!(far.len() > 20, "{distance}: {} dots", far.len());
        let grown = |dots: &[(DVec2, f64)]| {
            let sizes = dots.iter().map(|dot| dot.1 / area);
            let whole: Vec<f64> = sizes.clone().filter(|size| *size > 0.97).collect();
            let largest = sizes.fold(0.0, f64::max);
            (whole.len(), largest)
        };
        let (whole, largest) = grown(&far);
        println!(
            "{distance}: {} dots, {whole} of them whole; largest {largest:.3}; near: {}",
            far.len(),
            near.len()
        );
        assert!((largest - 1.0).abs() < 0.03, "{distance}: {largest}");
        // Ink of a dot for each whole old one: the tone. Borders take half a dot on each side.
        let pixels = f64::from(SIZE.x * SIZE.y);
        let ink: f64 = far.iter().map(|dot| dot.1).sum();
        let most = tone * pixels;
        assert!(ink <= 1.02 * most && ink > 0.7 * most, "{ink} of {most}");
        let half = SIZE.as_dvec2() / 2.0 - 12.0;
        let mut compared = 0;
        for (middle, size) in &far {
            let there = 2.0 * *middle;
            if size / area < 0.97 || there.abs().cmpgt(half).any() {
                continue;
            }
            compared += 1;
            let off = near.iter().map(|dot| dot.0.distance(there));
            let nearest = off.fold(f64::MAX, f64::min);
            assert!(nearest < 0.15, "{distance}, {middle}: {nearest}");
        }
        assert!(compared > 4, "{distance}: {compared}");
        // A dot keeps the size that is its own.
        let [far, near] = [distance, 0.5 * distance].map(|distance| {
            small.clear();
            flat(&mut small, light, Transform::from_xyz(0.0, 0.0, -distance));
            dots(&covers(&mut small, varied))
        });
        let old = far.iter().filter_map(|(middle, size)| {
            let there = 2.0 * *middle;
            let same = near.iter().find(|dot| dot.0.distance(there) < 0.15)?;
            Some((*size, same.1))
        });
        let pairs: Vec<(f64, f64)> = old.collect();
        let kept = pairs
            .iter()
            .filter(|(far, near)| (far / near - 1.0).abs() < 0.05)
            .count();
        let least = pairs
            .iter()
            .map(|pair| pair.1 / area)
            .fold(f64::MAX, f64::min);
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

/// Truth: no dot appears at once. While the camera comes nearer by 0.5 % in each frame, no pixel changes by
/// more than the motion and the growth of a dot explain.
#[test]
fn dots_grow_while_the_camera_comes_nearer() {
    dots_grow(Hatching {
        wobble: 1.0,
        pressure: 1.0,
        ..plain()
    });
}

#[test]
#[ignore = "long: an octave, of dots of one size in rows"]
fn dots_in_rows_grow_while_the_camera_comes_nearer() {
    dots_grow(plain());
}

fn dots_grow(s: Hatching) {
    let mut small = empty();
    flat(&mut small, 0.2, tilted(25.0, 20.0));
    let [largest, low, high] = come_nearer(&mut small, s, 145);
    println!("largest change {largest:.3}, mean tone {low:.3} to {high:.3}");
    // Within 20 pixels of the middle, things move by 0.1 pixels. While there are x^2 dots for each old
    // one, the newest grows by 2 * 0.005 * x^2 of its area in a frame: the last of three begins at
    // x^2 = 3.
    let growth = 0.03 * PI * dot_radius(&s, 4.0).powi(2);
    assert!(largest < 0.1 + growth, "{largest}, {growth}");
    assert!(high - low < 0.03, "{low} to {high}");
}

/// Truth: dots travel with an object that has a screen: the camera that follows sees the same picture.
#[test]
fn dots_travel_with_their_object() {
    let mut small = empty();
    let at = tilted(30.0, 12.0);
    let object = flat(&mut small, 0.2, at);
    let screen = PatternAnchor::default();
    small.world().entity_mut(object).insert(screen);
    let s = Hatching {
        wobble: 1.0,
        pressure: 1.0,
        ..plain()
    };
    let still = covers(&mut small, s);
    let turn = Quat::from_euler(EulerRot::YXZ, 0.7, -0.3, 1.1);
    let moved = Transform::from_xyz(31.7, -8.3, 102.9).with_rotation(turn);
    small.world().entity_mut(object).insert(moved * at);
    small.insert(moved);
    // As for strokes: normals are known to ten bits.
    let apart = |now: &[f64]| {
        let pairs = still.iter().zip(now);
        pairs.filter(|(a, b)| (*a - *b).abs() > 3.0 / 255.0).count()
    };
    let stays = apart(&covers(&mut small, s));
    println!("moved: {stays} pixels differ");
    assert!(stays < still.len() / 200, "{stays}");
    // Fixed to the world, they swim.
    small.world().entity_mut(object).remove::<PatternAnchor>();
    let swims = apart(&covers(&mut small, s));
    assert!(swims > still.len() / 10, "{swims}");
    assert_eq!(small.errors(), 0);
}

/// Truth: dots of the toon material stay on a mesh that moves, turns and is stretched.
#[test]
fn dots_stay_on_the_material() {
    let (mut small, sun) = studio();
    small.insert((DepthPrepass, NormalPrepass));
    let hatching = Some(Hatching {
        wobble: 1.0,
        pressure: 1.0,
        shadows: 0.0,
        ..plain()
    });
    let light = ToonLight {
        hatching,
        ..default()
    };
    let own =
        Transform::from_rotation(Quat::from_rotation_x(0.4)).with_scale(Vec3::new(1.2, 0.7, 1.0));
    let ball = || Sphere::new(0.8).mesh().uv(64, 32);
    let object = put(&mut small, ball(), &light, own);
    let still = hatched_material::covers(&mut small);
    for frame in frames() {
        small.world().entity_mut(object).insert(frame * own);
        seen_from(&mut small, frame, sun);
        assert_same(&still, &hatched_material::covers(&mut small), "moved");
    }
}

/// The sky has no dots on things, and light walls have none, black ones are solid; values out of range are
/// clamped.
#[test]
fn extreme_dots_are_finite() {
    let mut small = empty();
    let sky = covers(&mut small, plain());
    assert!(sky.iter().all(|c| c.abs() < 0.01));
    let solid = |small: &mut Small, want: f64| {
        for anchor in [HatchingAnchor::Object, HatchingAnchor::Page] {
            let found = covers(small, Hatching { anchor, ..plain() });
            assert!(
                found.iter().all(|c| (c - want).abs() < 0.01),
                "{want}, {anchor:?}"
            );
        }
    };
    for (light, want) in [(0.0, 1.0), (1.0, 0.0)] {
        small.clear();
        flat(&mut small, light, tilted(40.0, 5.0));
        solid(&mut small, want);
    }
    small.clear();
    flat(&mut small, 0.2, tilted(89.5, 5.0));
    small.insert(Projection::Perspective(PerspectiveProjection {
        fov: 2.0 * FOV,
        ..default()
    }));
    for x in [f32::NAN, f32::INFINITY, -1e30, 0.0, 1e30] {
        let s = Hatching {
            spacing: x,
            layers: 99,
            layer_darkness: x,
            angle: x,
            wobble: x,
            pressure: x,
            rate: x,
            simplify_small: x,
            ..plain()
        };
        let found = covers(&mut small, s);
        assert!(found.iter().all(|c| c.is_finite()), "{x}");
    }
    assert_eq!(small.errors(), 0);
}
