//! When flashes begin, and how many are let through.

use std::time::Duration;

use bevy::window::WindowRef;

use super::*;

/// Frames per second, as multiples of which times are exact.
const RATE: usize = 64;

/// Runs frames from 0 on. In each, `trigger` gives impacts; `waits` says whether a pipeline is
/// compiling, which is known a frame late, as in the app. Returns the frames in which the
/// picture begins to change there and back.
fn flashes(
    frames: usize,
    trigger: impl Fn(usize) -> Option<Impact>,
    compiles: impl Fn(usize) -> bool,
) -> Vec<usize> {
    let mut impacts = Impacts::default();
    let mut changes = Vec::new();
    let mut before = None;
    for frame in 0..frames {
        let seconds = frame as f64 / RATE as f64;
        let now = Moment {
            game: seconds,
            real: seconds,
        };
        if let Some(impact) = trigger(frame) {
            impacts.start(impact.sanitized(), 0, seconds);
        }
        let waits = frame > 0 && compiles(frame - 1);
        impacts.run(now, waits, false);
        // What the frame shows: a tone, or the original while the pipeline compiles.
        let running = impacts.running.as_ref().filter(|_| !compiles(frame));
        let shown = running.map(|running| {
            let since = running.since.expect("it has run");
            let drawing = clock::drawing(seconds - since, running.impact.rate);
            running.impact.alternate && drawing % 2 == 1
        });
        if shown != before {
            changes.push(frame);
        }
        before = shown;
    }
    changes.into_iter().step_by(2).collect()
}

/// Truth: no second has more flashes than the limit, wherever it begins.
fn assert_few(flashes: &[usize], case: &str) {
    for (i, first) in flashes.iter().enumerate() {
        let within = flashes[i..].iter().filter(|f| **f < first + RATE).count();
        assert!(
            within <= Impact::MOST_FLASHES,
            "{case}: from frame {first}: {flashes:?}"
        );
    }
}

fn impact(drawings: u32, rate: f32, alternate: bool) -> Impact {
    Impact {
        drawings,
        rate,
        alternate,
        ..Impact::new(Entity::PLACEHOLDER)
    }
}

#[test]
fn an_impact_that_waits_flashes_when_it_is_shown() {
    // Compiles until shortly before a second has passed; then three more are asked for.
    for done in [1, 2, 30, 61, 64, 90] {
        let trigger = |frame: usize| {
            let later = frame >= done && frame.is_multiple_of(6);
            (frame == 0 || later).then(|| impact(1, 30.0, false))
        };
        let found = flashes(done + 160, trigger, |frame| frame < done);
        assert!(found.len() > 5, "{found:?}");
        assert_few(&found, &format!("compiled in frame {done}"));
    }
}

#[test]
fn every_flash_of_an_impact_counts_from_where_it_begins() {
    for (drawings, rate) in [(2, 4.0), (3, 4.0), (3, 12.0), (2, 30.0), (3, 30.0)] {
        for every in [1, 5, 7, 11, 16, 33] {
            let trigger = |frame: usize| {
                frame
                    .is_multiple_of(every)
                    .then(|| impact(drawings, rate, true))
            };
            let found = flashes(400, trigger, |_| false);
            assert_few(&found, &format!("{drawings} at {rate}, every {every}"));
        }
    }
}

fn app() -> App {
    let mut app = App::new();
    app.init_resource::<ComicsDiagnostics>()
        .init_resource::<ReduceFlashing>()
        .init_resource::<PastFlashes>()
        .init_resource::<Time>()
        .add_observer(start_impact)
        .add_observer(keep_flashes)
        .add_systems(Update, run_impacts);
    app
}

/// Three flashes on a window, then the camera is `changed`: no other camera flashes there within
/// the second.
fn assert_flashes_stay(changed: impl FnOnce(&mut App, Entity), case: &str) {
    let mut app = app();
    let first = app.world_mut().spawn(Camera::default()).id();
    for _ in 0..Impact::MOST_FLASHES {
        app.world_mut().trigger(Impact::new(first));
        app.update();
    }
    changed(&mut app, first);
    app.update();
    let second = app.world_mut().spawn(Camera::default()).id();
    let ask = |app: &mut App| {
        app.world_mut().trigger(Impact::new(second));
        app.update();
        app.world().resource::<ComicsDiagnostics>().impacts[&second]
    };
    let count = ask(&mut app);
    assert_eq!((count.shown, count.refused), (0, 1), "{case}");
    let later = Duration::from_millis(1001);
    app.world_mut().resource_mut::<Time>().advance_by(later);
    let count = ask(&mut app);
    assert_eq!((count.shown, count.refused), (1, 1), "{case}");
}

#[test]
fn flashes_of_cameras_that_left_count() {
    assert_flashes_stay(
        |app, camera| {
            app.world_mut().despawn(camera);
        },
        "despawned",
    );
    assert_flashes_stay(
        |app, camera| {
            let elsewhere = RenderTarget::None {
                size: UVec2::splat(8),
            };
            app.world_mut().entity_mut(camera).insert(elsewhere);
        },
        "another target",
    );
}

#[test]
fn the_primary_window_is_the_same_by_another_name() {
    let mut app = app();
    let window = app
        .world_mut()
        .spawn((Window::default(), PrimaryWindow))
        .id();
    let named = RenderTarget::Window(WindowRef::Entity(window));
    let first = app.world_mut().spawn(Camera::default()).id();
    let second = app.world_mut().spawn((Camera::default(), named)).id();
    for camera in [first, second, first, second] {
        app.world_mut().trigger(Impact::new(camera));
        app.update();
    }
    let counts = &app.world().resource::<ComicsDiagnostics>().impacts;
    assert_eq!((counts[&first].shown, counts[&second].shown), (2, 1));
    assert_eq!(counts[&second].refused, 1);
}
