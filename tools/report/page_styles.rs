//! Effects of the page, each alone, and three together: what `parts` times.

use bevy_comics::{
    Abstraction, BlackFlats, ColorHarmony, ComicStyle, DepthLayers, Effect, Focus, Halftone,
    Hatching, Misregistration, Paint, Paper, SpeedLines, ToneRamp, TwoTone, Vignette,
    effects::{
        FocusAt, FocusStyle, Granularity, HalftoneMode, HatchingKind, LayerBorders, PaintKernel,
        ScreenSampling, ScreenShape,
    },
};

/// A style of one effect, with changes of its defaults.
pub fn changed<E: Effect>(change: fn(&mut E)) -> ComicStyle {
    let mut effect = E::default();
    change(&mut effect);
    ComicStyle::new().with(effect)
}

fn plain<E: Effect>() -> ComicStyle {
    changed::<E>(|_| ())
}

/// All of them, with the names of their rows.
pub fn all() -> Vec<(&'static str, ComicStyle)> {
    let halftone = changed::<Halftone>;
    let hatching = changed::<Hatching>;
    let layers = changed::<DepthLayers>;
    let focus = |style: FocusStyle| {
        ComicStyle::new().with(Focus {
            at: FocusAt::Center,
            style,
            ..Focus::default()
        })
    };
    let spot = |s: &mut Halftone| (s.mode, s.shape) = (HalftoneMode::Spot, ScreenShape::Round);
    let fixed = |s: &mut DepthLayers| {
        (s.granularity, s.borders) = (Granularity::Pixel, LayerBorders::Fixed);
    };
    let grains = |s: &mut Halftone| s.shape = ScreenShape::Stochastic;
    let whole = |s: &mut Halftone| s.sampling = ScreenSampling::Cell;
    let pixels = |s: &mut DepthLayers| s.granularity = Granularity::Pixel;
    let steep = changed::<BlackFlats>(|s| s.slope = Some(0.02));
    let along_edges = changed::<Paint>(|s| s.kernel = PaintKernel::Anisotropic);
    let printed = plain::<Misregistration>()
        .with(Halftone::default())
        .with(Paper::default());
    vec![
        ("halftone of four inks", plain::<Halftone>()),
        ("halftone of one ink", halftone(spot)),
        ("halftone of four inks in grains", halftone(grains)),
        ("halftone of four inks; whole dots", halftone(whole)),
        ("misregistration", plain::<Misregistration>()),
        ("hatching", plain::<Hatching>()),
        ("hatching; dots", hatching(|s| s.kind = HatchingKind::Dots)),
        (
            "hatching; simplify_small",
            hatching(|s| s.simplify_small = 1.0),
        ),
        ("color harmony", plain::<ColorHarmony>()),
        ("abstraction", plain::<Abstraction>()),
        ("depth layers", plain::<DepthLayers>()),
        ("depth layers; of pixels", layers(pixels)),
        ("depth layers; of pixels; fixed borders", layers(fixed)),
        ("paper", plain::<Paper>()),
        ("paint", plain::<Paint>()),
        ("paint; strokes along edges", along_edges),
        ("focus; blur", focus(FocusStyle::Blur)),
        ("focus; offset", focus(FocusStyle::Offset)),
        ("focus; paint", focus(FocusStyle::Paint)),
        ("focus; dots", focus(FocusStyle::Dots)),
        ("tone ramp", plain::<ToneRamp>()),
        ("two tones", plain::<TwoTone>()),
        ("speed lines", plain::<SpeedLines>()),
        ("black flats", plain::<BlackFlats>()),
        ("black flats; steep slopes too", steep),
        ("vignette", plain::<Vignette>()),
        ("halftone; misregistration and paper", printed),
    ]
}
