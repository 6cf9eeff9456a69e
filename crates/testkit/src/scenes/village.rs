//! A village: many objects at many distances, from a barrel near the camera to a
//! windmill on a hill.

use bevy::{light::light_consts::lux, prelude::*};

use super::{
    Stage, Vantage,
    buildings::{House, barrel, cart, church, fence, house, lamp, well, windmill},
    mountains::{broadleaf, conifer},
    noise::{Random, fractal, smoothstep},
    shadow_cascades,
    shape::{Shape, blend, rgb},
    sky::Sky,
    sunlight,
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
        let p = Vec2::from([i, j].map(|i| warp(i.clamp(0, side) as f32 / side as f32)));
        Vec3::new(p.x, height(p), p.y)
    };
    for (i, j) in (0..=side).flat_map(|j| (0..=side).map(move |i| (i, j))) {
        let p = at(i, j);
        let normal = (at(i, j + 1) - at(i, j - 1)).cross(at(i + 1, j) - at(i - 1, j));
        let flat = Vec2::new(p.x, p.z);
        let field = fractal(flat / 60.0 + 5.0, 3);
        let grass = blend(rgb(0x6c9f3c), rgb(0xb5bd55), 0.5 + field * 1.4);
        let far = smoothstep(200.0, 700.0, flat.length());
        let color = blend(grass, rgb(0x4a7d45), far);
        shape.vertex(p, normal.normalize_or(Vec3::Y), color);
    }
    shape.grid(side as u32 + 1, side as u32 + 1);
    shape
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let sun = Vec3::new(0.6, 0.62, 0.5);
    let mut random = Random::new(77);
    let matt = stage.matt();

    // Puts a shape on the ground at (`x`, `z`), turned by radians around y.
    let place = |stage: &mut Stage, shape: Shape, x: f32, z: f32, turn: f32| {
        let mesh = stage.meshes.add(shape.into_mesh());
        let at = Vec3::new(x, height(Vec2::new(x, z)), z);
        let transform = Transform::from_translation(at).with_rotation(Quat::from_rotation_y(turn));
        stage.solid(mesh, matt.clone(), transform);
    };
    place(stage, ground(), 0.0, 0.0, 0.0);
    // The road and the square around the well are flat, 5 and 8 cm above the grass.
    let mut road = Shape::default();
    road.cuboid([-3.4, -0.3, -120.0], [3.4, 0.05, 34.0], 0xd9c59a);
    road.frustum([0.0, -0.3, -22.0], 0.38, (13.0, 13.0), 40, 0xcdbb96);
    place(stage, road, 0.0, 0.0, 0.0);

    let walls = [
        0xf4e7c8, 0xe9b872, 0xd98f6a, 0xf1d9d0, 0xc9d6c3, 0xb9cbd9, 0xf0c94f,
    ];
    let walls = walls.map(rgb);
    let tiles = [0xb5533c, 0x9c3d33, 0xc46a3a, 0x7d4a3c, 0x5b6a7c].map(rgb);
    let build = |stage: &mut Stage, random: &mut Random, x: f32, z: f32, turn: f32, size: f32| {
        let sides = [(5.2, 6.8), (2.9, 5.0), (6.0, 8.6)];
        let plan = House {
            size: Vec3::from(sides.map(|(low, high)| random.range(low, high))) * size,
            roof: random.range(2.1, 3.2) * size,
            wall: random.pick(&walls),
            tiles: random.pick(&tiles),
        };
        let shape = house(&plan, random);
        place(stage, shape, x, z, turn);
    };
    let rows = [12.0f32, 1.5, -9.0, -36.0, -48.0, -60.0, -73.0, -87.0];
    for (i, z) in rows.into_iter().enumerate() {
        for side in [-1.0f32, 1.0] {
            let x = side * (9.4 + random.range(0.0, 1.6));
            let turn = -side * std::f32::consts::FRAC_PI_2 + 0.06 * i as f32;
            build(stage, &mut random, x, z + side * 1.3, turn, 1.0);
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

    place(stage, church(), -11.0, -134.0, 0.35);
    place(stage, windmill(), 96.0, -215.0, -0.35);
    place(stage, well(), 1.5, -22.0, 0.6);
    place(stage, cart(), -4.3, 14.6, 0.5);
    let barrels = [
        (4.6, 16.9),
        (5.2, 16.0),
        (4.4, 15.6),
        (-4.8, -4.0),
        (5.0, -13.0),
    ];
    for (x, z) in barrels {
        place(stage, barrel(), x, z, x);
    }
    for z in [8.0, -6.0, -34.0, -52.0, -70.0] {
        place(stage, lamp(), 3.9, z, 0.0);
        place(stage, lamp(), -3.9, z - 7.0, 0.0);
    }
    for (x, z, turn) in [(-14.5, 19.0, 0.1), (6.3, 19.6, -0.05), (-15.0, -27.0, 1.2)] {
        place(stage, fence(8.1), x, z, turn);
    }
    let leaves = [0x6fa53a, 0x8fb544, 0x4f8f3f, 0xd98a2b].map(rgb);
    for _ in 0..130 {
        let angle = random.range(0.0, 6.3);
        let r = 24.0 + 300.0 * random.unit().powf(1.4);
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
        place(stage, tree, x, z, angle);
    }
    for (x, z, i) in [
        (-9.5, 21.5, 3),
        (-15.0, 6.5, 0),
        (15.5, -14.0, 1),
        (-14.0, -24.0, 2),
        (12.5, 22.0, 1),
    ] {
        let tree = broadleaf(&mut random, leaves[i]);
        place(stage, tree, x, z, z);
    }

    let shadows = shadow_cascades(3, 30.0, 240.0);
    let light = sunlight(
        sun,
        lux::AMBIENT_DAYLIGHT * 0.85,
        [1.0, 0.94, 0.82],
        shadows,
    );
    stage.commands.spawn(light);
    stage.ambient([0.7, 0.8, 1.0], 1200.0);
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
        far: 4000.0,
        ortho: (Vec3::new(95.0, 90.0, 110.0), Vec3::new(2.0, 0.0, -14.0)),
        ortho_height: 52.0,
        ..stage.under(&sky)
    }
}
