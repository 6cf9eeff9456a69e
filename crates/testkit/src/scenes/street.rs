//! A street at night in the rain: lit windows, signs, lamps and a wet road. Lengths are in metres.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::{light::CascadeShadowConfigBuilder, prelude::*};

use super::{
    ScenePart, Stage, Vantage,
    noise::{Random, noise2},
    shape::{Shape, rgb, shade},
    sky::Sky,
};

/// Half the width of the road, and of the street between the fronts.
const ROAD: f32 = 3.6;
const FRONTS: f32 = 6.4;
const STOREY: f32 = 3.1;

/// Meshes of all that is lit, of what shines by itself, and of what is mixed over the picture: the colour of
/// a vertex has its opacity.
#[derive(Default)]
struct Parts {
    lit: Shape,
    shining: Shape,
    mixed: Shape,
}

/// A lamp or a sign: where it is, and its colour.
struct Shining {
    at: Vec3,
    color: u32,
}

/// A box of which `side` (-1 left, 1 right) is where +x is: `low` and `high` are for the right side.
fn beside(shape: &mut Shape, side: f32, low: Vec3, high: Vec3, color: [f32; 4]) {
    let [a, b] = [low, high].map(|p| Vec3::new(side * p.x, p.y, p.z));
    shape.cuboid(a.min(b), a.max(b), color);
}

/// The front of a house from `z` on towards the eye, `width` wide.
fn front(parts: &mut Parts, random: &mut Random, side: f32, z: f32, width: f32) {
    let storeys = 3 + (random.unit() * 3.0) as i32;
    let height = 0.15 + STOREY * storeys as f32 + 0.6;
    let wall = random.pick(&[0x7a4b45, 0x5d6470, 0x8a7a64, 0x4e5f63, 0x6b5468].map(rgb));
    let v = Vec3::new;
    let (near, far) = (z + width, z);
    beside(
        &mut parts.lit,
        side,
        v(FRONTS, 0.0, far),
        v(FRONTS + 9.0, height, near),
        wall,
    );
    // A cornice, and a band over the shop.
    for (y, high, out) in [(height - 0.5, 0.5, 0.35), (STOREY + 0.3, 0.25, 0.2)] {
        let color = shade(wall, 1.35);
        let low = v(FRONTS - out, y, far + 0.02);
        let high = v(FRONTS, y + high, near - 0.02);
        beside(&mut parts.lit, side, low, high, color);
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
            beside(&mut parts.lit, side, corner, other, frame);
            let is_lit = random.unit() < 0.4;
            let shape = if is_lit {
                &mut parts.shining
            } else {
                &mut parts.lit
            };
            let glass = if is_lit {
                random.pick(&warm)
            } else {
                rgb(0x1d2733)
            };
            for pane in [-0.44, 0.03] {
                let corner = v(FRONTS - 0.1, low, middle + pane);
                let other = v(FRONTS - 0.02, low + 1.55, middle + pane + 0.41);
                beside(shape, side, corner, other, glass);
            }
            let sill = v(FRONTS - 0.22, low - 0.2, middle - 0.65);
            beside(
                &mut parts.lit,
                side,
                sill,
                v(FRONTS, low - 0.08, middle + 0.65),
                frame,
            );
        }
    }
    shop(parts, random, side, far, near);
    if random.unit() < 0.6 {
        let middle = Vec3::new(side * (FRONTS + 3.0), height, 0.5 * (far + near));
        parts
            .lit
            .frustum(middle, 2.2, (1.1, 1.1), 14, rgb(0x4b3b33));
        parts
            .lit
            .frustum(middle + Vec3::Y * 2.2, 0.8, (1.3, 0.0), 14, rgb(0x332a26));
    }
}

/// A shop window under an awning, and a door.
fn shop(parts: &mut Parts, random: &mut Random, side: f32, far: f32, near: f32) {
    let v = Vec3::new;
    let dark = rgb(0x232a33);
    let light = random.pick(&[0xffe0a3, 0xfff0cf, 0xbfe9ff].map(rgb));
    beside(
        &mut parts.lit,
        side,
        v(FRONTS - 0.12, 0.15, far + 0.5),
        v(FRONTS, 2.75, near - 0.5),
        dark,
    );
    let mut at = far + 0.7;
    while at + 1.2 < near - 0.7 {
        let corner = v(FRONTS - 0.16, 0.75, at);
        let other = v(FRONTS - 0.1, 2.55, at + 1.1);
        beside(&mut parts.shining, side, corner, other, light);
        at += 1.3;
    }
    // Stripes of the awning, from the wall down.
    let cloth = random.pick(&[0xb8383c, 0x2f6f73, 0xc98a2b, 0x5a4f8f].map(rgb));
    let stripes = 9;
    let wide = (near - far - 0.8) / stripes as f32;
    for k in 0..stripes {
        let color = if k % 2 == 0 { cloth } else { rgb(0xe8dcc4) };
        let (a, b) = (
            far + 0.4 + wide * k as f32,
            far + 0.4 + wide * (k as f32 + 1.0),
        );
        let p = |x: f32, y: f32, z: f32| v(side * x, y, z);
        let mut roof = [
            p(FRONTS, 3.1, a),
            p(FRONTS, 3.1, b),
            p(FRONTS - 1.2, 2.55, b),
            p(FRONTS - 1.2, 2.55, a),
        ];
        let mut below = roof;
        below.reverse();
        let mut hem = [
            p(FRONTS - 1.2, 2.55, a),
            p(FRONTS - 1.2, 2.55, b),
            p(FRONTS - 1.2, 2.3, b),
            p(FRONTS - 1.2, 2.3, a),
        ];
        if side < 0.0 {
            std::mem::swap(&mut roof, &mut below);
            hem.reverse();
        }
        parts.lit.polygon(&roof, color);
        parts.lit.polygon(&below, shade(color, 0.5));
        parts.lit.polygon(&hem, color);
    }
}

/// A sign that stands out from a front. `marks`: dark bars on it, as `[x, y, width, height]` in parts of
/// its face.
fn sign(parts: &mut Parts, side: f32, low: Vec3, size: Vec2, color: u32, marks: &[[f32; 4]]) {
    let v = Vec3::new;
    let out = FRONTS - 0.25;
    let corner = v(out - size.x, low.y, low.z);
    beside(
        &mut parts.lit,
        side,
        corner - v(0.08, 0.08, 0.0),
        v(out + 0.08, low.y + size.y + 0.08, low.z + 0.24),
        rgb(0x20242b),
    );
    beside(
        &mut parts.shining,
        side,
        corner + v(0.0, 0.0, 0.1),
        v(out, low.y + size.y, low.z + 0.28),
        rgb(color),
    );
    for [x, y, width, height] in marks {
        let a = v(out - size.x * (x + width), low.y + size.y * y, low.z + 0.2);
        let b = v(
            out - size.x * x,
            low.y + size.y * (y + height),
            low.z + 0.31,
        );
        beside(&mut parts.lit, side, a, b, rgb(0x16181d));
    }
    for y in [0.2, 0.8] {
        let at = low.y + size.y * y;
        let bar = v(out, at - 0.03, low.z + 0.08);
        beside(
            &mut parts.lit,
            side,
            bar,
            v(FRONTS, at + 0.03, low.z + 0.16),
            rgb(0x20242b),
        );
    }
}

fn lamp(parts: &mut Parts, side: f32, z: f32) -> Shining {
    let iron = rgb(0x262b31);
    let foot = Vec3::new(side * (ROAD + 0.5), 0.15, z);
    parts.lit.frustum(foot, 0.5, (0.16, 0.12), 10, iron);
    parts.lit.frustum(foot, 4.6, (0.07, 0.05), 10, iron);
    let v = Vec3::new;
    let arm = v(ROAD - 0.7, 4.6, z - 0.04);
    beside(
        &mut parts.lit,
        side,
        arm,
        v(ROAD + 0.56, 4.7, z + 0.04),
        iron,
    );
    let head = v(ROAD - 0.75, 4.42, z - 0.17);
    beside(
        &mut parts.lit,
        side,
        head + Vec3::Y * 0.1,
        v(ROAD - 0.05, 4.62, z + 0.17),
        iron,
    );
    beside(
        &mut parts.shining,
        side,
        head + v(0.06, 0.0, 0.04),
        v(ROAD - 0.11, 4.52, z + 0.13),
        rgb(0xffe2a6),
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
        s.frustum(foot, 0.6, (0.075, 0.095), 10, rgb(0x23283a));
        let shoe = Vec3::new(0.11 * side, 0.05, 0.16 * side - 0.05);
        s.blob(
            shoe,
            Vec3::new(0.08, 0.06, 0.15),
            6,
            |_| rgb(0x14161c),
            |_| 0.0,
        );
    }
    s.frustum(Vec3::Y * 0.45, 0.65, (0.31, 0.2), 18, coat);
    s.frustum(Vec3::Y * 1.1, 0.32, (0.2, 0.17), 18, coat);
    s.blob(
        Vec3::Y * 1.4,
        Vec3::new(0.22, 0.12, 0.15),
        10,
        |_| coat,
        |_| 0.0,
    );
    s.frustum(Vec3::Y * 0.98, 0.07, (0.245, 0.235), 18, shade(coat, 0.55));
    s.blob(
        Vec3::Y * 1.66,
        Vec3::new(0.12, 0.15, 0.13),
        12,
        |_| rgb(0x3a2a24),
        |_| 0.0,
    );
    s.cuboid(
        Vec3::new(0.16, 1.05, -0.2),
        Vec3::new(0.26, 1.42, 0.0),
        coat,
    );
    let stick = Vec3::new(0.22, 1.05, -0.22);
    s.frustum(stick, 1.15, (0.015, 0.015), 8, rgb(0x1b1d22));
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
            let quad = [
                rib(k, r0, d0),
                rib(k + 1, r0, d0),
                rib(k + 1, r1, d1),
                rib(k, r1, d1),
            ];
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
    let v = Vec3::new;
    s.cuboid(v(-0.85, 0.32, -2.1), v(0.85, 0.86, 2.1), paint);
    s.cuboid(v(-0.88, 0.3, 2.05), v(0.88, 0.5, 2.2), rgb(0x8c949c));
    // The cabin is narrower at the top.
    let ring = |y: f32, x: f32, back: f32, front: f32| {
        [
            v(-x, y, front),
            v(x, y, front),
            v(x, y, back),
            v(-x, y, back),
        ]
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
        wheel.frustum(Vec3::Y * -0.12, 0.24, (0.34, 0.34), 20, rgb(0x17191c));
        wheel.frustum(Vec3::Y * 0.12, 0.02, (0.2, 0.18), 12, rgb(0x9aa3ab));
        let outwards = Quat::from_rotation_z(if x > 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 });
        s.add(
            &wheel,
            Transform::from_xyz(x, 0.34, z).with_rotation(outwards),
        );
    }
    parts.lit.add(&s, at);
    let mut lights = Shape::default();
    for side in [-1.0, 1.0] {
        beside(
            &mut lights,
            side,
            v(0.45, 0.58, 2.08),
            v(0.75, 0.74, 2.14),
            rgb(0xd9d2b8),
        );
    }
    parts.shining.add(&lights, at);
}

/// Light of a lamp or a sign on the wet ground in front of it.
fn reflection(parts: &mut Parts, shining: &Shining) {
    let [r, g, b, _] = rgb(shining.color);
    let y = if shining.at.x.abs() < ROAD {
        0.02
    } else {
        0.17
    };
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
        let at = Vec3::new(
            random.range(-7.0, 7.0),
            random.range(0.0, 9.0),
            random.range(-26.0, 11.5),
        );
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
        let (a, b) = (at(k), at(k + 1));
        let mut piece = Shape::default();
        piece.frustum(
            Vec3::ZERO,
            (b - a).length(),
            (0.018, 0.018),
            6,
            rgb(0x14171c),
        );
        let turn = Quat::from_rotation_arc(Vec3::Y, (b - a).normalize());
        shape.add(&piece, Transform::from_translation(a).with_rotation(turn));
    }
}

fn ground(parts: &mut Parts) {
    let v = Vec3::new;
    parts
        .lit
        .cuboid(v(-ROAD, -0.4, -90.0), v(ROAD, 0.0, 20.0), rgb(0x2b323c));
    for side in [-1.0, 1.0] {
        let kerb = v(ROAD, -0.4, -90.0);
        beside(
            &mut parts.lit,
            side,
            kerb,
            v(ROAD + 0.25, 0.16, 20.0),
            rgb(0x6d737b),
        );
        let flags = v(ROAD + 0.25, -0.4, -90.0);
        beside(
            &mut parts.lit,
            side,
            flags,
            v(FRONTS + 1.0, 0.15, 20.0),
            rgb(0x4a515a),
        );
    }
    // A crossing.
    for k in 0..6 {
        let x = -ROAD + 0.45 + 1.2 * k as f32;
        parts
            .lit
            .cuboid(v(x, -0.1, -4.6), v(x + 0.6, 0.012, -1.6), rgb(0xb9bcb6));
    }
}

fn end_of_the_street(parts: &mut Parts) {
    let v = Vec3::new;
    let stone = rgb(0x5a5f6e);
    parts
        .lit
        .cuboid(v(-16.0, 0.0, -78.0), v(16.0, 17.0, -66.0), stone);
    parts
        .lit
        .cuboid(v(-3.2, 0.0, -68.0), v(3.2, 29.0, -62.0), shade(stone, 1.2));
    parts
        .lit
        .frustum(v(0.0, 29.0, -65.0), 8.0, (4.6, 0.0), 4, rgb(0x34394a));
    let mut clock = Shape::default();
    clock.frustum(Vec3::ZERO, 0.3, (2.2, 2.2), 40, rgb(0xfff1c9));
    let face =
        Transform::from_xyz(0.0, 24.5, -62.1).with_rotation(Quat::from_rotation_x(FRAC_PI_2));
    parts.shining.add(&clock, face);
    for (angle, long) in [(0.9f32, 1.7), (-1.9, 1.2)] {
        let mut hand = Shape::default();
        hand.cuboid(v(-0.09, -0.2, 0.0), v(0.09, long, 0.08), rgb(0x1a1c22));
        let at = Transform::from_xyz(0.0, 24.5, -61.76).with_rotation(Quat::from_rotation_z(angle));
        parts.lit.add(&hand, at);
    }
}

/// A sign: its side, height and place along the street, its size, its colour, and its marks.
type Board<'a> = (f32, f32, f32, Vec2, u32, &'a [[f32; 4]]);

/// Signs of a bar, a kitchen, a hotel and others, and the light they give.
fn signs(parts: &mut Parts) -> Vec<Shining> {
    let rows: [[f32; 4]; 3] = [
        [0.2, 0.72, 0.6, 0.12],
        [0.2, 0.45, 0.6, 0.12],
        [0.2, 0.18, 0.35, 0.12],
    ];
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
        stage.commands.spawn((
            ScenePart,
            PointLight {
                intensity: 900_000.0,
                color: color(lamp.color),
                range: 24.0,
                // The nearest three.
                shadow_maps_enabled: number < 3,
                ..default()
            },
            Transform::from_translation(lamp.at - Vec3::Y * 0.1),
        ));
    }
    for sign in signs {
        stage.commands.spawn((
            ScenePart,
            PointLight {
                intensity: 220_000.0,
                color: color(sign.color),
                range: 13.0,
                ..default()
            },
            Transform::from_translation(sign.at),
        ));
    }
    let moon = Vec3::new(-0.35, 0.8, 0.45);
    stage.commands.spawn((
        ScenePart,
        DirectionalLight {
            illuminance: 320.0,
            color: Color::srgb(0.62, 0.74, 1.0),
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_translation(moon).looking_at(Vec3::ZERO, Vec3::Y),
        CascadeShadowConfigBuilder {
            num_cascades: 2,
            first_cascade_far_bound: 18.0,
            maximum_distance: 90.0,
            ..default()
        }
        .build(),
    ));
    stage.commands.insert_resource(GlobalAmbientLight {
        color: Color::srgb(0.5, 0.6, 0.95),
        brightness: 170.0,
        ..default()
    });
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
    let lamps: Vec<Shining> = [
        (1.0, 4.5),
        (-1.0, -5.0),
        (1.0, -15.0),
        (-1.0, -26.0),
        (1.0, -38.0),
    ]
    .map(|(side, z)| lamp(&mut parts, side, z))
    .into();
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    for (from, to, sag) in [
        (
            Vec3::new(-FRONTS, 8.6, -3.0),
            Vec3::new(FRONTS, 7.9, -6.0),
            0.7,
        ),
        (
            Vec3::new(-FRONTS, 8.2, -3.0),
            Vec3::new(FRONTS, 8.8, -14.0),
            0.9,
        ),
        (
            Vec3::new(-FRONTS, 9.4, -20.0),
            Vec3::new(FRONTS, 8.9, -24.0),
            0.8,
        ),
    ] {
        cable(&mut parts.lit, from, to, sag);
    }
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    let parked = Transform::from_xyz(2.5, 0.0, -9.5).with_rotation(Quat::from_rotation_y(0.04));
    car(&mut parts, parked);
    stage.shape(std::mem::take(&mut parts.lit), &damp);
    let mut person = Shape::default();
    person.add(
        &walker(),
        Transform::from_xyz(-0.9, 0.0, 5.2).with_rotation(Quat::from_rotation_y(0.25)),
    );
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
        near: 0.1,
        far: 400.0,
        ortho: (Vec3::new(18.0, 22.0, 26.0), Vec3::new(0.0, 2.0, -4.0)),
        ortho_height: 20.0,
        sky: stage.images.add(sky.image()),
        sky_brightness: 1000.0,
    }
}
