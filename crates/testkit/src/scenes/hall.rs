//! The hall of an old house: stairs with railings, a gallery, and sun through tall windows. Lengths
//! are in meters.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use bevy::prelude::*;

use super::{
    Stage, Vantage, lamplight,
    noise::Random,
    shadows_within,
    shape::{Shape, rgb, shade},
    sky::Sky,
    sunlight,
};

/// Half the width of the hall, where it ends at the back, and the height of the gallery and the
/// ceiling.
const HALF: f32 = 6.0;
const BACK: f32 = -6.5;
const FRONT: f32 = 9.0;
const GALLERY: f32 = 3.4;
const CEILING: f32 = 7.2;
/// Steps up to the landing, and from there to the gallery.
const STEPS: [u32; 2] = [10, 10];
const RISE: f32 = GALLERY / 20.0;
const TREAD: f32 = 0.3;
const FLIGHT: f32 = 1.5;

const OAK: u32 = 0x7a4a2a;
const WALL: u32 = 0xe9dcc0;

fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The stem of a railing, turned on a lathe.
fn baluster(shape: &mut Shape, foot: Vec3) {
    let white = rgb(0xf1e7d3);
    for (y, high, low, top) in [
        (0.0, 0.12, 0.05, 0.05),
        (0.12, 0.2, 0.024, 0.044),
        (0.32, 0.25, 0.044, 0.02),
        (0.57, 0.23, 0.02, 0.032),
    ] {
        shape.frustum(foot + Vec3::Y * y, high, (low, top), 10, white);
    }
}

/// A post at the end of a railing.
fn post(shape: &mut Shape, foot: Vec3) {
    let wood = rgb(OAK);
    shape.cuboid(foot - v(0.09, 0.0, 0.09), foot + v(0.09, 1.0, 0.09), wood);
    let cap = foot + v(-0.12, 1.0, -0.12);
    shape.cuboid(cap, foot + v(0.12, 1.06, 0.12), wood);
    shape.ellipsoid(foot + Vec3::Y * 1.15, Vec3::splat(0.11), 10, wood);
}

/// A handrail between two points at the height of the feet.
fn handrail(shape: &mut Shape, from: Vec3, to: Vec3) {
    let along = to - from;
    let mut rail = Shape::default();
    rail.cuboid([-0.05, 0.8, 0.0], [0.05, 0.88, along.length()], OAK);
    let mut at = Transform::from_translation(from);
    at.rotation = Quat::from_rotation_arc(Vec3::Z, along.normalize());
    // A rail on stairs is upright: its turn is about the horizontal axis across it.
    shape.add(&rail, at);
}

/// A railing on level ground, with a stem every 18 cm.
fn railing(shape: &mut Shape, from: Vec3, to: Vec3) {
    let count = ((to - from).length() / 0.18).round() as i32;
    for k in 1..count {
        baluster(shape, from.lerp(to, k as f32 / count as f32));
    }
    handrail(shape, from, to);
    post(shape, from);
    post(shape, to);
}

/// Stairs from `foot` in a direction, and their railings.
fn stairs(foot: Vec3, ahead: Vec3, half: f32, steps: u32) -> [Shape; 2] {
    let [mut treads, mut rails] = [Shape::default(), Shape::default()];
    let aside = ahead.cross(Vec3::Y);
    let quad_box = |shape: &mut Shape, a: Vec3, b: Vec3, color| {
        shape.cuboid(a.min(b), a.max(b), color);
    };
    for k in 0..steps {
        let k = k as f32;
        let start = foot + ahead * TREAD * k;
        let low = start - aside * half;
        let high = start + aside * half + ahead * TREAD;
        let riser = v(0.0, RISE * (k + 1.0) - 0.04, 0.0);
        let body = rgb(0xeee2ca);
        quad_box(&mut treads, low, high + riser, body);
        let nose = low - ahead * 0.03 - aside * 0.03 + riser;
        let top = high + aside * 0.03 + riser + Vec3::Y * 0.04;
        quad_box(&mut treads, nose, top, rgb(OAK));
        // A carpet in the middle.
        let carpet = start - aside * half * 0.6 - ahead * 0.034 + riser - Vec3::Y * (RISE - 0.04);
        let end = start + aside * half * 0.6 + ahead * TREAD + riser + Vec3::Y * 0.052;
        quad_box(&mut treads, carpet, end, rgb(0xa83236));
    }
    let rise = Vec3::Y * RISE * steps as f32;
    for side in [-1.0, 1.0] {
        let edge = aside * side * (half - 0.08);
        for k in 0..steps {
            for part in [0.25, 0.75] {
                let at = k as f32 + part;
                let on = foot + edge + ahead * TREAD * at + Vec3::Y * RISE * (k as f32 + 1.0);
                baluster(&mut rails, on);
            }
        }
        let from = foot + edge - ahead * 0.1 + Vec3::Y * 0.08;
        let to = foot + edge + ahead * TREAD * steps as f32 + rise + Vec3::Y * 0.12;
        handrail(&mut rails, from, to);
        post(&mut rails, foot + edge - ahead * 0.1);
    }
    [treads, rails]
}

fn floor() -> Shape {
    let mut s = Shape::default();
    let tiles = [rgb(0xf2ead8), rgb(0x3d4650)];
    let size = 0.75;
    s.cuboid([-HALF, -0.3, BACK], [HALF, -0.01, FRONT], 0x5c5147);
    let (columns, rows) = ((2.0 * HALF / size) as i32, ((FRONT - BACK) / size) as i32);
    for j in 0..rows {
        for i in 0..columns {
            let low = v(-HALF + size * i as f32, 0.0, BACK + size * j as f32);
            let [a, b] = [low, low + v(size, 0.0, size)];
            let corners = [a, v(a.x, 0.0, b.z), b, v(b.x, 0.0, a.z)];
            s.polygon(&corners, tiles[((i + j) & 1) as usize]);
        }
    }
    s
}

/// A wall along z at `x`, with tall round-headed windows; the light comes from outside.
fn window_wall(x: f32, places: &[f32], frames: &mut Shape) -> Shape {
    let mut s = Shape::default();
    let color = rgb(WALL);
    let (thick, half, sill, spring) = (0.4, 0.75, 1.0, 4.6);
    let outside = x + thick * x.signum();
    let mut bar = |low: Vec3, high: Vec3, color| s.cuboid(low.min(high), low.max(high), color);
    bar(v(x, 0.0, BACK), v(outside, sill, FRONT), color);
    let mut edge = BACK;
    for at in places {
        bar(v(x, sill, edge), v(outside, CEILING, at - half), color);
        edge = at + half;
    }
    bar(v(x, sill, edge), v(outside, CEILING, FRONT), color);
    for at in places {
        // The arch, in steps of the circle.
        let steps = 14;
        for k in 0..steps {
            let angle = |k: i32| PI * k as f32 / steps as f32;
            let [a, b] = [angle(k), angle(k + 1)];
            let (z0, z1) = (at - half * a.cos(), at - half * b.cos());
            let y = spring + half * (0.5 * (a + b)).sin();
            bar(v(x, y, z0), v(outside, CEILING, z1), color);
        }
        let white = rgb(0xf7f2e6);
        let middle = x + 0.5 * thick * x.signum();
        let mut bar = |y: [f32; 2], z: [f32; 2]| {
            let high = v(middle + 0.04, y[1], z[1]);
            frames.cuboid([middle - 0.04, y[0], z[0]], high, white);
        };
        for z in [-half + 0.04, 0.0, half - 0.04] {
            bar([sill, spring + 0.4], [at + z - 0.04, at + z + 0.04]);
        }
        for y in [sill + 0.04, 2.2, 3.4, spring] {
            bar([y - 0.04, y + 0.04], [at - half, at + half]);
        }
        let low = v(x, sill - 0.06, at - half - 0.15);
        let high = v(x - 0.18 * x.signum(), sill + 0.02, at + half + 0.15);
        frames.cuboid(low.min(high), low.max(high), white);
    }
    s
}

/// The back wall with doors, the side wall with pictures, and the ceiling.
fn walls(frames: &mut Shape) -> Shape {
    let mut s = Shape::default();
    let color = rgb(WALL);
    s.cuboid([-HALF, 0.0, BACK - 0.4], [HALF, CEILING, BACK], color);
    s.cuboid([HALF, 0.0, BACK], [HALF + 0.4, CEILING, FRONT], color);
    s.cuboid(
        [-HALF - 0.4, CEILING, BACK - 0.4],
        [HALF + 0.4, CEILING + 0.3, FRONT],
        0xf4ecdb,
    );
    // Panels of wood below, and a cornice above.
    let wood = shade(rgb(OAK), 1.15);
    s.cuboid([-HALF, 0.0, BACK], [HALF, 1.05, BACK + 0.06], wood);
    s.cuboid([HALF - 0.06, 0.0, BACK], [HALF, 1.05, FRONT], wood);
    for ([left, right], front) in [
        ([-HALF, HALF], BACK + 0.2),
        ([HALF - 0.2, HALF], FRONT),
        ([-HALF, -HALF + 0.2], FRONT),
    ] {
        let low = v(left, CEILING - 0.3, BACK);
        s.cuboid(low, [right, CEILING, front], 0xf7f2e6);
    }
    for x in [-4.3, 4.3] {
        door(frames, x, 0.0);
        door(frames, x, GALLERY);
    }
    for (z, half, hex) in [
        (-2.0f32, 1.1f32, 0x2f5f72),
        (1.2, 0.8, 0x9c4a35),
        (4.0, 1.0, 0x4e6b3a),
    ] {
        let (x, left, right) = (HALF - 0.05, z - half, z + half);
        frames.cuboid([x - 0.03, 1.6, left], [x + 0.05, 2.8, right], 0xc79a3c);
        let (left, right, dark) = (left + 0.1, right - 0.1, shade(rgb(hex), 0.5));
        frames.cuboid([x - 0.05, 1.7, left], [x, 2.7, right], hex);
        frames.cuboid([x - 0.06, 1.7, left], [x, 2.05, right], dark);
    }
    s
}

fn door(frames: &mut Shape, x: f32, y: f32) {
    let wood = rgb(0x5f3620);
    let frame = v(x + 0.62, y + 2.3, BACK + 0.1);
    frames.cuboid([x - 0.62, y, BACK], frame, 0xf7f2e6);
    frames.cuboid([x - 0.5, y, BACK], [x + 0.5, y + 2.18, BACK + 0.13], wood);
    for row in [0.2, 1.2] {
        for column in [-0.4, 0.06] {
            let low = v(x + column, y + row, BACK + 0.1);
            let high = [x + column + 0.34, y + row + 0.85, BACK + 0.16];
            frames.cuboid(low, high, shade(wood, 1.3));
        }
    }
    let knob = v(x + 0.42, y + 1.05, BACK + 0.2);
    frames.ellipsoid(knob, Vec3::splat(0.045), 8, 0xd9a92f);
}

/// The gallery along the back and the right, and what bears it.
fn gallery(rails: &mut Shape) -> Shape {
    let mut s = Shape::default();
    let edge = rgb(0xf1e7d3);
    let deep = 1.7;
    let (inner, front) = (HALF - deep, BACK + deep);
    s.cuboid([-HALF, GALLERY - 0.3, BACK], [HALF, GALLERY, front], edge);
    s.cuboid([inner, GALLERY - 0.3, front], [HALF, GALLERY, 4.0], edge);
    s.cuboid([-HALF, GALLERY - 0.3, front], [-inner, GALLERY, 0.0], edge);
    let mut column = |x: f32, z: f32| {
        s.cuboid([x - 0.28, 0.0, z - 0.28], [x + 0.28, 0.25, z + 0.28], edge);
        s.frustum([x, 0.25, z], 2.5, (0.2, 0.16), 20, edge);
        s.frustum([x, 2.75, z], 0.2, (0.16, 0.27), 20, edge);
        let top = v(x + 0.29, GALLERY - 0.3, z + 0.29);
        s.cuboid([x - 0.29, 2.95, z - 0.29], top, edge);
    };
    for z in [front - 0.3, 0.4, 3.6] {
        column(inner + 0.35, z);
    }
    column(-inner - 0.35, front - 0.3);
    column(-inner - 0.35, -0.4);
    let (side, rail) = (inner + 0.08, front - 0.08);
    // Along the sides, between the two upper flights, and beside them.
    for ([x0, z0], [x1, z1]) in [
        ([side, rail], [side, 3.9]),
        ([-inner - 0.08, rail], [-inner - 0.08, -0.1]),
        ([-1.4, rail], [1.4, rail]),
        ([3.05, rail], [side, rail]),
        ([-inner - 0.08, rail], [-3.05, rail]),
    ] {
        railing(rails, v(x0, GALLERY, z0), v(x1, GALLERY, z1));
    }
    s
}

fn chandelier() -> [Shape; 2] {
    let [mut brass, mut flames] = [Shape::default(), Shape::default()];
    let gold = rgb(0xc79a3c);
    let middle = v(0.0, 4.7, 1.2);
    brass.frustum(middle, CEILING - middle.y, (0.02, 0.02), 8, gold);
    brass.ellipsoid(middle, [0.16, 0.26, 0.16], 12, gold);
    for k in 0..8 {
        let angle = TAU * k as f32 / 8.0;
        let outwards = v(angle.cos(), 0.0, angle.sin());
        for piece in 0..6 {
            let place = |piece: i32| {
                let t = piece as f32 / 6.0;
                middle + outwards * 0.9 * t + Vec3::Y * (0.45 * t * t - 0.3 * (PI * t).sin())
            };
            brass.rod(place(piece), place(piece + 1), 0.02, 8, gold);
        }
        let cup = middle + outwards * 0.9 + Vec3::Y * 0.45;
        brass.frustum(cup, 0.05, (0.04, 0.09), 10, gold);
        brass.frustum(cup + Vec3::Y * 0.05, 0.2, (0.03, 0.03), 8, 0xf7f2e6);
        flames.ellipsoid(cup + Vec3::Y * 0.32, [0.035, 0.075, 0.035], 8, 0xffdf8f);
    }
    [brass, flames]
}

/// A palm in a pot, a chest and a clock.
fn furniture(random: &mut Random) -> Vec<Shape> {
    let mut pot = Shape::default();
    pot.frustum([-4.6, 0.0, 3.4], 0.7, (0.28, 0.42), 20, 0x2f6f73);
    pot.frustum([-4.6, 0.7, 3.4], 0.06, (0.46, 0.46), 20, 0x2f6f73);
    for k in 0..13 {
        let angle = 2.4 * k as f32;
        let outwards = v(angle.cos(), 0.0, angle.sin());
        let across = outwards.cross(Vec3::Y) * 0.1;
        let far = random.range(0.7, 1.1);
        let high = random.range(0.9, 1.5);
        let place =
            |t: f32| v(-4.6, 0.75, 3.4) + outwards * far * t + Vec3::Y * high * (1.7 * t - t * t);
        let green = shade(rgb(0x3f7d3a), random.range(0.7, 1.2));
        for piece in 0..5 {
            let [a, b] = [piece, piece + 1].map(|p| p as f32 / 5.0);
            let wide = |t: f32| across * (PI * (0.15 + 0.85 * t)).sin();
            let [p, q] = [place(a), place(b)];
            let quad = [p - wide(a), p + wide(a), q + wide(b), q - wide(b)];
            let mut below = quad;
            below.reverse();
            pot.polygon(&quad, green);
            pot.polygon(&below, shade(green, 0.8));
        }
    }
    let mut chest = Shape::default();
    let wood = rgb(0x6b3f26);
    chest.cuboid([4.9, 0.15, 0.6], [5.9, 0.95, 2.4], wood);
    chest.cuboid([4.8, 0.95, 0.5], [5.94, 1.02, 2.5], shade(wood, 1.4));
    for z in [0.7, 1.55] {
        for y in [0.25, 0.6] {
            chest.cuboid([4.86, y, z], [4.92, y + 0.28, z + 0.75], shade(wood, 1.25));
        }
    }
    chest.frustum([5.4, 1.02, 1.2], 0.3, (0.1, 0.18), 16, 0x3c5c9a);
    chest.frustum([5.4, 1.32, 1.2], 0.2, (0.18, 0.08), 16, 0x3c5c9a);
    let mut clock = Shape::default();
    let at = v(-1.9, 0.0, BACK + 0.3);
    clock.cuboid(at + v(-0.3, 0.0, -0.25), at + v(0.3, 0.5, 0.2), wood);
    clock.cuboid(at + v(-0.22, 0.5, -0.2), at + v(0.22, 1.6, 0.12), wood);
    clock.cuboid(at + v(-0.3, 1.6, -0.25), at + v(0.3, 2.2, 0.2), wood);
    let mut face = Shape::default();
    face.frustum(Vec3::ZERO, 0.04, (0.22, 0.22), 28, 0xf7f2e6);
    let front = Transform::from_translation(at + v(0.0, 1.9, 0.2))
        .with_rotation(Quat::from_rotation_x(FRAC_PI_2));
    clock.add(&face, front);
    let hand = at + v(-0.015, 1.9, 0.22);
    clock.cuboid(hand, at + v(0.015, 2.07, 0.26), 0x20242b);
    vec![pot, chest, clock]
}

fn spawn_lights(stage: &mut Stage, sun: Vec3) {
    let shadows = shadows_within(30.0);
    let light = sunlight(sun, 9000.0, [1.0, 0.92, 0.78], shadows);
    stage.commands.spawn(light);
    let warm = Color::srgb(1.0, 0.85, 0.6);
    let light = lamplight(v(0.0, 5.1, 1.2), 420_000.0, warm, 20.0, true);
    stage.commands.spawn(light);
    stage.ambient([0.75, 0.83, 1.0], 700.0);
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let mut random = Random::new(12);
    let matt = stage.matt();
    let mut rails = Shape::default();
    let mut frames = Shape::default();
    let mut shapes = vec![
        floor(),
        window_wall(-HALF, &[-3.6, -0.6, 2.4, 5.4], &mut frames),
        walls(&mut frames),
        gallery(&mut rails),
    ];
    // A broad flight to the landing, and two from there to the gallery.
    let landing = RISE * STEPS[0] as f32;
    let front = BACK + 1.7 + FLIGHT + 0.3 + TREAD * STEPS[0] as f32;
    let start = v(0.0, 0.0, front);
    let [treads, more] = stairs(start, -Vec3::Z, 1.4, STEPS[0]);
    shapes.push(treads);
    rails.add(&more, Transform::IDENTITY);
    let end = start.z - TREAD * STEPS[0] as f32;
    let mut platform = Shape::default();
    platform.cuboid([-1.4, 0.0, end - FLIGHT], [1.4, landing, end], 0xeee2ca);
    platform.cuboid(
        [-1.4, landing, end - FLIGHT],
        [1.4, landing + 0.02, end],
        0xa83236,
    );
    shapes.push(platform);
    for side in [-1.0f32, 1.0] {
        let foot = v(1.4 * side, landing, end - 0.5 * FLIGHT);
        let [treads, more] = stairs(foot, Vec3::X * side, 0.5 * FLIGHT, STEPS[1]);
        shapes.push(treads);
        rails.add(&more, Transform::IDENTITY);
    }
    shapes.extend([rails, frames]);
    shapes.extend(furniture(&mut random));
    let [brass, flames] = chandelier();
    shapes.push(brass);
    for shape in shapes {
        stage.shape(shape, &matt);
    }
    let unlit = stage.materials.add(StandardMaterial {
        unlit: true,
        ..default()
    });
    stage.shape(flames, &unlit);
    let sun = v(-0.85, 0.75, 0.3);
    spawn_lights(stage, sun);
    let sky = Sky {
        zenith: 0x6aa3d8,
        middle: 0xbfdcec,
        horizon: 0xf6f0dd,
        ground: 0xa3b083,
        cloud: 0xffffff,
        cover: 0.4,
        sun,
    };
    Vantage {
        eye: v(2.3, 2.1, 8.6),
        target: v(-0.5, 2.55, -2.0),
        fov: 55f32.to_radians(),
        far: 400.0,
        ortho: (v(12.0, 14.0, 16.0), v(0.0, 1.5, 0.0)),
        ortho_height: 14.0,
        ..stage.under(&sky)
    }
}
