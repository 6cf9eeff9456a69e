//! The toon material: light, shadows against a ray cast, and the conversion of
//! scenes and back.

use bevy::{
    light::CascadeShadowConfigBuilder, material::OpaqueRendererMethod,
    pbr::DefaultOpaqueRendererMethod,
};

use crate::{
    hatched_material::{covers, light_from, plain, tone},
    line_scenes::mean,
    prelude::*,
    ramp::{put, room},
};

pub const SIZE: UVec2 = UVec2::new(240, 160);
/// The object that casts the shadow: an axis-aligned box on the ground.
pub const LOW: Vec3 = Vec3::new(-0.6, 0.0, -0.5);
pub const HIGH: Vec3 = Vec3::new(0.5, 1.4, 0.6);

pub enum Kind {
    Sun(Vec3),
    Lamp(Vec3),
    Spot(Vec3, Vec3),
}

pub struct Stage {
    pub small: Small,
    pub ground: Entity,
    eye: Transform,
    projection: PerspectiveProjection,
}

pub fn material(small: &mut Small, light: ToonLight) -> MeshMaterial3d<ToonMaterial> {
    let base = StandardMaterial {
        base_color: Color::WHITE,
        perceptual_roughness: 1.0,
        ..default()
    };
    let material = ToonMaterial {
        base,
        extension: light,
    };
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    MeshMaterial3d(materials.add(material))
}

/// Ground, box and one light. Outlines that are nearly invisible request the ids.
pub fn stage(light: &Kind, msaa: Msaa) -> Stage {
    stage_in(Small::new(SIZE, msaa), light)
}

impl Stage {
    /// Another stage in the same app.
    pub fn again(self, light: &Kind, msaa: Msaa) -> Self {
        let mut small = self.small;
        small.restart(msaa);
        stage_in(small, light)
    }
}

fn stage_in(mut small: Small, light: &Kind) -> Stage {
    small.clear();
    let white = material(
        &mut small,
        ToonLight {
            // No rings in the light, so that every lit pixel has one color.
            falloff: 0.0,
            ..default()
        },
    );
    let ground = Plane3d::default().mesh().size(12.0, 12.0);
    let ground = small.put_shared(ground, white.clone(), Transform::IDENTITY);
    let middle = Transform::from_translation((LOW + HIGH) / 2.0);
    small.put_shared(Cuboid::from_size(HIGH - LOW), white, middle);
    let world = small.world();
    world.insert_resource(GlobalAmbientLight {
        brightness: 100.0,
        ..default()
    });
    match *light {
        Kind::Sun(to) => {
            let sun = DirectionalLight {
                illuminance: 1500.0,
                shadow_maps_enabled: true,
                ..default()
            };
            let cascades = CascadeShadowConfigBuilder {
                num_cascades: 1,
                maximum_distance: 16.0,
                ..default()
            };
            let at = Transform::from_translation(to).looking_at(Vec3::ZERO, Vec3::Y);
            world.spawn((Object, sun, at, cascades.build()));
        }
        Kind::Lamp(at) => {
            let lamp = PointLight {
                intensity: 600_000.0,
                range: 40.0,
                shadow_maps_enabled: true,
                ..default()
            };
            world.spawn((Object, lamp, Transform::from_translation(at)));
        }
        Kind::Spot(at, to) => {
            let spot = SpotLight {
                intensity: 900_000.0,
                range: 40.0,
                outer_angle: 1.0,
                inner_angle: 0.95,
                shadow_maps_enabled: true,
                ..default()
            };
            let at = Transform::from_translation(at).looking_at(to, Vec3::Y);
            world.spawn((Object, spot, at));
        }
    }
    let eye = Transform::from_xyz(2.6, 3.4, 5.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y);
    let projection = PerspectiveProjection {
        near: 0.1,
        far: 100.0,
        ..default()
    };
    let camera = small.camera;
    small.world().entity_mut(camera).insert((
        eye,
        Projection::Perspective(projection.clone()),
        Exposure::default(),
        VisibleDepthRange::default(),
        Outlines {
            silhouettes: None,
            creases: None,
            objects: Some(ObjectEdges {
                color: Color::WHITE,
                opacity: 1e-6,
            }),
            ..default()
        },
    ));
    small.headless.step(3);
    Stage {
        small,
        ground,
        eye,
        projection,
    }
}

/// Where the ray through a place of the picture, in pixels, meets the ground.
pub fn ground_point_at(stage: &Stage, at: Vec2) -> Option<Vec3> {
    let size = SIZE.as_vec2();
    let ndc = at / size * 2.0 - 1.0;
    let tan = (0.5 * stage.projection.fov).tan();
    let direction =
        stage.eye.rotation * Vec3::new(ndc.x * tan * size.x / size.y, -ndc.y * tan, -1.0);
    let t = -stage.eye.translation.y / direction.y;
    (t > 0.0).then(|| stage.eye.translation + direction * t)
}

/// Whether a segment from the ground towards the light meets the box.
pub fn blocked(from: Vec3, to: Vec3, low: Vec3, high: Vec3) -> bool {
    let d = to - from;
    let (mut enter, mut leave) = (0.0f32, 1.0f32);
    for i in 0..3 {
        let (a, b) = ((low[i] - from[i]) / d[i], (high[i] - from[i]) / d[i]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    enter < leave
}

/// The fraction of ground pixels whose shadow differs from the ray cast, among
/// those farther than `texel` from its border; and their number.
fn wrong_fraction(stage: &mut Stage, light: &Kind, texel: f32) -> (f64, usize, usize) {
    let ids = stage.small.object_ids().expect("ids are drawn");
    let (_, picture) = stage.small.pass();
    let id = stage.small.id_of(stage.ground);
    let (mut wrong, mut looked, mut dark) = (0, 0, 0);
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let i = (y * SIZE.x + x) as usize;
            if ids.pixels[i][0] != id {
                continue;
            }
            let at = Vec2::new(x as f32, y as f32) + 0.5;
            let Some(point) = ground_point_at(stage, at) else {
                continue;
            };
            let towards = match *light {
                Kind::Sun(to) => point + to.normalize() * 50.0,
                Kind::Lamp(at) => at,
                // Dark outside the cone; near its rim, either is right.
                Kind::Spot(at, to) if (to - at).angle_between(point - at) > 0.9 => continue,
                Kind::Spot(at, _) => at,
            };
            let grow = Vec3::splat(texel);
            let large = blocked(point, towards, LOW - grow, HIGH + grow);
            let little = blocked(point, towards, LOW + grow, HIGH - grow);
            if large != little {
                continue;
            }
            looked += 1;
            dark += usize::from(large);
            // Ambient light alone gives 100 / 1000 / pi; each light gives far more.
            let light_here = picture.pixels[i][1];
            let shaded = light_here < 0.16;
            wrong += usize::from(shaded != large);
        }
    }
    (wrong as f64 / looked.max(1) as f64, looked, dark)
}

/// Checks shadows with these numbers of samples against rays, in one app.
fn check_shadows(samples: &[Msaa]) {
    let lights = [
        ("sun", Kind::Sun(Vec3::new(-0.6, 1.0, 0.35)), 16.0 / 2048.0),
        ("lamp", Kind::Lamp(Vec3::new(-1.8, 3.0, 1.2)), 0.012),
        (
            "spot",
            Kind::Spot(Vec3::new(-2.0, 3.4, 1.0), Vec3::new(0.3, 0.0, -0.2)),
            0.012,
        ),
    ];
    let mut stage = stage(&lights[0].1, samples[0]);
    for msaa in samples.iter().copied() {
        for (name, light, texel) in &lights {
            stage = stage.again(light, msaa);
            // A shadow texel on the ground, seen at a slant, and half the filter.
            let (fraction, looked, dark) = wrong_fraction(&mut stage, light, 2.0 * texel);
            println!(
                "{name}, {msaa:?}: {:.3} % of {looked} wrong, {dark} in shadow",
                100.0 * fraction
            );
            assert!(
                dark > 500 && looked > dark + 5000,
                "{name}: {looked}, {dark}"
            );
            assert!(fraction <= 0.002, "{name}, {msaa:?}: {fraction}");
        }
    }
}

/// The cast shadow that [CL] draws in the wrong place (its Figure 10).
#[test]
fn cast_shadows_are_where_a_ray_cast_puts_them() {
    check_shadows(&[Msaa::Off]);
}

#[test]
fn multisampled_shadows_are_where_a_ray_cast_puts_them() {
    check_shadows(&[Msaa::Sample4]);
}

/// No shadow acne on a curved surface: what faces the light is lit everywhere.
#[test]
fn a_sphere_is_lit_on_one_side_and_dark_on_the_other() {
    let lights = [
        Kind::Sun(Vec3::new(-0.7, 0.6, 0.6)),
        Kind::Lamp(Vec3::new(-3.0, 2.6, 2.6)),
        Kind::Spot(Vec3::new(-3.0, 2.6, 2.6), Vec3::ZERO),
    ];
    let mut stage = stage(&lights[0], Msaa::Off);
    for light in lights {
        stage = stage.again(&light, Msaa::Off);
        let world = stage.small.world();
        let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
        for mesh in meshes.iter(world).collect::<Vec<_>>() {
            world.despawn(mesh);
        }
        let matte = ToonLight {
            falloff: 0.0,
            highlight: 0.0,
            ..default()
        };
        let white = material(&mut stage.small, matte);
        let ball = Sphere::new(1.0).mesh().uv(96, 48);
        let ball = stage.small.put_shared(ball, white, Transform::IDENTITY);
        stage.small.insert(NormalPrepass);
        stage.small.headless.step(4);
        let normals = stage.small.normals().expect("a normal prepass");
        let ids = stage.small.object_ids().expect("drawn");
        let (_, picture) = stage.small.pass();
        let (mut wrong, mut lit, mut dark) = (0, 0, 0);
        for (i, n) in normals.pixels.iter().enumerate() {
            if ids.pixels[i][0] != stage.small.id_of(ball) {
                continue;
            }
            let n = Vec3::new(n[0], n[1], n[2]);
            // The normal of a unit sphere is the position.
            let towards = match light {
                Kind::Sun(to) => to.normalize(),
                Kind::Lamp(at) | Kind::Spot(at, _) => (at - n).normalize(),
            };
            let cosine = n.dot(towards);
            // The default `shadow_threshold` is 0.08; ten bits and a pixel blur it.
            if (cosine - 0.08).abs() < 0.05 {
                continue;
            }
            let bright = picture.pixels[i][1] > 0.16;
            wrong += usize::from(bright != (cosine > 0.08));
            lit += usize::from(bright);
            dark += usize::from(!bright);
        }
        assert!(lit > 1000 && dark > 500, "{lit} {dark}");
        // The center of a pixel at the rim may lie off the sphere.
        assert!(wrong * 1000 <= lit + dark, "{wrong} of {}", lit + dark);
    }
}

fn picture_of(small: &mut Small) -> image::RgbaImage {
    small.headless.step(4);
    small.picture()
}

/// Whether a mesh has the toon material; it has one of the two.
fn is_toon(small: &mut Small, mesh: Entity) -> bool {
    let mesh = small.world().entity(mesh);
    let is_toon = mesh.contains::<MeshMaterial3d<ToonMaterial>>();
    assert_ne!(is_toon, mesh.contains::<MeshMaterial3d<StandardMaterial>>());
    is_toon
}

fn set_color(small: &mut Small, material: AssetId<StandardMaterial>, color: Color) {
    let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
    materials.get_mut(material).expect("listed").base_color = color;
}

#[test]
fn a_scene_is_converted_with_one_component_and_back() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let world = small.world();
    let root = world.spawn((Transform::default(), Visibility::default()));
    let root = root.id();
    let mut parts = world.query_filtered::<Entity, With<Object>>();
    let parts: Vec<Entity> = parts.iter(world).collect();
    world.entity_mut(root).add_children(&parts);
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    for (_, material) in materials.iter_mut() {
        material.unlit = false;
    }
    let first = world.get::<MeshMaterial3d<StandardMaterial>>(parts[0]);
    let first = first.expect("a material").id();
    world.spawn((
        DirectionalLight::default(),
        Transform::from_xyz(1.0, 2.0, 1.5).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let standard = picture_of(&mut small);
    small.world().entity_mut(root).insert(ToonScene::default());
    let toon = picture_of(&mut small);
    assert_ne!(standard, toon);
    assert!(parts.iter().all(|part| is_toon(&mut small, *part)));
    // Changes of the original material and of the settings reach the copy.
    let changed = Color::srgb(0.1, 0.9, 0.9);
    set_color(&mut small, first, changed);
    assert_ne!(picture_of(&mut small), toon);
    let copies = small.world().resource::<Assets<ToonMaterial>>();
    assert!(
        copies
            .iter()
            .any(|(_, copy)| copy.base.base_color == changed)
    );
    let light = ToonLight {
        shadow_threshold: 0.5,
        ..default()
    };
    (small.world().entity_mut(root)).insert(ToonScene::new(light));
    small.headless.step(2);
    let copies = small.world().resource::<Assets<ToonMaterial>>();
    assert!(
        copies
            .iter()
            .all(|(_, copy)| copy.extension.shadow_threshold == 0.5)
    );
    // A part that is added later is converted as well.
    let late = small.put(Cuboid::default(), Color::WHITE.into(), default());
    small.world().entity_mut(late).insert(ChildOf(root));
    small.headless.step(2);
    assert!(is_toon(&mut small, late));
    small.world().despawn(late);
    small.world().entity_mut(root).remove::<ToonScene>();
    set_color(&mut small, first, Color::srgb(0.85, 0.2, 0.15));
    assert!(
        picture_of(&mut small) == standard,
        "the standard picture is back"
    );
    assert!(parts.iter().all(|part| !is_toon(&mut small, *part)));
}

/// Toon meshes are drawn forward on a deferred camera, beside meshes that are not: the same
/// picture.
#[test]
fn a_deferred_camera_draws_the_same_toon() {
    let sun = Kind::Sun(Vec3::new(-0.6, 1.0, 0.35));
    // Materials are made for one of the two methods.
    let put_matte = |stage: &mut Stage| {
        let matte = StandardMaterial {
            base_color: Color::srgb(0.8, 0.4, 0.2),
            perceptual_roughness: 1.0,
            reflectance: 0.0,
            ..default()
        };
        let at = Transform::from_xyz(1.4, 0.5, 1.6);
        stage.small.put(Cuboid::from_length(1.0), matte, at)
    };
    let mut stage = stage(&sun, Msaa::Off);
    let matte = put_matte(&mut stage);
    let forward = picture_of(&mut stage.small);
    stage.small.world().despawn(matte);
    stage.small.insert((DepthPrepass, DeferredPrepass));
    (stage.small.world()).insert_resource(DefaultOpaqueRendererMethod::deferred());
    // A material that requests the deferred pass is drawn forward.
    let mut materials = stage.small.world().resource_mut::<Assets<ToonMaterial>>();
    for (_, material) in materials.iter_mut() {
        material.base.opaque_render_method = OpaqueRendererMethod::Deferred;
    }
    put_matte(&mut stage);
    let deferred = picture_of(&mut stage.small);
    let apart = differ(&forward, &deferred, 2);
    assert!(
        apart * 200 < forward.pixels().len(),
        "{apart} pixels differ"
    );
}

/// Strokes of the page on a material have the tone of its light, and are drawn anew at their rate.
#[test]
fn strokes_of_the_page_are_redrawn_at_their_rate() {
    let strokes = Hatching {
        anchor: HatchingAnchor::Page,
        rate: 10.0,
        breaks: 1.0,
        wobble: 1.0,
        pressure: 0.5,
        ..plain()
    };
    let light = ToonLight {
        hatching: Some(strokes),
        ..default()
    };
    let mut small = room(UVec2::splat(160), 0.0);
    light_from(&mut small, Vec3::Z, 0.3);
    light_from(&mut small, -Vec3::Z, 0.6);
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
    put(&mut small, wall, &light, Transform::IDENTITY);
    let (got, want) = (mean(&covers(&mut small)), tone(&strokes, 1.0 / 3.0));
    assert!((got - want).abs() < 0.04, "{got}, {want}");
    let pictures: Vec<image::RgbaImage> = (0..13)
        .map(|_| {
            small.headless.step(1);
            small.picture()
        })
        .collect();
    // Six frames last a tenth of a second.
    let changes = pictures
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .count();
    assert_eq!(changes, 2);
}
