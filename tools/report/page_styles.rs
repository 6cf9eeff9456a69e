//! Effects of the page, each alone, and three together: what `parts` times.

use bevy_comics::{
    Abstraction, BlackFlats, ColorHarmony, ComicStyle, DepthLayers, Effect, Focus, Halftone,
    Hatching, Misregistration, Paint, Paper, SpeedLines, ToneRamp, TwoTone, Vignette,
    effects::{
        FocusAt, FocusStyle, Granularity, HalftoneMode, HatchingMarks, LayerBorders, PaintKernel,
        ScreenSampling, ScreenShape,
    },
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
            "halftone; misregistration and paper",
            alone(Misregistration::default())
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
        ("misregistration", alone(Misregistration::default())),
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
            "hatching; simplify_small",
            alone(Hatching {
                simplify_small: 1.0,
                ..Hatching::default()
            }),
        ),
    ]
}

fn planes() -> Vec<(&'static str, ComicStyle)> {
    let pixels = DepthLayers {
        granularity: Granularity::Pixel,
        ..DepthLayers::default()
    };
    let fixed = DepthLayers {
        granularity: Granularity::Pixel,
        borders: LayerBorders::Fixed,
        ..DepthLayers::default()
    };
    vec![
        ("color harmony", alone(ColorHarmony::default())),
        ("abstraction", alone(Abstraction::default())),
        ("depth layers", alone(DepthLayers::default())),
        ("depth layers; of pixels", alone(pixels)),
        ("depth layers; of pixels; fixed borders", alone(fixed)),
    ]
}

fn paintings() -> Vec<(&'static str, ComicStyle)> {
    let focus = |style: FocusStyle| {
        alone(Focus {
            at: FocusAt::Center,
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
                kernel: PaintKernel::Anisotropic,
                ..Paint::default()
            }),
        ),
        ("focus; blur", focus(FocusStyle::Blur)),
        ("focus; offset", focus(FocusStyle::Offset)),
        ("focus; paint", focus(FocusStyle::Paint)),
        ("focus; dots", focus(FocusStyle::Dots)),
    ]
}
