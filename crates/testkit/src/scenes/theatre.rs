//! A toy theatre: a robot, a chick and props under a directional light, a point light
//! and a spot light. It shows textures, highlights, both kinds of shadow and every kind
//! of line.

use bevy::{
    asset::RenderAssetUsages,
    light::NotShadowCaster,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

use super::{
    ScenePart, Stage, Vantage, lamplight, shadows_within,
    shape::{Shape, rgb, shade},
    sky::Sky,
    sunlight,
};

/// A texture of flat squares, `width` per row, in sRGB codes.
fn texels(stage: &mut Stage, width: u32, colors: &[u32]) -> Handle<Image> {
    // Texels per side of a square: filtering then blurs only a narrow border.
    const SCALE: u32 = 64;
    let height = colors.len() as u32 / width;
    let size = Extent3d {
        width: width * SCALE,
        height: height * SCALE,
        depth_or_array_layers: 1,
    };
    let mut bytes = Vec::new();
    for (y, x) in (0..size.height).flat_map(|y| (0..size.width).map(move |x| (y, x))) {
        let [_, r, g, b] = colors[((y / SCALE) * width + x / SCALE) as usize].to_be_bytes();
        bytes.extend([r, g, b, 255]);
    }
    let (dimension, usage) = (TextureDimension::D2, RenderAssetUsages::RENDER_WORLD);
    let image = Image::new(size, dimension, bytes, TextureFormat::Rgba8UnormSrgb, usage);
    stage.images.add(image)
}

struct Workshop<'a, 'w, 's> {
    stage: &'a mut Stage<'w, 's>,
}

impl Workshop<'_, '_, '_> {
    fn paint(&mut self, color: u32, roughness: f32) -> Handle<StandardMaterial> {
        let [_, r, g, b] = color.to_be_bytes();
        self.stage.materials.add(StandardMaterial {
            base_color: Color::srgb_u8(r, g, b),
            perceptual_roughness: roughness,
            reflectance: 0.5,
            ..default()
        })
    }

    fn textured(&mut self, texture: Handle<Image>, roughness: f32) -> Handle<StandardMaterial> {
        self.stage.materials.add(StandardMaterial {
            base_color_texture: Some(texture),
            perceptual_roughness: roughness,
            ..default()
        })
    }

    fn put(
        &mut self,
        mesh: impl Into<Mesh>,
        material: &Handle<StandardMaterial>,
        at: Transform,
    ) -> Entity {
        let mesh = self.stage.meshes.add(mesh);
        let material = MeshMaterial3d(material.clone());
        let part = (ScenePart, Mesh3d(mesh), material, at);
        self.stage.commands.spawn(part).id()
    }
}

fn at(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_xyz(x, y, z)
}

fn ball(radius: f32) -> Mesh {
    Sphere::new(radius).mesh().uv(48, 24)
}

fn cone(radius: f32, height: f32) -> Mesh {
    tube(radius, 0.001, height)
}

fn tube(bottom: f32, top: f32, height: f32) -> Mesh {
    let mut shape = Shape::default();
    shape.frustum(Vec3::ZERO, height, (bottom, top), 40, [1.0; 4]);
    shape.into_mesh()
}

fn robot(shop: &mut Workshop, place: Transform) {
    let tin = shop.paint(0x5b8fd6, 0.35);
    let dark = shop.paint(0x27364f, 0.6);
    let glass = shop.paint(0xfff3c4, 0.2);
    let red = shop.paint(0xd8423a, 0.4);
    let mut put = |mesh: Mesh, material: &Handle<StandardMaterial>, local: Transform| {
        shop.put(mesh, material, place * local);
    };
    let block = |x: f32, y: f32, z: f32| Mesh::from(Cuboid::new(x, y, z));
    // Legs, body, head.
    for side in [-1.0, 1.0] {
        put(tube(0.2, 0.17, 0.62), &dark, at(0.27 * side, 0.12, 0.0));
        put(block(0.42, 0.16, 0.56), &tin, at(0.27 * side, 0.08, 0.08));
    }
    put(block(1.15, 1.2, 0.8), &tin, at(0.0, 1.32, 0.0));
    put(block(0.6, 0.36, 0.06), &dark, at(0.0, 1.42, 0.42));
    for (x, lamp) in [(-0.16, &red), (0.0, &glass), (0.16, &red)] {
        put(ball(0.06), lamp, at(x, 1.42, 0.46));
    }
    put(tube(0.22, 0.22, 0.14), &dark, at(0.0, 1.92, 0.0));
    put(block(0.86, 0.66, 0.7), &tin, at(0.0, 2.38, 0.0));
    for side in [-1.0, 1.0] {
        put(ball(0.15), &glass, at(0.2 * side, 2.45, 0.34));
        put(ball(0.065), &dark, at(0.2 * side, 2.45, 0.47));
        put(ball(0.2), &dark, at(0.66 * side, 1.72, 0.0));
        let arm = at(0.74 * side, 1.68, 0.0).with_rotation(Quat::from_rotation_z(
            side * if side > 0.0 { 2.35 } else { -2.75 },
        ));
        put(tube(0.12, 0.14, 0.8), &tin, arm);
        put(ball(0.19), &red, arm * at(0.0, 0.88, 0.0));
    }
    put(block(0.42, 0.05, 0.04), &dark, at(0.0, 2.2, 0.36));
    put(tube(0.03, 0.03, 0.36), &dark, at(0.0, 2.7, 0.0));
    put(ball(0.1), &red, at(0.0, 3.12, 0.0));
}

fn chick(shop: &mut Workshop, place: Transform) {
    let down = shop.paint(0xf6c832, 0.75);
    let orange = shop.paint(0xea7a1f, 0.6);
    let black = shop.paint(0x1d1a1f, 0.25);
    let mut put = |mesh: Mesh, material: &Handle<StandardMaterial>, local: Transform| {
        shop.put(mesh, material, place * local);
    };
    let mut body = Shape::default();
    body.ellipsoid(Vec3::ZERO, [0.62, 0.66, 0.68], 24, [1.0; 4]);
    put(body.into_mesh(), &down, at(0.0, 0.86, 0.0));
    put(ball(0.43), &down, at(0.0, 1.62, 0.14));
    let beak = at(0.0, 1.6, 0.5).with_rotation(Quat::from_rotation_x(1.57));
    put(cone(0.15, 0.34), &orange, beak);
    for side in [-1.0, 1.0] {
        put(ball(0.075), &black, at(0.17 * side, 1.72, 0.5));
        let wing = at(0.6 * side, 0.95, -0.05)
            .with_rotation(Quat::from_rotation_z(0.35 * side))
            .with_scale(Vec3::new(0.28, 0.8, 0.9));
        put(ball(0.46), &down, wing);
        put(tube(0.05, 0.05, 0.3), &orange, at(0.22 * side, 0.0, 0.05));
        let foot = Cuboid::new(0.24, 0.06, 0.4);
        put(foot.into(), &orange, at(0.22 * side, 0.03, 0.15));
    }
    for (lean, height) in [(-0.35f32, 0.2), (0.0, 0.28), (0.35, 0.2)] {
        let tuft = at(0.0, 2.0, 0.1).with_rotation(Quat::from_rotation_z(lean));
        put(cone(0.05, height), &orange, tuft);
    }
}

fn props(shop: &mut Workshop) {
    // Two stacked crates with flush sides: only their ids tell them apart.
    let rows = [[0xc8935a; 4], [0xb67f47; 4]].repeat(2);
    let plank = texels(shop.stage, 4, rows.as_flattened());
    let wood = shop.textured(plank, 0.9);
    let turn = Quat::from_rotation_y(0.42);
    for y in [0.6, 1.8] {
        let place = at(2.75, y, -0.7).with_rotation(turn);
        shop.put(Cuboid::new(1.2, 1.2, 1.2), &wood, place);
    }
    // A beach ball: texture and highlight.
    let stripes = [0xe23b3b, 0xf7f2e6, 0x2f7fd1, 0xf7f2e6, 0xf2b430, 0xf7f2e6];
    let stripes = texels(shop.stage, 6, &stripes);
    let rubber = shop.textured(stripes, 0.28);
    let turn = Quat::from_euler(EulerRot::XYZ, 0.5, 0.3, 0.6);
    let place = at(1.35, 0.62, 1.75).with_rotation(turn);
    shop.put(ball(0.62), &rubber, place);
    // A table lamp; its light is spawned in `spawn`.
    let brass = shop.paint(0xb98d3a, 0.35);
    let shade_material = shop.stage.materials.add(StandardMaterial {
        base_color: Color::srgb_u8(0x3f, 0x8f, 0x6b),
        perceptual_roughness: 0.8,
        double_sided: true,
        cull_mode: None,
        ..default()
    });
    let bulb = shop.stage.materials.add(StandardMaterial {
        base_color: Color::srgb(1.0, 0.93, 0.7),
        unlit: true,
        ..default()
    });
    let foot = at(-3.1, 0.0, 0.5);
    shop.put(tube(0.5, 0.42, 0.14), &brass, foot);
    shop.put(tube(0.07, 0.07, 2.5), &brass, foot * at(0.0, 0.14, 0.0));
    let glow = shop.put(ball(0.2), &bulb, foot * at(0.0, 2.72, 0.0));
    let mut glow = shop.stage.commands.entity(glow);
    glow.insert(NotShadowCaster);
    let mut hood = Shape::default();
    for i in 0..40u32 {
        let ring = |k: u32, radius: f32, y: f32| {
            let a = std::f32::consts::TAU * k as f32 / 40.0;
            Vec3::new(radius * a.cos(), y, radius * a.sin())
        };
        let mut corner = |k: u32, radius: f32, y: f32| {
            let normal = ring(k, 0.9, 0.35).normalize();
            hood.vertex(ring(k, radius, y), normal, [1.0; 4])
        };
        let [a, b] = [i, i + 1].map(|k| corner(k, 0.72, 0.0));
        let [c, d] = [i + 1, i].map(|k| corner(k, 0.34, 0.62));
        hood.indices.extend([a, d, c, a, c, b]);
    }
    shop.put(hood.into_mesh(), &shade_material, foot * at(0.0, 2.6, 0.0));
    // Books.
    for (i, color, width, angle) in [
        (0.0, 0x7b3f8c, 1.0, 0.2),
        (1.0, 0x2f8c7b, 0.86, -0.15),
        (2.0, 0xc2453d, 0.92, 0.45),
    ] {
        let cloth = shop.paint(color, 0.85);
        let turn = Quat::from_rotation_y(angle);
        let place = at(-1.0, 0.09 + 0.18 * i, 2.15).with_rotation(turn);
        shop.put(Cuboid::new(width, 0.18, 0.66), &cloth, place);
    }
}

fn room(shop: &mut Workshop) {
    let checks: Vec<u32> = (0..48)
        .map(|i| [0xdcb987, 0xcfa56c][(i % 6 + i / 6) % 2])
        .collect();
    let boards = texels(shop.stage, 6, &checks);
    let floor = shop.textured(boards, 0.9);
    shop.put(Cuboid::new(12.0, 0.5, 8.0), &floor, at(0.0, -0.25, 0.5));
    let mut wall = Shape::default();
    // A folding screen, with creases between its panels.
    let color = rgb(0xf1e3c6);
    for i in 0..6 {
        let x = -5.1 + 1.7 * i as f32;
        let z = |k: i32| -3.0 + if k % 2 == 0 { 0.0 } else { 0.85 };
        let (z0, z1) = (z(i), z(i + 1));
        let tone = [color, shade(color, 0.93)][i as usize % 2];
        let [left, right] = [(x, z0), (x + 1.7, z1)].map(|(x, z)| {
            // From the foot in front over the top to the foot behind.
            [(0.0, 0.0), (4.6, 0.0), (4.6, 0.15), (0.0, 0.15)]
                .map(|(y, back)| Vec3::new(x, y, z - back))
        });
        for panel in [
            [left[0], right[0], right[1], left[1]],
            [left[1], right[1], right[2], left[2]],
            [right[3], left[3], left[2], right[2]],
        ] {
            wall.polygon(&panel, tone);
        }
    }
    let paper = shop.stage.matt();
    shop.put(wall.into_mesh(), &paper, Transform::IDENTITY);
}

pub fn spawn(stage: &mut Stage) -> Vantage {
    let sun = Vec3::new(-0.55, 0.8, 0.62);
    let sky = Sky {
        zenith: 0x4a6fa8,
        middle: 0x9cc4de,
        horizon: 0xf4e6cf,
        ground: 0x8d97a5,
        cloud: 0xffffff,
        cover: 0.3,
        sun,
    };
    let mut shop = Workshop { stage };
    room(&mut shop);
    let turned = |at: Transform, angle| at.with_rotation(Quat::from_rotation_y(angle));
    robot(&mut shop, turned(at(0.35, 0.0, -0.6), -0.18));
    chick(&mut shop, turned(at(-1.55, 0.0, 0.35), 0.42));
    props(&mut shop);

    let shadows = shadows_within(26.0);
    let light = sunlight(sun, 3000.0, [1.0, 0.95, 0.86], shadows);
    stage.commands.spawn(light);
    let (bulb, warm) = (Vec3::new(-3.1, 2.72, 0.5), Color::srgb(1.0, 0.78, 0.45));
    let light = lamplight(bulb, 240_000.0, warm, 7.0, true);
    stage.commands.spawn(light);
    stage.commands.spawn((
        ScenePart,
        SpotLight {
            intensity: 2_000_000.0,
            color: Color::srgb(0.72, 0.84, 1.0),
            range: 20.0,
            outer_angle: 0.34,
            inner_angle: 0.3,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(5.0, 6.5, 4.6).looking_at(Vec3::new(0.4, 1.0, -0.8), Vec3::Y),
    ));
    stage.ambient([0.78, 0.84, 1.0], 330.0);

    Vantage {
        eye: Vec3::new(0.6, 3.5, 11.0),
        target: Vec3::new(-0.05, 1.45, 0.0),
        fov: 32f32.to_radians(),
        ortho: (Vec3::new(10.0, 9.0, 16.0), Vec3::new(0.0, 1.4, 0.0)),
        ortho_height: 8.5,
        ..stage.under(&sky)
    }
}
