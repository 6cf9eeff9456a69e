//! The text on the screen.

use bevy::prelude::*;

use crate::{Game, Page, courses::LEVELS};

pub struct ScreenPlugin;

impl Plugin for ScreenPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, spawn).add_systems(Update, write);
        #[cfg(feature = "inspector")]
        app.add_systems(Update, photo_mode);
    }
}

/// The line at the top left: level, lanterns, time, points.
#[derive(Component)]
struct Status;

/// The box at the bottom centre: title, pause, results.
#[derive(Component)]
struct Notice;

const INK: Color = Color::srgb(0.1, 0.09, 0.13);
const PAPER: Color = Color::srgba(0.99, 0.97, 0.9, 0.94);

fn spawn(mut commands: Commands) {
    let caption = |size: f32| {
        (
            TextFont {
                font_size: FontSize::Px(size),
                ..default()
            },
            TextColor(INK),
            BackgroundColor(PAPER),
            BorderColor::all(INK),
        )
    };
    commands.spawn((
        Status,
        Text::default(),
        caption(22.0),
        Node {
            position_type: PositionType::Absolute,
            top: Val::Px(14.0),
            left: Val::Px(14.0),
            padding: UiRect::axes(Val::Px(14.0), Val::Px(6.0)),
            border: UiRect::all(Val::Px(3.0)),
            ..default()
        },
    ));
    commands
        .spawn(Node {
            width: Val::Percent(100.0),
            height: Val::Percent(100.0),
            align_items: AlignItems::FlexEnd,
            justify_content: JustifyContent::Center,
            padding: UiRect::bottom(Val::Percent(7.0)),
            ..default()
        })
        .with_child((
            Notice,
            Text::default(),
            caption(24.0),
            TextLayout::justify(Justify::Center),
            Node {
                padding: UiRect::axes(Val::Px(26.0), Val::Px(16.0)),
                border: UiRect::all(Val::Px(4.0)),
                ..default()
            },
        ));
}

const TITLE: &str = "\
PAPER GLIDER

Collect all lanterns before the time is up.
Hitting a storm cloud or the ground costs four seconds.

Steer  arrows, WASD or stick      Boost  Space or A
Slow motion  Shift or X      Photo  F or Y      Pause  Esc or Start

Press Enter or A";

fn write(
    game: Res<Game>,
    mut status: Single<(&mut Text, &mut Visibility), (With<Status>, Without<Notice>)>,
    mut notice: Single<(&mut Text, &mut Visibility), (With<Notice>, Without<Status>)>,
) {
    let flight = &game.flight;
    let total = game.score + flight.score;
    let top = format!(
        "{}   lanterns {}/{}   {:>4.1} s   {total} points   focus {:.0} %",
        LEVELS[game.level].name,
        flight.found(),
        flight.course.lanterns.len(),
        flight.seconds_left,
        flight.focus * 100.0,
    );
    let middle = match game.page {
        Page::Title => TITLE.to_owned(),
        Page::Paused => "PAUSED\n\nEsc: continue   R: restart   F: photo mode".to_owned(),
        Page::Won if game.level + 1 == LEVELS.len() => {
            format!("THE END\n\n{total} points\n\nEnter: play again")
        }
        Page::Won => format!("ALL LANTERNS!\n\n{total} points\n\nEnter: next course"),
        Page::Lost => "TIME IS UP\n\nEnter: try again".to_owned(),
        Page::Photo if cfg!(feature = "inspector") => String::new(),
        Page::Photo => "F: back".to_owned(),
        Page::Flying => String::new(),
    };
    let shows_status = !matches!(game.page, Page::Title | Page::Photo);
    set(&mut status, if shows_status { top } else { String::new() });
    set(&mut notice, middle);
}

fn set(place: &mut (Mut<Text>, Mut<Visibility>), words: String) {
    let visibility = if words.is_empty() {
        Visibility::Hidden
    } else {
        Visibility::Inherited
    };
    place.1.set_if_neq(visibility);
    if **place.0 != words {
        **place.0 = words;
    }
}

/// Opens the panel in the photo mode, and closes it afterwards.
#[cfg(feature = "inspector")]
fn photo_mode(
    game: Res<Game>,
    mut inspector: ResMut<bevy_comics::inspector::ComicsInspector>,
    mut before: Local<Page>,
) {
    if *before != game.page {
        if game.page == Page::Photo {
            inspector.open = true;
        } else if *before == Page::Photo {
            inspector.open = false;
        }
        *before = game.page;
    }
}
