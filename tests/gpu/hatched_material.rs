//! Strokes on the toon material: `hatch_light.wgsl`, and `vertex.wgsl`, which outputs positions of the mesh at rest.

use bevy::{light::DirectionalLightShadowMap, mesh::morph::MorphAttributes};
use bevy_comics_testkit::reference::hatching::Hatch;
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{apart, bright, drawn, full, put, room, set_light, sun},
};

pub const SIZE: UVec2 = UVec2::new(160, 160);

/// Black strokes on white paper.
fn inked() -> Hatching {
    Hatching {
        ground: HatchingGround::Paper,
        ..default()
    }
}

/// The same without what is random, with a tone for every lightness.
pub fn plain() -> Hatching {
    Hatching {
        breaks: 0.0,
        wobble: 0.0,
        pressure: 0.0,
        shadows: 0.0,
        highlights: 1.0,
        ..inked()
    }
}

fn with(hatching: Hatching) -> ToonLight {
    ToonLight {
        hatching: Some(hatching),
        ..default()
    }
}

/// Darkness of every pixel: 0 paper, 1 ink.
pub fn covers(small: &mut Small) -> Vec<f64> {
    let picture = drawn(small);
    let places = (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
    places
        .map(|(x, y)| 1.0 - linear(&picture, x, y)[0])
        .collect()
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Pixels that differ by more than two codes of a display of linear light.
pub fn differ(a: &[f64], b: &[f64]) -> usize {
    let pairs = a.iter().zip(b);
    pairs.filter(|(a, b)| (*a - *b).abs() > 2.0 / 255.0).count()
}

/// A sun that shines along an axis of a frame, without shadow maps.
pub fn light_from(small: &mut Small, frame: Transform, to: Vec3, part: f32) -> Entity {
    let at = frame * Transform::IDENTITY.looking_to(-to, Vec3::new(0.1, 0.9, 0.2));
    let bundle = (Object, bright(part), at);
    small.world().spawn(bundle).id()
}

pub fn tone(hatching: &Hatching, share: f64) -> f64 {
    let hatch = Hatch {
        settings: hatching,
        scale: 1.0,
        drawing: 0,
    };
    hatch.tone(share.sqrt()) * f64::from(hatching.at_near)
}

/// Light from the front, from behind, and from all around.
const LIGHT: [[f32; 3]; 3] = [[0.3, 0.9, 0.0], [0.6, 0.4, 0.0], [0.0, 0.6, 0.2]];

fn ambient(part: f32) -> GlobalAmbientLight {
    GlobalAmbientLight {
        brightness: part * full() / std::f32::consts::PI,
        ..default()
    }
}

/// Truth: a flat wall on which a share of all light arrives has the darkness that this share asks for, at
/// every angle, with one layer and with three.
#[test]
fn flat_walls_have_the_tone_of_their_light() {
    let [back, front, around] = LIGHT;
    walls_have_the_tone_of_their_light(&[(back, &[0.0]), (front, &[35.0]), (around, &[60.0])]);
}

#[test]
#[ignore = "long: every angle under every light"]
fn flat_walls_have_the_tone_of_every_light() {
    walls_have_the_tone_of_their_light(&LIGHT.map(|light| (light, &[0.0, 35.0, 60.0][..])));
}

/// `walls`: their light, and their angles in degrees.
fn walls_have_the_tone_of_their_light(walls: &[([f32; 3], &[f32])]) {
    let mut worst = [0.0f64; 2];
    let mut small = room(SIZE, 0.0);
    for &([front, behind, around], angles) in walls {
        let share = f64::from((front + around) / (front + behind + around));
        small.world().insert_resource(ambient(around));
        for degrees in angles {
            small.clear();
            light_from(&mut small, Transform::IDENTITY, Vec3::Z, front);
            light_from(&mut small, Transform::IDENTITY, -Vec3::Z, behind);
            let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
            let axis = Vec3::new(0.6, 0.8, 0.0);
            // Lines at 45 degrees would all lie in the same way on pixels.
            let roll = Quat::from_rotation_z(0.2);
            let turn = Quat::from_axis_angle(axis, degrees.to_radians()) * roll;
            let at = Transform::from_rotation(turn);
            put(&mut small, wall, &ToonLight::default(), at);
            for layers in [1, 3] {
                for (random, worst) in [0.0, 1.0].into_iter().zip(&mut worst) {
                    let s = Hatching {
                        layers,
                        breaks: random,
                        wobble: random,
                        pressure: 0.5 * random,
                        at_near: 1.0 - 0.2 * random,
                        ..plain()
                    };
                    set_light(&mut small, &with(s));
                    let (got, want) = (mean(&covers(&mut small)), tone(&s, share));
                    println!(
                        "share {share:.2}, {degrees} degrees, {layers} layers, random {random}: {got:.3}, {want:.3}"
                    );
                    *worst = worst.max((got - want).abs());
                }
            }
        }
    }
    println!("mean tone off by up to {worst:.3?}");
    assert!(worst[0] < 0.02 && worst[1] < 0.04, "{worst:?}");
}

/// Every mode of a ramp gives the share of what the same ramp gives where all light arrives.
#[test]
fn strokes_follow_the_tones_of_ramps() {
    let grey = |part| Color::linear_rgb(part, part, part);
    let mut small = room(SIZE, 0.0);
    for mode in [
        RampMode::LightFraction,
        RampMode::PerLight,
        RampMode::Brightest,
    ] {
        small.clear();
        // 60 degrees from the normal.
        let to = Vec3::new(0.0, 0.75f32.sqrt(), 0.5);
        light_from(&mut small, Transform::IDENTITY, to, 0.8);
        let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
        let stops = [
            RampStop::new(0.0, Color::BLACK),
            RampStop::new(0.3, grey(0.3)),
            RampStop::new(0.7, grey(0.9)),
        ];
        let light = ToonLight {
            ramp: Some(Ramp {
                mode,
                ..Ramp::new(stops)
            }),
            ..with(plain())
        };
        put(&mut small, wall, &light, Transform::IDENTITY);
        let (got, want) = (mean(&covers(&mut small)), tone(&plain(), 0.3 / 0.9));
        println!("{mode:?}: {got:.3}, {want:.3}");
        assert!((got - want).abs() < 0.02, "{mode:?}: {got}, {want}");
    }
}

/// The places that a rigid motion takes things to.
pub fn frames() -> [Transform; 3] {
    let turn = Quat::from_euler(EulerRot::YXZ, 0.7, -0.3, 1.1);
    [
        Transform::from_xyz(0.4, -1.3, 2.9),
        Transform::from_rotation(turn),
        Transform::from_xyz(31.7, -8.3, 102.9).with_rotation(turn),
    ]
}

fn ball() -> Mesh {
    Sphere::new(0.8).mesh().uv(64, 32)
}

/// The eye and the light of the pictures below, in a frame.
pub fn seen_from(small: &mut Small, frame: Transform, sun: Entity) {
    small.insert(frame * Transform::from_xyz(0.0, 0.0, 5.0));
    let to = Vec3::new(0.5, 0.6, 0.7);
    let at = frame * Transform::IDENTITY.looking_to(-to, Vec3::Y);
    small.world().entity_mut(sun).insert(at);
}

/// An empty white room with a sun, and a seventh of the light from all around.
pub fn studio() -> (Small, Entity) {
    let mut small = room(SIZE, 0.1);
    small.insert(Camera {
        clear_color: Color::WHITE.into(),
        ..default()
    });
    let sun = light_from(&mut small, Transform::IDENTITY, Vec3::Z, 0.6);
    seen_from(&mut small, Transform::IDENTITY, sun);
    (small, sun)
}

/// Where all of it is seen, edges of the light and the mesh may round to another pixel.
pub fn assert_same(still: &[f64], now: &[f64], what: &str) {
    assert!(still.iter().any(|c| *c > 0.9), "{what}: no ink");
    let apart = differ(still, now);
    println!("{what}: {apart} of {} pixels differ", still.len());
    assert!(apart < still.len() / 200, "{what}: {apart}");
}

/// Truth: strokes stay on a mesh that moves, turns and is stretched: the camera that follows sees the same
/// picture. Strokes of the page do not.
#[test]
fn strokes_stay_on_what_moves() {
    let (mut small, sun) = studio();
    let own =
        Transform::from_rotation(Quat::from_rotation_x(0.4)).with_scale(Vec3::new(1.2, 0.7, 1.0));
    let object = put(&mut small, ball(), &with(inked()), own);
    let still = covers(&mut small);
    for frame in frames() {
        small.world().entity_mut(object).insert(frame * own);
        seen_from(&mut small, frame, sun);
        assert_same(&still, &covers(&mut small), "moved");
    }
    // Strokes lie in the mesh: seen from elsewhere, they are elsewhere in the picture.
    small.world().entity_mut(object).insert(own);
    let turned = covers(&mut small);
    assert!(differ(&still, &turned) > still.len() / 20);
}

/// Truth: strokes stay on a skinned mesh, whatever its entity does.
#[test]
fn strokes_stay_on_skinned_meshes() {
    let (mut small, sun) = studio();
    // Prepasses have a vertex shader of their own: both must give the same depth.
    small.insert((DepthPrepass, NormalPrepass));
    let mut mesh = ball();
    let count = mesh.count_vertices();
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(vec![[0; 4]; count]),
    );
    let weights = vec![[1.0, 0.0, 0.0, 0.0]; count];
    mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights);
    let plain = put(&mut small, ball(), &with(inked()), Transform::IDENTITY);
    let still = covers(&mut small);
    small.world().despawn(plain);
    let object = put(&mut small, mesh, &with(inked()), Transform::IDENTITY);
    let world = small.world();
    let poses = SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY]);
    let inverse_bindposes = world
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
        .add(poses);
    let joint = world.spawn(Transform::IDENTITY).id();
    world.entity_mut(object).insert((
        SkinnedMesh {
            inverse_bindposes,
            joints: vec![joint],
        },
        bevy::camera::visibility::NoFrustumCulling,
    ));
    for (k, frame) in frames().into_iter().enumerate() {
        small.world().entity_mut(joint).insert(frame);
        let aside = Transform::from_xyz(k as f32, 0.0, 0.0);
        small.world().entity_mut(object).insert(aside);
        seen_from(&mut small, frame, sun);
        assert_same(&still, &covers(&mut small), "skinned");
    }
}

/// Truth: strokes stay on a morphed mesh.
#[test]
fn strokes_stay_on_morphed_meshes() {
    let (mut small, sun) = studio();
    let by = Vec3::new(0.9, -0.6, 0.4);
    let mut mesh = ball();
    let count = mesh.count_vertices();
    mesh.set_morph_targets(vec![
        MorphAttributes {
            position: by,
            ..default()
        };
        count
    ]);
    let plain = put(&mut small, ball(), &with(inked()), Transform::IDENTITY);
    let still = covers(&mut small);
    small.world().despawn(plain);
    let object = put(&mut small, mesh, &with(inked()), Transform::IDENTITY);
    for weight in [0.0, 0.5, 1.0] {
        small.world().entity_mut(object).insert((
            MorphWeights::new(vec![weight], None).expect("one weight"),
            MeshMorphWeights::Value {
                weights: vec![weight],
            },
            bevy::camera::visibility::NoFrustumCulling,
        ));
        seen_from(&mut small, Transform::from_translation(weight * by), sun);
        assert_same(&still, &covers(&mut small), "morphed");
    }
}

/// Shadows of other things are hatched, with the tone of the light that is left.
#[test]
fn cast_shadows_are_hatched() {
    let mut small = room(SIZE, 0.2);
    // A texel is a hundredth of the picture.
    let map = DirectionalLightShadowMap { size: 1024 };
    small.world().insert_resource(map);
    let shadows = DirectionalLight {
        shadow_maps_enabled: true,
        ..bright(0.6)
    };
    sun(&mut small, Vec3::new(0.0, 0.6, 1.0), shadows);
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
    put(&mut small, wall, &with(plain()), Transform::IDENTITY);
    // Its shadow covers the lower part of the picture; itself it is above.
    let above = Transform::from_xyz(0.0, 2.3, 3.0);
    put(
        &mut small,
        Cuboid::new(9.0, 2.0, 0.2),
        &with(plain()),
        above,
    );
    let found = covers(&mut small);
    let rows = |rows: Range<u32>| {
        let range = (rows.start * SIZE.x) as usize..(rows.end * SIZE.x) as usize;
        mean(&found[range])
    };
    // The shadow reaches from 1.5 to -0.5: rows 0 to 120.
    let (dark, light) = (rows(10..110), rows(130..160));
    let want = tone(&plain(), 0.25);
    println!("shadow {dark:.3}, not {want:.3}; light {light:.3}");
    assert!((dark - want).abs() < 0.03, "{dark}, {want}");
    assert!(light < 0.01, "{light}");
}

/// A material without strokes is what it was, to the bit, also if they are not seen.
#[test]
fn no_strokes_change_nothing() {
    let (mut small, _) = studio();
    put(
        &mut small,
        ball(),
        &ToonLight::default(),
        Transform::IDENTITY,
    );
    let before = drawn(&mut small);
    let unseen = Hatching {
        opacity: 0.0,
        ..default()
    };
    set_light(&mut small, &with(unseen));
    assert_eq!(apart(&before, &drawn(&mut small)), 0);
    // Where all light arrives, there are none.
    let lit = |picture: &RgbaImage, x: u32, y: u32| *picture.get_pixel(x, y);
    set_light(&mut small, &with(default()));
    let after = drawn(&mut small);
    assert_eq!(lit(&before, 95, 60), lit(&after, 95, 60));
    assert!(apart(&before, &after) > 50);
}

/// The colour between strokes keeps the mean of a shade.
#[test]
fn shades_keep_their_mean_colour() {
    let mut small = room(SIZE, 0.2);
    light_from(&mut small, Transform::IDENTITY, -Vec3::Z, 0.6);
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
    put(&mut small, wall, &ToonLight::default(), Transform::IDENTITY);
    let bare = mean(&covers(&mut small));
    let s = Hatching {
        ground: HatchingGround::Color,
        ..plain()
    };
    set_light(&mut small, &with(s));
    let found = covers(&mut small);
    let hatched = mean(&found);
    assert!((bare - hatched).abs() < 0.02, "{bare}, {hatched}");
    assert!(found.iter().any(|c| *c > 0.99), "no ink");
}

/// Every pixel is a number, whatever the settings and the mesh are.
#[test]
fn extreme_strokes_are_finite() {
    let (mut small, _) = studio();
    small.headless.resize(UVec2::splat(48), 1.0);
    let target = small.headless.render_target();
    small.insert((Hdr, target));
    small.style(&ComicStyle::new().with(Vignette::default()));
    let mut bare = ball();
    bare.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
    bare.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    let mut flat = ball();
    let count = flat.count_vertices();
    flat.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0; 3]; count]);
    for (x, mesh) in [(-0.4, ball()), (0.0, bare), (0.4, flat)] {
        let at = Transform::from_xyz(x, 0.0, 0.0);
        put(&mut small, mesh, &ToonLight::default(), at);
    }
    let squashed = Transform::from_scale(Vec3::new(1.0, 0.0, 1e-20));
    put(&mut small, ball(), &ToonLight::default(), squashed);
    for x in [f32::NAN, f32::INFINITY, -1e30, 0.0, 1e30] {
        for anchor in [HatchingAnchor::Object, HatchingAnchor::Page] {
            let s = Hatching {
                anchor,
                shadows: x,
                highlights: x,
                gamma: x,
                tones: u32::MAX,
                spacing: x,
                layers: 99,
                layer_darkness: x,
                angle: x,
                length: x,
                breaks: x,
                wobble: x,
                pressure: x,
                rate: x,
                at_near: x,
                ..default()
            };
            set_light(&mut small, &with(s));
            small.headless.step(3);
            let found = small.loaded();
            let all = found.pixels.iter().flatten();
            assert!(all.into_iter().all(|c| c.is_finite()), "{x}, {anchor:?}");
        }
    }
    assert_eq!(small.errors(), 0);
}
