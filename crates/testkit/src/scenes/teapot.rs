//! The Utah teapot on a cube on a plane (\[CL\] Figure 6).

use bevy::{light::light_consts::lux, prelude::*};

use super::{
    Stage, Vantage, shadow_cascades,
    shape::{Shape, rgb},
    sky::Sky,
    sunlight,
};

/// Martin Newell's profile curves (University of Utah, 1975): radius and height of the
/// control points of the patches around the axis.
const PROFILES: [[[f32; 2]; 4]; 6] = [
    // Rim, the two halves of the body, and the bottom.
    [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]],
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
    [[1.5, 0.15], [1.5, 0.075], [1.425, 0.0], [0.0, 0.0]],
    // The knob and the lid.
    [[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]],
    [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]],
];

/// Length of the tangents of the cubic that stands for a quarter of the unit circle.
const QUARTER: f32 = 0.56;

/// Rows of control points of the two patches of the handle and of the spout, on one side of the
/// plane of symmetry: place and height of the first two points, how far the middle two are aside,
/// place and height of the last two. Both patches have the fourth row.
const HANDLE: [[f32; 5]; 7] = [
    [-1.6, 2.025, -0.3, -1.5, 2.25],
    [-2.3, 2.025, -0.3, -2.5, 2.25],
    [-2.7, 2.025, -0.3, -3.0, 2.25],
    [-2.7, 1.8, -0.3, -3.0, 1.8],
    [-2.7, 1.575, -0.3, -3.0, 1.35],
    [-2.5, 1.125, -0.3, -2.65, 0.9375],
    [-2.0, 0.9, -0.3, -1.9, 0.6],
];
const SPOUT: [[f32; 5]; 7] = [
    [1.7, 1.425, -0.66, 1.7, 0.6],
    [2.6, 1.425, -0.66, 3.1, 0.825],
    [2.3, 2.1, -0.25, 2.4, 2.025],
    [2.7, 2.4, -0.25, 3.3, 2.4],
    [2.8, 2.475, -0.25, 3.525, 2.49375],
    [2.9, 2.475, -0.15, 3.45, 2.5125],
    [2.8, 2.4, -0.15, 3.2, 2.4],
];

/// A bicubic Bezier patch in the data's frame, z up.
pub type Patch = [[Vec3; 4]; 4];

/// The 32 patches of the teapot.
pub fn patches() -> Vec<Patch> {
    let mut patches = Vec::with_capacity(32);
    for profile in PROFILES {
        for quarter in 0..4 {
            let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2 * quarter as f32);
            patches.push(profile.map(|[r, z]| {
                [[1.0, 0.0], [1.0, -QUARTER], [QUARTER, -1.0], [0.0, -1.0]]
                    .map(|[x, y]| turn * Vec3::new(r * x, r * y, z))
            }));
        }
    }
    let row = |[x, z, y, far_x, far_z]: [f32; 5]| {
        let places = [
            [x, 0.0, z],
            [x, y, z],
            [far_x, y, far_z],
            [far_x, 0.0, far_z],
        ];
        places.map(Vec3::from)
    };
    for (part, first) in [(HANDLE, 0), (HANDLE, 3), (SPOUT, 0), (SPOUT, 3)] {
        let patch = [0, 1, 2, 3].map(|k| row(part[first + k]));
        patches.push(patch);
        // The mirror image has its columns in reverse order, to face outwards.
        let mirrored = patch.map(|row| {
            let [a, b, c, d] = row.map(|p| p * Vec3::new(1.0, -1.0, 1.0));
            [d, c, b, a]
        });
        patches.push(mirrored);
    }
    patches
}

fn cubic(p: [Vec3; 4], t: f32) -> (Vec3, Vec3) {
    let s = 1.0 - t;
    let value =
        p[0] * s * s * s + p[1] * 3.0 * s * s * t + p[2] * 3.0 * s * t * t + p[3] * t * t * t;
    let slope = ((p[1] - p[0]) * s * s + (p[2] - p[1]) * 2.0 * s * t + (p[3] - p[2]) * t * t) * 3.0;
    (value, slope)
}

fn surface(patch: &Patch, u: f32, v: f32) -> (Vec3, Vec3) {
    let rows = patch.map(|row| cubic(row, u));
    let (position, along_v) = cubic(rows.map(|r| r.0), v);
    let (along_u, _) = cubic(rows.map(|r| r.1), v);
    (position, along_u.cross(along_v))
}

/// The teapot, y up, with its bottom at the origin. Its body is four units wide.
/// `steps`: quads along each side of a patch.
pub fn mesh(steps: u32, color: [f32; 4]) -> Shape {
    let mut shape = Shape::default();
    let y_up = |p: Vec3| Vec3::new(p.x, p.z, -p.y);
    for patch in patches() {
        let first = shape.positions.len() as u32;
        for i in 0..=steps {
            for j in 0..=steps {
                let (u, v) = (j as f32 / steps as f32, i as f32 / steps as f32);
                let (position, mut normal) = surface(&patch, u, v);
                if normal.length_squared() < 1e-10 {
                    // The patch shrinks to a point at the top of the lid and at the
                    // bottom: a point nearby has the normal.
                    normal = surface(&patch, u.clamp(0.02, 0.98), v.clamp(0.02, 0.98)).1;
                }
                shape.vertex(y_up(position), y_up(normal).normalize_or(Vec3::Y), color);
            }
        }
        for i in 0..steps {
            for j in 0..steps {
                let at = |i: u32, j: u32| first + i * (steps + 1) + j;
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                shape.indices.extend([a, c, d, a, b, c]);
            }
        }
    }
    shape
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let sun = Vec3::new(0.55, 0.75, 0.5);
    let sky = Sky {
        zenith: 0x4f8fc4,
        middle: 0xa9d3e6,
        horizon: 0xf2ead8,
        ground: 0xb9c4c0,
        cloud: 0xffffff,
        cover: 0.32,
        sun,
    };
    let china = stage.materials.add(StandardMaterial {
        perceptual_roughness: 0.22,
        reflectance: 0.6,
        ..default()
    });
    let matt = stage.matt();

    let teapot = stage.meshes.add(mesh(12, rgb(0xd6452f)).into_mesh());
    stage.solid(teapot, china, Transform::from_xyz(0.0, 4.0, 0.0));

    let mut cube = Shape::default();
    cube.cuboid([-3.0, 0.0, -3.0], [3.0, 4.0, 3.0], 0x2f7f79);
    let cube = stage.meshes.add(cube.into_mesh());
    let turned = Transform::from_rotation(Quat::from_rotation_y(0.5));
    stage.solid(cube, matt.clone(), turned);

    // A round table top: with an endless floor, the teapot would have only a small part
    // of the depth range.
    let mut floor = Shape::default();
    floor.frustum([0.0, -0.6, 0.0], 0.6, (15.0, 15.0), 96, 0xe3c98a);
    stage.shape(floor, &matt);

    let shadows = shadow_cascades(2, 26.0, 60.0);
    let light = sunlight(
        sun,
        lux::AMBIENT_DAYLIGHT * 0.85,
        [1.0, 0.96, 0.88],
        shadows,
    );
    stage.commands.spawn(light);
    stage.ambient([0.72, 0.82, 1.0], 1200.0);

    Vantage {
        eye: Vec3::new(5.2, 8.4, 11.5),
        target: Vec3::new(0.1, 4.15, 0.0),
        fov: 42f32.to_radians(),
        ortho: (Vec3::new(16.0, 21.0, 33.0), Vec3::new(0.1, 4.0, 0.0)),
        ortho_height: 12.0,
        ..stage.under(&sky)
    }
}
