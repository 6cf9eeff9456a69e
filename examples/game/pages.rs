//! The pages of the game, as states of the engine, and how the player turns them.

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::{CameraCut, effect::EffectTarget};
use bevy_comics_testkit::scenes::{ScenePart, Stage};

use crate::{
    Game, Target,
    best::BestTimes,
    courses::LEVELS,
    flying::Chase,
    input::Input,
    scenery::{self, Plane, build},
    styles::{Dressed, Looks},
};

/// The page that is shown.
#[derive(States, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Page {
    #[default]
    Title,
    Flying,
    Paused,
    Photo,
    Won,
    Lost,
}

pub struct PagesPlugin;

impl Plugin for PagesPlugin {
    fn build(&self, app: &mut App) {
        app.init_state::<Page>()
            .init_resource::<BestTimes>()
            .add_systems(OnEnter(Page::Won), keep_time)
            .add_systems(
                Update,
                (
                    (choose_level.run_if(in_state(Page::Title)), turn_pages).chain(),
                    (open_level, scenery::finish, aim)
                        .chain()
                        .run_if(|game: Res<Game>| game.fresh),
                )
                    .chain()
                    .in_set(Pages),
            );
    }
}

/// The systems that turn pages and open levels.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Pages;

fn choose_level(mut game: ResMut<Game>, input: Res<Input>) {
    if input.choose != 0 {
        let count = LEVELS.len() as i32;
        let level = (game.level as i32 + input.choose).rem_euclid(count);
        game.open(level as usize);
    }
}

/// Changes the page when a button is pressed.
fn turn_pages(
    mut game: ResMut<Game>,
    input: Res<Input>,
    page: Res<State<Page>>,
    mut next: ResMut<NextState<Page>>,
) {
    let now = *page.get();
    let to = match now {
        Page::Title if input.confirm => Page::Flying,
        Page::Flying if input.pause => Page::Paused,
        Page::Flying | Page::Paused if input.photo => Page::Photo,
        Page::Paused if input.pause || input.confirm => Page::Flying,
        Page::Photo if input.photo || input.pause => Page::Paused,
        Page::Won | Page::Lost if input.confirm => Page::Title,
        Page::Paused if input.quit => Page::Title,
        Page::Title | Page::Photo => return,
        _ if input.restart => Page::Flying,
        _ => return,
    };
    let level = game.level;
    match (now, to) {
        // After a level, the title offers the next one.
        (Page::Won, Page::Title) => game.open((level + 1) % LEVELS.len()),
        (Page::Lost | Page::Paused, Page::Title) => game.open(level),
        (_, Page::Flying) if input.restart => game.open(level),
        _ => {}
    }
    next.set(to);
}

fn keep_time(mut game: ResMut<Game>, mut best: ResMut<BestTimes>) {
    let (key, seconds) = (LEVELS[game.level].key, game.flight.seconds_used());
    // The autopilot's times are not the player's.
    game.is_record = !game.autopilot && best.record(key, seconds);
}

fn open_level(
    mut stage: Stage,
    mut game: ResMut<Game>,
    mut looks: ResMut<Looks>,
    old: Query<Entity, Or<((With<ScenePart>, Without<ChildOf>), With<Dressed>)>>,
    target: Option<Res<Target>>,
) {
    for entity in &old {
        stage.commands.entity(entity).despawn();
    }
    game.is_record = false;
    let level = &LEVELS[game.level];
    let vantage = build(&mut stage, level, &game.flight);
    looks.enter(level.style());
    let mut camera = stage.commands.spawn((
        Name::new("Chase camera"),
        Dressed,
        vantage.camera(),
        Chase::behind(&game.flight),
        Msaa::Sample4,
        IsDefaultUiCamera,
    ));
    if let Some(target) = target {
        camera.insert(target.0.clone());
    }
    // The depth range must not be smoothed from the last level to this one.
    let camera = camera.id();
    stage.commands.trigger(CameraCut { entity: camera });
}

/// Points the camera's effects at the plane.
fn aim(
    mut commands: Commands,
    mut game: ResMut<Game>,
    camera: Single<Entity, With<Dressed>>,
    plane: Single<Entity, With<Plane>>,
) {
    game.fresh = false;
    commands.entity(*camera).insert(EffectTarget::new(*plane));
}
