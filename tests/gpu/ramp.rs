//! Ramps of the toon material: tones, their places, edges and shadows.

use bevy::{
    camera::visibility::RenderLayers, light::CascadeShadowConfigBuilder, mesh::PrimitiveTopology,
};
use image::RgbaImage;

use crate::prelude::*;

const SIZE: UVec2 = UVec2::new(160, 160);

const RED: Color = Color::linear_rgb(1.0, 0.0, 0.0);
const GREEN: Color = Color::linear_rgb(0.0, 1.0, 0.0);
const BLUE: Color = Color::linear_rgb(0.0, 0.0, 1.0);

pub const MODES: [RampMode; 3] = [
    RampMode::LightFraction,
    RampMode::PerLight,
    RampMode::Brightest,
];

/// Illuminance that makes white of white in a picture.
pub fn full() -> f32 {
    std::f32::consts::PI / Exposure::default().exposure()
}

/// An app without objects; the camera is at +Z and shows 2 units.
pub fn room(size: UVec2, ambient: f32) -> Small {
    let mut small = Small::new(size, Msaa::Off);
    small.clear();
    small.insert((
        Exposure::default(),
        Transform::from_xyz(0.0, 0.0, 5.0),
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 2.0,
            },
            ..OrthographicProjection::default_3d()
        }),
    ));
    small.world().insert_resource(GlobalAmbientLight {
        brightness: ambient * full() / std::f32::consts::PI,
        ..default()
    });
    small
}

pub fn sun(small: &mut Small, to: Vec3, light: DirectionalLight) -> Entity {
    let at = Transform::from_translation(to).looking_at(Vec3::ZERO, Vec3::Z);
    let shadows = CascadeShadowConfigBuilder {
        num_cascades: 1,
        maximum_distance: 16.0,
        ..default()
    };
    let bundle = (Object, light, at, shadows.build());
    small.world().spawn(bundle).id()
}

pub fn bright(part: f32) -> DirectionalLight {
    DirectionalLight {
        illuminance: part * full(),
        ..default()
    }
}

pub fn put(small: &mut Small, mesh: impl Into<Mesh>, light: &ToonLight, at: Transform) -> Entity {
    let material = ToonMaterial {
        base: StandardMaterial {
            base_color: Color::WHITE,
            perceptual_roughness: 1.0,
            ..default()
        },
        extension: light.clone(),
    };
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    let material = MeshMaterial3d(materials.add(material));
    small.put_shared(mesh, material, at)
}

pub fn with(ramp: Ramp) -> ToonLight {
    ToonLight {
        ramp: Some(ramp),
        falloff: 0.0,
        ..default()
    }
}

pub fn set_light(small: &mut Small, light: &ToonLight) {
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    let ids: Vec<_> = materials.ids().collect();
    for id in ids {
        materials.get_mut(id).expect("listed").extension = light.clone();
    }
}

/// The picture after a change. The engine knows one frame later how far the clusters of a new lamp
/// reach; suns are in none.
pub fn drawn(small: &mut Small) -> RgbaImage {
    let world = small.world();
    let mut lamps = world.query_filtered::<(), Or<(With<PointLight>, With<SpotLight>)>>();
    let has_lamps = lamps.iter(world).next().is_some();
    small.headless.step(if has_lamps { 3 } else { 2 });
    small.picture()
}

/// A ball and a box on a ground, under a sun and a lamp with shadows.
pub fn stage(light: &ToonLight) -> Small {
    let mut small = room(UVec2::new(240, 160), 0.1);
    small.insert((
        Transform::from_xyz(2.6, 3.4, 5.0).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y),
        Projection::Perspective(PerspectiveProjection::default()),
    ));
    let ground = Plane3d::default().mesh().size(12.0, 12.0);
    put(&mut small, ground, light, Transform::IDENTITY);
    let block = Transform::from_xyz(-0.7, 0.6, -0.3);
    put(&mut small, Cuboid::new(0.9, 1.2, 0.9), light, block);
    let ball = Sphere::new(0.7).mesh().uv(64, 32);
    put(&mut small, ball, light, Transform::from_xyz(0.8, 0.7, 0.4));
    let shadows = |light| DirectionalLight {
        shadow_maps_enabled: true,
        ..light
    };
    sun(&mut small, Vec3::new(-0.6, 1.0, 0.35), shadows(bright(0.4)));
    let lamp = PointLight {
        intensity: 400_000.0,
        range: 40.0,
        color: Color::srgb(1.0, 0.8, 0.6),
        shadow_maps_enabled: true,
        ..default()
    };
    let at = Transform::from_xyz(2.4, 3.0, 1.2);
    small.world().spawn((Object, lamp, at));
    small
}

/// Black, and white from `shadow_threshold`, for each light: the light without a ramp.
#[test]
fn two_stops_per_light_are_the_light_without_a_ramp() {
    let mut small = stage(&ToonLight::default());
    for (shadow_strength, form_shadows, cast_shadows) in [
        (1.0, true, true),
        (0.6, true, true),
        (1.0, false, true),
        (0.7, true, false),
    ] {
        let plain = ToonLight {
            shadow_strength,
            form_shadows,
            cast_shadows,
            ..default()
        };
        set_light(&mut small, &plain);
        let before = drawn(&mut small);
        let stops = [
            RampStop::new(0.0, Color::BLACK),
            RampStop::new(plain.shadow_threshold, Color::WHITE),
        ];
        let light = ToonLight {
            ramp: Some(Ramp {
                mode: RampMode::PerLight,
                ..Ramp::new(stops)
            }),
            ..plain
        };
        set_light(&mut small, &light);
        let far = apart(&before, &drawn(&mut small));
        assert!(far <= 1, "{light:?}: {far} codes");
    }
}

/// `LightFraction` without the strength of the light: the exposure changes nothing, nor does a
/// light that is divided in two.
#[test]
fn fractions_do_not_depend_on_the_exposure() {
    let light = ToonLight {
        falloff: 1.0,
        ..with(Ramp {
            keep_intensity: 0.0,
            ..Ramp::default()
        })
    };
    let mut small = stage(&light);
    let picture = drawn(&mut small);
    let tones: HashSet<_> = picture.pixels().collect();
    assert!(tones.len() > 8, "{} tones", tones.len());
    for factor in [0.01f32, 100.0] {
        small.insert(Exposure {
            ev100: Exposure::default().ev100 - factor.log2(),
        });
        let far = apart(&picture, &drawn(&mut small));
        assert!(far <= 1, "exposure x{factor}: {far} codes");
    }
    // A light that is divided in two: where the border of a shadow has two lights, it is that of
    // two shadows, so there are none here.
    small.insert(Exposure::default());
    let change = |small: &mut Small, change: fn(&mut DirectionalLight)| {
        let world = small.world();
        let mut suns = world.query::<&mut DirectionalLight>();
        let mut sun = suns.single_mut(world).expect("one");
        change(&mut sun);
        *sun
    };
    change(&mut small, |sun| sun.shadow_maps_enabled = false);
    let picture = drawn(&mut small);
    let half = change(&mut small, |sun| sun.illuminance *= 0.5);
    sun(&mut small, Vec3::new(-0.6, 1.0, 0.35), half);
    let far = apart(&picture, &drawn(&mut small));
    assert!(far <= 1, "divided: {far} codes");
}

/// Fractions of pixels nearest to black, red, green and blue, among those of the disc.
fn fractions(picture: &RgbaImage) -> [f64; 4] {
    let mut counts = [0usize; 4];
    let background = *picture.get_pixel(0, 0);
    let disc = picture
        .enumerate_pixels()
        .filter(|(.., pixel)| **pixel != background);
    for (x, y, _) in disc {
        let color = linear(picture, x, y);
        let largest = (0..3).fold(0, |k, c| if color[c] > color[k] { c } else { k });
        counts[if color[largest] < 0.5 { 0 } else { largest + 1 }] += 1;
    }
    let all: usize = counts.iter().sum();
    counts.map(|n| n as f64 / all as f64)
}

/// Checks that tones of a ball that begin at three places have the areas of its caps: rings around
/// the light, or segments. `light` gives the light of a mode that has black, red, green and blue.
pub fn check_caps(at: [f32; 3], light: impl Fn(&mut Small, RampMode) -> ToonLight) {
    let mut small = room(UVec2::splat(120), 0.0);
    let ball = Sphere::new(0.95).mesh().uv(128, 64);
    put(&mut small, ball, &ToonLight::default(), Transform::IDENTITY);
    let segment = |a: f64| (a.acos() - a * (1.0 - a * a).sqrt()) / std::f64::consts::PI;
    let ring = |a: f64| 1.0 - a * a;
    let cases: [(Vec3, &dyn Fn(f64) -> f64); 2] = [(Vec3::Z, &ring), (Vec3::X, &segment)];
    for (to, area) in cases {
        let lamp = sun(&mut small, to, bright(1.0));
        let above = at.map(|a| area(f64::from(a)));
        let wanted = [
            1.0 - above[0],
            above[0] - above[1],
            above[1] - above[2],
            above[2],
        ];
        for mode in MODES {
            let light = light(&mut small, mode);
            set_light(&mut small, &light);
            let found = fractions(&drawn(&mut small));
            for (found, wanted) in found.into_iter().zip(wanted) {
                let off = (found - wanted).abs();
                assert!(off < 0.01, "{mode:?}, {to}: {found}, not {wanted}");
            }
        }
        small.world().despawn(lamp);
    }
}

#[test]
fn tones_of_a_ball_have_the_areas_of_its_caps() {
    let at = [0.2, 0.5, 0.8];
    let stops = [
        RampStop::new(at[2], BLUE),
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(at[0], RED),
        RampStop::new(at[1], GREEN),
    ];
    check_caps(at, |_, mode| {
        with(Ramp {
            mode,
            blend: RampBlend::Absolute,
            keep_intensity: 1.0,
            ..Ramp::new(stops)
        })
    });
}

/// A square of 4 units whose normals lean from left to right: towards +X, the cosine is
/// t / sqrt(1 + t^2), with the place t from -1 to 1.
pub fn leaning() -> Mesh {
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let normal = |x: f32| [x.signum() * 0.5f32.sqrt(), 0.0, 0.5f32.sqrt()];
    let places = corners.map(|[x, y]| [x, y, 0.0f32]).to_vec();
    let normals = corners.map(|[x, _]| normal(x)).to_vec();
    Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_indices(Indices::U32(vec![0, 1, 2, 0, 2, 3]))
}

/// The view of [`check_edge`], of 16 pixels a unit.
pub const EDGE_SIZE: UVec2 = UVec2::new(64, 32);

/// Checks that, over 64 shifts of the leaning square by parts of a pixel, a row is white from where
/// the cosine is `at`, within `most` of a pixel, and exactly so in the mean.
pub fn check_edge(small: &mut Small, square: Entity, at: f64, most: f64) {
    let per_unit = 16.0;
    let edge = 2.0 * at / (1.0 - at * at).sqrt();
    let mut error = 0.0;
    for shift in 0..64 {
        let moved = f64::from(shift) / 64.0 / per_unit;
        let place = Transform::from_xyz(moved as f32, 0.0, 0.0);
        small.world().entity_mut(square).insert(place);
        small.headless.step(1);
        let picture = small.picture();
        // The first columns are black, or beside the square.
        let row: f64 = (4..EDGE_SIZE.x).map(|x| linear(&picture, x, 16)[0]).sum();
        let wanted = f64::from(EDGE_SIZE.x) / 2.0 - (edge + moved) * per_unit;
        assert!((row - wanted).abs() < most, "{row}, not {wanted}");
        error += (row - wanted) / 64.0;
    }
    assert!(error.abs() < 1.0 / 255.0, "{error} pixels");
}

#[test]
fn edges_of_tones_cover_what_they_should() {
    let stops = [
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(0.4, Color::WHITE),
    ];
    let ramp = Ramp {
        mode: RampMode::PerLight,
        blend: RampBlend::Absolute,
        ..Ramp::new(stops)
    };
    let mut small = room(EDGE_SIZE, 0.0);
    let square = put(&mut small, leaning(), &with(ramp), Transform::IDENTITY);
    sun(&mut small, Vec3::X, bright(1.0));
    small.headless.step(6);
    check_edge(&mut small, square, 0.4, 0.15);
}

/// Checks that the border of a shadow on a wall has no tone between light and shade. `light_of`
/// gives the light of a mode, with a ramp from black over red and green to white from 0.6 to 0.8
/// on.
pub fn check_borders(light_of: impl Fn(&mut Small, RampMode) -> ToonLight) {
    let mut small = room(SIZE, 0.0);
    let light = ToonLight::default();
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(4.0));
    put(&mut small, wall.mesh(), &light, Transform::IDENTITY);
    let ball = Transform::from_xyz(0.3, 0.2, 0.8);
    let ball = put(&mut small, Sphere::new(0.4).mesh().uv(64, 32), &light, ball);
    let to = Vec3::new(0.5, 0.3, 1.0);
    let lamp = DirectionalLight {
        shadow_maps_enabled: true,
        ..bright(1.0)
    };
    let lamp = sun(&mut small, to, lamp);
    // Of the ball, only its shadow is drawn.
    (small.world().entity_mut(ball)).insert(RenderLayers::layer(3));
    (small.world().entity_mut(lamp)).insert(RenderLayers::from_layers(&[0, 3]));
    for mode in MODES {
        let light = light_of(&mut small, mode);
        set_light(&mut small, &light);
        let picture = drawn(&mut small);
        let count = |is: fn(&[u8; 4]) -> bool| picture.pixels().filter(|p| is(&p.0)).count();
        let dark = count(|p| p[0] < 5);
        let mixed = count(|p| (10..245).contains(&p[0]));
        assert!(dark > 500 && mixed > 20, "{mode:?}: {dark}, {mixed}");
        assert_eq!(count(|p| p[0].abs_diff(p[1]) > 1), 0, "{mode:?}");
    }
}

#[test]
fn borders_of_shadows_have_no_bands() {
    let stops = [
        RampStop::new(0.0, Color::BLACK),
        RampStop::new(0.2, RED),
        RampStop::new(0.4, GREEN),
        RampStop::new(0.6, Color::WHITE),
    ];
    check_borders(|_, mode| {
        with(Ramp {
            mode,
            keep_intensity: 1.0,
            ..Ramp::new(stops)
        })
    });
}
