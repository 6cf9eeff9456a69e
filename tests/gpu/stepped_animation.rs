//! Held poses: what is shown, and what the game sees of it.

use bevy::{ecs::change_detection::DetectChanges, render::render_resource::PrimitiveTopology};
use bevy_comics::SteppedAnimation;
use bevy_comics_testkit::pool::Pool;
use image::RgbaImage;

use crate::{
    floating_origin::shift,
    line_scenes::{mean, runs, skinned},
    prelude::*,
    small::{draw_once, start},
    walls::towards_the_sky_again,
};

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

/// Apps whose systems walk, rise and look.
static POOL: Pool = Pool::new(new, draw_once);

fn new(options: HeadlessOptions) -> Headless {
    let mut headless = start(options, ());
    let app = headless.app.init_resource::<Seen>();
    app.add_systems(Update, (walk, rise))
        .add_systems(First, look)
        .add_systems(Last, look);
    headless
}

/// A view towards the sky, one unit per pixel.
fn stage() -> Small {
    let mut small = Small::of(POOL.take(options(SIZE)), Msaa::Off);
    towards_the_sky_again(&mut small, Msaa::Off);
    small
}

/// A white square of 16 pixels on a path in the upper or lower half.
fn square(small: &mut Small, y: f32, more: impl Bundle) -> Entity {
    let shape = Rectangle::new(16.0, 16.0);
    let at = Transform::from_xyz(0.0, y, -50.0);
    let square = small.put(shape, unlit(Color::WHITE), at);
    small.on(square).insert(more).id()
}

/// Center of the white pixels of the rows, pixels from the left.
fn place(picture: &RgbaImage, rows: Range<u32>) -> f64 {
    let white = (picture.enumerate_pixels())
        .filter(|(_, y, p)| rows.contains(y) && p.0[..3] == [255; 3])
        .map(|(x, ..)| f64::from(x) + 0.5);
    let columns: Vec<f64> = white.collect();
    assert!(columns.len() > 20, "{} white pixels", columns.len());
    mean(&columns)
}

/// One square is held, the other not. Truth: the held one is for five frames where the
/// other one was in the first of them. A mesh below the held entity is held too.
#[test]
fn a_pose_is_held_for_its_drawing() {
    let mut small = stage();
    square(&mut small, 16.0, Walks(60.0));
    let below = square(&mut small, 0.0, ());
    let held = (Transform::from_xyz(0.0, -16.0, 0.0), Visibility::default());
    let root = (held, Walks(60.0), SteppedAnimation::default());
    small.world().spawn(root).add_child(below);
    small.headless.step(10);
    let film = small.film(30);
    let places = film.iter().map(|p| [place(p, 0..32), place(p, 32..64)]);
    let places: Vec<[f64; 2]> = places.collect();
    let lag = places
        .iter()
        .map(|[free, held]| (free - held).round() as usize);
    let lag: Vec<usize> = lag.collect();
    let first = lag.iter().position(|lag| *lag == 0).expect("a new drawing");
    for (i, lag) in lag.iter().enumerate().skip(first) {
        assert_eq!(*lag, (i - first) % 5, "frame {i}: {places:?}");
    }
    let drawings = places.chunk_by(|a, b| a[1].round() == b[1].round()).count();
    assert!((6..=7).contains(&drawings), "{places:?}");
}

/// The game sees the true transforms, with the true times of change, in every schedule; and
/// the picture is the true one again when the component is removed.
#[test]
fn the_game_sees_the_truth() {
    let run = |held: bool| {
        let mut small = stage();
        let squares = [
            square(&mut small, 0.0, Walks(60.0)),
            square(&mut small, -24.0, ()),
        ];
        if held {
            for square in squares {
                small.on(square).insert(SteppedAnimation::default());
            }
        }
        // Until pipelines are compiled, a step is several frames.
        small.headless.step(3);
        small.world().insert_resource(Seen::default());
        // Two drawings, and parts of two.
        let seen = (0..12).map(|_| {
            small.headless.step(1);
            let found = small.headless.app.world().resource::<Seen>();
            (found.last.clone(), found.changes)
        });
        let seen: Vec<_> = seen.collect();
        for square in squares {
            small.on(square).remove::<SteppedAnimation>();
        }
        (seen, small.film(3))
    };
    let (held, free) = (run(true), run(false));
    assert_eq!(held.0, free.0);
    assert!(held.1 == free.1, "the pictures after the release differ");
}

/// A held pose moves with the whole world, which is no motion.
#[test]
fn a_held_pose_moves_with_the_origin() {
    for tells in [true, false] {
        let mut small = stage();
        small.insert((DepthPrepass, MotionVectorPrepass));
        let still = SteppedAnimation { rate: 1.0 };
        square(&mut small, 0.0, still);
        small.headless.step(10);
        let before = small.picture();
        shift(small.world(), Vec3::new(7.0, 0.0, 0.0), tells);
        small.headless.step(1);
        assert_eq!(small.picture() == before, tells);
        let motion = small.motion_vectors().expect("a prepass");
        let middle = motion.pixels.len() / 2 + SIZE.x as usize / 2;
        let [right, ..] = motion.pixels[middle];
        assert_eq!(right.abs() < 1e-3, tells, "{right}");
    }
}

/// Motion vectors are those of the picture: none while the pose is held, the whole jump in
/// the first frame of a drawing. The lower square is held, the upper one not.
#[test]
fn motion_is_that_of_the_picture() {
    let mut small = stage();
    small.insert((DepthPrepass, MotionVectorPrepass));
    square(&mut small, 16.0, Walks(60.0));
    let held = (Walks(60.0), SteppedAnimation::default());
    square(&mut small, -16.0, held);
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
            let off = (motion - moved).abs();
            assert!(off < 0.6, "{which}, {frame}: {motion}, {moved}");
            jumps[which] += usize::from(moved > 0.5);
        }
        last = now;
    }
    assert_eq!(jumps, [20, 4]);
}

/// A strip whose right half follows a joint that rises with time.
fn put_strip(small: &mut Small, held: bool) {
    let columns = [-40.0f32, 0.0, 40.0].into_iter();
    let positions = columns.flat_map(|x| [[x, -6.0, 0.0], [x, 6.0, 0.0]]);
    let positions: Vec<[f32; 3]> = positions.collect();
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::all());
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 6]);
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 0.0]; 6]);
    mesh.insert_indices(Indices::U16(vec![0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5]));
    let body = small.put(Rectangle::default(), unlit(Color::WHITE), default());
    let at = Transform::from_xyz(0.0, 0.0, -50.0);
    let still = small.world().spawn(at).id();
    let rises = small.world().spawn((at, Rises)).id();
    let skin = skinned(small, mesh, &[still, rises], |vertex| (vertex / 4) as u16);
    small.on(body).insert(skin);
    let parts = (Transform::default(), Visibility::default());
    let mut root = small.world().spawn(parts);
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
    let run = |held: bool| {
        let mut small = stage();
        put_strip(&mut small, held);
        small.headless.step(3);
        small.film(20)
    };
    let (free, held) = (run(false), run(true));
    assert_eq!(runs(&free), [1; 20], "the free skin moves");
    let runs = runs(&held);
    let are_short = runs.len() <= 5 && runs.iter().all(|run| *run <= 5);
    assert!(are_short, "{runs:?}");
    let mut frame = runs[0];
    for run in &runs[1..] {
        assert!(held[frame] == free[frame], "frame {frame}");
        frame += run;
    }
}

/// A camera below a held entity moves at full rate, and an inner `SteppedAnimation` has its own.
#[test]
fn cameras_are_never_held() {
    let mut small = stage();
    square(&mut small, 0.0, ());
    let inner = square(&mut small, -24.0, SteppedAnimation { rate: 60.0 });
    let camera = small.camera;
    let parts = (Transform::default(), Visibility::default());
    let held = (parts, Walks(30.0), SteppedAnimation::default());
    small.world().spawn(held).add_children(&[camera, inner]);
    small.headless.step(10);
    let places = small.film(12).into_iter().map(|picture| {
        // It rests relative to the camera.
        let inner = place(&picture, 50..64);
        assert!((inner - 96.0).abs() < 0.6, "{inner}");
        place(&picture, 20..44)
    });
    let places: Vec<f64> = places.collect();
    let moves = places.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(moves >= 5, "half a pixel a frame: {places:?}");
}

/// Rates that are no numbers, entities that die while they are held, parents that change.
#[test]
fn what_happens_to_held_things() {
    let mut small = stage();
    small.insert(Hdr);
    let walkers = [f32::NAN, 0.0, -3.0, 1e30]
        .map(|rate| square(&mut small, 0.0, (Walks(60.0), SteppedAnimation { rate })));
    small.headless.step(3);
    small.world().despawn(walkers[0]);
    small.on(walkers[1]).remove::<SteppedAnimation>();
    small.on(walkers[2]).remove::<Mesh3d>();
    small.on(walkers[3]).insert(ChildOf(walkers[1]));
    small.headless.step(8);
    small.on(walkers[1]).remove::<GlobalTransform>();
    small.headless.step(3);
}
