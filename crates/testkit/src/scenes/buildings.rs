//! Buildings and props of the village. Lengths are in meters.

use bevy::prelude::*;

use super::{
    noise::Random,
    shape::{Shape, rgb, shade},
};

pub struct House {
    /// Width, height of the walls, and depth.
    pub size: Vec3,
    /// Height of the roof above the walls.
    pub roof: f32,
    pub wall: [f32; 4],
    pub tiles: [f32; 4],
}

/// A house that stands at the origin, with its gables towards +z and -z.
pub fn house(h: &House, random: &mut Random) -> Shape {
    let mut s = Shape::default();
    let (x, y, z) = (h.size.x / 2.0, h.size.y, h.size.z / 2.0);
    s.cuboid([-x, -0.5, -z], [x, y, z], h.wall);
    s.cuboid(
        [-x - 0.06, -0.5, -z - 0.06],
        [x + 0.06, 0.45, z + 0.06],
        0x8c8377,
    );
    let ridge = y + h.roof;
    for front in [1.0, -1.0] {
        let gable = [[-x * front, y], [x * front, y], [0.0, ridge]];
        s.polygon(&gable.map(|[x, y]| Vec3::new(x, y, z * front)), h.wall);
    }
    // The roof overhangs the walls on every side.
    let (ex, ez, thick) = (x + 0.4, z + 0.45, 0.2);
    let drop = h.roof / x * 0.4;
    for side in [1.0f32, -1.0] {
        let eave = |z: f32, up: f32| Vec3::new(side * ex, y - drop + up, z);
        let top = |z: f32, up: f32| Vec3::new(0.0, ridge + up, z);
        // Corners in front and behind: of the eave, below and above; of the ridge, below and above.
        let corners = |z: f32| [eave(z, 0.0), eave(z, thick), top(z, 0.0), top(z, thick)];
        let (f, b) = (corners(ez), corners(-ez));
        let beam = rgb(0x6d4c33);
        for (mut quad, color) in [
            ([f[1], b[1], b[3], f[3]], h.tiles),
            ([f[2], b[2], b[0], f[0]], shade(h.tiles, 0.5)),
            ([f[0], b[0], b[1], f[1]], shade(h.tiles, 0.8)),
            ([f[0], f[1], f[3], f[2]], beam),
            ([b[2], b[3], b[1], b[0]], beam),
        ] {
            if side < 0.0 {
                quad.reverse();
            }
            s.polygon(&quad, color);
        }
    }
    let cx = x * 0.45;
    s.cuboid(
        [cx - 0.3, y, -z * 0.4 - 0.3],
        [cx + 0.3, ridge + 0.7, -z * 0.4 + 0.3],
        0xa0563f,
    );
    // Door, windows and shutters, each a few centimeters in front of the wall.
    let frame = rgb(0xf3ead6);
    let glass = rgb(0x35506b);
    let shutter = random.pick(&[rgb(0x2f6f73), rgb(0x9c3d33), rgb(0x3c5c9a), rgb(0x5c7f3a)]);
    for front in [1.0f32, -1.0] {
        let face = |s: &mut Shape, cx: f32, low: f32, high: f32, half: f32, out: f32, c| {
            let (a, b) = (front * z, front * (z + out));
            s.cuboid([cx - half, low, a.min(b)], [cx + half, high, a.max(b)], c);
        };
        face(&mut s, 0.0, 0.0, 2.25, 0.62, 0.06, frame);
        face(&mut s, 0.0, 0.0, 2.15, 0.5, 0.1, shutter);
        for wx in [-x * 0.62, x * 0.62] {
            face(&mut s, wx, 1.15, 2.35, 0.5, 0.05, frame);
            face(&mut s, wx, 1.25, 2.25, 0.4, 0.08, glass);
            for side in [-0.72, 0.72] {
                face(&mut s, wx + side, 1.15, 2.35, 0.2, 0.09, shutter);
            }
        }
        if h.roof > 2.0 {
            face(&mut s, 0.0, y + 0.3, y + 1.2, 0.42, 0.05, frame);
            face(&mut s, 0.0, y + 0.4, y + 1.1, 0.32, 0.08, glass);
        }
    }
    for side in [1.0f32, -1.0] {
        for wz in [-z * 0.5, z * 0.5] {
            let a = side * x;
            for (out, [low, high], half, color) in [
                (0.06, [1.2, 2.3], 0.45, frame),
                (0.09, [1.3, 2.2], 0.35, glass),
            ] {
                let b = side * (x + out);
                let corners = [[a.min(b), low, wz - half], [a.max(b), high, wz + half]];
                s.cuboid(corners[0], corners[1], color);
            }
        }
    }
    s
}

pub fn church() -> Shape {
    let mut random = Random::new(4);
    let wall = rgb(0xeee3cf);
    let nave = House {
        size: Vec3::new(8.0, 6.0, 15.0),
        roof: 4.2,
        wall,
        tiles: rgb(0x5b6a7c),
    };
    let mut s = house(&nave, &mut random);
    s.cuboid([-2.2, -0.5, 7.0], [2.2, 14.0, 11.4], wall);
    for side in [-1.0f32, 1.0] {
        s.cuboid(
            [side * 0.8 - 0.45, 10.6, 11.4],
            [side * 0.8 + 0.45, 12.8, 11.5],
            0x3b4454,
        );
    }
    s.cuboid([-2.5, 14.0, 6.7], [2.5, 14.5, 11.7], 0xc9bda6);
    s.frustum([0.0, 14.5, 9.2], 8.0, (3.1, 0.0), 4, 0x5b6a7c);
    s.cuboid([-0.06, 22.2, 9.14], [0.06, 24.0, 9.26], 0xd9a92f);
    s.cuboid([-0.5, 23.2, 9.14], [0.5, 23.35, 9.26], 0xd9a92f);
    s
}

pub fn windmill() -> Shape {
    let mut s = Shape::default();
    s.frustum(Vec3::ZERO, 11.0, (3.6, 2.3), 12, 0xf0e6d2);
    s.frustum(Vec3::Y * 11.0, 2.6, (2.7, 0.3), 12, 0x9c3d33);
    let hub = Vec3::new(0.0, 11.4, 3.0);
    s.ellipsoid(hub, Vec3::splat(0.5), 6, 0x5a4030);
    for k in 0..4 {
        let mut sail = Shape::default();
        sail.cuboid([-0.12, 0.0, -0.08], [0.12, 8.5, 0.08], 0x5a4030);
        sail.cuboid([0.12, 1.6, -0.05], [1.5, 8.3, 0.05], 0xe8d9b5);
        let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2 * k as f32 + 0.5);
        s.add(&sail, Transform::from_translation(hub).with_rotation(turn));
    }
    s
}

pub fn barrel() -> Shape {
    let mut s = Shape::default();
    let wood = rgb(0x9a6a3c);
    s.frustum(Vec3::ZERO, 0.45, (0.34, 0.42), 16, wood);
    s.frustum(Vec3::Y * 0.45, 0.45, (0.42, 0.34), 16, wood);
    for y in [0.12, 0.68] {
        s.frustum(Vec3::Y * y, 0.09, (0.405, 0.405), 16, 0x4c4a4d);
    }
    s
}

pub fn well() -> Shape {
    let mut s = Shape::default();
    s.frustum(Vec3::ZERO, 1.0, (1.25, 1.2), 14, 0xa39a8c);
    s.frustum(Vec3::Y * 1.0, 0.03, (0.95, 0.95), 14, 0x2b3a48);
    for side in [-1.0f32, 1.0] {
        s.cuboid(
            [side * 1.05 - 0.1, 0.9, -0.1],
            [side * 1.05 + 0.1, 2.9, 0.1],
            0x6d4c33,
        );
    }
    s.frustum(Vec3::Y * 2.8, 1.1, (1.9, 0.0), 4, 0xb5533c);
    s
}

pub fn lamp() -> Shape {
    let mut s = Shape::default();
    s.frustum(Vec3::ZERO, 3.2, (0.09, 0.06), 8, 0x32363c);
    s.frustum(Vec3::Y * 3.2, 0.5, (0.16, 0.26), 6, 0xf5dd8b);
    s.frustum(Vec3::Y * 3.7, 0.25, (0.34, 0.0), 6, 0x32363c);
    s
}

pub fn fence(length: f32) -> Shape {
    let mut s = Shape::default();
    let wood = rgb(0xe9e0cc);
    let posts = (length / 0.45) as u32;
    for i in 0..=posts {
        let x = length * i as f32 / posts as f32;
        s.cuboid([x - 0.06, 0.0, -0.03], [x + 0.06, 1.0, 0.03], wood);
    }
    for y in [0.35, 0.75] {
        s.cuboid(
            [0.0, y - 0.05, -0.055],
            [length, y + 0.05, -0.02],
            shade(wood, 0.85),
        );
    }
    s
}

pub fn cart() -> Shape {
    let mut s = Shape::default();
    let wood = rgb(0x8a5a34);
    s.cuboid([-0.8, 0.6, -1.3], [0.8, 0.7, 1.3], wood);
    for (low, high) in [
        (Vec3::new(-0.85, 0.7, -1.3), Vec3::new(-0.75, 1.15, 1.3)),
        (Vec3::new(0.75, 0.7, -1.3), Vec3::new(0.85, 1.15, 1.3)),
        (Vec3::new(-0.8, 0.7, -1.35), Vec3::new(0.8, 1.15, -1.25)),
    ] {
        s.cuboid(low, high, shade(wood, 1.15));
    }
    for side in [-1.0f32, 1.0] {
        let mut wheel = Shape::default();
        wheel.frustum(Vec3::ZERO, 0.1, (0.55, 0.55), 14, 0x5a3d26);
        wheel.frustum(Vec3::Y * 0.1, 0.05, (0.12, 0.12), 8, 0x32363c);
        let turn = Quat::from_rotation_z(-side * std::f32::consts::FRAC_PI_2);
        let at = Transform::from_xyz(side * 0.9, 0.55, 0.1);
        s.add(&wheel, at.with_rotation(turn));
    }
    for (x, z, r, hex) in [
        (-0.3, -0.6, 0.34, 0xe07f28),
        (0.35, -0.4, 0.3, 0xd8611f),
        (0.0, 0.3, 0.36, 0xeb9a37),
    ] {
        s.blob(
            [x, 0.7 + r * 0.7, z],
            [r, r * 0.8, r],
            8,
            |_| rgb(hex),
            |d| 0.04 * (d.x.atan2(d.z) * 7.0).cos(),
        );
    }
    s
}
