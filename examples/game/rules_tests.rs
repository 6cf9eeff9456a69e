//! Tests of the rules.

use super::*;

fn course() -> Course {
    Course {
        start: Vec3::new(0.0, 10.0, 0.0),
        heading: 0.0,
        lanterns: vec![Vec3::new(0.0, 10.0, -40.0), Vec3::new(20.0, 14.0, -80.0)],
        clouds: Vec::new(),
        seconds: 30.0,
        ground: |_| 0.0,
        ceiling: 70.0,
        scale: 1.0,
        solids: Solids::default(),
    }
}

/// The same with a wall across the way, 30 units ahead.
fn walled(course: Course) -> Course {
    let [a, b, c, d] =
        [(-9.0, 0.0), (9.0, 0.0), (9.0, 16.0), (-9.0, 16.0)].map(|(x, y)| Vec3::new(x, y, -30.0));
    let solids = Solids::new(vec![[a, b, c], [a, c, d]], 4.0);
    Course { solids, ..course }
}

fn fly(mut flight: Flight, mut controls: impl FnMut(&Flight) -> Controls) -> Flight {
    for _ in 0..6000 {
        let now = controls(&flight);
        flight.step(&now, 1.0 / 60.0);
    }
    flight
}

#[test]
fn the_autopilot_wins_and_nobody_else_does() {
    let won = fly(Flight::new(course()), Flight::autopilot);
    assert_eq!(won.found(), 2);
    assert!(won.is_over && won.seconds_left > 0.0);
    assert!(won.seconds_used() > 3.0 && won.seconds_used() < 10.0);
    let lost = fly(Flight::new(course()), |_| Controls::default());
    assert!(lost.is_over && lost.found() < 2 && lost.seconds_left == 0.0);
}

#[test]
fn only_the_next_lanterns_are_lit() {
    let lanterns = (0..6).map(|i| Vec3::new(0.0, 10.0, -60.0 * i as f32));
    let mut flight = Flight::new(Course {
        lanterns: lanterns.collect(),
        ..course()
    });
    assert_eq!(flight.lit().collect::<Vec<_>>(), [0, 1, 2]);
    flight.at = flight.course.lanterns[4];
    assert!(flight.step(&Controls::default(), 1e-3).is_empty());
    flight.at = flight.course.lanterns[1];
    let events = flight.step(&Controls::default(), 1e-3);
    assert_eq!(events, [Event::Lantern(1)]);
    assert_eq!(flight.lit().collect::<Vec<_>>(), [0, 2, 3]);
}

#[test]
fn walls_are_solid_at_every_frame_rate_and_slow_the_plane() {
    for frame in [1.0 / 240.0, 1.0 / 60.0, 0.1] {
        let mut flight = Flight::new(walled(course()));
        let boost = Controls {
            boost: true,
            ..Controls::default()
        };
        let (mut bumps, mut slowest) = (0, 1.0f32);
        for _ in 0..(1.6 / frame) as usize {
            let events = flight.step(&boost, frame);
            bumps += events.iter().filter(|e| **e == Event::Bump).count();
            slowest = slowest.min(flight.pace);
            assert!(flight.at.z > -30.0, "{frame}: {}", flight.at);
        }
        assert_eq!(bumps, 1, "{frame}");
        assert!(slowest < 0.5, "{frame}: {slowest}");
        let time = flight.course.seconds - flight.seconds_left;
        assert!(time < 1.8, "a wall costs speed, not time: {time}");
    }
}

#[test]
fn the_autopilot_flies_around_a_wall() {
    let won = fly(Flight::new(walled(course())), Flight::autopilot);
    assert_eq!(won.found(), 2, "{won:?}");
}

#[test]
fn the_ground_slows_and_no_more() {
    let mut flight = Flight::new(course());
    let down = Controls {
        steer: Vec2::new(0.0, -1.0),
        ..Controls::default()
    };
    let mut bumps = 0;
    for _ in 0..240 {
        let events = flight.step(&down, 1.0 / 60.0);
        bumps += events.iter().filter(|e| **e == Event::Bump).count();
        assert!(flight.at.y >= 1.0 - 1e-3 && flight.at.is_finite());
    }
    assert!(bumps >= 1);
    assert!((flight.seconds_used() - 4.0).abs() < 0.01);
}

#[test]
fn a_storm_cloud_costs_four_seconds() {
    let mut flight = Flight::new(Course {
        clouds: vec![Vec3::new(-5.0, 9.0, -40.0)],
        ..course()
    });
    let mut hits = 0;
    for _ in 0..180 {
        let events = flight.step(&Controls::default(), 1.0 / 60.0);
        hits += events.iter().filter(|e| **e == Event::Hit).count();
    }
    assert_eq!(hits, 1);
    assert!((flight.seconds_used() - 3.0 - LOSS).abs() < 0.01);
}

#[test]
fn a_smaller_scale_is_the_same_flight_in_a_smaller_world() {
    let small = |p: Vec3| p * 0.25;
    let full = course();
    let quarter = Course {
        start: small(full.start),
        lanterns: full.lanterns.iter().map(|p| small(*p)).collect(),
        ceiling: full.ceiling * 0.25,
        scale: 0.25,
        ..full.clone()
    };
    let controls = Controls {
        steer: Vec2::new(0.3, 0.2),
        ..Controls::default()
    };
    let [mut a, mut b] = [Flight::new(full), Flight::new(quarter)];
    for _ in 0..120 {
        a.step(&controls, 1.0 / 60.0);
        b.step(&controls, 1.0 / 60.0);
        assert!(small(a.at).distance(b.at) < 0.01);
    }
}

#[test]
fn slow_motion_slows_and_runs_out() {
    let slow = Controls {
        slow: true,
        ..Controls::default()
    };
    let mut flight = Flight::new(course());
    flight.step(&slow, 0.1);
    assert!(flight.is_slow);
    assert!((30.0 - flight.seconds_left - 0.1 * SLOW).abs() < 1e-4);
    for _ in 0..60 {
        flight.step(&slow, 0.1);
    }
    assert!(
        !flight.is_slow || flight.focus < 0.05,
        "slow motion has to run out"
    );
}
