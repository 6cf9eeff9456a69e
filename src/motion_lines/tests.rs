//! Points of meshes, and trails.

use bevy::{asset::RenderAssetUsages, math::Affine3A, mesh::PrimitiveTopology, prelude::*};

use super::{
    ribbon::{strength, taper},
    seeds::{Seed, seeds_of},
    trail::{Pose, Trail},
};

/// A box of 4 by 2 by 1.
fn brick() -> Mesh {
    Cuboid::new(4.0, 2.0, 1.0).into()
}

#[test]
fn points_lie_on_the_surface_evenly_by_area() {
    let seeds = seeds_of(&brick(), 128, 0);
    assert_eq!(seeds.len(), 128);
    let half = Vec3::new(2.0, 1.0, 0.5);
    let mut faces = [0u32; 3];
    for seed in &seeds {
        let off = seed.place.abs() - half;
        assert!(off.max_element().abs() < 1e-6, "{seed:?}");
        let axis = seed.normal.abs().max_position();
        // The outward normal of the face.
        assert!((seed.place[axis] - half[axis] * seed.normal[axis]).abs() < 1e-6);
        faces[axis] += 1;
    }
    // The faces across x, y and z have 4, 8 and 16 of 28 units of area. Random points have a
    // deviation of sqrt(n p (1 - p)), at most 5.6; those that avoid each other have less.
    for (count, area) in faces.into_iter().zip([4.0, 8.0, 16.0]) {
        let expected = 128.0 * area / 28.0;
        assert!((f64::from(count) - expected).abs() < 3.0 * 5.6, "{faces:?}");
    }
}

/// Points are farther from each other than random ones: of n random points on an area A, the
/// nearest neighbor is at `0.5 sqrt(A / n)` in the mean.
#[test]
fn points_keep_apart_and_depend_on_the_seed_alone() {
    let ball: Mesh = Sphere::new(1.0).mesh().ico(8).expect("few vertices");
    let seeds = seeds_of(&ball, 64, 5);
    let nearest = |seed: &Seed| {
        let others = seeds.iter().filter(|other| *other != seed);
        let distances = others.map(|other| other.place.distance(seed.place));
        distances.fold(f32::INFINITY, f32::min)
    };
    let mean = seeds.iter().map(nearest).sum::<f32>() / 64.0;
    let random = 0.5 * (4.0 * std::f32::consts::PI / 64.0).sqrt();
    assert!(mean > 1.3 * random, "{mean}, random ones: {random}");
    assert_eq!(seeds, seeds_of(&ball, 64, 5));
    assert_ne!(seeds, seeds_of(&ball, 64, 6));
}

#[test]
fn meshes_without_faces_have_no_points() {
    let empty = |topology| Mesh::new(topology, RenderAssetUsages::default());
    assert!(seeds_of(&empty(PrimitiveTopology::TriangleList), 8, 0).is_empty());
    assert!(seeds_of(&empty(PrimitiveTopology::LineList), 8, 0).is_empty());
    let broken = [[f32::NAN; 3], [0.0; 3], [1.0; 3]];
    let broken = empty(PrimitiveTopology::TriangleList)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, broken.to_vec());
    assert!(seeds_of(&broken, 8, 0).is_empty());
    // Indices beyond the vertices.
    let mut wild = brick();
    wild.insert_indices(bevy::mesh::Indices::U32(vec![0, 1, 9999]));
    assert!(seeds_of(&wild, 8, 0).is_empty());
}

fn moved(place: Vec3) -> Affine3A {
    Affine3A::from_translation(place)
}

fn corner() -> Seed {
    Seed {
        place: Vec3::new(1.0, 0.5, -0.25),
        normal: Vec3::X,
        chance: 0.0,
    }
}

/// The trail of a motion over a second at a frame rate.
fn trail(rate: u32, duration: f64, motion: impl Fn(f64) -> Affine3A) -> Trail {
    let mut trail = Trail::default();
    for frame in 0..=rate {
        let time = f64::from(frame) / f64::from(rate);
        let world_from_mesh = motion(time);
        let pose = Pose {
            time,
            world_from_mesh,
        };
        trail.add(pose, duration);
    }
    trail
}

fn length(path: &[Vec3A]) -> f32 {
    path.windows(2).map(|step| step[0].distance(step[1])).sum()
}

/// Memory does not grow: poses are thinned out at high frame rates, and old ones are dropped.
#[test]
fn a_trail_has_few_poses() {
    for (rate, duration) in [(1000, 0.5), (1000, 0.02), (20, 2.0), (60, 0.15)] {
        let trail = trail(rate, duration, |t| moved(Vec3::X * t as f32));
        let count = trail.poses().len();
        assert!((2..=36).contains(&count), "{rate}, {duration}: {count}");
        let (first, second) = (trail.poses()[0], trail.poses()[1]);
        let begins = 1.0 - duration;
        assert!(first.time <= begins.max(0.0) && second.time > begins);
    }
}

#[test]
fn a_pause_keeps_the_trail_and_a_jump_ends_it() {
    let steady = |t: f64| moved(Vec3::X * (2.0 * t) as f32);
    let mut trail = trail(60, 0.25, steady);
    let before = trail.poses().clone();
    for _ in 0..10 {
        let pose = Pose {
            time: 1.0,
            world_from_mesh: steady(1.0),
        };
        trail.add(pose, 0.25);
    }
    assert_eq!(*trail.poses(), before, "paused");
    // A frame that takes long is none, at the same speed.
    let late = Pose {
        time: 1.1,
        world_from_mesh: steady(1.1),
    };
    trail.add(late, 0.25);
    assert!(trail.poses().len() > 5);
    let jump = Pose {
        time: 1.1 + 1.0 / 60.0,
        world_from_mesh: moved(Vec3::Y * 40.0),
    };
    trail.add(jump, 0.25);
    assert_eq!(trail.poses().len(), 1);
}

/// Things are spawned somewhere, and put where they belong a frame later.
#[test]
fn a_jump_in_the_first_step_is_forgotten() {
    let mut trail = Trail::default();
    for frame in 0..4 {
        let x = if frame == 0 {
            -50.0
        } else {
            0.05 * frame as f32
        };
        let pose = Pose {
            time: f64::from(frame) / 60.0,
            world_from_mesh: moved(Vec3::X * x),
        };
        trail.add(pose, 0.25);
    }
    let path = trail.path(&corner(), 0.0, 0.05);
    assert!(length(&path) < 0.11, "{path:?}");
}

#[test]
fn transforms_that_are_no_numbers_leave_no_trail() {
    let mut trail = trail(60, 0.25, |t| moved(Vec3::X * t as f32));
    let pose = Pose {
        time: 1.5,
        world_from_mesh: Affine3A::from_scale_rotation_translation(
            Vec3::ONE,
            Quat::IDENTITY,
            Vec3::NAN,
        ),
    };
    trail.add(pose, 0.25);
    assert!(trail.poses().is_empty());
    assert!(trail.path(&corner(), 0.0, 2.0).is_empty());
}

#[test]
fn widths_grow_with_the_speed_and_taper_to_both_ends() {
    assert_eq!(strength(1.5, 2.0, -1.0), 0.0);
    assert_eq!(strength(2.5, 2.0, -1.0), 1.0);
    assert_eq!(strength(2.5, 2.0, 0.5), 0.0, "not in front");
    assert_eq!(taper(0.0), 0.0);
    let widths: Vec<f32> = (0..=100).map(|k| taper(k as f32 / 100.0)).collect();
    assert!(widths.iter().all(|w| (0.0..=1.0).contains(w)));
    assert!(widths[..85].is_sorted(), "thinner to the tail");
    assert!(widths[100] < 0.2);
}
