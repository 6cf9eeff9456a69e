//! A large landscape: a meadow with flowers, trees, hills and distant mountains (\[CS\]
//! Figure 4). The ground has one million vertices.

use bevy::{light::light_consts::lux, prelude::*};

use bevy_comics::OutlineGroup;

use super::{
    ScenePart, Stage, Vantage,
    noise::{Random, fractal, noise2, ridges, smoothstep},
    shadow_cascades,
    shape::{Shape, blend, rgb, shade},
    sky::Sky,
    sunlight,
};

/// Vertices along each side of the ground.
const SIDE: u32 = 1000;
/// Tiles along each side of the ground. Tiles outside the view are not drawn.
const TILES: u32 = 10;
/// Half the width of the world, meters.
const REACH: f32 = 6000.0;

/// Height of the ground, meters.
pub fn height(p: Vec2) -> f32 {
    let r = p.length();
    let meadow = 1.1 * noise2(p / 31.0) + 0.22 * noise2(p / 7.0);
    let hills = 34.0 * (fractal(p / 340.0 + 3.7, 4) + 0.25) * smoothstep(60.0, 420.0, r);
    // A valley along the z axis: the mountains begin farther away there.
    let valley = smoothstep(0.05, 0.6, (p.x / r.max(1.0)).abs());
    let rise = smoothstep(700.0 + 500.0 * (1.0 - valley), 4200.0, r);
    let peaks = ridges(p / 1500.0 + Vec2::new(11.3, 5.1), 7);
    meadow + hills + rise * (120.0 + 1500.0 * peaks)
}

/// Coordinate in meters of a grid line, `t` in [0, 1]: dense around the meadow, wide at
/// the horizon.
fn warp(t: f32) -> f32 {
    let u = 2.0 * t - 1.0;
    REACH * u * (0.012 + 0.988 * u.abs().powf(2.1))
}

fn ground_color(p: Vec3, normal: Vec3) -> [f32; 4] {
    let (at, steep) = (p.xz(), 1.0 - normal.y);
    let between = |dark: u32, light: u32, t: f32| blend(rgb(dark), rgb(light), 0.5 + t);
    let patch = fractal(at / 23.0, 3);
    let grass = between(0x5f9a2e, 0x9cbf45, patch);
    let forest = between(0x2e6638, 0x4d8040, fractal(at / 90.0, 4));
    let rock = between(0x7b7486, 0xa89d94, fractal(at / 60.0 + 9.0, 4));
    let trees = smoothstep(140.0, 600.0, at.length() + 120.0 * patch);
    let mut color = blend(grass, forest, trees);
    let tree_line = 330.0 + 120.0 * fractal(at / 200.0, 3);
    let above_trees = smoothstep(tree_line - 90.0, tree_line + 60.0, p.y);
    color = blend(color, rock, above_trees);
    let cliff = smoothstep(0.28, 0.42, steep) * smoothstep(60.0, 180.0, p.y);
    color = blend(color, rock, cliff);
    let snow_line = 620.0 + 160.0 * fractal(at / 260.0 + 4.0, 4);
    let snow = smoothstep(snow_line, snow_line + 110.0, p.y) * smoothstep(0.62, 0.4, steep);
    blend(color, rgb(0xf4f7fb), snow)
}

/// The tiles of the ground. Together they have `SIDE` x `SIDE` vertices; those at the
/// seams are in both tiles.
pub fn ground() -> Vec<Shape> {
    let position = |i: u32, j: u32| {
        let p = Vec2::from([i, j].map(|i| warp(i as f32 / (SIDE - 1) as f32)));
        Vec3::new(p.x, height(p), p.y)
    };
    let rows: Vec<Vec<Vec3>> = (0..SIDE)
        .map(|j| (0..SIDE).map(|i| position(i, j)).collect())
        .collect();
    let at = |i: i64, j: i64| {
        let last = i64::from(SIDE) - 1;
        rows[j.clamp(0, last) as usize][i.clamp(0, last) as usize]
    };
    let step = SIDE / TILES;
    let mut tiles = Vec::new();
    for tile in 0..TILES * TILES {
        let mut shape = Shape::default();
        let [x0, y0] = [tile % TILES, tile / TILES].map(|tile| tile * step);
        let [x1, y1] = [x0, y0].map(|first| (first + step).min(SIDE - 1));
        for (i, j) in (y0..=y1).flat_map(|j| (x0..=x1).map(move |i| (i.into(), j.into()))) {
            let east = at(i + 1, j) - at(i - 1, j);
            let south = at(i, j + 1) - at(i, j - 1);
            let normal = south.cross(east).normalize_or(Vec3::Y);
            shape.vertex(at(i, j), normal, ground_color(at(i, j), normal));
        }
        shape.grid(x1 - x0 + 1, y1 - y0 + 1);
        tiles.push(shape);
    }
    tiles
}

pub fn conifer(random: &mut Random) -> Shape {
    let mut tree = Shape::default();
    tree.frustum(Vec3::ZERO, 1.6, (0.22, 0.16), 7, 0x6a4a32);
    let green = blend(rgb(0x1f5a35), rgb(0x35803f), random.unit());
    for (y, radius, rise) in [(0.9, 1.75, 2.4), (2.2, 1.35, 2.1), (3.4, 0.95, 1.9)] {
        let tier = shade(green, 0.85 + 0.1 * y);
        tree.frustum([0.0, y, 0.0], rise, (radius, 0.0), 11, tier);
        let skirt: Vec<_> = (0..11)
            .map(|i| {
                let a = std::f32::consts::TAU * i as f32 / 11.0;
                Vec3::new(radius * a.cos(), y, radius * a.sin())
            })
            .collect();
        tree.polygon(&skirt, shade(tier, 0.55));
    }
    tree
}

pub fn broadleaf(random: &mut Random, leaf: [f32; 4]) -> Shape {
    let mut tree = Shape::default();
    tree.frustum(Vec3::ZERO, 2.6, (0.32, 0.2), 8, 0x74523a);
    let seed = random.range(0.0, 100.0);
    for (offset, size) in [
        (Vec3::new(0.0, 4.1, 0.0), 1.9),
        (Vec3::new(1.1, 3.3, 0.4), 1.25),
        (Vec3::new(-0.9, 3.4, 0.7), 1.3),
        (Vec3::new(-0.1, 3.2, -1.1), 1.2),
    ] {
        tree.blob(
            offset,
            [size, size * 0.85, size],
            9,
            |d| shade(leaf, 0.8 + 0.35 * d.y.max(-0.3)),
            |d| 0.12 * super::noise::noise3(d * 2.7 + seed),
        );
    }
    tree
}

/// One flower: a stem with leaves, and petals around a center.
fn flower(random: &mut Random, petal: [f32; 4]) -> Shape {
    let mut shape = Shape::default();
    let tall = random.range(0.28, 0.62);
    shape.frustum(Vec3::ZERO, tall, (0.012, 0.008), 5, 0x4e8a2c);
    for side in [0.0, 2.4] {
        let out = Vec3::new(f32::cos(side), 0.0, f32::sin(side));
        let base = Vec3::Y * tall * 0.25;
        let tip = base + out * 0.13 + Vec3::Y * 0.12;
        let across = out.cross(Vec3::Y) * 0.03;
        let middle = base.midpoint(tip) + Vec3::Y * 0.015;
        shape.polygon(&[base, middle + across, tip], rgb(0x5c9c34));
        shape.polygon(&[base, tip, middle - across], rgb(0x4e8a2c));
    }
    let radius = random.range(0.075, 0.125);
    let tilt = Quat::from_rotation_x(random.range(-0.5, 0.75))
        * Quat::from_rotation_z(random.range(-0.5, 0.5));
    let center = Vec3::Y * tall;
    let petals = 5 + (random.unit() * 3.0) as u32;
    for k in 0..petals {
        let a = std::f32::consts::TAU * k as f32 / petals as f32;
        let half = std::f32::consts::TAU / petals as f32 * 0.46;
        let out = |angle: f32, r: f32, y: f32| {
            center + tilt * Vec3::new(angle.cos() * r, y, angle.sin() * r)
        };
        let tone = shade(petal, if k % 2 == 0 { 1.0 } else { 0.88 });
        let outline = [
            out(a, radius * 0.15, 0.0),
            out(a + half, radius * 0.75, 0.02),
            out(a + half * 0.45, radius * 1.05, 0.035),
            out(a - half * 0.45, radius * 1.05, 0.035),
            out(a - half, radius * 0.75, 0.02),
        ];
        shape.polygon(&outline, tone);
    }
    let middle = center + tilt * Vec3::Y * 0.012;
    shape.ellipsoid(middle, Vec3::splat(radius * 0.34), 4, 0xf2b51d);
    shape
}

const PETALS: [u32; 8] = [
    0xe0332f, 0xf6d327, 0xffffff, 0x8d4fd0, 0xf26fa8, 0x3f6fe0, 0xf58a1f, 0xd03fae,
];

fn meadow(random: &mut Random) -> Shape {
    let mut shape = Shape::default();
    let kinds: Vec<Shape> = (0..24)
        .map(|i| flower(random, rgb(PETALS[i % PETALS.len()])))
        .collect();
    let grounded = |p: Vec2| Vec3::new(p.x, height(p), p.y);
    // Denser towards the camera, which is at `EYE` and looks along -z.
    let scatter = |random: &mut Random, far: f32| {
        let distance = 1.1 + far * random.unit().powf(1.7);
        let across = random.range(-1.0, 1.0) * (0.9 + 0.85 * distance);
        EYE.xz() + Vec2::new(across, -distance)
    };
    for _ in 0..2600 {
        let p = scatter(random, 34.0);
        // Flowers near each other have similar colors.
        let drift = (noise2(p / 3.1) * 0.5 + 0.5) * kinds.len() as f32;
        let kind = (drift as usize + (random.unit() * 5.0) as usize) % kinds.len();
        let size = random.range(0.7, 1.15);
        let turn = Quat::from_rotation_y(random.range(0.0, 6.3));
        let at = Transform::from_translation(grounded(p)).with_rotation(turn);
        shape.add(&kinds[kind], at.with_scale(Vec3::splat(size)));
    }
    for _ in 0..14000 {
        let base = grounded(scatter(random, 40.0));
        let lean = Vec3::new(random.range(-0.09, 0.09), 0.0, random.range(-0.09, 0.09));
        let tip = base + lean + Vec3::Y * random.range(0.1, 0.3);
        let side = Vec3::new(random.range(-1.0, 1.0), 0.0, random.range(-0.4, 0.4)) * 0.014;
        let color = blend(rgb(0x568f2b), rgb(0xa2c64a), random.unit());
        let first = shape.vertex(base - side, Vec3::Y, shade(color, 0.65));
        shape.vertex(base + side, Vec3::Y, shade(color, 0.65));
        shape.vertex(tip, Vec3::Y, color);
        shape.indices.extend([first, first + 1, first + 2]);
    }
    shape
}

const EYE: Vec3 = Vec3::new(4.0, 0.0, 26.0);

pub fn spawn(stage: &mut Stage) -> Vantage {
    let sun = Vec3::new(-0.62, 0.55, 0.42);
    let mut random = Random::new(2010);
    let matt = stage.matt();
    let leaf = stage.materials.add(StandardMaterial {
        perceptual_roughness: 0.9,
        reflectance: 0.2,
        double_sided: true,
        cull_mode: None,
        ..default()
    });

    // One object, without lines between its tiles.
    let root = (ScenePart, OutlineGroup, Visibility::default());
    let land = stage.commands.spawn((root, Transform::IDENTITY)).id();
    for tile in ground() {
        let mesh = Mesh3d(stage.meshes.add(tile.into_mesh()));
        let tile = (ScenePart, mesh, MeshMaterial3d(matt.clone()), ChildOf(land));
        stage.commands.spawn((tile, Transform::IDENTITY));
    }
    stage.shape(meadow(&mut random), &leaf);

    let conifers: Vec<_> = (0..3)
        .map(|_| stage.meshes.add(conifer(&mut random).into_mesh()))
        .collect();
    let broad = [0x6fa53a, 0x8fb544, 0xd98a2b].map(|hex| {
        let tree = broadleaf(&mut random, rgb(hex));
        stage.meshes.add(tree.into_mesh())
    });
    let plant = |stage: &mut Stage, p: Vec2, mesh: &Handle<Mesh>, size: f32, turn: f32| {
        let at = Vec3::new(p.x, height(p) - 0.1, p.y);
        let transform = Transform::from_translation(at)
            .with_rotation(Quat::from_rotation_y(turn))
            .with_scale(Vec3::new(size, size * 1.1, size));
        stage.solid(mesh.clone(), leaf.clone(), transform);
    };
    for (x, z, kind, size) in [
        (-7.5, 8.0, 0, 1.35),
        (15.5, 2.0, 2, 1.5),
        (-17.0, -16.0, 1, 1.6),
        (24.0, -26.0, 0, 1.7),
    ] {
        plant(stage, Vec2::new(x, z), &broad[kind], size, x);
    }
    for _ in 0..420 {
        let distance = 38.0 + 620.0 * random.unit().powf(1.6);
        let angle = random.range(-1.05, 1.05);
        let p = EYE.xz() + distance * Vec2::new(angle.sin(), -angle.cos());
        // Leaves clearings, and a free view along the middle.
        if fractal(p / 120.0 + 1.7, 3) < -0.04 || (p.x - EYE.x).abs() < 0.13 * distance {
            continue;
        }
        let mesh = random.pick(&conifers);
        let size = random.range(1.2, 2.3);
        plant(stage, p, &mesh, size, angle * 9.0);
    }

    let shadows = shadow_cascades(3, 14.0, 260.0);
    let light = sunlight(sun, lux::AMBIENT_DAYLIGHT, [1.0, 0.95, 0.85], shadows);
    stage.commands.spawn(light);
    stage.ambient([0.68, 0.8, 1.0], 1200.0);

    let sky = Sky {
        zenith: 0x3c78bd,
        middle: 0x8fc0e4,
        horizon: 0xe9eef0,
        ground: 0x9fae8a,
        cloud: 0xffffff,
        cover: 0.47,
        sun,
    };
    let eye = EYE.with_y(height(EYE.xz()) + 1.15);
    Vantage {
        eye,
        target: eye + Vec3::new(-0.5, 0.62, -10.0),
        fov: 54f32.to_radians(),
        far: 12_000.0,
        ortho: (Vec3::new(150.0, 190.0, 330.0), Vec3::new(2.0, 6.0, -12.0)),
        ortho_height: 62.0,
        ..stage.under(&sky)
    }
}
