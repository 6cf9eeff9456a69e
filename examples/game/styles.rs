//! Styles that tell the player what happens: every level has its own style, danger tints
//! the distance red, slow motion is a sketch, a hit flashes in ink, a lantern in gold.

use bevy::prelude::*;
use bevy_comics::{
    BlackFlats, Colorization, ComicStyle, Contours, Desaturation, Impact, Outlines, Sketch,
    SpeedLines, StyleTransition, ToneBands,
    effects::{ColorizationMode, Equations},
    presets,
    style::{Preset, StyleTransitionFinished},
};

/// The situation that the style shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mood {
    #[default]
    Title,
    Flying,
    Slow,
    Fast,
    Paused,
    Won,
    Lost,
}

/// The style of the camera: what is wanted, and what it has.
#[derive(Resource, Debug, Default)]
pub struct Looks {
    pub level: ComicStyle,
    pub mood: Mood,
    /// 0 is safe, 1 is the greatest danger.
    pub danger: f32,
    /// The mood whose style the camera has, or is getting.
    shown: Option<Mood>,
    /// The style of a hit or a lantern that is yet to flash.
    flash: Option<ComicStyle>,
    /// Whether a transition to a flash is running.
    flashing: bool,
    /// Whether an impact is yet to be shown.
    bumped: bool,
    /// The danger that the camera's style shows.
    tinted: f32,
}

impl Looks {
    /// Begins a level in its own style.
    pub fn enter(&mut self, level: ComicStyle) {
        self.level = level;
        self.shown = None;
        self.flashing = false;
    }

    pub fn hit(&mut self) {
        let blow = self
            .level
            .clone()
            .with(ToneBands {
                levels: 2,
                ..default()
            })
            .with(Desaturation::default())
            .with(BlackFlats {
                value: Some(0.45),
                ..default()
            })
            .with(Colorization {
                mode: ColorizationMode::Atmosphere,
                color: Color::srgb(0.85, 0.12, 0.1),
                amount: 0.85,
                equations: Equations::Corrected,
            });
        self.flash = Some(blow);
    }

    pub fn bump(&mut self) {
        self.bumped = true;
    }

    pub fn lantern(&mut self) {
        let glow = self.level.clone().with(Colorization {
            mode: ColorizationMode::Atmosphere,
            color: Color::srgb(1.0, 0.82, 0.35),
            amount: 0.35,
            equations: Equations::Corrected,
        });
        self.flash = Some(glow);
    }

    /// The style of the level, with a distance as red as the danger is great.
    fn in_danger(&self) -> ComicStyle {
        let contours = self.level.get::<Contours>().copied();
        let red = self
            .level
            .clone()
            .with(Colorization {
                mode: ColorizationMode::Linear,
                color: Color::srgb(0.9, 0.1, 0.08),
                amount: 1.0,
                equations: Equations::Corrected,
            })
            .with(Contours {
                color: Color::srgb(0.25, 0.0, 0.02),
                ..contours.unwrap_or_default()
            });
        self.level.blend(&red, self.danger)
    }

    fn style(&self) -> ComicStyle {
        match self.mood {
            Mood::Flying => self.in_danger(),
            Mood::Fast => self.in_danger().with(SpeedLines {
                inner: 0.75,
                width: 3.0,
                opacity: 0.7,
                ..default()
            }),
            Mood::Slow => ComicStyle::new()
                .with(Outlines {
                    width: 1.6,
                    ..Outlines::default()
                })
                .with(Sketch {
                    wash: 0.45,
                    strokes: 2,
                    ..Sketch::default()
                }),
            Mood::Title => self.level.clone(),
            Mood::Paused => {
                let level = self.level.clone().without::<Desaturation>();
                level.with(Colorization {
                    amount: 0.9,
                    ..Colorization::SEPIA
                })
            }
            Mood::Won => named("golden-hour", &self.level),
            Mood::Lost => named("noir", &self.level),
        }
    }
}

/// A preset by its name; `otherwise` if there is none.
pub fn named(name: &str, otherwise: &ComicStyle) -> ComicStyle {
    presets::find(name).map_or_else(|| otherwise.clone(), Preset::style)
}

/// Marks the camera that gets the styles.
#[derive(Component)]
pub struct Dressed;

/// Gives the camera its style: by a transition when a flash begins or the mood changes,
/// else at once when the danger changes.
pub fn dress(
    mut looks: ResMut<Looks>,
    mut commands: Commands,
    camera: Single<(Entity, Has<StyleTransition>), With<Dressed>>,
) {
    let (camera, fading) = *camera;
    let Ok(mut camera) = commands.get_entity(camera) else {
        return;
    };
    if std::mem::take(&mut looks.bumped) {
        let impact = Impact::new(camera.id());
        camera.commands().trigger(impact);
    }
    if let Some(flash) = looks.flash.take() {
        camera.insert(StyleTransition::to(flash, 0.09));
        looks.flashing = true;
        return;
    }
    let mood = looks.mood;
    if looks.shown != Some(mood) {
        let seconds = match (looks.shown, mood) {
            (None, _) => 0.0,
            (_, Mood::Slow | Mood::Fast) | (Some(Mood::Fast), _) => 0.3,
            (Some(Mood::Slow), _) => 0.5,
            _ => 0.6,
        };
        camera.insert(StyleTransition::to(looks.style(), seconds));
        looks.shown = Some(mood);
        looks.flashing = false;
        looks.tinted = looks.danger;
        return;
    }
    if matches!(mood, Mood::Flying | Mood::Fast)
        && !fading
        && (looks.danger - looks.tinted).abs() > 0.004
    {
        looks.tinted = looks.danger;
        looks.style().apply(&mut camera);
    }
}

/// Returns to the style of the mood after a flash.
pub fn come_back(
    finished: On<StyleTransitionFinished>,
    mut looks: ResMut<Looks>,
    mut commands: Commands,
) {
    if std::mem::take(&mut looks.flashing)
        && let Ok(mut camera) = commands.get_entity(finished.entity)
    {
        looks.tinted = looks.danger;
        camera.insert(StyleTransition::to(looks.style(), 0.4));
    }
}
