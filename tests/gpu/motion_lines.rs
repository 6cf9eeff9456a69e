//! Lines behind what moves: where they are, how wide they are, and when there are none.

use bevy::time::{TimeUpdateStrategy, Virtual};
use bevy_comics::{MotionLines, SteppedAnimation};

use crate::{
    floating_origin::{SHIFT, shift},
    prelude::*,
};

const SIZE: UVec2 = UVec2::new(160, 96);
/// Half of the size of the box.
const HALF: Vec3 = Vec3::new(0.4, 0.3, 0.2);
/// Units per second.
const SPEED: f32 = 12.0;

/// A gray box in front of white, seen along -z at a tenth of a unit per pixel.
struct Stage {
    small: Small,
    mesh: Entity,
}

fn lines() -> MotionLines {
    MotionLines {
        duration: 0.25,
        variation: 0.0,
        ..default()
    }
}

impl Stage {
    fn new(lines: MotionLines) -> Self {
        let mut small = Small::new(SIZE, Msaa::Off);
        small.empty_view(Msaa::Off, Color::WHITE);
        small.insert(Transform::from_xyz(0.0, 0.0, 0.05 * SIZE.y as f32));
        let gray = unlit(Color::srgb(0.5, 0.5, 0.5));
        let start = Transform::from_xyz(-5.0, 0.0, 0.0);
        let mesh = small.put(Cuboid::from_size(2.0 * HALF), gray, start);
        small.on(mesh).insert(lines);
        small.headless.step(3);
        Self { small, mesh }
    }

    fn seconds(&mut self) -> f64 {
        self.small.world().resource::<Time>().elapsed_secs_f64()
    }

    /// Steps while the box moves as a function of time says.
    fn fly(&mut self, frames: usize, place: impl Fn(f32) -> Transform) {
        for _ in 0..frames {
            let time = (self.seconds() + 0.016_667) as f32;
            self.small.on(self.mesh).insert(place(time));
            self.small.headless.step(1);
        }
    }

    /// From left to right.
    fn dash(&mut self, frames: usize) {
        let begin = self.seconds() as f32;
        let place = |t| Transform::from_xyz(-5.0 + SPEED * (t - begin), 0.0, 0.0);
        self.fly(frames, place);
    }

    /// Where the box is.
    fn at(&mut self) -> Transform {
        let at = self.small.world().get(self.mesh);
        *at.expect("the box")
    }

    /// The ribbons that are shown, and the pixels of ink, are none.
    fn assert_bare(&mut self, what: &str) {
        assert_eq!((self.places().len(), self.ink().len()), (0, 0), "{what}");
    }

    /// Places of all ribbons in the world, of both sides, if they are shown.
    fn places(&mut self) -> Vec<Vec3> {
        let world = self.small.world();
        type Ribbon = (
            &'static Mesh3d,
            &'static GlobalTransform,
            &'static ViewVisibility,
        );
        let mut ribbons = world.query_filtered::<Ribbon, Without<Object>>();
        let meshes = world.resource::<Assets<Mesh>>();
        let shown = ribbons.iter(world).filter(|(.., shown)| shown.get());
        let places = shown.flat_map(|(mesh, at, _)| {
            let mesh = meshes.get(&mesh.0).expect("a mesh");
            let list = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
            let list = list.and_then(|list| list.as_float3()).expect("places");
            list.iter()
                .map(|place| at.transform_point(Vec3::from(*place)))
        });
        places.collect()
    }

    /// The number of entities with ribbons.
    fn ribbons(&mut self) -> usize {
        let world = self.small.world();
        let mut ribbons = world.query_filtered::<(), (With<Mesh3d>, Without<Object>)>();
        ribbons.iter(world).count()
    }

    /// Pixels that are darker than the gray of the box.
    fn ink(&mut self) -> Vec<UVec2> {
        let picture = self.small.picture();
        let dark = picture.enumerate_pixels().filter(|(_, _, p)| p.0[0] < 100);
        dark.map(|(x, y, _)| UVec2::new(x, y)).collect()
    }
}

/// Lines of what moves straight on are the paths of points of its surface: at its height, behind
/// it, from the gap to the whole duration. The tolerance is that of f32 at 10 units, and a
/// microsecond.
#[test]
fn lines_are_the_paths_of_points_of_the_surface() {
    let mut stage = Stage::new(lines());
    stage.dash(30);
    let now = stage.at().translation;
    let places = stage.places();
    assert!(places.len() > 100, "{}", places.len());
    let (gap, whole) = (0.1 * 0.25 * SPEED, 0.25 * SPEED);
    let (mut first, mut last) = (f32::INFINITY, f32::NEG_INFINITY);
    for place in places {
        let from = place - now;
        let is_within = from.y.abs() <= HALF.y + 1e-5 && from.z.abs() <= HALF.z + 1e-5;
        assert!(is_within, "{from}");
        first = first.min(from.x);
        last = last.max(from.x);
    }
    // Points at the back are on its left side.
    let off = [first + HALF.x + whole, last + HALF.x + gap];
    assert!(off.iter().all(|off| off.abs() < 1e-4), "{off:?}");
    let box_left = 80.0 + 10.0 * (now.x - HALF.x);
    let ink = stage.ink();
    assert!(ink.len() > 40, "{}", ink.len());
    assert!(ink.iter().all(|pixel| (pixel.x as f32) < box_left));
}

/// Points of what turns are on circles about its axis, within the height of the arc between two
/// frames: `r (1 - cos(w / 120))`.
#[test]
fn lines_of_what_turns_are_arcs() {
    const TURN: f32 = 9.0;
    const SCALE: f32 = 3.0;
    let mut stage = Stage::new(lines());
    stage.fly(40, |t| {
        Transform::from_rotation(Quat::from_rotation_z(TURN * t)).with_scale(Vec3::splat(SCALE))
    });
    let places = stage.places();
    assert!(places.len() > 100);
    let farthest = SCALE * HALF.truncate().length();
    let sag = farthest * (1.0 - (TURN / 120.0).cos());
    // Points of faces that turn in their own plane have no lines, so each line has another height.
    for line in places.chunk_by(|a, b| (a.z - b.z).abs() < 1e-6) {
        let radius = line[0].truncate().length();
        assert!(radius <= farthest + 1e-5);
        // A point has to move at 1.6 units a second to have a line at all.
        assert!(radius > 1.6 / TURN - sag, "{radius}");
        let off = line.iter().map(|p| (p.truncate().length() - radius).abs());
        let most = off.fold(0.0, f32::max);
        assert!(most <= sag + 1e-5, "{most}, {sag}");
    }
    assert!(stage.ink().len() > 20);
}

#[test]
fn there_are_none_of_what_is_still_or_slow() {
    let mut stage = Stage::new(lines());
    stage.small.headless.step(20);
    assert_eq!((stage.ribbons(), stage.ink().len()), (0, 0), "still");
    let begin = stage.seconds() as f32;
    // Below 0.8 of the speed that has lines.
    let slow = |t: f32| Transform::from_xyz(-2.0 + 1.5 * (t - begin), 0.0, 0.0);
    stage.fly(30, slow);
    assert_eq!((stage.ribbons(), stage.ink().len()), (0, 0), "slow");
    stage.dash(30);
    assert!(!stage.ink().is_empty());
    // It stops: when the duration is over, nothing is left.
    let stop = stage.at();
    stage.fly(20, |_| stop);
    stage.assert_bare("stopped");
}

#[test]
fn a_pause_keeps_them() {
    let mut stage = Stage::new(lines());
    stage.dash(30);
    let (picture, places) = (stage.small.picture(), stage.places());
    stage.small.world().resource_mut::<Time<Virtual>>().pause();
    stage.small.headless.step(30);
    assert_eq!(stage.places(), places);
    assert_eq!(stage.small.picture(), picture);
    let mut time = stage.small.world().resource_mut::<Time<Virtual>>();
    time.unpause();
    // Standing still, time goes on.
    stage.small.headless.step(20);
    assert_eq!(stage.ink().len(), 0);
}

#[test]
fn they_begin_anew_at_a_jump_and_at_a_cut() {
    let mut stage = Stage::new(lines());
    for (what, place) in [
        ("a jump", Transform::from_xyz(2.0, 3.0, -1.0)),
        ("a cut", Transform::from_xyz(-1.0, 0.0, 0.0)),
    ] {
        stage.dash(20);
        assert!(!stage.ink().is_empty());
        if what == "a cut" {
            stage.small.cut();
        }
        stage.fly(1, |_| place);
        stage.assert_bare(what);
    }
}

/// A shift of the whole world is no motion: lines are where they would be without it, from their box.
#[test]
fn a_shift_of_the_world_is_no_motion() {
    let drawn = |by: Vec3, tells: bool| {
        let mut stage = Stage::new(lines());
        let begin = stage.seconds() as f32;
        let place = |t| Vec3::new(-5.0 + SPEED * (t - begin), 0.0, 0.0);
        stage.fly(10, |t| Transform::from_translation(place(t)));
        shift(stage.small.world(), by, tells);
        stage.fly(3, |t| Transform::from_translation(place(t) + by));
        let at = stage.at().translation;
        let places = stage.places().into_iter().map(|place| place - at);
        let places: Vec<Vec3> = places.collect();
        (places, stage.ink().len())
    };
    let (still, told) = (drawn(Vec3::ZERO, false), drawn(SHIFT, true));
    assert!(!still.0.is_empty());
    let pairs = still.0.iter().zip(&told.0);
    let most = pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    // An f32 has 6e-5 at 1000; a place has some roundings.
    assert!(most < 1e-3 && still.0.len() == told.0.len(), "{most}");
    assert!(still.1.abs_diff(told.1) <= 2, "{}, {}", still.1, told.1);
    // Three frames after a jump, lines are short.
    let untold = drawn(SHIFT, false);
    assert!(untold.1 < still.1 / 2, "{}, {}", untold.1, still.1);
}

/// Ribbons go with the object or its component, and wait while it is hidden. There is one entity
/// per object, whatever the time.
#[test]
fn they_go_with_their_object() {
    let mut stage = Stage::new(lines());
    let meshes = |stage: &mut Stage| stage.small.world().resource::<Assets<Mesh>>().len();
    stage.dash(12);
    let before = meshes(&mut stage);
    for _ in 0..2 {
        stage.dash(20);
        assert_eq!(stage.ribbons(), 1);
    }
    assert_eq!(meshes(&mut stage), before);
    let mesh = stage.mesh;
    stage.small.on(mesh).insert(Visibility::Hidden);
    stage.small.headless.step(2);
    assert!(stage.places().is_empty());
    stage.small.on(mesh).insert(Visibility::Inherited);
    stage.dash(20);
    assert!(!stage.places().is_empty());
    stage.small.on(mesh).remove::<MotionLines>();
    stage.small.headless.step(1);
    assert_eq!(stage.ribbons(), 0);
    stage.small.on(mesh).insert(lines());
    stage.dash(20);
    assert_eq!(stage.ribbons(), 1);
    stage.small.world().despawn(mesh);
    stage.small.headless.step(1);
    assert_eq!(stage.ribbons(), 0);
}

/// At the same moment of the same motion, lines are the same at 30 and at 144 frames a second.
#[test]
fn the_frame_rate_does_not_matter() {
    let [slow, fast] = [30u32, 144].map(|rate| {
        let mut stage = Stage::new(lines());
        let frame = Duration::from_secs_f64(1.0 / f64::from(rate));
        let app = &mut stage.small.headless.app;
        app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
        let begin = stage.seconds();
        for k in 1..=rate / 2 {
            let x = -5.0 + SPEED * k as f32 / rate as f32;
            let at = Transform::from_xyz(x, 0.0, 0.0);
            stage.small.on(stage.mesh).insert(at);
            stage.small.headless.step(1);
        }
        let passed = stage.seconds() - begin;
        assert!((passed - 0.5).abs() < 1e-6, "{passed}");
        let places = stage.places();
        let low = places.iter().copied().reduce(Vec3::min).expect("lines");
        let high = places.iter().copied().reduce(Vec3::max).expect("lines");
        (low, high)
    });
    let off = (slow.0 - fast.0).abs().max((slow.1 - fast.1).abs());
    assert!(off.max_element() < 1e-4, "{slow:?}, {fast:?}");
}

/// The ink across a line is its width: where it is widest, a column of pixels has that much. Along
/// the line, of 32 pixels, its width changes by 3 % from pixel to pixel. A pixel is rounded to one
/// of 256 codes, whose steps are less than a hundredth.
#[test]
fn lines_are_as_wide_as_asked_in_pixels() {
    let mut stage = Stage::new(lines());
    let mesh = stage.mesh;
    // A plate that faces backwards, so that the only point has a line.
    let plate = Mesh::from(Rectangle::new(0.1, 0.1));
    let plate = plate.rotated_by(Quat::from_rotation_y(-std::f32::consts::FRAC_PI_2));
    let world = stage.small.world();
    let plate = world.resource_mut::<Assets<Mesh>>().add(plate);
    world.entity_mut(mesh).insert(Mesh3d(plate));
    for width in [1.0, 2.5, 6.0] {
        let one = MotionLines {
            points: 1,
            width,
            duration: 0.3,
            ..lines()
        };
        stage.small.on(mesh).insert(one);
        stage.dash(24);
        let picture = stage.small.picture();
        let column = |x: u32| black_ink(&picture, (0..SIZE.y).map(|y| (x, y)));
        let widest = (0..SIZE.x).map(column).fold(0.0, f64::max);
        // Before its head, the line has 0.85^0.8 = 0.88 of its width.
        let expected = 0.88 * f64::from(width);
        let off = (widest - expected).abs();
        assert!(off < 0.03 * expected + 0.02, "{widest}, {expected}");
    }
}

/// They are in no prepass: the depth, the normals and the ids of a picture are those without them,
/// and so are its outlines away from the ink.
#[test]
fn they_are_not_in_the_prepass() {
    let mut stage = Stage::new(lines());
    stage.small.insert(Outlines::default());
    stage.dash(40);
    let prepass = |stage: &mut Stage| {
        let depth = stage.small.depth().expect("a prepass").bits;
        let normals = stage.small.normals().expect("normals").pixels;
        let ids = stage.small.ids().into_iter().map(|id| id != 0);
        (depth, normals, ids.collect::<Vec<bool>>())
    };
    assert!(!stage.places().is_empty());
    let with = prepass(&mut stage);
    let mesh = stage.mesh;
    stage.small.on(mesh).remove::<MotionLines>();
    stage.small.headless.step(2);
    assert!(stage.places().is_empty());
    assert!(with == prepass(&mut stage));
}

/// With the rate of a stepped animation, lines change in the same frames.
#[test]
fn they_can_be_drawn_on_twos() {
    let mut stage = Stage::new(MotionLines {
        rate: 12.0,
        ..lines()
    });
    stage
        .small
        .on(stage.mesh)
        .insert(SteppedAnimation::default());
    stage.dash(30);
    let pictures = (0..=20).map(|frame| {
        if frame > 0 {
            let (now, at) = (stage.seconds() as f32, stage.at());
            let step = |t: f32| 0.2 * SPEED * (t - now) * Vec3::X;
            stage.fly(1, |t| Transform::from_translation(at.translation + step(t)));
        }
        stage.small.picture()
    });
    let pictures: Vec<_> = pictures.collect();
    let changes = pictures.windows(2).filter(|two| two[0] != two[1]);
    assert_eq!(changes.count(), 4);
}
