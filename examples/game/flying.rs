//! A flight on the screen: events become looks, and entities follow the rules' state.

use bevy::prelude::*;

use crate::{
    Game,
    input::Input,
    pages::{Page, Pages},
    rules::{Controls, Event, Flight},
    scenery::{CloudAt, LanternAt, Plane},
    styles::{Dressed, Looks, Mood, come_back, dress},
};

pub struct FlyingPlugin;

impl Plugin for FlyingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Looks>()
            .add_observer(come_back)
            .add_systems(
                Update,
                (
                    fly.run_if(in_state(Page::Flying)),
                    set_mood,
                    (move_plane, light_lanterns, drift_clouds, follow),
                    dress.run_if(any_with_component::<Dressed>),
                )
                    .chain()
                    .after(Pages),
            );
    }
}

/// A camera that follows the plane with a delay. Both places are in world units.
#[derive(Component)]
pub struct Chase {
    eye: Vec3,
    target: Vec3,
}

impl Chase {
    fn goal(flight: &Flight) -> (Vec3, Vec3) {
        let heading = Quat::from_rotation_y(flight.yaw);
        let scale = flight.course.scale;
        let eye = Vec3::new(0.0, 2.7, 6.5) * scale;
        let target = Vec3::new(0.0, 0.6 + 6.0 * flight.pitch, -12.0) * scale;
        (flight.at + heading * eye, flight.at + heading * target)
    }

    pub fn behind(flight: &Flight) -> Self {
        let (eye, target) = Self::goal(flight);
        Self { eye, target }
    }
}

fn fly(
    mut game: ResMut<Game>,
    mut looks: ResMut<Looks>,
    input: Res<Input>,
    time: Res<Time>,
    mut next: ResMut<NextState<Page>>,
) {
    let controls = if game.autopilot {
        game.flight.autopilot()
    } else {
        Controls {
            steer: input.steer,
            boost: input.boost,
            slow: input.slow,
        }
    };
    // A longer step, after a slow frame, would be a jump on the screen.
    let seconds = time.delta_secs().min(0.1);
    for event in game.flight.step(&controls, seconds) {
        game.shout(event, time.elapsed_secs());
        match event {
            Event::Lantern(_) => looks.lantern(),
            Event::Bump => looks.bump(),
            Event::Hit => looks.hit(),
            Event::Won => next.set(Page::Won),
            Event::Lost => next.set(Page::Lost),
        }
    }
}

fn set_mood(game: Res<Game>, page: Res<State<Page>>, mut looks: ResMut<Looks>) {
    looks.danger = game.flight.danger();
    looks.mood = match page.get() {
        Page::Title => Mood::Title,
        Page::Flying if game.flight.is_slow => Mood::Slow,
        Page::Flying if game.flight.is_fast => Mood::Fast,
        // The photo mode keeps the style of the flight.
        Page::Flying | Page::Photo => Mood::Flying,
        Page::Paused => Mood::Paused,
        Page::Won => Mood::Won,
        Page::Lost => Mood::Lost,
    };
}

fn move_plane(game: Res<Game>, mut plane: Single<&mut Transform, With<Plane>>) {
    let flight = &game.flight;
    // The nose is drawn lower than it is, so that the wings stay visible in a climb.
    let lower = Quat::from_rotation_x(-0.12 - 0.5 * flight.pitch.max(0.0));
    plane.translation = flight.at;
    plane.rotation = flight.rotation() * lower;
}

/// Shows the lanterns that are lit, the next one as the largest. They face the plane.
fn light_lanterns(
    game: Res<Game>,
    mut lanterns: Query<(&mut Transform, &mut Visibility, &LanternAt)>,
) {
    let lit: Vec<usize> = game.flight.lit().collect();
    for (mut transform, mut visibility, lantern) in &mut lanterns {
        let place = lit.iter().position(|index| *index == lantern.0);
        visibility.set_if_neq(match place {
            Some(_) => Visibility::Inherited,
            None => Visibility::Hidden,
        });
        if let Some(place) = place {
            let size = if place == 0 { 1.0 } else { 0.6 };
            transform.scale = Vec3::splat(size * game.flight.course.scale);
            let away = transform.translation - game.flight.at;
            transform.rotation = Quat::from_rotation_y(away.x.atan2(away.z));
        }
    }
}

fn drift_clouds(game: Res<Game>, mut clouds: Query<(&mut Transform, &CloudAt)>) {
    let flight = &game.flight;
    for (mut transform, cloud) in &mut clouds {
        if cloud.0 < flight.course.clouds.len() {
            transform.translation = flight.cloud(cloud.0);
        }
    }
}

fn follow(
    game: Res<Game>,
    page: Res<State<Page>>,
    time: Res<Time>,
    mut camera: Single<(&mut Transform, &mut Chase), Without<Plane>>,
) {
    let flight = &game.flight;
    let scale = flight.course.scale;
    let (transform, chase) = &mut *camera;
    let (eye, target) = match page.get() {
        // A slow orbit around the plane.
        Page::Title => {
            let turn = Quat::from_rotation_y(flight.yaw + 0.5 + time.elapsed_secs() * 0.15);
            (
                flight.at + turn * Vec3::new(0.0, 1.6, 5.0) * scale,
                flight.at,
            )
        }
        _ => Chase::goal(flight),
    };
    let fraction = 1.0 - (-7.0 * time.delta_secs()).exp();
    chase.eye = chase.eye.lerp(eye, fraction);
    chase.target = chase.target.lerp(target, fraction * 0.9);
    let course = &flight.course;
    let lowest = (course.ground)(Vec2::new(chase.eye.x, chase.eye.z)) + 0.6 * scale;
    chase.eye.y = chase.eye.y.max(lowest);
    if let Some(way) = course.solids.way_out(chase.eye, 0.5 * scale) {
        chase.eye += way;
    }
    **transform = Transform::from_translation(chase.eye).looking_at(chase.target, Vec3::Y);
}
