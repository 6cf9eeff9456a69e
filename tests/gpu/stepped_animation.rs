//! Held poses: what is shown, and what the game sees of it.

use bevy::{ecs::change_detection::DetectChanges, render::render_resource::PrimitiveTopology};
use bevy_comics::SteppedAnimation;
use image::RgbaImage;

use crate::{prelude::*, walls::towards_the_sky};

const SIZE: UVec2 = UVec2::new(192, 64);

/// Moves by this many units a second to the right.
#[derive(Component)]
struct Walks(f32);

fn walk(mut walkers: Query<(&mut Transform, &Walks)>, time: Res<Time>) {
    for (mut at, speed) in &mut walkers {
        at.translation.x = speed.0 * time.elapsed_secs() - 60.0;
    }
}

/// The global transforms that the game sees, and how many of them changed since the last
/// frame, at its very end and at its beginning.
#[derive(Resource, Default)]
struct Seen {
    last: Vec<f32>,
    changes: usize,
}

fn look(places: Query<Ref<GlobalTransform>, With<Mesh3d>>, mut seen: ResMut<Seen>) {
    seen.last = places.iter().map(|p| p.translation().x).collect();
    // The order of a query is not that of spawning.
    seen.last.sort_by(f32::total_cmp);
    seen.changes += places.iter().filter(Ref::is_changed).count();
}

/// A view towards the sky, one unit per pixel.
fn stage() -> Small {
    let mut small = towards_the_sky(SIZE);
    let app = &mut small.headless.app;
    app.init_resource::<Seen>().add_systems(Update, walk);
    small
}

/// A white square of 16 pixels on a path in the upper or lower half.
fn square(small: &mut Small, y: f32) -> Entity {
    let shape = Rectangle::new(16.0, 16.0);
    small.put(
        shape,
        unlit(Color::WHITE),
        Transform::from_xyz(0.0, y, -50.0),
    )
}

/// Centre of the white pixels of the rows, pixels from the left.
fn place(picture: &RgbaImage, rows: Range<u32>) -> f64 {
    let white = picture
        .enumerate_pixels()
        .filter(|(_, y, p)| rows.contains(y) && p.0[..3] == [255; 3]);
    let (sum, count) = white.fold((0.0, 0.0), |(s, n), (x, ..)| {
        (s + f64::from(x) + 0.5, n + 1.0)
    });
    assert!(count > 20.0, "{count} white pixels");
    sum / count
}

/// One square is held, the other not. Truth: the held one is for five frames where the
/// other one was in the first of them. A mesh below the held entity is held too.
#[test]
fn a_pose_is_held_for_its_drawing() {
    let mut small = stage();
    let free = square(&mut small, 16.0);
    small.world().entity_mut(free).insert(Walks(60.0));
    let below = square(&mut small, 0.0);
    let held = (Transform::from_xyz(0.0, -16.0, 0.0), Visibility::default());
    let root = (held, Walks(60.0), SteppedAnimation::default());
    small.world().spawn(root).add_child(below);
    small.headless.step(10);
    let mut lag = Vec::new();
    let mut places = Vec::new();
    for _ in 0..30 {
        small.headless.step(1);
        let picture = small.picture();
        let (free, held) = (place(&picture, 0..32), place(&picture, 32..64));
        lag.push((free - held).round() as i32);
        places.push(held.round() as i32);
    }
    let first = lag.iter().position(|lag| *lag == 0).expect("a new drawing");
    for (i, lag) in lag.iter().enumerate().skip(first) {
        assert_eq!(*lag as usize, (i - first) % 5, "frame {i}: {places:?}");
    }
    places.dedup();
    assert!((6..=7).contains(&places.len()), "{places:?}");
}

/// The game sees the true transforms, with the true times of change, in every schedule; and
/// the picture is the true one again when the component is removed.
#[test]
fn the_game_sees_the_truth() {
    let film = |held: bool| {
        let mut small = stage();
        let walker = square(&mut small, 0.0);
        let resting = square(&mut small, -24.0);
        small.world().entity_mut(walker).insert(Walks(60.0));
        for entity in [walker, resting] {
            if held {
                small
                    .world()
                    .entity_mut(entity)
                    .insert(SteppedAnimation::default());
            }
        }
        // Until pipelines are compiled, a step is several frames.
        small.headless.step(3);
        small
            .headless
            .app
            .add_systems(First, look)
            .add_systems(Last, look);
        let mut seen = Vec::new();
        // Two drawings, and parts of two.
        for _ in 0..12 {
            small.headless.step(1);
            let found = small.headless.app.world().resource::<Seen>();
            seen.push((found.last.clone(), found.changes));
        }
        for entity in [walker, resting] {
            small
                .world()
                .entity_mut(entity)
                .remove::<SteppedAnimation>();
        }
        let mut pictures = Vec::new();
        for _ in 0..3 {
            small.headless.step(1);
            pictures.push(small.picture());
        }
        (seen, pictures)
    };
    let (held, free) = (film(true), film(false));
    assert_eq!(held.0, free.0);
    assert!(held.1 == free.1, "the pictures after the release differ");
}

/// Motion vectors are those of the picture: none while the pose is held, the whole jump in
/// the first frame of a drawing. The lower square is held, the upper one not.
#[test]
fn motion_is_that_of_the_picture() {
    let mut small = stage();
    small.insert((DepthPrepass, MotionVectorPrepass));
    let [free, held] = [16.0, -16.0].map(|y| square(&mut small, y));
    small.world().entity_mut(free).insert(Walks(60.0));
    let pose = (Walks(60.0), SteppedAnimation::default());
    small.world().entity_mut(held).insert(pose);
    small.headless.step(10);
    let places = |small: &mut Small| {
        let picture = small.picture();
        [0..32, 32..64].map(|rows| place(&picture, rows))
    };
    let mut last = places(&mut small);
    let mut jumps = [0; 2];
    for frame in 0..20 {
        small.headless.step(1);
        let now = places(&mut small);
        let vectors = small.motion_vectors().expect("a prepass");
        for (which, row) in [16, 48].into_iter().enumerate() {
            let moved = now[which] - last[which];
            let [right, ..] = vectors.pixels[(row * SIZE.x + now[which] as u32) as usize];
            let motion = f64::from(right) * f64::from(SIZE.x);
            assert!(
                (motion - moved).abs() < 0.6,
                "{which}, {frame}: {motion}, {moved}"
            );
            jumps[which] += usize::from(moved > 0.5);
        }
        last = now;
    }
    assert_eq!(jumps, [20, 4]);
}

/// A strip whose right half follows a joint that rises with time.
fn skinned(small: &mut Small, held: bool) {
    let positions = [-40.0f32, 0.0, 40.0]
        .iter()
        .flat_map(|x| [[*x, -6.0, 0.0], [*x, 6.0, 0.0]])
        .collect::<Vec<_>>();
    let joints: Vec<[u16; 4]> = [0, 0, 0, 0, 1, 1].map(|j| [j, 0, 0, 0]).to_vec();
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::all());
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 6]);
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 0.0]; 6]);
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(joints),
    );
    mesh.insert_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, vec![[1.0, 0.0, 0.0, 0.0]; 6]);
    mesh.insert_indices(Indices::U16(vec![0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5]));
    let body = small.put(mesh, unlit(Color::WHITE), Transform::default());
    let world = small.world();
    let bind = SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY; 2]);
    let inverse_bindposes = world
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
        .add(bind);
    let still = world.spawn(Transform::from_xyz(0.0, 0.0, -50.0)).id();
    let rises = world
        .spawn((Transform::from_xyz(0.0, 0.0, -50.0), Rises))
        .id();
    let joints = vec![still, rises];
    let skin = SkinnedMesh {
        inverse_bindposes,
        joints: joints.clone(),
    };
    world.entity_mut(body).insert(skin);
    let mut root = world.spawn((Transform::default(), Visibility::default()));
    root.add_children(&[body, still, rises]);
    if held {
        root.insert(SteppedAnimation::default());
    }
}

#[derive(Component)]
struct Rises;

fn rise(mut joints: Query<&mut Transform, With<Rises>>, time: Res<Time>) {
    for mut at in &mut joints {
        at.translation.y = 60.0 * time.elapsed_secs() - 15.0;
    }
}

/// A skin is held with its joints: its picture is that of the free skin in the first frame
/// of every drawing.
#[test]
fn skins_are_held() {
    let film = |held: bool| {
        let mut small = stage();
        small.headless.app.add_systems(Update, rise);
        skinned(&mut small, held);
        small.headless.step(3);
        (0..20)
            .map(|_| {
                small.headless.step(1);
                small.picture()
            })
            .collect::<Vec<_>>()
    };
    let (free, held) = (film(false), film(true));
    assert_eq!(
        free.chunk_by(|a, b| a == b).count(),
        20,
        "the free skin moves"
    );
    let runs: Vec<usize> = held
        .chunk_by(|a, b| a == b)
        .map(<[RgbaImage]>::len)
        .collect();
    assert!(
        runs.len() <= 5 && runs.iter().all(|run| *run <= 5),
        "{runs:?}"
    );
    let mut frame = 0;
    for (i, run) in runs.iter().enumerate() {
        if i > 0 {
            assert!(held[frame] == free[frame], "drawing {i}, frame {frame}");
        }
        frame += run;
    }
}

/// A camera below a held entity moves at full rate, and an inner `SteppedAnimation` has its own.
#[test]
fn cameras_are_never_held() {
    let mut small = stage();
    let wall = square(&mut small, 0.0);
    let camera = small.camera;
    let inner = square(&mut small, -24.0);
    small
        .world()
        .entity_mut(inner)
        .insert(SteppedAnimation { rate: 60.0 });
    let root = (
        Transform::default(),
        Visibility::default(),
        Walks(30.0),
        SteppedAnimation::default(),
    );
    small.world().spawn(root).add_children(&[camera, inner]);
    let _ = wall;
    small.headless.step(10);
    let mut places = Vec::new();
    for _ in 0..12 {
        small.headless.step(1);
        let picture = small.picture();
        places.push(place(&picture, 20..44));
        // It rests relative to the camera.
        let inner = place(&picture, 50..64);
        assert!((inner - 96.0).abs() < 0.6, "{inner}");
    }
    let moves = places.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(moves >= 5, "half a pixel a frame: {places:?}");
}

/// Rates that are no numbers, entities that die while they are held, parents that change.
#[test]
fn what_happens_to_held_things() {
    let mut small = stage();
    small.insert(Hdr);
    let walkers: Vec<Entity> = [f32::NAN, 0.0, -3.0, 1e30]
        .into_iter()
        .map(|rate| {
            let walker = square(&mut small, 0.0);
            small
                .world()
                .entity_mut(walker)
                .insert((Walks(60.0), SteppedAnimation { rate }));
            walker
        })
        .collect();
    small.headless.step(3);
    small.world().despawn(walkers[0]);
    small
        .world()
        .entity_mut(walkers[1])
        .remove::<SteppedAnimation>();
    small.world().entity_mut(walkers[2]).remove::<Mesh3d>();
    let parent = walkers[1];
    small.world().entity_mut(walkers[3]).insert(ChildOf(parent));
    small.headless.step(8);
    small.world().entity_mut(parent).remove::<GlobalTransform>();
    small.headless.step(3);
    assert_eq!(small.errors(), 0);
}
