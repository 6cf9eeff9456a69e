//! The sheet: panels with tilted borders, captions, and speech balloons with tails.

use bevy::{
    asset::embedded_asset, camera::visibility::RenderLayers, prelude::*,
    render::render_resource::AsBindGroup, shader::ShaderRef,
};
use bevy_comics_testkit::demo::Screen;

use crate::places::Pictures;

/// Size of the page in pixels.
pub const SIZE: UVec2 = UVec2::new(1000, 1400);
/// Places on the page: 100 units wide, 140 units high.
const SHEET: Vec2 = Vec2::new(100.0, 140.0);

pub const PANELS: usize = 5;

/// Corners of the panels, clockwise from the top left.
const QUADS: [[(f32, f32); 4]; PANELS] = [
    [(3.0, 3.0), (97.0, 3.0), (97.0, 38.0), (3.0, 44.0)],
    [(3.0, 46.4), (51.8, 43.3), (45.6, 88.0), (3.0, 88.0)],
    [(54.1, 43.1), (97.0, 40.4), (97.0, 84.0), (48.0, 88.0)],
    [(3.0, 90.4), (40.4, 90.4), (46.2, 137.0), (3.0, 137.0)],
    [(42.8, 90.3), (97.0, 86.3), (97.0, 137.0), (48.6, 137.0)],
];

/// Captions: left, top, width, and the words.
const CAPTIONS: [(f32, f32, f32, &str); 4] = [
    (
        5.0,
        5.0,
        36.0,
        "ONE FINE MORNING, IN A\nVILLAGE WHERE NOTHING\nEVER HAPPENS...",
    ),
    (66.0, 43.5, 29.0, "...OVER THE ROOFS,\nPAST THE CHURCH..."),
    (
        5.0,
        128.4,
        31.0,
        "...AND OVER THE HILLS,\nALL EVENING LONG.",
    ),
    (68.0, 89.8, 27.0, "MIDNIGHT.\nRAIN, AS ALWAYS."),
];

/// A balloon: middle and half size of its body, the tip of its tail, and the words.
struct Balloon {
    body: [f32; 4],
    tip: (f32, f32),
    /// Spikes of a shout; 0 is speech.
    spikes: f32,
    words: &'static str,
}

const BALLOONS: [Balloon; 3] = [
    Balloon {
        body: [79.0, 29.5, 14.0, 5.6],
        tip: (66.5, 21.5),
        spikes: 0.0,
        words: "HOLD ON TIGHT,\nLITTLE LETTER!",
    },
    Balloon {
        body: [13.2, 53.6, 9.6, 6.0],
        tip: (21.5, 65.5),
        spikes: 17.0,
        words: "FLY!",
    },
    Balloon {
        body: [79.5, 128.6, 15.0, 5.6],
        tip: (62.5, 121.0),
        spikes: 0.0,
        words: "A LETTER?\nAT THIS HOUR?",
    },
];

/// A picture in a tilted frame.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
pub struct Panel {
    /// Corners as fractions of the node's size.
    #[uniform(0)]
    upper: Vec4,
    #[uniform(1)]
    lower: Vec4,
    #[texture(2)]
    #[sampler(3)]
    picture: Handle<Image>,
}

impl UiMaterial for Panel {
    fn fragment_shader() -> ShaderRef {
        "embedded://comic_page/comic_page/panel.wgsl".into()
    }
}

/// The paper of a balloon.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
pub struct Speech {
    #[uniform(0)]
    body: Vec4,
    #[uniform(1)]
    tail: Vec4,
}

impl UiMaterial for Speech {
    fn fragment_shader() -> ShaderRef {
        "embedded://comic_page/comic_page/balloon.wgsl".into()
    }
}

pub struct PagePlugin;

impl Plugin for PagePlugin {
    fn build(&self, app: &mut App) {
        embedded_asset!(app, "examples", "panel.wgsl");
        embedded_asset!(app, "examples", "balloon.wgsl");
        app.add_plugins((
            UiMaterialPlugin::<Panel>::default(),
            UiMaterialPlugin::<Speech>::default(),
        ));
    }
}

/// The smallest rectangle around a panel: its corner and its size.
fn bounds(quad: &[(f32, f32); 4]) -> Rect {
    let corners = quad.map(Vec2::from);
    let low = corners.into_iter().fold(Vec2::INFINITY, Vec2::min);
    let high = corners.into_iter().fold(Vec2::NEG_INFINITY, Vec2::max);
    Rect::from_corners(low, high)
}

/// Size of a panel's picture in pixels.
pub fn picture_size(panel: usize) -> UVec2 {
    let scale = SIZE.as_vec2() / SHEET;
    (bounds(&QUADS[panel]).size() * scale).ceil().as_uvec2()
}

/// A node at a place of the page.
fn at(place: Rect) -> Node {
    let (corner, size) = (place.min / SHEET * 100.0, place.size() / SHEET * 100.0);
    Node {
        position_type: PositionType::Absolute,
        left: percent(corner.x),
        top: percent(corner.y),
        width: percent(size.x),
        height: percent(size.y),
        justify_content: JustifyContent::Center,
        align_items: AlignItems::Center,
        ..default()
    }
}

fn lettering(words: &str, size: f32) -> impl Bundle {
    (
        Text::new(words),
        TextFont {
            font_size: FontSize::Vh(size),
            ..default()
        },
        TextLayout {
            justify: Justify::Center,
            linebreak: LineBreak::NoWrap,
        },
        TextColor(Color::srgb(0.05, 0.05, 0.07)),
    )
}

pub fn spawn(
    mut commands: Commands,
    screen: Res<Screen>,
    pictures: Res<Pictures>,
    mut panels: ResMut<Assets<Panel>>,
    mut speech: ResMut<Assets<Speech>>,
) {
    commands.spawn((
        Camera2d,
        IsDefaultUiCamera,
        screen.target.clone(),
        RenderLayers::none(),
    ));
    let desk = Node {
        width: percent(100.0),
        height: percent(100.0),
        justify_content: JustifyContent::Center,
        ..default()
    };
    let sheet = Node {
        height: percent(100.0),
        aspect_ratio: Some(SHEET.x / SHEET.y),
        ..default()
    };
    let desk = (desk, BackgroundColor(Color::srgb(0.35, 0.33, 0.31)));
    let sheet = (sheet, BackgroundColor(Color::srgb(0.985, 0.975, 0.945)));
    commands.spawn(desk).with_children(|desk| {
        desk.spawn(sheet).with_children(|sheet| {
            for (quad, picture) in QUADS.iter().zip(&pictures.0) {
                let material = panels.add(frame(quad, picture.clone()));
                sheet.spawn((at(bounds(quad)), MaterialNode(material)));
            }
            for (left, top, width, words) in CAPTIONS {
                caption(sheet, Vec2::new(left, top), width, words);
            }
            for balloon in &BALLOONS {
                speak(sheet, balloon, &mut speech);
            }
        });
    });
}

fn frame(quad: &[(f32, f32); 4], picture: Handle<Image>) -> Panel {
    let place = bounds(quad);
    let [a, b, c, d] = quad.map(|p| (Vec2::from(p) - place.min) / place.size());
    Panel {
        upper: Vec4::new(a.x, a.y, b.x, b.y),
        lower: Vec4::new(c.x, c.y, d.x, d.y),
        picture,
    }
}

fn caption(sheet: &mut ChildSpawnerCommands, corner: Vec2, width: f32, words: &str) {
    let lines = words.lines().count() as f32;
    let size = Vec2::new(width, 2.2 + 2.5 * lines);
    let node = Node {
        border: UiRect::all(vh(0.2)),
        ..at(Rect::from_corners(corner, corner + size))
    };
    let yellow = BackgroundColor(Color::srgb(1.0, 0.92, 0.6));
    let ink = BorderColor::all(Color::BLACK);
    sheet
        .spawn((node, yellow, ink))
        .with_child(lettering(words, 1.45));
}

/// Draws a balloon over the rectangle that holds its body and the tip of its tail.
fn speak(sheet: &mut ChildSpawnerCommands, balloon: &Balloon, speech: &mut Assets<Speech>) {
    let [x, y, width, height] = balloon.body;
    let (middle, half) = (Vec2::new(x, y), Vec2::new(width, height));
    let body = Rect::from_center_half_size(middle, half);
    let place = body.union_point(balloon.tip.into()).inflate(1.0);
    let part = |p: Vec2| (p - place.min) / place.size();
    let (center, tip) = (part(middle), part(balloon.tip.into()));
    let half = half / place.size();
    let material = speech.add(Speech {
        body: Vec4::new(center.x, center.y, half.x, half.y),
        tail: Vec4::new(tip.x, tip.y, 16.0, balloon.spikes),
    });
    sheet.spawn((at(place), MaterialNode(material)));
    let size = if balloon.spikes > 0.0 { 3.0 } else { 1.55 };
    sheet
        .spawn(at(body))
        .with_child(lettering(balloon.words, size));
}
