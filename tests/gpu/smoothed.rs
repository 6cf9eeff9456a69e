//! Meshes that are shaded with smoothed normals: when they are made, and where the vertex shader
//! brings them.

use bevy::{camera::visibility::NoFrustumCulling, mesh::morph::MorphAttributes};
use bevy_comics_testkit::reference::octahedral::octahedral;
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{bright, drawn, put, room, set_light, sun, with},
};

const SIZE: UVec2 = UVec2::new(128, 128);

/// Three tones for each light; the normals of a number of rounds, or the mesh's own.
fn light(rounds: Option<u32>) -> ToonLight {
    let gray = |part| Color::linear_rgb(part, part, part);
    let stops = [
        RampStop::new(0.0, gray(0.0)),
        RampStop::new(0.3, gray(0.4)),
        RampStop::new(0.7, gray(1.0)),
    ];
    ToonLight {
        proxy: rounds.map(|rounds| ShadingProxy {
            shape: ProxyShape::Smoothed { rounds },
            ..default()
        }),
        ..with(Ramp {
            mode: RampMode::PerLight,
            ..Ramp::new(stops)
        })
    }
}

fn studio() -> Small {
    let mut small = room(SIZE, 0.1);
    sun(&mut small, Vec3::new(1.0, 0.7, 0.8), bright(1.0));
    small
}

fn block() -> Mesh {
    Cuboid::new(0.9, 1.1, 0.8).into()
}

fn turned() -> Transform {
    Transform::from_scale(Vec3::new(1.2, 0.8, 1.0)).with_rotation(Quat::from_euler(
        EulerRot::YXZ,
        0.6,
        0.4,
        0.2,
    ))
}

/// The picture of a mesh alone that is turned, shaded with its own normals.
fn alone(small: &mut Small, mesh: Mesh, more: impl Bundle) -> RgbaImage {
    let entity = put(small, mesh, &light(None), turned());
    small.world().entity_mut(entity).insert(more);
    let picture = drawn(small);
    small.world().despawn(entity);
    picture
}

/// The codes of a mesh, once they are there and `is_new`.
fn codes(small: &mut Small, entity: Entity, is_new: impl Fn(&[[i16; 2]]) -> bool) -> Vec<[i16; 2]> {
    for _ in 0..300 {
        small.headless.step(1);
        let world = small.world();
        let mesh = world.get::<Mesh3d>(entity).expect("a mesh");
        let mesh = world.resource::<Assets<Mesh>>().get(&mesh.0);
        let mut all = mesh.expect("loaded").attributes();
        let found = all.find(|(attribute, _)| attribute.name == "ComicsSmoothedNormal");
        if let Some((_, VertexAttributeValues::Snorm16x2(codes))) = found
            && is_new(codes)
        {
            return codes.clone();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("no normals after three seconds");
}

fn made(small: &mut Small, entity: Entity) -> Vec<[i16; 2]> {
    codes(small, entity, |_| true)
}

/// The same mesh with the vectors of these codes as its own normals.
fn with_normals(mut mesh: Mesh, codes: &[[i16; 2]]) -> Mesh {
    let normal = |code: &[i16; 2]| octahedral(code.map(|c| f64::from(c) / 32767.0));
    let normals: Vec<_> = codes.iter().map(|c| normal(c).map(|x| x as f32)).collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
    mesh
}

/// The picture of smoothed normals is that of a mesh that has them as its own: here on entities
/// that are turned and stretched, beside prepasses, and of some of the amount.
#[test]
fn smoothed_normals_are_normals() {
    let mut small = studio();
    small.insert(DepthPrepass);
    for rounds in [0, 2] {
        let mesh = || Cuboid::new(0.9, 1.1, 0.8).mesh().build();
        let plain = alone(&mut small, mesh(), ());
        let object = put(&mut small, mesh(), &light(Some(rounds)), turned());
        let codes = made(&mut small, object);
        let found = drawn(&mut small);
        let mut none = light(Some(rounds));
        if let Some(form) = &mut none.proxy {
            (form.amount, form.amount_at_far) = (0.0, 0.0);
        }
        set_light(&mut small, &none);
        assert_eq!(apart(&plain, &drawn(&mut small)), 0);
        small.world().despawn(object);
        let wanted = alone(&mut small, with_normals(mesh(), &codes), ());
        assert!(differ(&found, &plain, 2) > 500);
        let wrong = differ(&found, &wanted, 2);
        assert!(wrong <= 4, "{rounds} rounds: {wrong} pixels");
    }
}

/// They follow bones as normals do.
#[test]
fn smoothed_normals_follow_bones() {
    let mut small = studio();
    let mut skinned = block();
    let count = skinned.count_vertices();
    skinned.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(vec![[0; 4]; count]),
    );
    skinned.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_WEIGHT,
        vec![[1.0, 0.0, 0.0, 0.0]; count],
    );
    let at_rest = put(&mut small, block(), &light(Some(1)), turned());
    made(&mut small, at_rest);
    let wanted = drawn(&mut small);
    small.world().despawn(at_rest);
    let object = put(&mut small, skinned, &light(Some(1)), Transform::IDENTITY);
    let world = small.world();
    let poses = SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY]);
    let mut all = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    let inverse_bindposes = all.add(poses);
    let joints = vec![world.spawn(turned()).id()];
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints,
    };
    world.entity_mut(object).insert((skin, NoFrustumCulling));
    made(&mut small, object);
    let wrong = differ(&drawn(&mut small), &wanted, 2);
    assert!(wrong <= 4, "{wrong} pixels");
}

/// Morph targets turn them as they turn the mesh's normals.
#[test]
fn smoothed_normals_follow_morph_targets() {
    let mut small = studio();
    let ball = || Sphere::new(0.8).mesh().ico(12).expect("few enough");
    let mut morphed = ball();
    let count = morphed.count_vertices();
    let by = Vec3::new(0.5, -0.8, 0.3);
    morphed.set_morph_targets(vec![
        MorphAttributes {
            normal: by,
            ..default()
        };
        count
    ]);
    // Of a ball, they are its normals: so both must show the same.
    let weights = || {
        (
            MorphWeights::new(vec![0.7], None).expect("one weight"),
            MeshMorphWeights::Value { weights: vec![0.7] },
            NoFrustumCulling,
        )
    };
    let wanted = alone(&mut small, morphed.clone(), weights());
    let object = put(&mut small, morphed, &light(Some(0)), turned());
    small.world().entity_mut(object).insert(weights());
    made(&mut small, object);
    let found = drawn(&mut small);
    small.world().despawn(object);
    let still = alone(&mut small, ball(), ());
    assert!(differ(&wanted, &still, 2) > 500);
    // Angle weights of the icosphere differ from its radii by up to 1e-3: edges move by less than a
    // tenth of a pixel, which is 20 codes.
    let wrong = differ(&found, &wanted, 40);
    assert!(wrong <= 4, "{wrong} pixels");
}

/// The back of a surface with two sides faces the other way.
#[test]
fn backs_of_two_sided_surfaces_are_turned() {
    let mut small = studio();
    let base = StandardMaterial {
        double_sided: true,
        cull_mode: None,
        perceptual_roughness: 1.0,
        ..default()
    };
    let extension = light(Some(0));
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    let material = MeshMaterial3d(materials.add(ToonMaterial { base, extension }));
    let back = Transform::from_rotation(Quat::from_rotation_y(3.0));
    let object = small.put_shared(Rectangle::new(1.2, 1.2), material, back);
    made(&mut small, object);
    let found = drawn(&mut small);
    set_light(&mut small, &light(None));
    let wanted = drawn(&mut small);
    assert_eq!(apart(&found, &wanted), 0);
    assert!(linear(&found, 64, 64)[0] > 0.3);
}

/// Meshes whose data is gone, or that have no normals, are drawn as they are.
#[test]
fn meshes_that_cannot_be_smoothed_stay_as_they_are() {
    let gone = || {
        let mut mesh = block();
        mesh.asset_usage = RenderAssetUsages::RENDER_WORLD;
        mesh
    };
    let bare = || {
        let mut mesh = block();
        mesh.remove_attribute(Mesh::ATTRIBUTE_NORMAL);
        mesh
    };
    let mut small = studio();
    for mesh in [&gone as &dyn Fn() -> Mesh, &bare] {
        let wanted = alone(&mut small, mesh(), ());
        let smoothed = put(&mut small, mesh(), &light(Some(3)), turned());
        small.headless.step(20);
        assert_eq!(apart(&wanted, &drawn(&mut small)), 0);
        small.world().despawn(smoothed);
    }
}

/// Of two materials on one mesh, the one with more rounds counts, until it has fewer; a mesh that
/// changes gets new normals.
#[test]
fn normals_are_made_anew_when_something_changes() {
    let mut small = studio();
    let codes_of = |rounds| {
        let light = light(Some(rounds));
        let object = put(&mut small, block_of_squares(), &light, turned());
        let codes = made(&mut small, object);
        small.world().despawn(object);
        codes
    };
    let [one, two, six] = [1, 2, 6].map(codes_of);
    let first = put(&mut small, block_of_squares(), &light(Some(2)), turned());
    let shared = small.world().get::<Mesh3d>(first).expect("a mesh").clone();
    let second = put(&mut small, block(), &light(Some(6)), turned());
    small.world().entity_mut(second).insert(shared.clone());
    codes(&mut small, first, |codes| codes == six);
    set_light(&mut small, &light(Some(1)));
    codes(&mut small, first, |codes| codes == one);
    set_light(&mut small, &light(Some(2)));
    codes(&mut small, first, |codes| codes == two);
    // It stays as it is while nothing changes, and is no reason to make it again.
    small.headless.step(5);
    let mut meshes = small.world().resource_mut::<Assets<Mesh>>();
    let mut mesh = meshes.get_mut(&shared.0).expect("loaded");
    mesh.scale_by(Vec3::new(1.0, 1.0, 4.0));
    drop(mesh);
    let changed = codes(&mut small, first, |codes| codes != two);
    assert_ne!(changed, one);
}

fn block_of_squares() -> Mesh {
    let square = Plane3d::default().mesh().size(1.0, 1.0);
    let mut mesh = square.subdivisions(3).build();
    mesh.merge(&block()).expect("equal attributes");
    mesh
}
