//! Style files: read, written, loaded, changed on disk, broken, removed.

use std::fs;

use bevy_comics::style::ComicStyleError;
use proptest::{
    option,
    prelude::{ProptestConfig, Strategy, any},
    sample::select,
    test_runner::TestRunner,
};

use crate::prelude::*;

fn number() -> impl Strategy<Value = f32> {
    any::<f32>()
}

fn colors() -> impl Strategy<Value = Color> {
    (any::<[u8; 4]>(), 0.0f32..=1.0, any::<bool>()).prop_map(|([r, g, b, a], x, codes)| {
        if codes {
            Color::srgba_u8(r, g, b, a)
        } else {
            Color::srgba(x, 0.123_456_7, 0.9, 1.0)
        }
    })
}

pub fn styles() -> impl Strategy<Value = ComicStyle> {
    let methods = || select(vec![Equations::Corrected, Equations::Faithful]);
    let map = (number(), number(), number(), any::<bool>(), 0..6usize).prop_map(
        |(near, far, gap, flip, kind)| DepthMap {
            mapping: [
                DepthMapping::MinMax,
                DepthMapping::MinMaxLogarithmic,
                DepthMapping::Linear,
                DepthMapping::Logarithmic,
                DepthMapping::Fixed {
                    from: near,
                    to: far,
                },
                DepthMapping::FixedLogarithmic {
                    from: near,
                    to: far,
                },
            ][kind],
            flip,
            sky_gap: gap,
            reduction: ReductionMethod::PingPong,
            smoothing: (kind > 0).then_some(RangeSmoothing {
                outliers: gap,
                despike: flip,
                expand: near,
                ..default()
            }),
            locked: kind == 2,
            ..default()
        },
    );
    let desaturation =
        (number(), number(), methods()).prop_map(|(amount, exponent, method)| Desaturation {
            amount,
            exponent,
            equations: method,
        });
    let colorization =
        (colors(), number(), methods(), 0..4usize).prop_map(|(color, amount, method, mode)| {
            Colorization {
                mode: [
                    ColorizationMode::KeepHue,
                    ColorizationMode::Atmosphere,
                    ColorizationMode::Linear,
                    ColorizationMode::Quadratic,
                ][mode],
                color,
                amount,
                equations: method,
            }
        });
    let flats = (
        option::of(number()),
        option::of(number()),
        number(),
        colors(),
    )
        .prop_map(|(slope, value, softness, color)| BlackFlats {
            slope,
            value,
            softness,
            color,
            ..default()
        });
    let contours = (number(), number(), colors(), 0..4usize, any::<bool>()).prop_map(
        |(threshold, width, color, operator, faithful)| Contours {
            operator: [
                ContourOperator::Prewitt,
                ContourOperator::Sobel,
                ContourOperator::Laplace,
                ContourOperator::Roberts,
            ][operator],
            equations: if faithful {
                Equations::Faithful
            } else {
                Equations::Corrected
            },
            threshold,
            width,
            color,
            ..default()
        },
    );
    (
        ".{0,12}",
        option::of(map),
        option::of(desaturation),
        option::of(colorization),
        option::of(flats),
        option::of(contours),
        (toon_styles(), prints(), page_styles()),
    )
        .prop_map(
            |(name, depth_map, desaturation, colorization, black_flats, contours, others)| {
                let (
                    (tone_bands, outlines, sketch),
                    (halftone, offset, (paint, focus, hatching, harmony, planes)),
                    page,
                ) = others;
                let (speed_lines, two_tone, paper) = page;
                let mut style = ComicStyle::new();
                style.name = name;
                style.depth_map = depth_map;
                style = with_option(style, tone_bands);
                style = with_option(style, desaturation);
                style = with_option(style, colorization);
                style = with_option(style, black_flats);
                style = with_option(style, contours);
                style = with_option(style, outlines);
                style = with_option(style, halftone);
                style = with_option(style, hatching);
                style = with_option(style, harmony);
                style = with_option(style, planes);
                style = with_option(style, offset);
                style = with_option(style, paint);
                style = with_option(style, focus);
                style = with_option(style, sketch);
                style = with_option(style, speed_lines);
                style = with_option(style, two_tone);
                with_option(style, paper)
            },
        )
}

fn weights() -> impl Strategy<Value = LineWeight> {
    (number(), number(), number(), number(), number()).prop_map(
        |(outer, shade, perspective, nib, taper)| LineWeight {
            outer,
            shade,
            perspective,
            nib_roundness: nib,
            taper,
            ..default()
        },
    )
}

fn page_styles() -> impl Strategy<Value = (Option<SpeedLines>, Option<TwoTone>, Option<Paper>)> {
    let lines = (number(), number(), any::<u32>(), (any::<bool>(), colors())).prop_map(
        |(center, width, count, (parallel, color))| SpeedLines {
            color,
            kind: if parallel {
                SpeedLineKind::Parallel
            } else {
                SpeedLineKind::Radial
            },
            center: Vec2::new(center, 0.5),
            width,
            count,
            ..default()
        },
    );
    let two = (colors(), colors());
    let tones =
        (two, number(), any::<bool>()).prop_map(|((dark, light), threshold, invert)| TwoTone {
            dark,
            light,
            threshold,
            invert,
            ..default()
        });
    let paper =
        (colors(), number(), number(), number()).prop_map(|(color, grain, size, spread)| Paper {
            color,
            grain,
            size,
            ink_bleed: spread,
            dry_brush: spread,
            ..default()
        });
    (option::of(lines), option::of(tones), option::of(paper))
}

type Painted = (
    Option<Paint>,
    Option<Focus>,
    Option<Hatching>,
    Option<ColorHarmony>,
    Option<DepthLayers>,
);

/// Print effects, paint and harmony of all modes.
fn prints() -> impl Strategy<Value = (Option<Halftone>, Option<Misregistration>, Painted)> {
    let halftone = (number(), number(), colors(), 0u32..99, 0..4usize).prop_map(
        |(period, fraction, ink, tints, kind)| Halftone {
            mode: [
                HalftoneMode::Cmyk,
                HalftoneMode::Spot,
                HalftoneMode::Duotone,
                HalftoneMode::Rgb,
            ][kind],
            shape: [
                ScreenShape::Round,
                ScreenShape::Line,
                ScreenShape::Cross,
                ScreenShape::Stochastic,
            ][kind],
            sampling: [ScreenSampling::Pixel, ScreenSampling::Cell][kind % 2],
            anchor: [
                ScreenAnchor::View,
                ScreenAnchor::Window,
                ScreenAnchor::Object,
            ][kind % 3],
            cell_size: period,
            gain: fraction,
            at_near: fraction,
            tints,
            cyan: ink,
            paper: ink,
            black_angle: period,
            ..default()
        },
    );
    let offset = (number(), number()).prop_map(|(offset, amount)| Misregistration {
        cyan: Vec2::new(offset, 0.3),
        drift: offset,
        rate: amount,
        amount,
        ..default()
    });
    let paint = (number(), number(), any::<bool>()).prop_map(|(near, sharpness, fine)| Paint {
        kernel: if fine {
            PaintKernel::Anisotropic
        } else {
            PaintKernel::Box
        },
        at_near: near,
        sharpness,
        figures: fine,
        ..default()
    });
    let looks = vec![
        FocusStyle::Blur,
        FocusStyle::Offset,
        FocusStyle::Paint,
        FocusStyle::Dots,
        FocusStyle::Lines,
    ];
    let focus = (number(), number(), select(looks)).prop_map(|(distance, radius, style)| Focus {
        at: if style == FocusStyle::Offset {
            FocusAt::Center
        } else {
            FocusAt::Distance
        },
        style,
        distance,
        radius,
        cell_size: radius,
        ..default()
    });
    let hatching =
        (number(), number(), any::<u32>(), colors()).prop_map(|(spacing, breaks, layers, ink)| {
            Hatching {
                anchor: [HatchingAnchor::Object, HatchingAnchor::Page][layers as usize % 2],
                spacing,
                breaks,
                layers,
                tones: layers,
                ink,
                ..default()
            }
        });
    let modes = vec![
        HarmonyMode::TwoHues,
        HarmonyMode::Distance,
        HarmonyMode::Rotation,
        HarmonyMode::Shade,
    ];
    let harmony = (select(modes), number(), colors(), any::<bool>()).prop_map(
        |(mode, number, color, faithful)| ColorHarmony {
            mode,
            complement: number,
            pull: number,
            offset: number,
            color,
            equations: [Equations::Corrected, Equations::Faithful][usize::from(faithful)],
            ..default()
        },
    );
    let plane = (number(), number(), colors(), any::<u32>()).prop_map(
        |(saturation, contrast, tint, bands)| DepthLayer {
            saturation,
            tint,
            tint_amount: contrast,
            contrast,
            brightness: saturation,
            bands,
            line_width: contrast,
            line_opacity: saturation,
            line_color: tint,
            line_color_amount: contrast,
            hatching: contrast,
            halftone: saturation,
        },
    );
    let planes = (plane, number(), any::<bool>()).prop_map(|(near, number, fixed)| DepthLayers {
        foreground: near,
        borders: [LayerBorders::Auto, LayerBorders::Fixed][usize::from(fixed)],
        foreground_end: number,
        softness: number,
        ..default()
    });
    let painted = (
        option::of(paint),
        option::of(focus),
        option::of(hatching),
        option::of(harmony),
        option::of(planes),
    );
    (option::of(halftone), option::of(offset), painted)
}

fn toon_styles() -> impl Strategy<Value = (Option<ToneBands>, Option<Outlines>, Option<Sketch>)> {
    let forms = || select(vec![Equations::Corrected, Equations::Faithful]);
    let bands = (0u32..99, number(), number(), any::<bool>()).prop_map(
        |(levels, softness, amount, faithful)| ToneBands {
            equations: if faithful {
                Equations::Faithful
            } else {
                Equations::Corrected
            },
            levels,
            softness,
            amount,
        },
    );
    let silhouettes =
        (forms(), number(), number(), colors()).prop_map(|(form, threshold, softness, color)| {
            Silhouettes {
                equations: form,
                threshold,
                softness,
                color,
                ..default()
            }
        });
    let creases =
        (forms(), number(), number(), colors()).prop_map(|(form, angle, edge_limit, color)| {
            Creases {
                equations: form,
                angle,
                edge_limit,
                color,
                ..default()
            }
        });
    let objects = (colors(), number()).prop_map(|(color, opacity)| ObjectEdges { color, opacity });
    let outlines = (
        option::of(silhouettes),
        option::of(creases),
        option::of(objects),
        number(),
        number(),
        weights(),
    )
        .prop_map(
            |(silhouettes, creases, objects, width, fade, weight)| Outlines {
                silhouettes,
                creases,
                objects,
                width,
                width_fade: fade,
                opacity_fade: fade,
                weight,
                ink_budget: fade,
                boil: LineBoil {
                    amplitude: width,
                    wavelength: fade,
                    rate: width,
                },
                color: LineColor::Surface {
                    darken: fade,
                    saturate: width,
                },
                history_weight: fade,
                overshoot: width,
                gap_closing: 2,
                hold_frames: 5,
                ..default()
            },
        );
    let sketch =
        (colors(), colors(), number(), 0u32..9).prop_map(|(paper, ink, jitter, strokes)| Sketch {
            paper,
            ink,
            jitter,
            strokes,
            ..default()
        });
    (option::of(bands), option::of(outlines), option::of(sketch))
}

#[test]
fn a_style_saved_and_loaded_is_equal() {
    TestRunner::new(ProptestConfig {
        cases: 2000,
        ..default()
    })
    .run(&styles(), |style| {
        let text = style.to_ron().expect("every style has a text");
        let back = ComicStyle::from_ron(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        // Compares bits, so that -0 is kept.
        assert_eq!(format!("{style:?}"), format!("{back:?}"), "{text}");
        Ok(())
    })
    .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn errors_name_the_line_and_what_is_wrong() {
    let error = |text: &str| {
        ComicStyle::from_ron(text)
            .expect_err("must not read")
            .to_string()
    };
    let unknown = error("(\n    version: 3,\n    contours: (\n        treshold: 0.1,\n    ),\n)");
    assert!(
        unknown.contains("line 4") && unknown.contains("treshold"),
        "{unknown}"
    );
    let broken = error("(version: 3,\n contours: (\n");
    assert!(broken.contains("line 2"), "{broken}");
    let colour = error("(version: 3, contours: (color: \"reddish\"))");
    assert!(
        colour.contains("reddish") || colour.contains("#rrggbb"),
        "{colour}"
    );
    assert!(matches!(
        ComicStyle::from_ron("(version: 7)"),
        Err(ComicStyleError::Version { found: 7, .. })
    ));
}

/// A temporary folder, removed when dropped.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("bevy-comics-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // An error is ignored: the system empties its temporary folder.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Steps until the camera's contours satisfy `done`; false after ten seconds.
fn wait(small: &mut Small, done: impl Fn(Option<&Contours>) -> bool) -> bool {
    for _ in 0..400 {
        small.headless.step(1);
        if done(small.headless.app.world().get(small.camera)) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(25));
    }
    false
}

#[test]
fn a_style_file_is_loaded_reloaded_and_survives_being_broken() {
    let folder = Folder::new("styles");
    let file = folder.0.join("mine.comic.ron");
    fs::write(&file, "(version: 3, contours: (width: 3.0))").expect("written");
    let assets = folder.0.to_string_lossy().into_owned();
    let mut small = Small::with(
        HeadlessOptions {
            assets,
            watch: true,
            ..options(size())
        },
        Msaa::Off,
    );
    let handle = small
        .world()
        .resource::<AssetServer>()
        .load("mine.comic.ron");
    small.insert(Comic(handle));
    assert!(
        wait(&mut small, |c| c.is_some_and(|c| c.width == 3.0)),
        "the style did not load"
    );

    fs::write(
        &file,
        "(version: 3, contours: (width: 5.0), desaturation: ())",
    )
    .expect("written");
    assert!(
        wait(&mut small, |c| c.is_some_and(|c| c.width == 5.0)),
        "the change did not arrive"
    );
    let camera = small.camera;
    assert!(small.world().get::<Desaturation>(camera).is_some());

    fs::write(&file, "(version: 3, contours: (width: ").expect("written");
    assert!(
        !wait_briefly(&mut small, |c| c.is_none_or(|c| c.width != 5.0)),
        "the last good look is kept"
    );

    fs::write(&file, "(version: 3, contours: (width: 7.0))").expect("written");
    assert!(
        wait(&mut small, |c| c.is_some_and(|c| c.width == 7.0)),
        "mended, it is back"
    );
    assert!(
        small.world().get::<Desaturation>(camera).is_none(),
        "what the style lost, the camera lost"
    );

    small.world().entity_mut(camera).remove::<Comic>();
    assert!(
        wait(&mut small, |c| c.is_none()),
        "without the handle there is no look"
    );
}

fn wait_briefly(small: &mut Small, done: impl Fn(Option<&Contours>) -> bool) -> bool {
    for _ in 0..40 {
        small.headless.step(1);
        if done(small.headless.app.world().get(small.camera)) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(25));
    }
    false
}
