//! A street at night in the rain: lit windows, signs, lamps and a wet road. Lengths are in meters.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::prelude::*;

use super::{
    Stage, Vantage, lamplight,
    noise::{Random, noise2},
    shadow_cascades,
    shape::{Shape, rgb, shade},
    sky::Sky,
    sunlight,
};

/// Half the width of the road, and of the street between the fronts.
const ROAD: f32 = 3.6;
const FRONTS: f32 = 6.4;
const STOREY: f32 = 3.1;

/// Meshes of all that is lit, of what shines by itself, and of what is mixed over the picture: the
/// color of a vertex has its opacity.
#[derive(Default)]
struct Parts {
    lit: Shape,
    shining: Shape,
    mixed: Shape,
}

/// A lamp or a sign: where it is, and its color.
struct Shining {
    at: Vec3,
    color: u32,
}

/// The front of a house from `z` on towards the eye, `width` wide.
fn front(parts: &mut Parts, random: &mut Random, side: f32, z: f32, width: f32) {
    let storeys = 3 + (random.unit() * 3.0) as i32;
    let height = 0.15 + STOREY * storeys as f32 + 0.6;
    let wall = random.pick(&[0x7a4b45, 0x5d6470, 0x8a7a64, 0x4e5f63, 0x6b5468].map(rgb));
    let v = Vec3::new;
    let (near, far) = (z + width, z);
    parts
        .lit
        .beside(side, [FRONTS, 0.0, far], [FRONTS + 9.0, height, near], wall);
    // A cornice, and a band over the shop.
    for (y, high, out) in [(height - 0.5, 0.5, 0.35), (STOREY + 0.3, 0.25, 0.2)] {
        let color = shade(wall, 1.35);
        let low = v(FRONTS - out, y, far + 0.02);
        let high = v(FRONTS, y + high, near - 0.02);
        parts.lit.beside(side, low, high, color);
    }
    let count = (width / 1.9) as i32;
    let step = width / count as f32;
    let warm = [0xffd27a, 0xffb65c, 0xffe7b0, 0x9fd8ff].map(rgb);
    for storey in 1..storeys {
        for column in 0..count {
            let middle = far + step * (column as f32 + 0.5);
            let low = 0.8 + STOREY * storey as f32;
            let frame = shade(wall, 1.7);
            let corner = v(FRONTS - 0.08, low - 0.1, middle - 0.55);
            let other = v(FRONTS, low + 1.7, middle + 0.55);
            parts.lit.beside(side, corner, other, frame);
            let is_lit = random.unit() < 0.4;
            let (shape, glass) = if is_lit {
                (&mut parts.shining, random.pick(&warm))
            } else {
                (&mut parts.lit, rgb(0x1d2733))
            };
            for pane in [-0.44, 0.03] {
                let corner = v(FRONTS - 0.1, low, middle + pane);
                let other = v(FRONTS - 0.02, low + 1.55, middle + pane + 0.41);
                shape.beside(side, corner, other, glass);
            }
            let sill = v(FRONTS - 0.22, low - 0.2, middle - 0.65);
            parts
                .lit
                .beside(side, sill, [FRONTS, low - 0.08, middle + 0.65], frame);
        }
    }
    shop(parts, random, side, far, near);
    if random.unit() < 0.6 {
        let middle = Vec3::new(side * (FRONTS + 3.0), height, 0.5 * (far + near));
        parts.lit.frustum(middle, 2.2, (1.1, 1.1), 14, 0x4b3b33);
        parts
            .lit
            .frustum(middle + Vec3::Y * 2.2, 0.8, (1.3, 0.0), 14, 0x332a26);
    }
}

/// A shop window under an awning, and a door.
fn shop(parts: &mut Parts, random: &mut Random, side: f32, far: f32, near: f32) {
    let Parts { lit, shining, .. } = parts;
    let v = Vec3::new;
    let dark = rgb(0x232a33);
    let light = random.pick(&[0xffe0a3, 0xfff0cf, 0xbfe9ff].map(rgb));
    lit.beside(
        side,
        [FRONTS - 0.12, 0.15, far + 0.5],
        [FRONTS, 2.75, near - 0.5],
        dark,
    );
    let mut at = far + 0.7;
    while at + 1.2 < near - 0.7 {
        let corner = v(FRONTS - 0.16, 0.75, at);
        let other = v(FRONTS - 0.1, 2.55, at + 1.1);
        shining.beside(side, corner, other, light);
        at += 1.3;
    }
    // Stripes of the awning, from the wall down.
    let cloth = random.pick(&[0xb8383c, 0x2f6f73, 0xc98a2b, 0x5a4f8f].map(rgb));
    let stripes = 9;
    let wide = (near - far - 0.8) / stripes as f32;
    for k in 0..stripes {
        let color = if k % 2 == 0 { cloth } else { rgb(0xe8dcc4) };
        let at = |k: i32| far + 0.4 + wide * k as f32;
        // From one height and distance from the wall to another.
        let strip = |[y0, x0]: [f32; 2], [y1, x1]: [f32; 2]| {
            let p = |x: f32, y: f32, k: i32| v(side * (FRONTS - x), y, at(k));
            [
                p(x0, y0, k),
                p(x0, y0, k + 1),
                p(x1, y1, k + 1),
                p(x1, y1, k),
            ]
        };
        let mut roof = strip([3.1, 0.0], [2.55, 1.2]);
        let mut below = roof;
        below.reverse();
        let mut hem = strip([2.55, 1.2], [2.3, 1.2]);
        if side < 0.0 {
            std::mem::swap(&mut roof, &mut below);
            hem.reverse();
        }
        lit.polygon(&roof, color);
        lit.polygon(&below, shade(color, 0.5));
        lit.polygon(&hem, color);
    }
}

/// A sign that stands out from a front. `marks`: dark bars on it, as `[x, y, width, height]` in
/// parts of its face.
fn sign(parts: &mut Parts, side: f32, low: Vec3, size: Vec2, color: u32, marks: &[[f32; 4]]) {
    let Parts { lit, shining, .. } = parts;
    let v = Vec3::new;
    let out = FRONTS - 0.25;
    let corner = v(out - size.x, low.y, low.z);
    lit.beside(
        side,
        corner - v(0.08, 0.08, 0.0),
        [out + 0.08, low.y + size.y + 0.08, low.z + 0.24],
        0x20242b,
    );
    shining.beside(
        side,
        corner + v(0.0, 0.0, 0.1),
        [out, low.y + size.y, low.z + 0.28],
        color,
    );
    for [x, y, width, height] in marks {
        let a = v(out - size.x * (x + width), low.y + size.y * y, low.z + 0.2);
        let b = v(
            out - size.x * x,
            low.y + size.y * (y + height),
            low.z + 0.31,
        );
        lit.beside(side, a, b, 0x16181d);
    }
    for y in [0.2, 0.8] {
        let at = low.y + size.y * y;
        let bar = v(out, at - 0.03, low.z + 0.08);
        lit.beside(side, bar, [FRONTS, at + 0.03, low.z + 0.16], 0x20242b);
    }
}

fn lamp(parts: &mut Parts, side: f32, z: f32) -> Shining {
    let Parts { lit, shining, .. } = parts;
    let iron = rgb(0x262b31);
    let foot = Vec3::new(side * (ROAD + 0.5), 0.15, z);
    lit.frustum(foot, 0.5, (0.16, 0.12), 10, iron);
    lit.frustum(foot, 4.6, (0.07, 0.05), 10, iron);
    let v = Vec3::new;
    let arm = v(ROAD - 0.7, 4.6, z - 0.04);
    lit.beside(side, arm, [ROAD + 0.56, 4.7, z + 0.04], iron);
    let head = v(ROAD - 0.75, 4.42, z - 0.17);
    lit.beside(
        side,
        head + Vec3::Y * 0.1,
        [ROAD - 0.05, 4.62, z + 0.17],
        iron,
    );
    shining.beside(
        side,
        head + v(0.06, 0.0, 0.04),
        [ROAD - 0.11, 4.52, z + 0.13],
        0xffe2a6,
    );
    Shining {
        at: Vec3::new(side * (ROAD - 0.4), 4.3, z),
        color: 0xffd9a0,
    }
}

/// A walker with an umbrella, seen from behind.
fn walker() -> Shape {
    let mut s = Shape::default();
    let coat = rgb(0xc8a24a);
    for side in [-1.0, 1.0] {
        let foot = Vec3::new(0.11 * side, 0.0, 0.16 * side);
        s.frustum(foot, 0.6, (0.075, 0.095), 10, 0x23283a);
        let shoe = Vec3::new(0.11 * side, 0.05, 0.16 * side - 0.05);
        s.ellipsoid(shoe, [0.08, 0.06, 0.15], 6, 0x14161c);
    }
    s.frustum(Vec3::Y * 0.45, 0.65, (0.31, 0.2), 18, coat);
    s.frustum(Vec3::Y * 1.1, 0.32, (0.2, 0.17), 18, coat);
    s.ellipsoid(Vec3::Y * 1.4, [0.22, 0.12, 0.15], 10, coat);
    s.frustum(Vec3::Y * 0.98, 0.07, (0.245, 0.235), 18, shade(coat, 0.55));
    s.ellipsoid(Vec3::Y * 1.66, [0.12, 0.15, 0.13], 12, 0x3a2a24);
    s.cuboid([0.16, 1.05, -0.2], [0.26, 1.42, 0.0], coat);
    let stick = Vec3::new(0.22, 1.05, -0.22);
    s.frustum(stick, 1.15, (0.015, 0.015), 8, 0x1b1d22);
    // The cloth has eight ribs.
    let top = stick + Vec3::Y * 1.15;
    let rib = |k: usize, radius: f32, down: f32| {
        let angle = TAU * (k as f32 + 0.5) / 8.0;
        top + Vec3::new(radius * angle.cos(), -down, radius * angle.sin())
    };
    for k in 0..8 {
        let red = shade(rgb(0xc4342f), if k % 2 == 0 { 1.0 } else { 0.8 });
        let rings = [(0.02, 0.0), (0.42, 0.1), (0.78, 0.36)];
        for pair in rings.windows(2) {
            let [(r0, d0), (r1, d1)] = [pair[0], pair[1]];
            let top = [k, k + 1].map(|k| rib(k, r0, d0));
            let end = [k + 1, k].map(|k| rib(k, r1, d1));
            let quad = [top[0], top[1], end[0], end[1]];
            s.polygon(&quad, red);
            let below: Vec<Vec3> = quad.iter().rev().map(|p| p - Vec3::Y * 0.01).collect();
            s.polygon(&below, shade(red, 0.4));
        }
    }
    s
}

/// A parked car that looks towards +z.
fn car(parts: &mut Parts, at: Transform) {
    let mut s = Shape::default();
    let paint = rgb(0x2e6a8e);
    s.cuboid([-0.85, 0.32, -2.1], [0.85, 0.86, 2.1], paint);
    s.cuboid([-0.88, 0.3, 2.05], [0.88, 0.5, 2.2], 0x8c949c);
    // The cabin is narrower at the top.
    let ring = |y: f32, x: f32, back: f32, front: f32| {
        [(-x, front), (x, front), (x, back), (-x, back)].map(|(x, z)| Vec3::new(x, y, z))
    };
    let (low, high) = (ring(0.86, 0.82, -1.75, 0.95), ring(1.42, 0.66, -1.35, 0.35));
    for k in 0..4 {
        let next = (k + 1) % 4;
        let quad = [low[k], low[next], high[next], high[k]];
        s.polygon(&quad, rgb(0x1b242e));
    }
    s.polygon(&high, paint);
    for (x, z) in [(-0.8, 1.3), (0.8, 1.3), (-0.8, -1.35), (0.8, -1.35)] {
        let mut wheel = Shape::default();
        wheel.frustum(Vec3::Y * -0.12, 0.24, (0.34, 0.34), 20, 0x17191c);
        wheel.frustum(Vec3::Y * 0.12, 0.02, (0.2, 0.18), 12, 0x9aa3ab);
        let outwards = Quat::from_rotation_z(if x > 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 });
        let place = Transform::from_xyz(x, 0.34, z).with_rotation(outwards);
        s.add(&wheel, place);
    }
    parts.lit.add(&s, at);
    let mut lights = Shape::default();
    for side in [-1.0, 1.0] {
        lights.beside(side, [0.45, 0.58, 2.08], [0.75, 0.74, 2.14], 0xd9d2b8);
    }
    parts.shining.add(&lights, at);
}

/// Light of a lamp or a sign on the wet ground in front of it.
fn reflection(parts: &mut Parts, shining: &Shining) {
    let [r, g, b, _] = rgb(shining.color);
    let is_on_road = shining.at.x.abs() < ROAD;
    let y = if is_on_road { 0.02 } else { 0.17 };
    let mut last: Option<[u32; 3]> = None;
    let rows = 24;
    for k in 0..=rows {
        let t = k as f32 / rows as f32;
        let z = shining.at.z + 0.6 + 8.0 * t;
        // Ripples make it ragged.
        let aside = 0.16 * noise2(Vec2::new(2.3 * z, shining.at.x));
        let half = 0.16 + 0.5 * t + 0.12 * noise2(Vec2::new(3.1 * z, 7.0 + shining.at.x));
        let alpha = 0.5 * (1.0 - t) * (0.75 + 0.25 * noise2(Vec2::new(5.0 * z, 3.0)));
        let x = shining.at.x + aside;
        let row = [(-half, 0.0), (0.0, alpha), (half, 0.0)].map(|(by, alpha)| {
            let at = Vec3::new(x + by, y, z);
            parts.mixed.vertex(at, Vec3::Y, [r, g, b, alpha])
        });
        if let Some(before) = last {
            for i in 0..2 {
                let [a, b, c, d] = [before[i], before[i + 1], row[i + 1], row[i]];
                parts.mixed.indices.extend([a, d, c, a, c, b]);
            }
        }
        last = Some(row);
    }
}

fn rain(parts: &mut Parts, random: &mut Random) {
    for _ in 0..1100 {
        let box_of_rain = [(-7.0, 7.0), (0.0, 9.0), (-26.0, 11.5)];
        let at = Vec3::from(box_of_rain.map(|(low, high)| random.range(low, high)));
        let long = random.range(0.35, 0.8);
        let down = Vec3::new(0.12, -1.0, 0.0) * long;
        let wide = Vec3::X * 0.008;
        let ends = [0.0, 0.45];
        let corners = [
            (at - wide, ends[0]),
            (at + wide, ends[0]),
            (at + down + wide, ends[1]),
            (at + down - wide, ends[1]),
        ];
        let [a, b, c, d] =
            corners.map(|(p, alpha)| parts.mixed.vertex(p, Vec3::Z, [0.55, 0.66, 0.8, alpha]));
        parts.mixed.indices.extend([a, c, b, a, d, c]);
    }
}

/// A cable that hangs between two points.
fn cable(shape: &mut Shape, from: Vec3, to: Vec3, sag: f32) {
    let at = |k: i32| {
        let t = k as f32 / 16.0;
        from.lerp(to, t) - Vec3::Y * (sag * 4.0 * t * (1.0 - t))
    };
    for k in 0..16 {
        shape.rod(at(k), at(k + 1), 0.018, 6, 0x14171c);
    }
}

fn ground(parts: &mut Parts) {
    let Parts { lit, .. } = parts;
    let v = Vec3::new;
    lit.cuboid([-ROAD, -0.4, -90.0], [ROAD, 0.0, 20.0], 0x2b323c);
    for side in [-1.0, 1.0] {
        let kerb = v(ROAD, -0.4, -90.0);
        lit.beside(side, kerb, [ROAD + 0.25, 0.16, 20.0], 0x6d737b);
        let flags = v(ROAD + 0.25, -0.4, -90.0);
        lit.beside(side, flags, [FRONTS + 1.0, 0.15, 20.0], 0x4a515a);
    }
    // A crossing.
    for k in 0..6 {
        let x = -ROAD + 0.45 + 1.2 * k as f32;
        lit.cuboid([x, -0.1, -4.6], [x + 0.6, 0.012, -1.6], 0xb9bcb6);
    }
}

fn end_of_the_street(parts: &mut Parts) {
    let Parts { lit, shining, .. } = parts;
    let stone = rgb(0x5a5f6e);
    lit.cuboid([-16.0, 0.0, -78.0], [16.0, 17.0, -66.0], stone);
    lit.cuboid([-3.2, 0.0, -68.0], [3.2, 29.0, -62.0], shade(stone, 1.2));
    lit.frustum([0.0, 29.0, -65.0], 8.0, (4.6, 0.0), 4, 0x34394a);
    let mut clock = Shape::default();
    clock.frustum(Vec3::ZERO, 0.3, (2.2, 2.2), 40, 0xfff1c9);
    let face =
        Transform::from_xyz(0.0, 24.5, -62.1).with_rotation(Quat::from_rotation_x(FRAC_PI_2));
    shining.add(&clock, face);
    for (angle, long) in [(0.9f32, 1.7), (-1.9, 1.2)] {
        let mut hand = Shape::default();
        hand.cuboid([-0.09, -0.2, 0.0], [0.09, long, 0.08], 0x1a1c22);
        let at = Transform::from_xyz(0.0, 24.5, -61.76).with_rotation(Quat::from_rotation_z(angle));
        lit.add(&hand, at);
    }
}

/// A sign: its side, height and place along the street, its size, its color, and its marks.
type Board<'a> = (f32, f32, f32, Vec2, u32, &'a [[f32; 4]]);

/// Signs of a bar, a kitchen, a hotel and others, and the light they give.
fn signs(parts: &mut Parts) -> Vec<Shining> {
    let rows: [[f32; 4]; 3] =
        [[0.72, 0.6], [0.45, 0.6], [0.18, 0.35]].map(|[y, width]| [0.2, y, width, 0.12]);
    let bowl: [[f32; 4]; 4] = [
        [0.15, 0.3, 0.7, 0.12],
        [0.25, 0.18, 0.5, 0.12],
        [0.32, 0.5, 0.08, 0.3],
        [0.58, 0.5, 0.08, 0.3],
    ];
    let cross: [[f32; 4]; 2] = [[0.4, 0.15, 0.2, 0.7], [0.15, 0.4, 0.7, 0.2]];
    let letter: [[f32; 4]; 3] = [
        [0.2, 0.1, 0.18, 0.8],
        [0.62, 0.1, 0.18, 0.8],
        [0.38, 0.42, 0.24, 0.16],
    ];
    let all: [Board; 6] = [
        (1.0, 4.0, 2.6, Vec2::new(1.0, 2.6), 0xff4f6d, &rows),
        (-1.0, 3.7, -0.8, Vec2::new(1.5, 1.4), 0x35e0d0, &bowl),
        (1.0, 5.4, -9.0, Vec2::new(1.3, 1.3), 0x7dff8a, &cross),
        (-1.0, 5.0, -12.5, Vec2::new(1.1, 3.4), 0xffc23d, &letter),
        (1.0, 4.2, -22.0, Vec2::new(1.2, 3.0), 0x6fa8ff, &rows),
        (-1.0, 4.6, -31.0, Vec2::new(1.2, 2.4), 0xff7ad9, &rows),
    ];
    all.map(|(side, y, z, size, color, marks)| {
        sign(parts, side, Vec3::new(0.0, y, z), size, color, marks);
        let x = side * (FRONTS - 0.25 - 0.5 * size.x);
        Shining {
            at: Vec3::new(x, y + 0.5 * size.y, z + 0.6),
            color,
        }
    })
    .into()
}

fn spawn_lights(stage: &mut Stage, lamps: &[Shining], signs: &[Shining]) {
    let color = |hex: u32| {
        let [_, r, g, b] = hex.to_be_bytes();
        Color::srgb_u8(r, g, b)
    };
    for (number, lamp) in lamps.iter().enumerate() {
        let (at, color) = (lamp.at - Vec3::Y * 0.1, color(lamp.color));
        // The nearest three have shadows.
        let light = lamplight(at, 900_000.0, color, 24.0, number < 3);
        stage.commands.spawn(light);
    }
    for sign in signs {
        let light = lamplight(sign.at, 220_000.0, color(sign.color), 13.0, false);
        stage.commands.spawn(light);
    }
    let moon = Vec3::new(-0.35, 0.8, 0.45);
    let shadows = shadow_cascades(2, 18.0, 90.0);
    let light = sunlight(moon, 320.0, [0.62, 0.74, 1.0], shadows);
    stage.commands.spawn(light);
    stage.ambient([0.5, 0.6, 0.95], 170.0);
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let mut random = Random::new(31);
    let damp = stage.materials.add(StandardMaterial {
        perceptual_roughness: 0.55,
        reflectance: 0.4,
        ..default()
    });
    let shining = stage.materials.add(StandardMaterial {
        unlit: true,
        ..default()
    });
    let mixed = stage.materials.add(StandardMaterial {
        unlit: true,
        alpha_mode: AlphaMode::Blend,
        double_sided: true,
        cull_mode: None,
        ..default()
    });
    // Every house is an object of its own.
    for side in [-1.0f32, 1.0] {
        let mut z = 9.0 + 3.0 * side;
        while z > -62.0 {
            let width = random.range(6.5, 9.5);
            z -= width;
            let mut house = Parts::default();
            front(&mut house, &mut random, side, z, width);
            stage.shape(house.lit, &damp);
            stage.shape(house.shining, &shining);
        }
    }
    let mut parts = Parts::default();
    ground(&mut parts);
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    end_of_the_street(&mut parts);
    let signs = signs(&mut parts);
    let places = [
        (1.0, 4.5),
        (-1.0, -5.0),
        (1.0, -15.0),
        (-1.0, -26.0),
        (1.0, -38.0),
    ];
    let lamps = places.map(|(side, z)| lamp(&mut parts, side, z));
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    // Height and place along the street at both ends, and the sag.
    for ([left, left_z], [right, right_z], sag) in [
        ([8.6, -3.0], [7.9, -6.0], 0.7),
        ([8.2, -3.0], [8.8, -14.0], 0.9),
        ([9.4, -20.0], [8.9, -24.0], 0.8),
    ] {
        let from = Vec3::new(-FRONTS, left, left_z);
        let to = Vec3::new(FRONTS, right, right_z);
        cable(&mut parts.lit, from, to, sag);
    }
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    let parked = Transform::from_xyz(2.5, 0.0, -9.5).with_rotation(Quat::from_rotation_y(0.04));
    car(&mut parts, parked);
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    let mut person = Shape::default();
    let ahead = Quat::from_rotation_y(0.25);
    let place = Transform::from_xyz(-0.9, 0.0, 5.2).with_rotation(ahead);
    person.add(&walker(), place);
    stage.shape(person, &damp);
    for shining in lamps.iter().chain(&signs) {
        reflection(&mut parts, shining);
    }
    rain(&mut parts, &mut random);
    stage.shape(parts.shining, &shining);
    stage.shape(parts.mixed, &mixed);
    spawn_lights(stage, &lamps, &signs);
    let sky = Sky {
        zenith: 0x060a16,
        middle: 0x121a2e,
        horizon: 0x2a2f4a,
        ground: 0x0a0d14,
        cloud: 0x1d2438,
        cover: 0.5,
        sun: Vec3::new(-0.35, 0.8, 0.45),
    };
    Vantage {
        eye: Vec3::new(0.9, 1.75, 12.5),
        target: Vec3::new(-0.35, 3.1, -8.0),
        fov: 50f32.to_radians(),
        far: 400.0,
        ortho: (Vec3::new(18.0, 22.0, 26.0), Vec3::new(0.0, 2.0, -4.0)),
        ortho_height: 20.0,
        ..stage.under(&sky)
    }
}
