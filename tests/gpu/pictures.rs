//! The whole fused pass against its reference, pixel by pixel. The reference starts from
//! the texels that the pass read.

use bevy::camera::CompositingSpace;
use bevy_comics::{
    effects::HarmonyCurve,
    presets::{self, Preset},
};
use bevy_comics_testkit::reference::{
    Rgba, color,
    crack::jump,
    draw::Ink,
    fused::{Input, stylize},
    map::{Frame, Projection},
    resolve::{Prepass, Resolved},
    sheet::Sheet,
    view::View,
};

use crate::prelude::*;

const ONE_CODE: f64 = 1.0 / 255.0;

/// The orthographic projection of the camera, if it has one.
fn orthographic(small: &Small) -> Option<OrthographicProjection> {
    let world = small.headless.app.world();
    match world.get::<bevy::camera::Projection>(small.camera) {
        Some(bevy::camera::Projection::Orthographic(projection)) => Some(projection.clone()),
        _ => None,
    }
}

/// The depth frame of the small scene's infinite perspective, or of its orthographic view.
pub fn frame(small: &Small, map: &DepthMap) -> Frame {
    const NEAR: f64 = 0.1;
    const FAR: f64 = 1000.0;
    let orthographic = orthographic(small).map(|p| [p.near, p.far].map(f64::from));
    let raw_depth = |distance: f64| match orthographic {
        Some([near, far]) => (far - distance) / (far - near),
        None => NEAR / distance,
    };
    let planes = orthographic.unwrap_or([NEAR, FAR]);
    let ends = match map.mapping {
        DepthMapping::MinMax | DepthMapping::MinMaxLogarithmic => match small.range() {
            Some(VisibleDepthRange::Visible {
                raw_nearest,
                raw_farthest,
                ..
            }) => Some([f64::from(raw_nearest), f64::from(raw_farthest)]),
            other => panic!("no range: {other:?}"),
        },
        DepthMapping::Linear | DepthMapping::Logarithmic => Some(planes.map(raw_depth)),
        DepthMapping::Fixed { from, to } | DepthMapping::FixedLogarithmic { from, to } => {
            Some([from, to].map(|end| raw_depth(f64::from(end))))
        }
        other => panic!("no reference of {other:?}"),
    };
    let projection = match orthographic {
        Some([near, far]) => Projection::Orthographic {
            plane_far: far,
            extent: far - near,
        },
        None => Projection::Perspective { offset: 0.0 },
    };
    Frame {
        projection,
        ends,
        logarithmic: map.mapping.is_logarithmic(),
        floor: f64::from(map.floor),
        sky_gap: f64::from(map.sky_gap),
    }
}

/// Unit vector towards the light that lines follow.
fn to_light(small: &mut Small) -> [f64; 3] {
    let world = small.world();
    let mut lights = world.query_filtered::<&GlobalTransform, With<KeyLight>>();
    let found = lights.iter(world).next().map(|light| *light.back());
    found.unwrap_or(Vec3::Y).to_array().map(f64::from)
}

/// What the passes of the small scene read.
pub fn view_of<'a>(
    small: &mut Small,
    prepass: &'a Prepass,
    map: &DepthMap,
    viewport: [u32; 4],
) -> View<'a> {
    let depth = &prepass.depth;
    View {
        viewport,
        samples: depth.samples,
        width: depth.width,
        depth_bits: &depth.bits,
        frame: frame(small, map),
        flip: map.flip,
        normals: prepass.normals.first(),
        ids: prepass.ids.first(),
        widths: prepass.widths.first(),
        height: orthographic(small).map_or(0.0, |p| f64::from(p.area.height())),
        to_light: to_light(small),
    }
}

/// Whether an effect reads the picture at other places, so that there is more than one pass.
fn is_divided(style: &ComicStyle) -> bool {
    let cells =
        |s: &Halftone| s.sampling == ScreenSampling::Cell && s.shape != ScreenShape::Stochastic;
    style.get::<Misregistration>().is_some() || style.get::<Halftone>().is_some_and(cells)
}

/// Compares every pixel. Pixels so close to a threshold that the error of the
/// response decides are counted instead; at most 1 in 200 may be.
pub fn assert_pass_matches_the_reference(
    small: &mut Small,
    style: &ComicStyle,
    viewport: Option<[u32; 4]>,
    what: &str,
) {
    small.insert(VisibleDepthRange::default());
    small.style(style);
    small.settle();
    let (input, output) = small.pass();
    let loaded = small.loaded();
    let map = style.depth_map.unwrap_or_default();
    let prepass = small.prepass();
    let prepass = prepass.unwrap_or_else(|| panic!("{what}: no depth"));
    let viewport = viewport.unwrap_or([0, 0, input.width, input.height]);
    let view = view_of(small, &prepass, &map, viewport);
    let sketch = style.get::<Sketch>();
    let implied = sketch.map(|_| Outlines {
        objects: None,
        width: 1.5,
        response: LineResponse::Ink,
        ..default()
    });
    let outlines = style.get::<Outlines>().copied().or(implied);
    let seconds = small
        .headless
        .app
        .world()
        .resource::<Time>()
        .elapsed_secs_f64();
    let drawn = outlines.unwrap_or_default();
    let resolved = Resolved::new(&prepass, |near| jump(&drawn) * view.jump_reference(near));
    let seen = resolved.view(&view);
    let paper = style.get::<Paper>();
    let sheet = paper.map_or(Sheet::SMOOTH, |s| Sheet::new(s, 1.0, 0));
    let ink = |outlines: &Outlines| Ink::new((outlines, sheet), &seen, 1.0, seconds);
    let edges = outlines.map(|outlines| (outlines, ink(&outlines)));
    let mut undecided = 0;
    // This camera stores display codes instead of linear colour.
    let encoded = small
        .headless
        .app
        .world()
        .get::<CompositingSpace>(small.camera)
        == Some(&CompositingSpace::Srgb);
    let light = |stored: [f32; 4]| {
        let [r, g, b, a] = stored;
        if !encoded {
            return stored;
        }
        let [r, g, b] = [r, g, b].map(|c| color::srgb_decode_one(f64::from(c)) as f32);
        [r, g, b, a]
    };
    let light_of = |x: u32, y: u32| light(loaded.pixels[(y * input.width + x) as usize]);
    let read_by_pass = Input {
        picture: &light_of,
        size: [input.width, input.height],
        lines: edges.as_ref().map(|(outlines, edges)| (outlines, edges)),
        drawing: sketch.map_or(0, |s| (seconds * f64::from(s.rate)).floor() as u32),
        quads: if is_divided(style) {
            [viewport[0], viewport[1]]
        } else {
            [0, 0]
        },
    };
    for y in 0..input.height {
        for x in 0..input.width {
            let at = (y * input.width + x) as usize;
            let (read, wrote) = (light(input.pixels[at]), light(output.pixels[at]));
            if !view.contains(x, y) {
                assert_eq!(read, wrote, "{what}: ({x}, {y}) lies outside the viewport");
                continue;
            }
            let encode = |[r, g, b, alpha]: Rgba| {
                let [r, g, b] = color::srgb_encode([r, g, b].map(|v| v.max(0.0)));
                [r, g, b, alpha]
            };
            let got = encode(wrote.map(f64::from));
            let of_reference = |nudge| encode(stylize(style, &view, &read_by_pass, x, y, nudge));
            let want = of_reference(0.0);
            let apart = |a: Rgba, b: Rgba| {
                (0..4)
                    .map(|i| (a[i].min(1.0) - b[i].min(1.0)).abs())
                    .fold(0.0, f64::max)
            };
            // Half a code of rounding in the target on top of the one allowed.
            if apart(got, want) <= 1.5 * ONE_CODE {
                continue;
            }
            let [more, less] = [1e-5, -1e-5].map(of_reference);
            // Ink that is stored between two codes can be either.
            let close = (0..4).all(|i| {
                let low = want[i].min(more[i]).min(less[i]);
                let high = want[i].max(more[i]).max(less[i]);
                got[i] >= low - ONE_CODE && got[i] <= high + ONE_CODE
            });
            assert!(
                close || apart(more, less) > ONE_CODE,
                "{what}: ({x}, {y}) is {got:?}, its reference {want:?} ({more:?}, {less:?}), from {read:?}"
            );
            undecided += 1;
        }
    }
    let pixels = input.width * input.height;
    assert!(
        undecided * 200 <= pixels,
        "{what}: {undecided} of {pixels} pixels undecided"
    );
}

/// A style without what the reference of the whole picture does not know, and what other tests compare
/// with references of their own: paint, which changes the picture before the fused pass, hatching,
/// iso-lines, lines in the colours of surfaces, and of planes the borders that are found, whole
/// objects and lines.
fn known_to_reference(style: ComicStyle) -> ComicStyle {
    let outlines = style.get::<Outlines>().map(|outlines| Outlines {
        color: LineColor::Ink,
        ..*outlines
    });
    let planes = style.get::<DepthLayers>().map(|planes| {
        let plain = |plane: DepthLayer| DepthLayer {
            line_width: 1.0,
            line_opacity: 1.0,
            line_color_amount: 0.0,
            ..plane
        };
        DepthLayers {
            foreground: plain(planes.foreground),
            middle: plain(planes.middle),
            background: plain(planes.background),
            granularity: Granularity::Pixel,
            borders: LayerBorders::Fixed,
            ..*planes
        }
    });
    let mut style = style
        .without::<Paint>()
        .without::<Hatching>()
        .without::<IsoLines>();
    if let Some(outlines) = outlines {
        style.insert(outlines);
    }
    if let Some(planes) = planes {
        style.insert(planes);
    }
    style
}

/// A preset as the reference of the whole picture knows it. One with planes and tints is compared twice,
/// without the ones and without the others: steps of tints are ten times as steep as tones, and turn
/// the rounding of the planes' colours into another tint.
pub fn known_forms(preset: &Preset) -> Vec<ComicStyle> {
    let style = known_to_reference(preset.style().sanitized());
    let halftone = style.get::<Halftone>().copied();
    let tinted = halftone.filter(|s| s.tints > 0 && style.get::<DepthLayers>().is_some());
    let Some(halftone) = tinted else {
        return vec![style];
    };
    let all_tones = Halftone {
        tints: 0,
        ..halftone
    };
    vec![
        style.clone().without::<DepthLayers>(),
        style.with(all_tones),
    ]
}

fn check_presets(msaa: Msaa, presets: &[Preset]) {
    let mut small = Small::new(UVec2::new(80, 56), msaa);
    for preset in presets {
        for style in known_forms(preset) {
            assert_pass_matches_the_reference(
                &mut small,
                &style,
                None,
                &format!("{preset}, {msaa:?}"),
            );
        }
    }
    assert_eq!(small.errors(), 0);
}

/// Colours, contours, bands and a sketch.
#[test]
fn presets_match_the_reference() {
    check_presets(
        Msaa::Off,
        &[presets::CRIMSON_DUSK, presets::NOIR, presets::FIGURE_8B],
    );
}

/// Outlines, dots, planes and a vignette.
#[test]
fn multisampled_presets_match_the_reference() {
    check_presets(
        Msaa::Sample4,
        &[
            presets::SATURDAY_MORNING,
            presets::NEWSPRINT,
            presets::STORYBOOK,
        ],
    );
}

#[test]
#[ignore = "long: every preset, twice"]
fn every_preset_matches_the_reference_with_and_without_msaa() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        check_presets(msaa, presets::ALL);
    }
}

fn everything(
    color: Equations,
    mode: ColorizationMode,
    form: Equations,
    mapping: DepthMapping,
) -> ComicStyle {
    let mut style = ComicStyle::new();
    style.name = "everything".into();
    style = style
        .with(Desaturation {
            amount: 0.7,
            exponent: 0.5,
            equations: color,
        })
        .with(Colorization {
            mode,
            equations: color,
            amount: 0.8,
            ..default()
        })
        .with(BlackFlats {
            slope: Some(0.3),
            value: Some(0.2),
            depth_weight: 0.5,
            ..default()
        })
        .with(Contours {
            equations: form,
            width: 2.5,
            threshold: 0.06,
            opacity_fade: 0.4,
            ..default()
        });
    let map = DepthMap {
        mapping,
        ..default()
    };
    with_map(style, map)
}

const MAPPINGS: [DepthMapping; 6] = [
    DepthMapping::MinMax,
    DepthMapping::MinMaxLogarithmic,
    DepthMapping::Linear,
    DepthMapping::Logarithmic,
    DepthMapping::Fixed { from: 4.0, to: 9.0 },
    DepthMapping::FixedLogarithmic { from: 4.0, to: 9.0 },
];

const FORMS: [Equations; 2] = [Equations::Corrected, Equations::Faithful];

/// Checks these pairs of a mapping and a form, with another mode each time.
fn check_mappings(pairs: impl IntoIterator<Item = (usize, usize)>) {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let modes = [
        ColorizationMode::KeepHue,
        ColorizationMode::Atmosphere,
        ColorizationMode::Linear,
        ColorizationMode::Quadratic,
    ];
    for (i, j) in pairs {
        let form = FORMS[(i + j) % 2];
        let style = everything(FORMS[j], modes[(i + 2 * j) % 4], form, MAPPINGS[i]);
        assert_pass_matches_the_reference(&mut small, &style, None, &format!("{style:?}"));
    }
    assert_eq!(small.errors(), 0);
}

/// Every mapping, and every mode.
#[test]
fn every_mapping_matches_the_reference() {
    check_mappings((0..6).map(|i| (i, i / 2 % 2)));
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let flip = DepthMap {
        flip: true,
        ..default()
    };
    let flipped = with_map(ComicStyle::default().with(Desaturation::default()), flip);
    assert_pass_matches_the_reference(&mut small, &flipped, None, "flipped");
}

#[test]
#[ignore = "long: every mapping in both forms"]
fn every_mapping_matches_the_reference_in_both_forms() {
    check_mappings((0..6).flat_map(|i| [(i, 0), (i, 1)]));
}

/// Checks contours of an operator, a form and a width in pixels.
fn check_contours(cases: impl IntoIterator<Item = (ContourOperator, Equations, f32)>) {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for (operator, form, width) in cases {
        let style = ComicStyle::default().with(Contours {
            operator,
            equations: form,
            width,
            softness: 0.3,
            threshold: 0.08,
            ..default()
        });
        let what = format!("{operator:?} {form:?} {width} px");
        assert_pass_matches_the_reference(&mut small, &style, None, &what);
    }
    assert_eq!(small.errors(), 0);
}

const OPERATORS: [ContourOperator; 4] = [
    ContourOperator::Prewitt,
    ContourOperator::Sobel,
    ContourOperator::Laplace,
    ContourOperator::Roberts,
];
const WIDTHS: [f32; 4] = [0.5, 1.0, 3.0, 7.5];

/// Every operator in both forms, and every width.
#[test]
fn contours_match_the_reference() {
    let width = |i: usize, j: usize| WIDTHS[(i + 2 * j) % 4];
    let of = |i: usize| [0, 1].map(|j| (OPERATORS[i], FORMS[j], width(i, j)));
    check_contours((0..4).flat_map(of));
}

#[test]
#[ignore = "long: every operator, form and width"]
fn contours_of_every_operator_form_and_width_match_the_reference() {
    for operator in OPERATORS {
        for form in FORMS {
            check_contours(WIDTHS.map(|width| (operator, form, width)));
        }
    }
}

pub fn outlined(outlines: Outlines) -> ComicStyle {
    ComicStyle::default().with(outlines)
}

/// Checks outlines of every kind and form, and of these widths.
fn check_outlines(msaa: Msaa, widths: &[f32]) {
    let mut small = Small::new(UVec2::new(72, 48), msaa);
    for width in widths.iter().copied() {
        let style = outlined(Outlines {
            width,
            width_fade: 0.3,
            opacity_fade: 0.5,
            ..default()
        });
        assert_pass_matches_the_reference(
            &mut small,
            &style,
            None,
            &format!("{width} px, {msaa:?}"),
        );
    }
    for kind in 0..3 {
        let all = Outlines::default();
        let style = outlined(Outlines {
            silhouettes: all.silhouettes.filter(|_| kind == 0),
            creases: all.creases.filter(|_| kind == 1),
            objects: all.objects.filter(|_| kind == 2),
            width: 3.0,
            ..all
        });
        assert_pass_matches_the_reference(
            &mut small,
            &style,
            None,
            &format!("kind {kind}, {msaa:?}"),
        );
    }
    let faithful = outlined(Outlines {
        silhouettes: Some(Silhouettes {
            equations: Equations::Faithful,
            threshold: 0.0008,
            edge_limit: 0.7,
            ..default()
        }),
        creases: Some(Creases {
            equations: Equations::Faithful,
            color: Color::srgb(0.6, 0.1, 0.1),
            ..default()
        }),
        ..default()
    });
    assert_pass_matches_the_reference(&mut small, &faithful, None, &format!("faithful, {msaa:?}"));
    // Measured creases have no line at a jump, which faithful silhouettes have no measure of.
    let mixed = outlined(Outlines {
        silhouettes: Some(Silhouettes {
            equations: Equations::Faithful,
            threshold: 0.0008,
            ..default()
        }),
        ..default()
    });
    assert_pass_matches_the_reference(&mut small, &mixed, None, &format!("mixed, {msaa:?}"));
    assert_eq!(small.errors(), 0);
}

#[test]
fn outlines_of_every_kind_and_form_match_the_reference() {
    check_outlines(Msaa::Off, &[0.5, 1.7, 4.0]);
}

#[test]
fn multisampled_outlines_match_the_reference() {
    check_outlines(Msaa::Sample4, &[1.0]);
}

#[test]
#[ignore = "long: every width, twice"]
fn outlines_of_every_kind_form_and_width_match_the_reference() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        check_outlines(msaa, &[0.5, 1.0, 1.7, 2.0, 3.0, 4.0]);
    }
}

/// The two papers on one camera in one pass.
#[test]
fn everything_at_once_matches_the_reference() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let both = |sketch: Option<Sketch>| {
        let style = everything(
            Equations::Corrected,
            ColorizationMode::Quadratic,
            Equations::Corrected,
            DepthMapping::MinMax,
        )
        .with(ToneBands {
            levels: 5,
            softness: 0.0,
            ..default()
        })
        .with(Outlines {
            width: 2.5,
            opacity_fade: 0.4,
            ..default()
        });
        with_option(style, sketch)
    };
    assert_pass_matches_the_reference(&mut small, &both(None), None, "both papers");
    let sketch = Sketch {
        wash: 0.5,
        ..default()
    };
    assert_pass_matches_the_reference(
        &mut small,
        &both(Some(sketch)),
        None,
        "both papers, sketched",
    );
    // Larger, since every pixel of an edge lies on a steep step between bands.
    let mut small = Small::new(UVec2::new(144, 96), Msaa::Off);
    for method in [Equations::Corrected, Equations::Faithful] {
        for softness in [0.0, 1.0, 3.0] {
            let style = ComicStyle::default().with(ToneBands {
                equations: method,
                softness,
                ..default()
            });
            assert_pass_matches_the_reference(
                &mut small,
                &style,
                None,
                &format!("{method:?}, {softness} px"),
            );
        }
    }
}

/// A camera with a viewport smaller than its target.
#[test]
fn a_viewport_is_styled_inside_and_untouched_outside() {
    let mut small = Small::new(UVec2::new(90, 60), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        small.insert(Camera {
            viewport: Some(Viewport {
                physical_position: UVec2::new(13, 7),
                physical_size: UVec2::new(51, 41),
                ..default()
            }),
            ..default()
        });
        let style = everything(
            Equations::Corrected,
            ColorizationMode::Quadratic,
            Equations::Corrected,
            DepthMapping::MinMax,
        );
        assert_pass_matches_the_reference(
            &mut small,
            &style,
            Some([13, 7, 51, 41]),
            &format!("viewport, {msaa:?}"),
        );
    }
}

/// Storage in display codes (`CompositingSpace::Srgb`). Bevy 0.19.1 draws unlit
/// meshes darker there, with or without a style, so the picture is compared with
/// the reference of the pass and not with that of a linear camera.
#[test]
fn a_camera_that_stores_display_codes_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 48), Msaa::Off);
    small.insert(CompositingSpace::Srgb);
    let style = everything(
        Equations::Corrected,
        ColorizationMode::Linear,
        Equations::Corrected,
        DepthMapping::MinMax,
    );
    assert_pass_matches_the_reference(&mut small, &style, None, "gamma-encoded");
}

/// HDR storage, with colours above 1.
#[test]
fn an_hdr_camera_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 48), Msaa::Off);
    small.insert(Hdr);
    let style = everything(
        Equations::Corrected,
        ColorizationMode::Linear,
        Equations::Corrected,
        DepthMapping::MinMax,
    );
    assert_pass_matches_the_reference(&mut small, &style, None, "hdr");
    let style = everything(
        Equations::Faithful,
        ColorizationMode::Quadratic,
        Equations::Faithful,
        DepthMapping::MinMax,
    );
    assert_pass_matches_the_reference(&mut small, &style, None, "hdr, faithful");
}

/// After the other effects of colour, over a background that shows through.
#[test]
fn every_mode_of_harmony_matches_the_reference() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Sample4);
    small.insert(Camera {
        clear_color: Color::srgba(0.1, 0.2, 0.3, 0.4).into(),
        ..default()
    });
    let modes = [
        (HarmonyMode::TwoHues, Equations::Corrected),
        (HarmonyMode::Distance, Equations::Corrected),
        (HarmonyMode::Distance, Equations::Faithful),
        (HarmonyMode::Rotation, Equations::Corrected),
        (HarmonyMode::Shade, Equations::Corrected),
        (HarmonyMode::Shade, Equations::Faithful),
    ];
    for (mode, form) in modes {
        for curve in [HarmonyCurve::Linear, HarmonyCurve::SquareRoot] {
            let harmony = ColorHarmony {
                mode,
                equations: form,
                curve,
                complement: 1.2,
                shade: 0.9,
                ..default()
            };
            let desaturation = Desaturation {
                amount: 0.3,
                ..default()
            };
            let style = ComicStyle::new().with(desaturation).with(harmony);
            let what = format!("{harmony:?}");
            assert_pass_matches_the_reference(&mut small, &style, None, &what);
        }
    }
    assert_eq!(small.errors(), 0);
}

/// With fixed borders; those that are found are tested in `planes.rs`.
#[test]
fn planes_match_the_reference() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        small.insert(Camera {
            clear_color: Color::srgba(0.1, 0.2, 0.3, 0.4).into(),
            ..default()
        });
        for (bands, flip) in [(0, false), (3, false), (0, true)] {
            let planes = DepthLayers {
                foreground: DepthLayer {
                    saturation: 1.4,
                    contrast: 1.2,
                    bands,
                    ..default()
                },
                granularity: Granularity::Pixel,
                borders: LayerBorders::Fixed,
                foreground_end: 0.3,
                background_start: 0.6,
                softness: 0.2,
                ..default()
            };
            let map = DepthMap { flip, ..default() };
            let style = with_map(ComicStyle::new().with(planes), map);
            let what = format!("{msaa:?}, {bands} bands, flip: {flip}");
            assert_pass_matches_the_reference(&mut small, &style, None, &what);
        }
    }
    assert_eq!(small.errors(), 0);
}
