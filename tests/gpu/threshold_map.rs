//! Thresholds of the toon material from an image: where edges lie, and what their pixels cover.

use bevy::math::Affine2;

use crate::{
    prelude::*,
    ramp::{MODES, bright, put, room, sun, with},
};

const SIZE: UVec2 = UVec2::new(160, 16);
/// Cosine between the wall and the light.
const COSINE: f64 = 0.5;

/// An image of one row with a red channel. The values that tests use are halves of few bits.
fn thresholds(small: &mut Small, row: &[f32]) -> Handle<Image> {
    let half = |x: f32| half::f16::from_f32(x).to_le_bytes();
    let texel = |x: &f32| [half(*x), half(0.0), half(0.0), half(1.0)].concat();
    let image = Image::new(
        Extent3d {
            width: row.len() as u32,
            height: 1,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        row.iter().flat_map(texel).collect(),
        TextureFormat::Rgba16Float,
        RenderAssetUsages::default(),
    );
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// From 0 at the left border of the image to 1 at the right one.
fn gradient() -> Vec<f32> {
    (0..64).map(|k| (k as f32 + 0.5) / 64.0).collect()
}

/// Two halves, so that all edges are near the middle of the step.
fn step() -> Vec<f32> {
    (0..16).map(|k| if k < 8 { 0.125 } else { 0.625 }).collect()
}

/// No ramp, and one of black and white from a quarter of the light on, in each mode; with where
/// light begins.
fn lights() -> Vec<(ToonLight, f64)> {
    let plain = ToonLight::default();
    let begins = f64::from(plain.shadow_threshold);
    let ramp = |mode| Ramp {
        mode,
        blend: RampBlend::Absolute,
        keep_intensity: 1.0,
        ..Ramp::new([
            RampStop::new(0.0, Color::BLACK),
            RampStop::new(0.25, Color::WHITE),
        ])
    };
    let ramps = MODES.map(|mode| (with(ramp(mode)), 0.25));
    [(plain, begins)].into_iter().chain(ramps).collect()
}

/// A wall of 40 units, of which the view shows 20, with coordinates from 0 to 1 over its middle
/// half, and with the alpha of its vertices by where they are.
fn wall(alpha: impl Fn(f32) -> f32) -> Mesh {
    let mut wall = Plane3d::new(Vec3::Z, Vec2::splat(20.0)).mesh().build();
    let places = wall.attribute(Mesh::ATTRIBUTE_POSITION).expect("places");
    let places = places.as_float3().expect("numbers").to_vec();
    let uv = |[x, ..]: &[f32; 3]| [0.5 + x / 20.0, 0.5];
    let uvs: Vec<[f32; 2]> = places.iter().map(uv).collect();
    let color = |[x, ..]: &[f32; 3]| [1.0, 1.0, 1.0, alpha(*x)];
    let colors: Vec<[f32; 4]> = places.iter().map(color).collect();
    wall.insert_attribute(Mesh::ATTRIBUTE_UV_0, uvs);
    wall.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    wall
}

/// A wall under a sun, with coordinates from 0 at the left border of the picture to 1 at the right
/// one.
fn lit_wall(mesh: Mesh) -> (Small, Entity) {
    let mut small = room(SIZE, 0.0);
    let entity = put(&mut small, mesh, &ToonLight::default(), default());
    let across = (1.0 - COSINE * COSINE).sqrt();
    let to = Vec3::new(0.0, across as f32, COSINE as f32);
    sun(&mut small, to, bright(1.0));
    (small, entity)
}

fn set(small: &mut Small, light: &ToonLight, uv_transform: Affine2) {
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    let ids: Vec<_> = materials.ids().collect();
    for id in ids {
        let mut material = materials.get_mut(id).expect("listed");
        material.extension = light.clone();
        material.base.uv_transform = uv_transform;
    }
    small.headless.step(5);
}

/// How much of a row is white, in pixels; and how many of its pixels are neither black nor white.
fn white(small: &mut Small) -> (f64, usize) {
    small.headless.step(1);
    let picture = small.picture();
    let row: Vec<f64> = (0..SIZE.x).map(|x| linear(&picture, x, 8)[0]).collect();
    let between = row.iter().filter(|c| (0.01..0.99).contains(*c)).count();
    (row.iter().sum(), between)
}

/// Over 16 shifts by parts of a pixel, the edge lies where the threshold says, and its pixels are
/// covered by as much in the mean.
fn check_edge(small: &mut Small, wall: Entity, edge: f64, what: &str) {
    let per_unit = f64::from(SIZE.x) / 20.0;
    let (mut error, mut soft) = (0.0, 0);
    for shift in 0..16 {
        let moved = f64::from(shift) / 16.0;
        let at = Transform::from_xyz((moved / per_unit) as f32, 0.0, 0.0);
        small.world().entity_mut(wall).insert(at);
        let (found, between) = white(small);
        let wanted = f64::from(SIZE.x) - edge - moved;
        // A smooth step instead of the area of a pixel: off by up to 0.1. A hard edge would be off
        // by up to 0.5. The places of samplers are 1/256 of a texel, which is 10 pixels at most.
        let off = found - wanted;
        assert!(off.abs() < 0.15, "{what}, {moved}: {found}, not {wanted}");
        error += off / 16.0;
        soft += between;
    }
    assert!(error.abs() < 0.05, "{what}: {error} pixels");
    assert!((8..=32).contains(&soft), "{what}: {soft} pixels of edges");
}

/// Where the cosine and the threshold are that of the edge, as a fraction of the gradient.
fn crossing(begins: f64, bias: f64) -> f64 {
    0.5 + (begins - COSINE - bias) / 2.0
}

#[test]
fn edges_lie_where_a_gradient_crosses_the_threshold() {
    assert_edges_of_a_gradient(&lights()[..1]);
}

#[test]
#[ignore = "long: ramps of every mode"]
fn edges_of_ramps_lie_where_a_gradient_crosses_the_threshold() {
    assert_edges_of_a_gradient(&lights());
}

fn assert_edges_of_a_gradient(lights: &[(ToonLight, f64)]) {
    let (mut small, entity) = lit_wall(wall(|_| 0.625));
    let map = thresholds(&mut small, &gradient());
    let plain = Affine2::IDENTITY;
    let turned =
        Affine2::from_scale_angle_translation(Vec2::new(0.5, 1.0), 0.0, Vec2::new(0.25, 0.0));
    for (light, begins) in lights {
        let light = ToonLight {
            threshold_map: Some(map.clone()),
            ..light.clone()
        };
        let what = format!("{:?}", light.ramp.as_ref().map(|ramp| ramp.mode));
        let edge = crossing(*begins, 0.0);
        set(&mut small, &light, plain);
        check_edge(&mut small, entity, 160.0 * edge, &what);
        // The map is read by the coordinates of the base color.
        set(&mut small, &light, turned);
        let moved = (edge - 0.25) / 0.5;
        check_edge(&mut small, entity, 160.0 * moved, &format!("{what}, moved"));
        // What vertices and the map say adds up.
        let both = ToonLight {
            vertex_threshold: true,
            ..light
        };
        set(&mut small, &both, plain);
        let edge = crossing(*begins, 2.0 * 0.625 - 1.0);
        check_edge(&mut small, entity, 160.0 * edge, &format!("{what}, both"));
    }
    // Vertices alone, whose alpha is the same gradient.
    small.world().despawn(entity);
    let gradient = wall(|x| 0.5 + x / 20.0);
    let entity = put(&mut small, gradient, &lights[0].0, default());
    for (light, begins) in lights {
        let light = ToonLight {
            vertex_threshold: true,
            ..light.clone()
        };
        set(&mut small, &light, plain);
        let edge = 160.0 * crossing(*begins, 0.0);
        check_edge(&mut small, entity, edge, "vertices alone");
    }
}

/// The step is a texel wide, from middle to middle, as the sampler mixes both sides.
#[test]
fn edges_lie_in_the_texel_of_a_step() {
    assert_edges_of_a_step(&lights()[1..3]);
}

#[test]
#[ignore = "long: ramps of every mode"]
fn edges_of_ramps_lie_in_the_texel_of_a_step() {
    assert_edges_of_a_step(&lights());
}

fn assert_edges_of_a_step(lights: &[(ToonLight, f64)]) {
    let (mut small, entity) = lit_wall(wall(|_| 1.0));
    let map = thresholds(&mut small, &step());
    for (light, begins) in lights {
        let light = ToonLight {
            threshold_map: Some(map.clone()),
            ..light.clone()
        };
        set(&mut small, &light, Affine2::IDENTITY);
        let part = (crossing(*begins, 0.0) - 0.125) / 0.5;
        let what = format!("{:?}", light.ramp.as_ref().map(|ramp| ramp.mode));
        check_edge(&mut small, entity, 10.0 * (7.5 + part), &what);
    }
}

/// Meshes without texture coordinates are lit as without a map.
#[test]
fn without_coordinates_there_is_no_threshold() {
    let mut mesh = wall(|_| 1.0);
    mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    let (mut small, _) = lit_wall(mesh);
    let map = thresholds(&mut small, &[0.0]);
    let light = ToonLight {
        threshold_map: Some(map),
        ..default()
    };
    set(&mut small, &light, Affine2::IDENTITY);
    let (found, _) = white(&mut small);
    assert!((found - f64::from(SIZE.x)).abs() < 0.5, "{found}");
}
