//! Ids of many objects that share meshes and materials, in every way in which the engine draws
//! them; and the work that a frame does for them.

use bevy::{
    camera::visibility::{NoCpuCulling, VisibilityRange},
    math::{Affine3A, Vec3A},
    render::{
        batching::NoAutomaticBatching, occlusion_culling::OcclusionCulling, view::NoIndirectDrawing,
    },
};
use bevy_comics::{
    objects::{LineWidths, ObjectSimplification, SelectionOutline},
    testing::ObjectWork,
};

use crate::prelude::*;

const SIDE: u32 = 32;

/// A turned cube, and its place.
struct Turned {
    entity: Entity,
    to_local: Affine3A,
}

/// Cubes of one mesh and material, at all angles, some hidden by others.
fn put_cubes(
    small: &mut Small,
    count: usize,
    more: impl Fn(usize, &mut EntityWorldMut),
) -> Vec<Turned> {
    let world = small.world();
    let mesh = Mesh3d(world.resource_mut::<Assets<Mesh>>().add(Cuboid::default()));
    let white = unlit(Color::WHITE);
    let white = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(white));
    let cube = |at: usize| {
        // The fractions of multiples of irrational numbers fill a box evenly.
        let place = at as f32 * Vec3::new(0.754_877_7, 0.569_840_3, 0.618_034);
        let place = 20.0 * (place.fract_gl() - 0.5);
        let turned = Quat::from_scaled_axis(at as f32 * Vec3::new(0.7, 1.1, 1.3));
        let at = Transform::from_translation(place).with_rotation(turned);
        (Object, mesh.clone(), white.clone(), at)
    };
    (0..count)
        .map(|at| {
            let parts = cube(at);
            let to_local = parts.3.compute_affine().inverse();
            let mut entity = world.spawn(parts);
            more(at, &mut entity);
            Turned {
                entity: entity.id(),
                to_local,
            }
        })
        .collect()
}

/// The nearest cube on a ray, and how far it is.
fn first(cubes: &[Turned], origin: Vec3A, direction: Vec3A) -> Option<Entity> {
    let hit = |cube: &Turned| {
        let origin = cube.to_local.transform_point3a(origin);
        let along = cube.to_local.transform_vector3a(direction);
        // The ray is between the planes of each pair of sides.
        let [a, b] = [-0.5, 0.5].map(|side| (Vec3A::splat(side) - origin) / along);
        let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
        (enters > 0.0 && enters <= leaves).then_some((enters, cube.entity))
    };
    let hits = cubes.iter().filter_map(hit);
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, entity)| entity)
}

/// Asserts that each pixel has the id of the first object on its ray. A sample of a pixel has a
/// position of 1/256 pixel precision at least, so near an edge the object beside it counts too.
fn assert_ids(small: &mut Small, cubes: &[Turned], case: &str) {
    let camera = small.camera;
    let world = small.world();
    let projection = world
        .get::<Projection>(camera)
        .expect("of the camera")
        .clone();
    let at = *world.get::<Transform>(camera).expect("of the camera");
    let from_clip = at.compute_affine() * Affine3A::IDENTITY;
    let view_from_clip = projection.get_clip_from_view().inverse();
    let ids = small.ids();
    let ray = |x: f32, y: f32| {
        let ndc = Vec2::new(x, -y) * 2.0 / SIDE as f32 + Vec2::new(-1.0, 1.0);
        let [near, far] = [1.0, 0.5].map(|z| {
            let point = view_from_clip.project_point3(ndc.extend(z));
            from_clip.transform_point3a(point.into())
        });
        (near, far - near)
    };
    let ids_of: HashMap<Entity, u32> = cubes
        .iter()
        .map(|c| (c.entity, small.id_of(c.entity)))
        .collect();
    let (mut wrong, mut objects) = (Vec::new(), HashSet::new());
    for (i, found) in ids.iter().enumerate() {
        let (x, y) = (
            (i as u32 % SIDE) as f32 + 0.5,
            (i as u32 / SIDE) as f32 + 0.5,
        );
        let at = |dx: f32, dy: f32| {
            let (origin, direction) = ray(x + dx / 128.0, y + dy / 128.0);
            first(cubes, origin, direction).map_or(0, |cube| ids_of[&cube])
        };
        objects.insert(*found);
        let beside = [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
        if !beside.into_iter().any(|(dx, dy)| at(dx, dy) == *found) {
            wrong.push((x, y, *found, at(0.0, 0.0)));
        }
    }
    assert!(
        wrong.is_empty(),
        "{case}: {} pixels, {:?}",
        wrong.len(),
        wrong.first()
    );
    assert!(objects.len() > 80, "{case}: {} objects", objects.len());
}

/// What the camera in front of the cubes has.
fn lines() -> impl Bundle {
    let at = Transform::from_xyz(0.0, 0.0, 25.0);
    (at, DepthPrepass, Outlines::default())
}

/// Where the engine expands meshes on the CPU, its prepass is empty (Bevy 0.19.1), and so are ids.
#[test]
fn each_pixel_has_the_id_of_the_first_object_on_its_ray() {
    // Each case in some views.
    assert_ids_of_first_objects([&[0, 1, 2, 3], &[2], &[0, 3]]);
}

#[test]
#[ignore = "long: every case in every view"]
fn each_pixel_has_the_id_of_the_first_object_on_its_ray_in_every_view() {
    assert_ids_of_first_objects([&[0, 1, 2, 3]; 3]);
}

/// `seen`: the numbers of the views of each case.
fn assert_ids_of_first_objects(seen: [&[usize]; 3]) {
    let mut small = Small::new(UVec2::splat(SIDE), Msaa::Off);
    let cases: [(&str, fn(usize, &mut EntityWorldMut)); 3] = [
        ("all batch", |_, _| {}),
        ("every second one is drawn alone", |at, cube| {
            if at % 2 == 0 {
                cube.insert(NoAutomaticBatching);
            }
        }),
        ("culled by the GPU", |_, cube| {
            cube.insert(NoCpuCulling);
        }),
    ];
    let views: [(&str, fn(&mut EntityWorldMut)); 4] = [
        ("", |_| {}),
        ("in an orthographic view", |camera| {
            let scaling_mode = ScalingMode::Fixed {
                width: 20.0,
                height: 20.0,
            };
            camera.insert(Projection::Orthographic(OrthographicProjection {
                scaling_mode,
                ..OrthographicProjection::default_3d()
            }));
        }),
        ("drawn directly", |camera| {
            camera.insert(NoIndirectDrawing);
        }),
        ("with occlusion culling", |camera| {
            camera.insert(OcclusionCulling);
        }),
    ];
    let pairs = cases.into_iter().zip(seen);
    let pairs = pairs.flat_map(|(case, seen)| seen.iter().map(move |view| (case, views[*view])));
    for ((case, more), (how, view)) in pairs {
        small.restart(Msaa::Off);
        small.clear();
        let cubes = put_cubes(&mut small, 400, more);
        small.insert(lines());
        view(&mut small.camera_mut());
        small.settle();
        assert_ids(&mut small, &cubes, &format!("{case} {how}"));
    }
}

/// What the pass of ids did in the frames so far.
fn work(small: &Small) -> ObjectWork {
    ObjectWork::of(small.render_world())
}

#[test]
fn a_frame_does_what_has_changed() {
    let mut small = Small::new(UVec2::splat(SIDE), Msaa::Off);
    small.clear();
    let cubes = put_cubes(&mut small, 200, |_, _| {});
    small.insert((Transform::from_xyz(0.0, 0.0, 60.0), Outlines::default()));
    small.settle();
    let before = work(&small);
    assert_eq!((before.draw_calls, before.instances), (1, 200));
    small.headless.step(3);
    assert_eq!(work(&small), before, "nothing changed");
    // Moving needs nothing: the engine has the place.
    small
        .on(cubes[0].entity)
        .insert(Transform::from_xyz(0.0, 9.0, 9.0));
    small.headless.step(1);
    assert_eq!(work(&small), before, "a cube moved");
    small.on(cubes[0].entity).insert(Visibility::Hidden);
    small.headless.step(1);
    let hidden = work(&small);
    assert_eq!((hidden.draw_calls, hidden.instances), (1, 199));
    assert_eq!(hidden.queued, before.queued, "nothing was added");
    small.on(cubes[0].entity).insert(Visibility::Inherited);
    small.headless.step(1);
    small.on(cubes[1].entity).insert(OutlineGroup);
    small.headless.step(1);
    assert_eq!(
        work(&small).queued,
        before.queued + 2,
        "the cubes that changed"
    );
}

/// What is uploaded for objects is what has changed of them.
#[test]
fn a_frame_uploads_what_has_changed() {
    let mut small = Small::new(UVec2::splat(SIDE), Msaa::Off);
    small.clear();
    let cubes = put_cubes(&mut small, 200, |_, _| {});
    let at = Transform::from_xyz(0.0, 0.0, 60.0);
    small.insert((at, Outlines::default(), Abstraction::default()));
    small.on(cubes[0].entity).insert(NoOutlines::default());
    small.settle();
    small.headless.step(3);
    let mut before = work(&small);
    let mut step = |small: &mut Small, case: &str, bytes: usize| {
        small.headless.step(1);
        let now = work(small);
        assert_eq!(now.uploaded - before.uploaded, bytes, "{case}");
        before = now;
    };
    step(&mut small, "nothing changed", 0);
    // The record of an instance has four words, a box has twelve.
    small.on(cubes[9].entity).insert(NoOutlines::default());
    step(&mut small, "one has another style", 16);
    small
        .on(cubes[9].entity)
        .insert(Transform::from_xyz(0.0, 9.0, 9.0));
    step(&mut small, "one moved", 48);
    small
        .on(cubes[9].entity)
        .insert(ObjectSimplification::fixed(0.5));
    step(&mut small, "one is simplified", 48);
    small.on(cubes[9].entity).insert(OutlineGroup);
    step(&mut small, "the sections of a group have other numbers", 16);
}

/// While nothing changes, the passes of a view bind what they have bound before.
#[test]
fn a_still_view_makes_no_bind_groups() {
    let mut small = Small::new(UVec2::splat(SIDE), Msaa::Sample4);
    small.clear();
    let cubes = put_cubes(&mut small, 20, |_, _| {});
    small.on(cubes[0].entity).insert(LineWidths::default());
    small
        .on(cubes[1].entity)
        .insert(SelectionOutline::default());
    let at = Transform::from_xyz(0.0, 0.0, 60.0);
    let lines = Outlines {
        ink_budget: 0.5,
        overshoot: 3.0,
        ..default()
    };
    let sharp = Focus {
        at: FocusAt::Center,
        ..default()
    };
    small.insert((at, lines, Abstraction::default(), Halftone::default()));
    small.insert((DepthLayers::default(), sharp, Paint::default()));
    small.settle();
    // The two textures of the picture take turns.
    small.headless.step(4);
    let before = work(&small).bind_groups;
    assert!(before > 20, "{before}");
    small.headless.step(4);
    assert_eq!(work(&small).bind_groups, before);
    small.camera_mut().remove::<Paint>();
    small.settle();
    assert!(work(&small).bind_groups > before, "without paint");
}

/// The levels of detail of an object are in one place, and the GPU draws the one that is in range.
#[test]
fn ids_leave_out_the_levels_that_are_out_of_range() {
    let mut small = Small::new(UVec2::splat(SIDE), Msaa::Off);
    small.clear();
    let ranges = [(0.0, 10.0), (10.0, 20.0), (20.0, 1000.0)];
    let levels = put_cubes(&mut small, 3, |at, level| {
        let (start, end) = ranges[at];
        let range = VisibilityRange::abrupt(start, end);
        level.insert((range, NoCpuCulling, Transform::default()));
    });
    small.insert(Outlines::default());
    for (distance, level) in [(5.0, 0), (15.0, 1), (25.0, 2), (15.0, 1), (5.0, 0)] {
        small.insert(Transform::from_xyz(0.0, 0.0, distance));
        small.settle();
        let ids: HashSet<u32> = small.ids().iter().copied().collect();
        let wanted = HashSet::from([0, small.id_of(levels[level].entity)]);
        assert_eq!(ids, wanted, "at {distance}");
    }
}
