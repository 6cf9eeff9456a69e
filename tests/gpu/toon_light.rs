//! The toon material under every kind of light of the engine, beside the standard material.

use bevy::{
    light::{EnvironmentMapLight, IrradianceVolume, LightProbe, RectLight},
    pbr::{ContactShadows, DistanceFog, FogFalloff, Lightmap},
    render::render_resource::{TextureViewDescriptor, TextureViewDimension},
};
use bevy_comics_testkit::reference::rect::rect_light;
use image::RgbaImage;

use crate::prelude::*;

/// The exposure of a camera with default settings.
fn exposure() -> f32 {
    Exposure::default().exposure()
}

/// An app without objects and ambient light.
fn dark() -> Small {
    dark_of(size())
}

fn dark_of(size: UVec2) -> Small {
    let mut small = Small::new(size, Msaa::Off);
    small.clear();
    small.insert(Exposure::default());
    small.world().insert_resource(GlobalAmbientLight::NONE);
    small
}

/// An image of one color per texel, in linear light.
fn image(small: &mut Small, size: [u32; 3], colors: &[Vec3]) -> Handle<Image> {
    let [width, height, depth_or_array_layers] = size;
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers,
    };
    let data = colors
        .iter()
        .flat_map(|c| c.extend(1.0).to_array())
        .flat_map(|x| half::f16::from_f32(x).to_le_bytes())
        .collect();
    let is_volume = height > 1;
    let dimension = match is_volume {
        true => TextureDimension::D3,
        false => TextureDimension::D2,
    };
    let format = TextureFormat::Rgba16Float;
    let mut image = Image::new(
        size,
        dimension,
        data,
        format,
        RenderAssetUsages::RENDER_WORLD,
    );
    if depth_or_array_layers == 6 {
        image.texture_view_descriptor = Some(TextureViewDescriptor {
            dimension: Some(TextureViewDimension::Cube),
            ..default()
        });
    }
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// An environment of six colors, in the order +X, -X, +Y, -Y and towards -Z, +Z. A
/// color of 1 is white in the picture.
fn environment(small: &mut Small, colors: [Vec3; 6]) -> EnvironmentMapLight {
    let map = image(small, [1, 1, 6], &colors);
    EnvironmentMapLight {
        diffuse_map: map.clone(),
        specular_map: map,
        intensity: 1.0 / exposure(),
        ..default()
    }
}

/// A material without reflections: under an environment the standard material is its
/// diffuse part alone.
fn plain(color: Color) -> StandardMaterial {
    StandardMaterial {
        base_color: color,
        perceptual_roughness: 1.0,
        reflectance: 0.0,
        ..default()
    }
}

/// Pictures of objects with their standard materials and with the toon material.
fn both(small: &mut Small, objects: &[Entity], light: ToonLight) -> (RgbaImage, RgbaImage) {
    small.headless.step(3);
    let standard = small.picture();
    for object in objects {
        let mut object = small.world().entity_mut(*object);
        object.insert(ToonScene::new(light.clone()));
    }
    small.headless.step(3);
    let toon = small.picture();
    (standard, toon)
}

/// The light in the middle of the picture.
fn middle(picture: &RgbaImage) -> Vec3 {
    let (x, y) = (picture.width() / 2, picture.height() / 2);
    Vec3::from_array(linear(picture, x, y).map(|c| c as f32))
}

fn ball(small: &mut Small) -> Entity {
    let at = Transform::from_xyz(0.0, 0.4, 0.0);
    let color = plain(Color::srgb(0.8, 0.7, 0.6));
    small.put(Sphere::new(1.6).mesh().uv(64, 32), color, at)
}

const SKY: [Vec3; 6] = [
    Vec3::splat(0.5),
    Vec3::splat(0.5),
    Vec3::new(0.7, 0.8, 1.0),
    Vec3::splat(0.2),
    Vec3::splat(0.5),
    Vec3::splat(0.5),
];

/// The light of environments as on the standard material.
fn smooth_light() -> ToonLight {
    ToonLight {
        flat_environment: 0.0,
        ..default()
    }
}

/// `flat_environment` 0 is the standard material's light; 1 has the two tones of the
/// brightest side and of the opposite one.
#[test]
fn an_environment_is_smooth_or_two_tones_with_its_mean() {
    let mut small = dark();
    let sky = environment(&mut small, SKY);
    small.insert(sky);
    let at = Transform::from_xyz(0.0, 0.4, 0.0);
    let ball = Sphere::new(1.6).mesh().uv(64, 32);
    let white = small.put(ball, plain(Color::WHITE), at);
    let (standard, smooth) = both(&mut small, &[white], smooth_light());
    assert!(apart(&standard, &smooth) <= 1);
    small.world().entity_mut(white).insert(ToonScene::default());
    small.headless.step(6);
    let flat = small.picture();
    // Along Y: the mean of all sides, more and less half the difference of two of them.
    let mean = SKY.iter().sum::<Vec3>() / 6.0;
    let half = 0.5 * (SKY[2] - SKY[3]);
    let (light, shade) = (mean + half, mean - half);
    let near = |tone: Vec3| {
        let is_near = |x, y| {
            let light = Vec3::from_array(linear(&flat, x, y).map(|c| c as f32));
            light.abs_diff_eq(tone.min(Vec3::ONE), 0.01)
        };
        flat.enumerate_pixels()
            .filter(|(x, y, _)| is_near(*x, *y))
            .count()
    };
    let background = flat.get_pixel(0, 0);
    let ball = flat.pixels().filter(|p| *p != background).count();
    let (lit, dark) = (near(light), near(shade));
    assert!(lit * 3 > ball && dark * 10 > ball, "{lit} {dark} of {ball}");
    // Besides the border, every pixel has one of the two tones.
    assert!((lit + dark) * 100 > ball * 90, "{lit} {dark} of {ball}");
    // Between the two, every pixel is. A code is up to 0.009 of linear light.
    let half = ToonLight {
        flat_environment: 0.5,
        ..default()
    };
    small.world().entity_mut(white).insert(ToonScene::new(half));
    small.headless.step(6);
    let between = small.picture();
    for (x, y, _) in between.enumerate_pixels() {
        let [smooth, flat, found] = [&smooth, &flat, &between].map(|of| linear(of, x, y));
        let off = (0..3).map(|c| (0.5 * (smooth[c] + flat[c]) - found[c]).abs());
        assert!(
            off.fold(0.0, f64::max) < 0.01,
            "({x}, {y}): {smooth:?} {flat:?} {found:?}"
        );
    }
    // The bright side is that of the environment: the middle of what is lit is on the screen where
    // the axis points.
    small.world().entity_mut(white).insert(ToonScene::default());
    let eye = small
        .camera_mut()
        .get::<Transform>()
        .copied()
        .expect("an eye");
    for (bright, axis) in [(0, Vec3::X), (1, -Vec3::X), (3, -Vec3::Y), (5, Vec3::Z)] {
        let mut colors = [Vec3::splat(0.3); 6];
        colors[bright] = Vec3::ONE;
        let sky = environment(&mut small, colors);
        small.insert(sky);
        small.headless.step(6);
        let picture = small.picture();
        let ball = picture
            .enumerate_pixels()
            .filter(|(_, _, pixel)| *pixel != background);
        let mut sums = [Vec3::ZERO; 2];
        for (x, y, _) in ball {
            let is_lit = linear(&picture, x, y)[0] > 0.5;
            sums[usize::from(is_lit)] += Vec3::new(x as f32, -(y as f32), 1.0);
        }
        let [shade, lit] = sums.map(|sum| sum / sum.z);
        let points = (eye.rotation.inverse() * axis).truncate().normalize();
        let turned = (lit - shade).truncate().normalize().dot(points);
        assert!(turned > 0.95, "{axis}: {shade}, {lit}, not along {points}");
    }
}

#[test]
fn volumes_light_as_on_the_standard_material() {
    let mut small = dark();
    let whole = Transform::from_scale(Vec3::splat(20.0));
    let voxels = image(&mut small, [1, 2, 3], &SKY);
    small.world().spawn((
        Object,
        LightProbe::default(),
        IrradianceVolume {
            voxels,
            intensity: 1.0 / exposure(),
            ..default()
        },
        whole,
    ));
    // Of a volume and an environment of the camera, the volume counts.
    let white = environment(&mut small, [Vec3::ONE; 6]);
    for white in [None, Some(white)] {
        if let Some(white) = white {
            small.insert(white);
        }
        let second = ball(&mut small);
        let (standard, toon) = both(&mut small, &[second], smooth_light());
        assert!(
            (0.1..0.55).contains(&middle(&toon).x),
            "{:?}",
            middle(&toon)
        );
        assert!(apart(&standard, &toon) <= 1);
        small.world().despawn(second);
    }
}

fn quad(size: f32) -> Mesh {
    let quad = Plane3d::new(Vec3::Z, Vec2::splat(0.5 * size));
    quad.mesh().build().with_generated_tangents().expect("UVs")
}

fn with_colors(mut mesh: Mesh) -> Mesh {
    let colors = (0..mesh.count_vertices())
        .map(|i| [1.0, 0.3 * i as f32, 0.4, 0.5])
        .collect();
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_COLOR,
        VertexAttributeValues::Float32x4(colors),
    );
    mesh
}

/// A normal map of 2x2 texels that lean to four sides.
fn normal_map(small: &mut Small) -> Handle<Image> {
    let data = [
        [200, 128, 220, 255],
        [60, 128, 220, 255],
        [128, 210, 210, 255],
        [128, 50, 210, 255],
    ];
    let size = Extent3d {
        width: 2,
        height: 2,
        ..default()
    };
    let (dimension, format) = (TextureDimension::D2, TextureFormat::Rgba8Unorm);
    let usage = RenderAssetUsages::RENDER_WORLD;
    let image = Image::new(size, dimension, data.concat(), format, usage);
    small.world().resource_mut::<Assets<Image>>().add(image)
}

/// Checks that under an environment alone, materials and meshes are drawn as the standard material
/// draws them: those of which `is_checked` says so, by name and fog.
fn check_materials(is_checked: impl Fn(&str, bool) -> bool) {
    let mut small = dark();
    let map = normal_map(&mut small);
    let color = Color::srgba(0.8, 0.7, 0.6, 0.5);
    let glow = LinearRgba::rgb(0.2, 0.1, 0.3);
    let blended = |alpha_mode| StandardMaterial {
        alpha_mode,
        ..plain(color)
    };
    let glowing = |base| StandardMaterial {
        emissive: glow,
        ..base
    };
    let bumpy = StandardMaterial {
        normal_map_texture: Some(map),
        ..plain(color)
    };
    let two_sided = StandardMaterial {
        double_sided: true,
        cull_mode: None,
        ..plain(color)
    };
    let [quad, colored] = [quad(3.0), with_colors(quad(3.0))];
    let cases = [
        ("vertex colors", &colored, plain(color)),
        ("normal map", &quad, bumpy),
        ("alpha mask", &colored, blended(AlphaMode::Mask(0.25))),
        ("blend", &quad, blended(AlphaMode::Blend)),
        ("premultiplied", &quad, blended(AlphaMode::Premultiplied)),
        ("add", &quad, blended(AlphaMode::Add)),
        ("opaque emission", &quad, glowing(plain(color))),
        (
            "transparent emission",
            &quad,
            glowing(blended(AlphaMode::Blend)),
        ),
        ("double-sided", &quad, two_sided),
    ];
    for fog in [false, true] {
        if fog {
            small.insert(DistanceFog {
                color: Color::srgb(0.9, 0.9, 1.0),
                falloff: FogFalloff::Linear {
                    start: 2.0,
                    end: 10.0,
                },
                ..default()
            });
        }
        let sky = environment(&mut small, SKY);
        small.insert(sky);
        for (name, mesh, material) in &cases {
            if !is_checked(name, fog) {
                continue;
            }
            let mut at = Transform::from_xyz(0.4, 0.6, 0.0);
            if *name == "double-sided" {
                at.rotate_y(2.6);
            }
            let object = small.put((*mesh).clone(), material.clone(), at);
            let (standard, toon) = both(&mut small, &[object], smooth_light());
            let far = apart(&standard, &toon);
            assert!(far <= 1, "{name}, fog {fog}: {far} codes");
            let mut plain_sky = toon.pixels().filter(|p| *p != toon.get_pixel(0, 0));
            assert!(plain_sky.next().is_some(), "{name} is drawn");
            small.world().despawn(object);
        }
    }
}

/// Vertices, textures and alpha.
#[test]
fn materials_are_those_of_the_standard_material() {
    check_materials(|name, fog| match name {
        "normal map" | "alpha mask" => !fog,
        "transparent emission" => fog,
        _ => false,
    });
}

/// All that materials and meshes can be, with and without fog.
#[test]
#[ignore = "long: every kind of material, with and without fog"]
fn all_materials_are_those_of_the_standard_material() {
    check_materials(|_, _| true);
}

/// Lights that are baked into a lightmap are not counted twice.
#[test]
fn a_lightmap_replaces_the_lights_that_are_baked_into_it() {
    let mut small = dark();
    let baked = 0.3 / exposure();
    let image = image(&mut small, [1, 1, 1], &[Vec3::splat(0.3)]);
    let mut mesh = Sphere::new(1.6).mesh().uv(32, 16);
    let uv = vec![[0.5f32, 0.5]; mesh.count_vertices()];
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, uv);
    let object = small.put(
        mesh,
        StandardMaterial {
            lightmap_exposure: baked / 0.3,
            ..plain(Color::WHITE)
        },
        Transform::from_xyz(0.0, 0.4, 0.0),
    );
    let lightmap = Lightmap {
        image,
        uv_rect: Rect::new(0.0, 0.0, 1.0, 1.0),
        bicubic_sampling: false,
    };
    let matte = ToonScene::new(ToonLight {
        falloff: 0.0,
        ..default()
    });
    small.world().entity_mut(object).insert((lightmap, matte));
    let (eye, center) = (Vec3::new(1.5, 2.4, 6.0), Vec3::new(0.0, 0.4, 0.0));
    let at = Transform::from_translation(eye).looking_at(center, Vec3::Y);
    let illuminance = 0.2 * std::f32::consts::PI / exposure();
    let distance = eye.distance(center) - 1.6;
    for (light_affects, ambient_affects, expected) in [
        (false, false, 0.3),
        (true, false, 0.5),
        (false, true, 0.4),
        (true, true, 0.6),
    ] {
        small.world().insert_resource(GlobalAmbientLight {
            brightness: 0.1 / exposure(),
            affects_lightmapped_meshes: ambient_affects,
            ..default()
        });
        let sun = DirectionalLight {
            illuminance,
            affects_lightmapped_mesh_diffuse: light_affects,
            ..default()
        };
        let lamp = PointLight {
            intensity: illuminance * 4.0 * std::f32::consts::PI * distance * distance,
            affects_lightmapped_mesh_diffuse: light_affects,
            ..default()
        };
        let world = small.world();
        let lights = [
            world.spawn((Object, sun, at)).id(),
            world.spawn((Object, lamp, at, Visibility::Hidden)).id(),
        ];
        for [shown, hidden] in [lights, [lights[1], lights[0]]] {
            let world = small.world();
            world.entity_mut(shown).insert(Visibility::Visible);
            world.entity_mut(hidden).insert(Visibility::Hidden);
            small.headless.step(6);
            let found = middle(&small.picture()).x;
            let what = format!("light {light_affects}, ambient {ambient_affects}");
            assert!(
                (found - expected).abs() < 0.01,
                "{what}: {found}, not {expected}"
            );
        }
        for light in lights {
            small.world().despawn(light);
        }
    }
    // It replaces the light of the surroundings, too.
    small.world().insert_resource(GlobalAmbientLight::NONE);
    let sky = environment(&mut small, SKY);
    small.insert(sky);
    small.headless.step(6);
    let found = middle(&small.picture()).x;
    assert!((found - 0.3).abs() < 0.01, "with an environment: {found}");
}

/// Below a rectangle, its light is what the integral says, in its middle and beside it, and fades
/// out towards its range as that of a lamp; the light ends at the plane of the rectangle.
#[test]
fn a_rect_light_lights_what_it_shines_at() {
    let mut small = dark();
    let (width, height, up) = (2.0f32, 1.0f32, 1.5f32);
    let wanted = 0.4;
    let ground = small.put(
        Plane3d::default().mesh().size(12.0, 12.0),
        plain(Color::WHITE),
        Transform::IDENTITY,
    );
    let light = ToonLight {
        falloff: 0.0,
        ..default()
    };
    (small.world().entity_mut(ground)).insert(ToonScene::new(light));
    small
        .insert(Transform::from_xyz(0.0, 1.2, 3.0).looking_at(Vec3::new(0.02, 0.0, 0.02), Vec3::Y));
    // Light at the ground from all points of the rectangle, of luminance 1.
    let [half_width, half_height] = [width, height].map(|size| 0.5 * f64::from(size));
    let [right, up_there] = [[half_width, 0.0, 0.0], [0.0, half_height, 0.0]];
    let vector = rect_light(right, up_there, [0.0, 0.0, up.into()], 200);
    let illuminance = std::f64::consts::PI * DVec3::from_array(vector).length();
    let luminance = wanted * std::f64::consts::PI / illuminance / f64::from(exposure());
    let light = RectLight {
        intensity: luminance as f32 * width * height * std::f32::consts::PI,
        width,
        height,
        range: 1000.0,
        ..default()
    };
    let at = Transform::from_xyz(0.0, up, 0.0);
    let lamp = small
        .world()
        .spawn((Object, light, at.looking_to(-Vec3::Y, Vec3::Z)))
        .id();
    small.headless.step(6);
    let found = middle(&small.picture()).x;
    assert!(
        (f64::from(found) - wanted).abs() < 0.01,
        "{found}, not {wanted}"
    );
    for ([x, z], range) in [
        ([1.3f32, 0.6], 1000.0),
        ([0.0, 0.0], 2.0),
        ([1.3, 0.6], 2.5),
    ] {
        let place = at
            .with_translation(Vec3::new(x, up, z))
            .looking_to(-Vec3::Y, Vec3::Z);
        small
            .world()
            .entity_mut(lamp)
            .insert((place, RectLight { range, ..light }));
        small.headless.step(6);
        let [x, z] = [x, z].map(|v| 0.02 - f64::from(v));
        let beside = rect_light(right, up_there, [x, z, up.into()], 200);
        let part = DVec3::from_array(beside).length() / DVec3::from_array(vector).length();
        let far = (x * x + z * z + f64::from(up * up)) / f64::from(range * range);
        let wanted = wanted * part * (1.0 - far * far).powi(2);
        let found = f64::from(middle(&small.picture()).x);
        assert!(
            (found - wanted).abs() < 0.01,
            "{x}, {z}, {range}: {found}, not {wanted}"
        );
    }
    // Turned around, it shines away from the ground.
    small
        .world()
        .entity_mut(lamp)
        .insert(at.looking_to(Vec3::Y, Vec3::Z));
    small.headless.step(6);
    assert!(middle(&small.picture()).x < 0.001);
}

/// A box on the ground has a shadow where it meets the ground, without shadow maps, and the
/// shadow stands still.
#[test]
fn contact_shadows_are_drawn_and_stand_still() {
    let mut small = dark_of(2 * size());
    let color = plain(Color::WHITE);
    let ground = small.put(
        Plane3d::default().mesh().size(12.0, 12.0),
        color.clone(),
        Transform::IDENTITY,
    );
    let block = small.put(
        Cuboid::new(1.0, 1.0, 1.0),
        color,
        Transform::from_xyz(0.0, 0.5, 0.0),
    );
    small.world().spawn((
        Object,
        DirectionalLight {
            illuminance: 0.5 * std::f32::consts::PI / exposure(),
            contact_shadows_enabled: true,
            ..default()
        },
        Transform::from_xyz(-1.0, 1.0, -0.4).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let (_, without) = both(&mut small, &[ground, block], ToonLight::default());
    small.insert(ContactShadows {
        thickness: 0.6,
        length: 0.6,
        ..default()
    });
    small.headless.step(6);
    let with = small.picture();
    let pairs = || without.pixels().zip(with.pixels());
    let lost = pairs()
        .filter(|(without, with)| without.0[0] > 150 && with.0[0] <= 150)
        .count();
    // It does not fade.
    let faded = pairs()
        .filter(|(without, with)| without != with && with.0[0] > 1)
        .count();
    assert_eq!(faded, 0);
    // The shadow reaches 0.41 and 0.16 units from two sides of the box: 0.6 square units,
    // at 550 pixels each and seen at a slant of 20 degrees.
    assert!((80..160).contains(&lost), "{lost} pixels in shadow");
    small.headless.step(1);
    assert_eq!(with, small.picture());
}
