//! The lettering: captions, sounds, and the pages between flights.

use bevy::{math::Rot2, prelude::*, ui::UiTransform};

use crate::{Game, best::BestTimes, courses::LEVELS, pages::Page, rules::Event};

pub struct ScreenPlugin;

impl Plugin for ScreenPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, spawn)
            .add_systems(Update, (write, letter_sounds))
            .add_systems(OnEnter(Page::Photo), open_panel::<true>)
            .add_systems(OnExit(Page::Photo), open_panel::<false>);
    }
}

/// The caption at the top left: level, lanterns, time.
#[derive(Component)]
struct Status;

/// The box at the bottom center: title, pause, results.
#[derive(Component)]
struct Notice;

/// The word that a bump or a lantern makes.
#[derive(Component)]
struct Sound;

const INK: Color = Color::srgb(0.1, 0.09, 0.13);
const CAPTION: Color = Color::srgb(1.0, 0.93, 0.62);
const PAPER: Color = Color::srgb(0.99, 0.97, 0.9);
/// Seconds that a sound and the first caption of a level are shown.
const SOUND: f32 = 0.7;
const OPENING: f32 = 3.0;

fn lettering(size: f32, paper: Color) -> impl Bundle {
    (
        Text::default(),
        TextFont {
            font_size: FontSize::Vh(size),
            ..default()
        },
        TextColor(INK),
        BackgroundColor(paper),
        BorderColor::all(INK),
    )
}

fn spawn(mut commands: Commands) {
    commands.spawn((
        Status,
        lettering(3.2, CAPTION),
        Node {
            position_type: PositionType::Absolute,
            top: Val::Vh(2.6),
            left: Val::Vh(2.6),
            padding: UiRect::axes(Val::Vh(2.2), Val::Vh(1.0)),
            border: UiRect::all(Val::Vh(0.5)),
            ..default()
        },
        TextLayout::no_wrap(),
    ));
    let page = Node {
        width: Val::Percent(100.0),
        height: Val::Percent(100.0),
        align_items: AlignItems::FlexEnd,
        justify_content: JustifyContent::Center,
        padding: UiRect::bottom(Val::Percent(5.0)),
        ..default()
    };
    commands.spawn(page).with_child((
        Notice,
        lettering(3.2, PAPER),
        TextLayout::justify(Justify::Center),
        Node {
            padding: UiRect::axes(Val::Vh(3.6), Val::Vh(2.2)),
            border: UiRect::all(Val::Vh(0.6)),
            ..default()
        },
    ));
    commands.spawn((
        Sound,
        Text::default(),
        TextFont {
            font_size: FontSize::Vh(13.0),
            ..default()
        },
        TextShadow {
            offset: Vec2::splat(5.0),
            color: INK,
        },
        UiTransform::from_rotation(Rot2::degrees(-9.0)),
        Visibility::Hidden,
        Node {
            position_type: PositionType::Absolute,
            top: Val::Percent(26.0),
            left: Val::Percent(60.0),
            ..default()
        },
    ));
}

const TITLE: &str = "\
Collect the lanterns before two minutes are over.
Houses, trees and the ground slow you down; a storm cloud costs four seconds.

Steer  arrows, WASD or stick      Boost  Space or A
Slow motion  Shift or X      Photo  F or Y      Pause  Esc or Start";

fn title(level: usize, best: &BestTimes) -> String {
    let line = |(index, entry): (usize, &crate::courses::Level)| {
        let time = best.get(entry.key);
        let time = time.map_or("    --".into(), |t| format!("{t:>4.1} s"));
        let mark = if index == level { '>' } else { ' ' };
        format!("{mark} {}. {:<20} {time}\n", index + 1, entry.name)
    };
    let levels: String = LEVELS.iter().enumerate().map(line).collect();
    format!("PAPER GLIDER\n\n{levels}\n{TITLE}\n\nLeft, right: level      Enter or A: fly")
}

/// What the box at the bottom says.
fn notice(game: &Game, page: Page, best: &BestTimes) -> String {
    let seconds = game.flight.seconds_used();
    match page {
        Page::Title => title(game.level, best),
        Page::Paused => "PAUSED\n\nEsc: go on   R: restart   Q: title   F: photo mode".into(),
        Page::Won if game.is_record => {
            format!("ALL LANTERNS!\n\n{seconds:.1} s, your best\n\nEnter: next level   R: again")
        }
        Page::Won => format!("ALL LANTERNS!\n\n{seconds:.1} s\n\nEnter: next level   R: again"),
        Page::Lost => "THE LIGHTS GO OUT.\n\nR: try again   Enter: title".into(),
        Page::Photo | Page::Flying => String::new(),
    }
}

/// The caption of a flight.
fn status(game: &Game) -> String {
    let (flight, level) = (&game.flight, &LEVELS[game.level]);
    if flight.seconds_used() < OPENING {
        return level.caption.into();
    }
    format!(
        "{}   {}/{} lanterns   {:.0} s   focus {:.0} %",
        level.name,
        flight.found(),
        flight.course.lanterns.len(),
        flight.seconds_left.ceil(),
        flight.focus * 100.0,
    )
}

fn write(
    game: Res<Game>,
    page: Res<State<Page>>,
    best: Res<BestTimes>,
    mut top: Single<(&mut Text, &mut Visibility), (With<Status>, Without<Notice>)>,
    mut bottom: Single<(&mut Text, &mut Visibility), (With<Notice>, Without<Status>)>,
) {
    let shows_status = !matches!(page.get(), Page::Title | Page::Photo);
    let caption = if shows_status {
        status(&game)
    } else {
        String::new()
    };
    set(&mut top, caption);
    set(&mut bottom, notice(&game, *page.get(), &best));
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

/// Shows the word of what happened last, which grows at first.
fn letter_sounds(
    game: Res<Game>,
    page: Res<State<Page>>,
    time: Res<Time>,
    mut sound: Single<(&mut Text, &mut TextColor, &mut Visibility, &mut UiTransform), With<Sound>>,
) {
    let (text, color, visibility, transform) = &mut *sound;
    let word = game.last.and_then(|(event, since)| match event {
        Event::Bump => Some(("BONK!", Color::srgb(1.0, 0.55, 0.1), since)),
        Event::Hit => Some(("KRAKK!", Color::srgb(1.0, 0.93, 0.3), since)),
        Event::Lantern(_) => Some(("DING!", Color::srgb(1.0, 0.9, 0.35), since)),
        Event::Won | Event::Lost => None,
    });
    let shown = word.filter(|(_, _, since)| time.elapsed_secs() < since + SOUND);
    let Some((word, paint, since)) = shown.filter(|_| *page.get() == Page::Flying) else {
        visibility.set_if_neq(Visibility::Hidden);
        return;
    };
    visibility.set_if_neq(Visibility::Inherited);
    if text.0 != word {
        word.clone_into(&mut text.0);
    }
    color.0 = paint;
    let grown = ((time.elapsed_secs() - since) / 0.12).clamp(0.3, 1.0);
    transform.scale = Vec2::splat(grown);
}

/// The panel is open in the photo mode.
fn open_panel<const OPEN: bool>(inspector: Option<ResMut<bevy_comics_inspector::ComicsInspector>>) {
    if let Some(mut inspector) = inspector {
        inspector.open = OPEN;
    }
}
