//! A village: many things at many distances, from a barrel at arm's length to a
//! windmill on its hill.

use bevy::{
    light::{CascadeShadowConfigBuilder, light_consts::lux},
    math::Vec2,
    prelude::*,
};

use super::{
    ScenePart, Stage, Vantage,
    mountains::{broadleaf, conifer},
    noise::{Random, fractal, smoothstep},
    shape::{Shape, blend, rgb, shade},
    sky::Sky,
};

fn height(p: Vec2) -> f32 {
    let r = p.length();
    26.0 * (fractal(p / 170.0 + 2.2, 4) + 0.3) * smoothstep(70.0, 260.0, r)
        + 120.0 * (fractal(p / 600.0, 4) + 0.4).max(0.0) * smoothstep(300.0, 1200.0, r)
}

fn ground() -> Shape {
    let mut shape = Shape::default();
    let side = 220;
    let warp = |t: f32| {
        let u = 2.0 * t - 1.0;
        1500.0 * u * (0.05 + 0.95 * u.abs().powf(1.6))
    };
    let at = |i: i32, j: i32| {
        let p = Vec2::new(
            warp(i.clamp(0, side) as f32 / side as f32),
            warp(j.clamp(0, side) as f32 / side as f32),
        );
        Vec3::new(p.x, height(p), p.y)
    };
    for j in 0..=side {
        for i in 0..=side {
            let p = at(i, j);
            let normal = (at(i, j + 1) - at(i, j - 1)).cross(at(i + 1, j) - at(i - 1, j));
            let flat = Vec2::new(p.x, p.z);
            let field = fractal(flat / 60.0 + 5.0, 3);
            let grass = blend(rgb(0x6c9f3c), rgb(0xb5bd55), 0.5 + field * 1.4);
            let color = blend(
                grass,
                rgb(0x4a7d45),
                smoothstep(200.0, 700.0, flat.length()),
            );
            shape.vertex(p, normal.normalize_or(Vec3::Y), color);
        }
    }
    let width = side as u32 + 1;
    for j in 0..side as u32 {
        for i in 0..side as u32 {
            let a = j * width + i;
            shape
                .indices
                .extend([a, a + width, a + 1, a + 1, a + width, a + width + 1]);
        }
    }
    shape
}

struct House {
    size: Vec3,
    roof: f32,
    wall: [f32; 4],
    tiles: [f32; 4],
}

/// A house whose gable faces z, standing on the origin.
fn house(h: &House, random: &mut Random) -> Shape {
    let mut s = Shape::default();
    let (x, y, z) = (h.size.x / 2.0, h.size.y, h.size.z / 2.0);
    s.cuboid(Vec3::new(-x, -0.5, -z), Vec3::new(x, y, z), h.wall);
    s.cuboid(
        Vec3::new(-x - 0.06, -0.5, -z - 0.06),
        Vec3::new(x + 0.06, 0.45, z + 0.06),
        rgb(0x8c8377),
    );
    let ridge = y + h.roof;
    for front in [1.0, -1.0] {
        let gable = [
            Vec3::new(-x * front, y, z * front),
            Vec3::new(x * front, y, z * front),
            Vec3::new(0.0, ridge, z * front),
        ];
        s.polygon(&gable, h.wall);
    }
    // The roof slabs stand out on every side.
    let (ex, ez, thick) = (x + 0.4, z + 0.45, 0.2);
    let drop = h.roof / x * 0.4;
    for side in [1.0f32, -1.0] {
        let eave = |z: f32, up: f32| Vec3::new(side * ex, y - drop + up, z);
        let top = |z: f32, up: f32| Vec3::new(0.0, ridge + up, z);
        let quad = |s: &mut Shape, mut q: [Vec3; 4], c| {
            if side < 0.0 {
                q.reverse();
            }
            s.polygon(&q, c);
        };
        quad(
            &mut s,
            [
                eave(ez, thick),
                eave(-ez, thick),
                top(-ez, thick),
                top(ez, thick),
            ],
            h.tiles,
        );
        quad(
            &mut s,
            [top(ez, 0.0), top(-ez, 0.0), eave(-ez, 0.0), eave(ez, 0.0)],
            shade(h.tiles, 0.5),
        );
        quad(
            &mut s,
            [
                eave(ez, 0.0),
                eave(-ez, 0.0),
                eave(-ez, thick),
                eave(ez, thick),
            ],
            shade(h.tiles, 0.8),
        );
        quad(
            &mut s,
            [eave(ez, 0.0), eave(ez, thick), top(ez, thick), top(ez, 0.0)],
            rgb(0x6d4c33),
        );
        quad(
            &mut s,
            [
                top(-ez, 0.0),
                top(-ez, thick),
                eave(-ez, thick),
                eave(-ez, 0.0),
            ],
            rgb(0x6d4c33),
        );
    }
    let cx = x * 0.45;
    s.cuboid(
        Vec3::new(cx - 0.3, y, -z * 0.4 - 0.3),
        Vec3::new(cx + 0.3, ridge + 0.7, -z * 0.4 + 0.3),
        rgb(0xa0563f),
    );
    // Door, windows and shutters, each a few centimetres proud of the wall.
    let frame = rgb(0xf3ead6);
    let glass = rgb(0x35506b);
    let shutter = random.pick(&[rgb(0x2f6f73), rgb(0x9c3d33), rgb(0x3c5c9a), rgb(0x5c7f3a)]);
    for front in [1.0f32, -1.0] {
        let face = |s: &mut Shape, cx: f32, low: f32, high: f32, half: f32, out: f32, c| {
            let (a, b) = (front * z, front * (z + out));
            s.cuboid(
                Vec3::new(cx - half, low, a.min(b)),
                Vec3::new(cx + half, high, a.max(b)),
                c,
            );
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
            let (a, b) = (side * x, side * (x + 0.06));
            s.cuboid(
                Vec3::new(a.min(b), 1.2, wz - 0.45),
                Vec3::new(a.max(b), 2.3, wz + 0.45),
                frame,
            );
            let b = side * (x + 0.09);
            s.cuboid(
                Vec3::new(a.min(b), 1.3, wz - 0.35),
                Vec3::new(a.max(b), 2.2, wz + 0.35),
                glass,
            );
        }
    }
    s
}

fn church() -> Shape {
    let mut random = Random::new(4);
    let wall = rgb(0xeee3cf);
    let nave = House {
        size: Vec3::new(8.0, 6.0, 15.0),
        roof: 4.2,
        wall,
        tiles: rgb(0x5b6a7c),
    };
    let mut s = house(&nave, &mut random);
    s.cuboid(Vec3::new(-2.2, -0.5, 7.0), Vec3::new(2.2, 14.0, 11.4), wall);
    for side in [-1.0f32, 1.0] {
        s.cuboid(
            Vec3::new(side * 0.8 - 0.45, 10.6, 11.4),
            Vec3::new(side * 0.8 + 0.45, 12.8, 11.5),
            rgb(0x3b4454),
        );
    }
    s.cuboid(
        Vec3::new(-2.5, 14.0, 6.7),
        Vec3::new(2.5, 14.5, 11.7),
        rgb(0xc9bda6),
    );
    s.frustum(Vec3::new(0.0, 14.5, 9.2), 8.0, (3.1, 0.0), 4, rgb(0x5b6a7c));
    s.cuboid(
        Vec3::new(-0.06, 22.2, 9.14),
        Vec3::new(0.06, 24.0, 9.26),
        rgb(0xd9a92f),
    );
    s.cuboid(
        Vec3::new(-0.5, 23.2, 9.14),
        Vec3::new(0.5, 23.35, 9.26),
        rgb(0xd9a92f),
    );
    s
}

fn windmill() -> Shape {
    let mut s = Shape::default();
    s.frustum(Vec3::ZERO, 11.0, (3.6, 2.3), 12, rgb(0xf0e6d2));
    s.frustum(Vec3::Y * 11.0, 2.6, (2.7, 0.3), 12, rgb(0x9c3d33));
    let hub = Vec3::new(0.0, 11.4, 3.0);
    s.blob(hub, Vec3::splat(0.5), 6, |_| rgb(0x5a4030), |_| 0.0);
    for k in 0..4 {
        let mut sail = Shape::default();
        sail.cuboid(
            Vec3::new(-0.12, 0.0, -0.08),
            Vec3::new(0.12, 8.5, 0.08),
            rgb(0x5a4030),
        );
        sail.cuboid(
            Vec3::new(0.12, 1.6, -0.05),
            Vec3::new(1.5, 8.3, 0.05),
            rgb(0xe8d9b5),
        );
        let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2 * k as f32 + 0.5);
        s.add(&sail, Transform::from_translation(hub).with_rotation(turn));
    }
    s
}

fn barrel() -> Shape {
    let mut s = Shape::default();
    let wood = rgb(0x9a6a3c);
    s.frustum(Vec3::ZERO, 0.45, (0.34, 0.42), 16, wood);
    s.frustum(Vec3::Y * 0.45, 0.45, (0.42, 0.34), 16, wood);
    for y in [0.12, 0.68] {
        s.frustum(Vec3::Y * y, 0.09, (0.405, 0.405), 16, rgb(0x4c4a4d));
    }
    s
}

fn well() -> Shape {
    let mut s = Shape::default();
    s.frustum(Vec3::ZERO, 1.0, (1.25, 1.2), 14, rgb(0xa39a8c));
    s.frustum(Vec3::Y * 1.0, 0.03, (0.95, 0.95), 14, rgb(0x2b3a48));
    for side in [-1.0f32, 1.0] {
        s.cuboid(
            Vec3::new(side * 1.05 - 0.1, 0.9, -0.1),
            Vec3::new(side * 1.05 + 0.1, 2.9, 0.1),
            rgb(0x6d4c33),
        );
    }
    s.frustum(Vec3::Y * 2.8, 1.1, (1.9, 0.0), 4, rgb(0xb5533c));
    s
}

fn lamp() -> Shape {
    let mut s = Shape::default();
    s.frustum(Vec3::ZERO, 3.2, (0.09, 0.06), 8, rgb(0x32363c));
    s.frustum(Vec3::Y * 3.2, 0.5, (0.16, 0.26), 6, rgb(0xf5dd8b));
    s.frustum(Vec3::Y * 3.7, 0.25, (0.34, 0.0), 6, rgb(0x32363c));
    s
}

fn fence(length: f32) -> Shape {
    let mut s = Shape::default();
    let wood = rgb(0xe9e0cc);
    let posts = (length / 0.45) as u32;
    for i in 0..=posts {
        let x = length * i as f32 / posts as f32;
        s.cuboid(
            Vec3::new(x - 0.06, 0.0, -0.03),
            Vec3::new(x + 0.06, 1.0, 0.03),
            wood,
        );
    }
    for y in [0.35, 0.75] {
        s.cuboid(
            Vec3::new(0.0, y - 0.05, -0.055),
            Vec3::new(length, y + 0.05, -0.02),
            shade(wood, 0.85),
        );
    }
    s
}

fn cart() -> Shape {
    let mut s = Shape::default();
    let wood = rgb(0x8a5a34);
    s.cuboid(Vec3::new(-0.8, 0.6, -1.3), Vec3::new(0.8, 0.7, 1.3), wood);
    for (low, high) in [
        (Vec3::new(-0.85, 0.7, -1.3), Vec3::new(-0.75, 1.15, 1.3)),
        (Vec3::new(0.75, 0.7, -1.3), Vec3::new(0.85, 1.15, 1.3)),
        (Vec3::new(-0.8, 0.7, -1.35), Vec3::new(0.8, 1.15, -1.25)),
    ] {
        s.cuboid(low, high, shade(wood, 1.15));
    }
    for side in [-1.0f32, 1.0] {
        let mut wheel = Shape::default();
        wheel.frustum(Vec3::ZERO, 0.1, (0.55, 0.55), 14, rgb(0x5a3d26));
        wheel.frustum(Vec3::Y * 0.1, 0.05, (0.12, 0.12), 8, rgb(0x32363c));
        s.add(
            &wheel,
            Transform::from_xyz(side * 0.9, 0.55, 0.1)
                .with_rotation(Quat::from_rotation_z(-side * std::f32::consts::FRAC_PI_2)),
        );
    }
    for (x, z, r, hex) in [
        (-0.3, -0.6, 0.34, 0xe07f28),
        (0.35, -0.4, 0.3, 0xd8611f),
        (0.0, 0.3, 0.36, 0xeb9a37),
    ] {
        s.blob(
            Vec3::new(x, 0.7 + r * 0.7, z),
            Vec3::new(r, r * 0.8, r),
            8,
            |_| rgb(hex),
            |d| 0.04 * (d.x.atan2(d.z) * 7.0).cos(),
        );
    }
    s
}

/// Puts a shape on the ground.
fn place(
    stage: &mut Stage,
    material: &Handle<StandardMaterial>,
    shape: Shape,
    x: f32,
    z: f32,
    turn: f32,
) {
    let mesh = stage.meshes.add(shape.into_mesh());
    let at = Vec3::new(x, height(Vec2::new(x, z)), z);
    let transform = Transform::from_translation(at).with_rotation(Quat::from_rotation_y(turn));
    stage.solid(mesh, material.clone(), transform);
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let sun = Vec3::new(0.6, 0.62, 0.5);
    let mut random = Random::new(77);
    let matt = stage.matt();

    place(stage, &matt, ground(), 0.0, 0.0, 0.0);
    // The road, and the square around the well: flat, a hand above the grass.
    let mut road = Shape::default();
    road.cuboid(
        Vec3::new(-3.4, -0.3, -120.0),
        Vec3::new(3.4, 0.05, 34.0),
        rgb(0xd9c59a),
    );
    road.frustum(
        Vec3::new(0.0, -0.3, -22.0),
        0.38,
        (13.0, 13.0),
        40,
        rgb(0xcdbb96),
    );
    place(stage, &matt, road, 0.0, 0.0, 0.0);

    let walls = [
        0xf4e7c8, 0xe9b872, 0xd98f6a, 0xf1d9d0, 0xc9d6c3, 0xb9cbd9, 0xf0c94f,
    ]
    .map(rgb);
    let tiles = [0xb5533c, 0x9c3d33, 0xc46a3a, 0x7d4a3c, 0x5b6a7c].map(rgb);
    let build = |stage: &mut Stage, random: &mut Random, x: f32, z: f32, turn: f32, size: f32| {
        let plan = House {
            size: Vec3::new(
                random.range(5.2, 6.8),
                random.range(2.9, 5.0),
                random.range(6.0, 8.6),
            ) * size,
            roof: random.range(2.1, 3.2) * size,
            wall: random.pick(&walls),
            tiles: random.pick(&tiles),
        };
        let shape = house(&plan, random);
        place(stage, &matt, shape, x, z, turn);
    };
    for (i, z) in [12.0f32, 1.5, -9.0, -36.0, -48.0, -60.0, -73.0, -87.0]
        .into_iter()
        .enumerate()
    {
        for side in [-1.0f32, 1.0] {
            let x = side * (9.4 + random.range(0.0, 1.6));
            build(
                stage,
                &mut random,
                x,
                z + side * 1.3,
                -side * std::f32::consts::FRAC_PI_2 + 0.06 * i as f32,
                1.0,
            );
        }
    }
    for (x, z, turn) in [
        (-24.0, -18.0, 0.4),
        (25.0, -30.0, -0.6),
        (-30.0, -48.0, 0.9),
        (33.0, -62.0, -0.3),
        (-44.0, -80.0, 0.2),
        (47.0, -95.0, 1.2),
        (-16.0, -112.0, 0.1),
        (18.0, -118.0, -0.2),
    ] {
        build(stage, &mut random, x, z, turn, 1.05);
    }

    place(stage, &matt, church(), -11.0, -134.0, 0.35);
    place(stage, &matt, windmill(), 96.0, -215.0, -0.35);
    place(stage, &matt, well(), 1.5, -22.0, 0.6);
    place(stage, &matt, cart(), -4.3, 14.6, 0.5);
    for (x, z) in [
        (4.6, 16.9),
        (5.2, 16.0),
        (4.4, 15.6),
        (-4.8, -4.0),
        (5.0, -13.0),
    ] {
        place(stage, &matt, barrel(), x, z, x);
    }
    for z in [8.0, -6.0, -34.0, -52.0, -70.0] {
        place(stage, &matt, lamp(), 3.9, z, 0.0);
        place(stage, &matt, lamp(), -3.9, z - 7.0, 0.0);
    }
    for (x, z, turn) in [(-14.5, 19.0, 0.1), (6.3, 19.6, -0.05), (-15.0, -27.0, 1.2)] {
        place(stage, &matt, fence(8.1), x, z, turn);
    }
    let leaves = [0x6fa53a, 0x8fb544, 0x4f8f3f, 0xd98a2b].map(rgb);
    for _ in 0..130 {
        let (angle, r) = (
            random.range(0.0, 6.3),
            24.0 + 300.0 * random.unit().powf(1.4),
        );
        let (x, z) = (r * angle.cos(), r * angle.sin() - 40.0);
        if x.abs() < 14.0 {
            continue;
        }
        let tree = if random.unit() < 0.6 {
            let leaf = random.pick(&leaves);
            broadleaf(&mut random, leaf)
        } else {
            conifer(&mut random)
        };
        place(stage, &matt, tree, x, z, angle);
    }
    for (x, z, i) in [
        (-9.5, 21.5, 3),
        (-15.0, 6.5, 0),
        (15.5, -14.0, 1),
        (-14.0, -24.0, 2),
        (12.5, 22.0, 1),
    ] {
        let tree = broadleaf(&mut random, leaves[i]);
        place(stage, &matt, tree, x, z, z);
    }

    stage.commands.spawn((
        ScenePart,
        DirectionalLight {
            illuminance: lux::AMBIENT_DAYLIGHT * 0.85,
            color: Color::srgb(1.0, 0.94, 0.82),
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_translation(sun).looking_at(Vec3::ZERO, Vec3::Y),
        CascadeShadowConfigBuilder {
            num_cascades: 3,
            first_cascade_far_bound: 30.0,
            maximum_distance: 240.0,
            ..default()
        }
        .build(),
    ));
    stage.commands.insert_resource(GlobalAmbientLight {
        color: Color::srgb(0.7, 0.8, 1.0),
        brightness: 1200.0,
        ..default()
    });
    let sky = Sky {
        zenith: 0x4a86c6,
        middle: 0x9fcbe8,
        horizon: 0xf1ecdc,
        ground: 0xb9b58f,
        cloud: 0xffffff,
        cover: 0.42,
        sun,
    };
    Vantage {
        eye: Vec3::new(1.6, 4.6, 27.0),
        target: Vec3::new(-0.6, 4.0, -14.0),
        fov: 50f32.to_radians(),
        near: 0.1,
        far: 4000.0,
        ortho: (Vec3::new(95.0, 90.0, 110.0), Vec3::new(2.0, 0.0, -14.0)),
        ortho_height: 52.0,
        sky: stage.images.add(sky.image()),
        sky_brightness: 1000.0,
    }
}
