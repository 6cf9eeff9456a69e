//! Effects of the page, each alone, and three together: what `parts` times.

use bevy_comics::{
    Abstraction, BlackFlats, ColorHarmony, ComicStyle, Effect, Focus, FocusAt, FocusStyle,
    Halftone, HalftoneMode, Hatching, HatchingMarks, Paint, PaintForm, Paper, PlaneBorders,
    PlaneUnit, Planes, PrintOffset, ScreenSampling, ScreenShape, SpeedLines, ToneRamp, TwoTone,
    Vignette,
};

/// A style of one effect.
fn alone<E: Effect>(effect: E) -> ComicStyle {
    ComicStyle::new().with(effect)
}

/// All of them, with the names of their rows.
pub fn all() -> Vec<(&'static str, ComicStyle)> {
    let mut all = prints();
    all.extend(strokes());
    all.extend(planes());
    all.extend(paintings());
    all.extend([
        ("tone ramp", alone(ToneRamp::default())),
        ("two tones", alone(TwoTone::default())),
        ("speed lines", alone(SpeedLines::default())),
        ("black flats", alone(BlackFlats::default())),
        (
            "black flats; steep slopes too",
            alone(BlackFlats {
                slope: Some(0.02),
                ..BlackFlats::default()
            }),
        ),
        ("vignette", alone(Vignette::default())),
        (
            "halftone; print offset and paper",
            alone(PrintOffset::default())
                .with(Halftone::default())
                .with(Paper::default()),
        ),
    ]);
    all
}

fn prints() -> Vec<(&'static str, ComicStyle)> {
    let default = Halftone::default();
    vec![
        ("halftone of four inks", alone(default)),
        (
            "halftone of one ink",
            alone(Halftone {
                mode: HalftoneMode::Spot,
                shape: ScreenShape::Round,
                ..default
            }),
        ),
        (
            "halftone of four inks in grains",
            alone(Halftone {
                shape: ScreenShape::Stochastic,
                ..default
            }),
        ),
        (
            "halftone of four inks; whole dots",
            alone(Halftone {
                sampling: ScreenSampling::Cell,
                ..default
            }),
        ),
        ("print offset", alone(PrintOffset::default())),
    ]
}

fn strokes() -> Vec<(&'static str, ComicStyle)> {
    vec![
        ("hatching", alone(Hatching::default())),
        (
            "hatching; dots",
            alone(Hatching {
                marks: HatchingMarks::Dots,
                ..Hatching::default()
            }),
        ),
        (
            "hatching; calm",
            alone(Hatching {
                calm: 1.0,
                ..Hatching::default()
            }),
        ),
    ]
}

fn planes() -> Vec<(&'static str, ComicStyle)> {
    let pixels = Planes {
        by: PlaneUnit::Pixel,
        ..Planes::default()
    };
    let fixed = Planes {
        by: PlaneUnit::Pixel,
        borders: PlaneBorders::Fixed,
        ..Planes::default()
    };
    vec![
        ("color harmony", alone(ColorHarmony::default())),
        ("abstraction", alone(Abstraction::default())),
        ("planes", alone(Planes::default())),
        ("planes; of pixels", alone(pixels)),
        ("planes; of pixels; fixed borders", alone(fixed)),
    ]
}

fn paintings() -> Vec<(&'static str, ComicStyle)> {
    let focus = |style: FocusStyle| {
        alone(Focus {
            at: FocusAt::Centre,
            style,
            ..Focus::default()
        })
    };
    vec![
        ("paper", alone(Paper::default())),
        ("paint", alone(Paint::default())),
        (
            "paint; strokes along edges",
            alone(Paint {
                form: PaintForm::Anisotropic,
                ..Paint::default()
            }),
        ),
        ("focus; blur", focus(FocusStyle::Blur)),
        ("focus; offset", focus(FocusStyle::Offset)),
        ("focus; paint", focus(FocusStyle::Paint)),
        ("focus; dots", focus(FocusStyle::Dots)),
    ]
}
