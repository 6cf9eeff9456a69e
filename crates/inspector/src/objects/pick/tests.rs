use bevy::{
    camera::primitives::MeshAabb,
    mesh::{Indices, PrimitiveTopology, VertexAttributeValues},
};

use super::*;

/// A world with meshes.
struct Scene {
    world: World,
    meshes: Vec<Entity>,
}

impl Scene {
    fn new() -> Self {
        let mut world = World::new();
        world.insert_resource(Assets::<Mesh>::default());
        world.insert_resource(Assets::<SkinnedMeshInverseBindposes>::default());
        Self {
            world,
            meshes: Vec::new(),
        }
    }

    fn add(&mut self, mesh: Mesh) -> Handle<Mesh> {
        self.world.resource_mut::<Assets<Mesh>>().add(mesh)
    }

    fn spawn(&mut self, mesh: Mesh, at: Transform) -> Entity {
        let bounds = mesh.compute_aabb().expect("vertices");
        let mesh = Mesh3d(self.add(mesh));
        let bundle = (mesh, bounds, GlobalTransform::from(at));
        let entity = self.world.spawn(bundle).id();
        self.meshes.push(entity);
        entity
    }

    fn pick(&self, origin: Vec3, target: Vec3) -> Option<Entity> {
        let direction = Dir3::new(target - origin).expect("a direction");
        let ray = Ray::from(Ray3d { origin, direction });
        let found = first_of(&self.world, &self.meshes, ray);
        let mut other = self.meshes.clone();
        other.reverse();
        assert_eq!(first_of(&self.world, &other, ray), found, "in any order");
        found
    }
}

fn cube() -> Mesh {
    Cuboid::from_length(2.0).mesh().build()
}

/// The half of a square from (-1, -1) to (1, 1) that is below its diagonal.
fn half_square() -> Mesh {
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
    Mesh::new(PrimitiveTopology::TriangleList, Default::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners.to_vec())
}

#[test]
fn the_nearest_mesh_wins() {
    let mut scene = Scene::new();
    let far = scene.spawn(cube(), Transform::from_xyz(0.0, 0.0, -8.0));
    let near = scene.spawn(cube(), Transform::from_xyz(0.0, 0.0, 0.0));
    let eye = Vec3::new(0.0, 0.0, 9.0);
    assert_eq!(scene.pick(eye, Vec3::ZERO), Some(near));
    assert_eq!(scene.pick(-2.0 * eye, Vec3::ZERO), Some(far));
    assert_eq!(scene.pick(eye, eye + Vec3::Z), None, "behind the eye");
    assert_eq!(scene.pick(eye, Vec3::new(3.0, 0.0, 0.0)), None, "the sky");
}

/// The box of the nearer mesh is hit, and its triangle is not.
#[test]
fn triangles_count_and_boxes_do_not() {
    let mut scene = Scene::new();
    let half = scene.spawn(half_square(), Transform::IDENTITY);
    let behind = scene.spawn(cube(), Transform::from_xyz(0.0, 0.0, -5.0));
    let at = |scene: &Scene, x, y| scene.pick(Vec3::new(x, y, 9.0), Vec3::new(x, y, 0.0));
    assert_eq!(at(&scene, 0.5, -0.5), Some(half));
    assert_eq!(at(&scene, -0.5, 0.5), Some(behind));
}

/// Of a stretched and turned cube, exactly those rays meet it that meet the cube in its own space.
#[test]
fn meshes_are_picked_where_they_are_drawn() {
    let mut scene = Scene::new();
    let at = Transform {
        translation: Vec3::new(3.0, -1.0, 2.0),
        rotation: Quat::from_rotation_z(0.6) * Quat::from_rotation_x(1.1),
        scale: Vec3::new(4.0, 0.2, -1.5),
    };
    let cube = scene.spawn(cube(), at);
    // A face of the cube, a little inside and outside of its border.
    for (u, v, inside) in [
        (0.0, 0.0, true),
        (0.98, 0.98, true),
        (-0.98, 0.98, true),
        (1.02, 0.0, false),
        (0.0, -1.02, false),
    ] {
        let on_face = at.transform_point(Vec3::new(u, 1.0, v));
        // Along the face's normal, so that no other face is met beside its border.
        let normal = at.rotation * Vec3::Y;
        let found = scene.pick(on_face + 5.0 * normal, on_face);
        assert_eq!(found, inside.then_some(cube), "{u}, {v}");
    }
}

/// A skinned mesh is where its joints are, not at rest, and not at the place of its entity.
#[test]
fn skinned_meshes_are_picked_in_their_pose() {
    let mut scene = Scene::new();
    let mesh = half_square()
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_JOINT_INDEX,
            VertexAttributeValues::Uint16x4(vec![[0, 1, 0, 0]; 3]),
        )
        .with_inserted_attribute(
            Mesh::ATTRIBUTE_JOINT_WEIGHT,
            VertexAttributeValues::Float32x4(vec![[0.25, 0.75, 0.0, 0.0]; 3]),
        );
    let joint = |at: Transform| GlobalTransform::from(at);
    let joints = vec![
        scene
            .world
            .spawn(joint(Transform::from_xyz(0.0, 0.0, 0.0)))
            .id(),
        scene
            .world
            .spawn(joint(Transform::from_xyz(8.0, 4.0, 0.0)))
            .id(),
    ];
    // At rest, the second joint is one unit to the left.
    let poses = vec![Mat4::IDENTITY, Mat4::from_translation(Vec3::X)];
    let poses = SkinnedMeshInverseBindposes::from(poses);
    let inverse_bindposes = scene
        .world
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
        .add(poses);
    let skinned = scene.spawn(mesh, Transform::from_xyz(-50.0, 0.0, 0.0));
    let at = |scene: &Scene, x, y| scene.pick(Vec3::new(x, y, 9.0), Vec3::new(x, y, 0.0));
    assert_eq!(at(&scene, -49.5, -0.5), Some(skinned), "without its skin");
    scene.world.entity_mut(skinned).insert(SkinnedMesh {
        inverse_bindposes,
        joints,
    });
    // Three quarters of 9 and of 4 units.
    let moved = Vec3::new(6.75, 3.0, 0.0);
    assert_eq!(at(&scene, moved.x + 0.5, moved.y - 0.5), Some(skinned));
    assert_eq!(at(&scene, moved.x - 0.5, moved.y + 0.5), None);
    assert_eq!(at(&scene, 0.5, -0.5), None, "at rest");
    assert_eq!(at(&scene, -49.5, -0.5), None, "at its entity");
    let corners = corners(&scene.world, skinned).expect("a box");
    assert!(corners[0].distance(moved - Vec3::new(1.0, 1.0, 0.0)) < 1e-5);
    assert!(corners[7].distance(moved + Vec3::new(1.0, 1.0, 0.0)) < 1e-5);
}

/// What the main world does not keep is picked by its box.
#[test]
fn meshes_on_the_gpu_alone_are_picked_by_their_boxes() {
    let mut scene = Scene::new();
    let mut mesh = cube();
    let away = scene.spawn(mesh.clone(), Transform::from_xyz(0.0, 0.0, -4.0));
    let inside = scene.spawn(cube(), Transform::from_scale(Vec3::splat(0.1)));
    mesh.take_gpu_data().expect("data");
    assert!(mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).is_err());
    let id = scene.world.get::<Mesh3d>(away).expect("a mesh").0.id();
    let mut meshes = scene.world.resource_mut::<Assets<Mesh>>();
    meshes.insert(id, mesh).expect("the same mesh");
    let eye = Vec3::new(0.9, 0.9, 9.0);
    assert_eq!(scene.pick(eye, eye - Vec3::Z), Some(away));
    // From inside the box, what is in it comes first.
    let large = Transform::from_scale(Vec3::splat(3.0));
    *scene
        .world
        .get_mut::<GlobalTransform>(away)
        .expect("a place") = large.into();
    let eye = Vec3::new(0.0, 0.0, 2.0);
    assert_eq!(scene.pick(eye, Vec3::ZERO), Some(inside));
    assert_eq!(scene.pick(eye, Vec3::new(2.0, 0.0, 0.0)), Some(away));
}

/// Strips, indices that do not exist, and meshes of lines.
#[test]
fn odd_meshes_do_no_harm() {
    let mut scene = Scene::new();
    let corners = [
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
    ];
    let mesh = |topology, indices: Option<Vec<u32>>| {
        let mesh = Mesh::new(topology, Default::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners.to_vec());
        match indices {
            Some(indices) => mesh.with_inserted_indices(Indices::U32(indices)),
            None => mesh,
        }
    };
    let lines = mesh(PrimitiveTopology::LineList, None);
    scene.spawn(lines, Transform::from_xyz(0.0, 0.0, 2.0));
    let broken = mesh(
        PrimitiveTopology::TriangleList,
        Some(vec![0, 1, 9, 7, 7, 7]),
    );
    scene.spawn(broken, Transform::from_xyz(0.0, 0.0, 1.0));
    let strip = scene.spawn(
        mesh(PrimitiveTopology::TriangleStrip, None),
        Transform::IDENTITY,
    );
    let squashed = Transform::from_scale(Vec3::new(1.0, 1.0, 0.0));
    scene.spawn(cube(), squashed.with_translation(Vec3::new(0.0, 0.0, 3.0)));
    for (x, y) in [(0.5, -0.5), (-0.5, 0.5), (0.9, 0.9)] {
        let found = scene.pick(Vec3::new(x, y, 9.0), Vec3::new(x, y, 0.0));
        assert_eq!(found, Some(strip));
    }
}

#[cfg(feature = "toon")]
#[test]
fn sides_that_a_material_leaves_out_are_not_picked() {
    use bevy::pbr::StandardMaterial;

    let mut scene = Scene::new();
    let mut materials = Assets::<StandardMaterial>::default();
    let of = |cull_mode| StandardMaterial {
        cull_mode,
        ..StandardMaterial::default()
    };
    let [front, back, both] =
        [Some(Face::Back), Some(Face::Front), None].map(|cull| materials.add(of(cull)));
    scene.world.insert_resource(materials);
    let plane = || Plane3d::default().mesh().size(2.0, 2.0).build();
    let sheet = scene.spawn(plane(), Transform::IDENTITY);
    let eye = Vec3::new(0.1, 5.0, 0.2);
    let seen = |scene: &Scene| [eye, -eye].map(|eye| scene.pick(eye, Vec3::ZERO).is_some());
    assert_eq!(seen(&scene), [true, true], "without a known material");
    for (material, wanted) in [
        (front, [true, false]),
        (back, [false, true]),
        (both, [true, true]),
    ] {
        scene
            .world
            .entity_mut(sheet)
            .insert(MeshMaterial3d(material));
        assert_eq!(seen(&scene), wanted);
    }
}
