//! Apps that tests use one after another.

use bevy::light::PointLightShadowMap;
use bevy_comics_testkit::pool::Pool;

use crate::prelude::*;

#[derive(Component)]
struct Mark;

#[derive(Resource)]
struct Own;

fn new(options: HeadlessOptions) -> Headless {
    Headless::new(options, ())
}

fn draw(headless: &mut Headless) {
    headless.step(1);
}

fn options() -> HeadlessOptions {
    HeadlessOptions {
        size: UVec2::splat(8),
        ..default()
    }
}

/// What a test spawns and sets is gone in the next one. Apps that a test changed for good are not used again.
#[test]
fn an_app_is_used_again_as_it_was() {
    static POOL: Pool = Pool::new(new, draw);
    for _ in 0..3 {
        let mut headless = POOL.take(options());
        let world = headless.app.world_mut();
        assert_eq!(world.query::<&Mark>().iter(world).count(), 0);
        assert_eq!(world.resource::<ClearColor>().0, ClearColor::default().0);
        world.insert_resource(ClearColor(Color::WHITE));
        let parent = world.spawn(Mark).id();
        for _ in 0..10 {
            world.spawn((Mark, ChildOf(parent)));
        }
        headless.step(2);
        drop(headless);
        assert_eq!(POOL.idle_apps(), 1);
    }
    let changes: [fn(&mut App); 3] = [
        |app| {
            app.insert_resource(Own);
        },
        |app| {
            app.add_systems(Update, || ());
        },
        |app| {
            app.world_mut().resource_mut::<PointLightShadowMap>().size = 64;
        },
    ];
    for change in changes {
        let mut headless = POOL.take(options());
        change(&mut headless.app);
        drop(headless);
        assert_eq!(POOL.idle_apps(), 0);
        drop(POOL.take(options()));
        assert_eq!(POOL.idle_apps(), 1);
    }
    let others = HeadlessOptions {
        parallel_systems: true,
        ..options()
    };
    drop(POOL.take(others));
    assert_eq!(POOL.idle_apps(), 1);
}
