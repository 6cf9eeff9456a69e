//! The whole fused pass against its reference, pixel by pixel. The reference starts from
//! the texels that the pass read.

use std::cell::LazyCell;

use bevy::camera::CompositingSpace;
use bevy_comics::presets::Preset;
use bevy_comics_testkit::reference::{
    Rgba,
    box_statistics::Sheet,
    color,
    crack::separation,
    draw::Ink,
    fused::{Input, stylize},
    map::{Frame, Projection},
    resolve::{Prepass, Resolved},
    sheet, tone_range,
    view::View,
};

use half::f16;

use crate::{halftone::fill, prelude::*};

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

/// Unit vector to the right of the camera.
fn right(small: &Small) -> [f64; 3] {
    let world = small.headless.app.world();
    let camera = world.get::<GlobalTransform>(small.camera);
    let right = camera.map_or(Vec3::X, |camera| *camera.right());
    right.to_array().map(f64::from)
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
        least_bend: least_bend(small, viewport, depth.samples),
        to_light: to_light(small),
        right: right(small),
    }
}

/// Of [`View`]. The view is symmetric.
fn least_bend(small: &Small, [.., width, height]: [u32; 4], samples: u32) -> f64 {
    let camera = small.headless.app.world().get::<Camera>(small.camera);
    let matrix = camera.expect("it is a camera").clip_from_view();
    let half = [matrix.x_axis.x, matrix.y_axis.y].map(|scale| 1.0 / f64::from(scale));
    let pixel = f64::min(
        2.0 * half[0] / f64::from(width),
        2.0 * half[1] / f64::from(height),
    );
    let over = match orthographic(small) {
        Some(_) => half[1] / 22.5f64.to_radians().tan(),
        None => 1.0 + half[0] * half[0] + half[1] * half[1],
    };
    let sampled = if samples > 1 { 0.64 } else { 1.0 };
    2f64.sqrt() * sampled * pixel / over
}

/// Whether an effect reads the picture at other places, so that there is more than one pass.
fn is_divided(style: &ComicStyle) -> bool {
    let cells =
        |s: &Halftone| s.sampling == ScreenSampling::Cell && s.shape != ScreenShape::Stochastic;
    style.get::<Halftone>().is_some_and(cells)
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
    small.style(style).settle();
    let (input, output) = small.pass();
    let loaded = small.loaded();
    let map = style.depth_map.unwrap_or_default();
    let prepass = small.prepass().expect("depth");
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
    let world = small.headless.app.world();
    let seconds = world.resource::<Time>().elapsed_secs_f64();
    // This camera stores display codes instead of linear color.
    let encoded = world.get::<CompositingSpace>(small.camera) == Some(&CompositingSpace::Srgb);
    let drawn = outlines.unwrap_or_default();
    let resolved = Resolved::new(&prepass, |near, differ| {
        separation(&drawn, differ) * view.jump_reference(near)
    });
    let seen = resolved.view(&view);
    let paper = style.get::<Paper>();
    let sheet = paper.map_or(sheet::Sheet::SMOOTH, |s| sheet::Sheet::new(s, 1.0, 0));
    let edges = outlines.map(|s| (s, Ink::new((&s, sheet), &seen, 1.0, seconds)));
    let mut undecided = 0;
    let light = |stored: [f32; 4]| {
        let [r, g, b, a] = stored;
        if !encoded {
            return stored;
        }
        let [r, g, b] = [r, g, b].map(|c| color::srgb_decode_one(f64::from(c)) as f32);
        [r, g, b, a]
    };
    let light_of = |x: u32, y: u32| light(loaded.pixels[(y * input.width + x) as usize]);
    let tones = style.get::<ToneRange>().and_then(|s| {
        let [left, top, width, height] = viewport;
        let rows = (top..top + height).step_by(2);
        let counted = rows.flat_map(|y| (left..left + width).step_by(2).map(move |x| (x, y)));
        tone_range::percentiles(counted.map(|(x, y)| light_of(x, y)), s.outliers)
    });
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
        tones,
    };
    for y in 0..input.height {
        for x in 0..input.width {
            let at = (y * input.width + x) as usize;
            let (read, wrote) = (light(input.pixels[at]), light(output.pixels[at]));
            if !view.contains(x, y) {
                assert_eq!(read, wrote, "{what}: ({x}, {y}) lies outside the viewport");
                continue;
            }
            let got = encode(wrote.map(f64::from));
            let of_reference = |nudge| encode(stylize(style, &view, &read_by_pass, x, y, nudge));
            let want = of_reference(0.0);
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

/// Compares every pixel of a pass after the fused pass with its reference. That starts from the
/// picture of the style `before`, as it is stored between the passes: in 11 bits. A nudge moves
/// what decides which pixels are read; at most 1 pixel in 200 may depend on it.
pub fn assert_later_pass_matches_the_reference<E: Effect>(
    small: &mut Small,
    before: &ComicStyle,
    effect: E,
    viewport: Option<[u32; 4]>,
    reference: impl Fn(&View, &Sheet, f64) -> Sheet,
) {
    small.insert(VisibleDepthRange::default());
    let style = before.clone().with(effect);
    small.style(&style).settle();
    assert!(small.ran(ComicsStage::of::<E>()));
    let (read, wrote) = small.pass();
    let loaded = small.loaded();
    let map = before.depth_map.unwrap_or_default();
    let prepass = small.prepass().expect("depth");
    let viewport = viewport.unwrap_or([0, 0, read.width, read.height]);
    let view = view_of(small, &prepass, &map, viewport);
    let [left, top, width, height] = viewport;
    let light = |x: u32, y: u32| loaded.pixels[(y * read.width + x) as usize];
    let input = Input {
        picture: &light,
        size: [read.width, read.height],
        lines: None,
        drawing: 0,
        quads: [left, top],
        tones: None,
    };
    let sheet = Sheet::new([width, height].map(|v| v as usize), |[x, y]| {
        let [x, y] = [left + x as u32, top + y as u32];
        let pixel = stylize(before, &view, &input, x, y, 0.0);
        pixel.map(|v| f64::from(f16::from_f64(v).to_f32()))
    });
    let want = reference(&view, &sheet, 0.0);
    let nudged = LazyCell::new(|| [1e-4, -1e-4].map(|nudge| reference(&view, &sheet, nudge)));
    let (mut changed, mut undecided) = (0, 0);
    for (i, want) in want.pixels.iter().enumerate() {
        let [x, y] = [i % sheet.size[0], i / sheet.size[0]];
        let at = (top as usize + y) * read.width as usize + left as usize + x;
        let got = wrote.pixels[at].map(f64::from);
        changed += usize::from(*want != sheet.pixels[i]);
        // Half a code of rounding in the target on top of the one allowed.
        if apart(encode(got), encode(*want)) <= 1.5 * ONE_CODE {
            continue;
        }
        let [more, less] = nudged.each_ref().map(|sheet| encode(sheet.pixels[i]));
        assert!(
            apart(more, less) > ONE_CODE,
            "{style:?}: ({x}, {y}): {got:?}, {want:?}"
        );
        undecided += 1;
    }
    assert!(changed > 100, "{changed} pixels change");
    assert!(undecided * 200 <= want.pixels.len(), "{undecided} pixels");
}

/// Display codes, and the opacity.
fn encode([r, g, b, alpha]: Rgba) -> Rgba {
    let [r, g, b] = color::srgb_encode([r, g, b].map(|v| v.max(0.0)));
    [r, g, b, alpha]
}

/// The largest difference on a display.
fn apart(a: Rgba, b: Rgba) -> f64 {
    (0..4)
        .map(|i| (a[i].min(1.0) - b[i].min(1.0)).abs())
        .fold(0.0, f64::max)
}

/// A style without what the reference of the whole picture does not know and other tests check:
/// paint, hatching, iso-lines, plates out of register, strokes beyond the ends of lines, lines in the colors of surfaces, convex
/// and concave creases of their own, and of layers the borders that are found, whole objects and lines.
fn known_to_reference(style: ComicStyle) -> ComicStyle {
    let mut style = style
        .without::<Paint>()
        .without::<Hatching>()
        .without::<Misregistration>()
        .without::<IsoLines>();
    if let Some(outlines) = style.get_mut::<Outlines>() {
        outlines.color = LineColor::Ink;
        outlines.overshoot = 0.0;
        outlines.creases = outlines.creases.map(|creases| Creases {
            convex: None,
            concave: None,
            ..creases
        });
    }
    if let Some(layers) = style.get_mut::<DepthLayers>() {
        layers.granularity = Granularity::Pixel;
        layers.borders = LayerBorders::Fixed;
        for layer in [
            &mut layers.foreground,
            &mut layers.middle,
            &mut layers.background,
        ] {
            layer.line_width = 1.0;
            layer.line_opacity = 1.0;
            layer.line_color_amount = 0.0;
        }
    }
    style
}

/// A preset as the reference of the whole picture knows it. One with layers and tints is compared
/// twice, without the ones and without the others: steps of tints are ten times as steep as tones,
/// and turn the rounding of the layers' colors into another tint.
pub fn known_forms(preset: &Preset) -> Vec<ComicStyle> {
    let style = known_to_reference(preset.style().sanitized());
    let mut untinted = style.clone();
    match untinted.get_mut::<Halftone>() {
        Some(halftone) if halftone.tints > 0 && style.get::<DepthLayers>().is_some() => {
            halftone.tints = 0;
            vec![style.without::<DepthLayers>(), untinted]
        }
        _ => vec![style],
    }
}

/// Compares styles on the camera of the small scene, each with a name for the message.
pub fn check(
    small: &mut Small,
    viewport: Option<[u32; 4]>,
    styles: impl IntoIterator<Item = (String, ComicStyle)>,
) {
    for (what, style) in styles {
        assert_pass_matches_the_reference(small, &style, viewport, &what);
    }
}

pub fn check_presets(small: &mut Small, presets: &[Preset]) {
    for preset in presets {
        let forms = known_forms(preset).into_iter();
        check(small, None, forms.map(|style| (preset.to_string(), style)));
    }
}

/// Colors, contours, bands and a sketch; with four samples, outlines, dots, planes and a vignette.
#[test]
fn presets_match_the_reference() {
    let one = [presets::CRIMSON_DUSK, presets::NOIR, presets::FIGURE_8B];
    check_presets(&mut Small::new(UVec2::new(80, 56), Msaa::Off), &one);
    let four = [
        presets::SATURDAY_MORNING,
        presets::NEWSPRINT,
        presets::STORYBOOK,
    ];
    check_presets(&mut Small::new(UVec2::new(80, 56), Msaa::Sample4), &four);
}

#[test]
#[ignore = "long: every preset, twice"]
fn every_preset_matches_the_reference_with_and_without_msaa() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        check_presets(&mut Small::new(UVec2::new(80, 56), msaa), presets::ALL);
    }
}

fn everything(
    color: Equations,
    mode: ColorizationMode,
    form: Equations,
    mapping: DepthMapping,
) -> ComicStyle {
    let style = ComicStyle::new()
        .with(Desaturation {
            amount: 0.7,
            amount_near: 0.2,
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

/// `everything` by the corrected equations.
fn corrected(mode: ColorizationMode) -> ComicStyle {
    let form = Equations::Corrected;
    everything(form, mode, form, DepthMapping::MinMax)
}

const FORMS: [Equations; 2] = [Equations::Corrected, Equations::Faithful];

/// Every mapping, and every mode.
#[test]
fn every_mapping_matches_the_reference() {
    let mappings = [
        DepthMapping::MinMax,
        DepthMapping::MinMaxLogarithmic,
        DepthMapping::Linear,
        DepthMapping::Logarithmic,
        DepthMapping::Fixed { from: 4.0, to: 9.0 },
        DepthMapping::FixedLogarithmic { from: 4.0, to: 9.0 },
    ];
    let modes = [
        ColorizationMode::KeepHue,
        ColorizationMode::Atmosphere,
        ColorizationMode::Linear,
        ColorizationMode::SquareRoot,
    ];
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for (i, mapping) in mappings.into_iter().enumerate() {
        let j = i / 2 % 2;
        let mode = modes[(i + 2 * j) % 4];
        let style = everything(FORMS[j], mode, FORMS[(i + j) % 2], mapping);
        check(&mut small, None, [(format!("{style:?}"), style)]);
    }
    let flip = DepthMap {
        flip: true,
        ..default()
    };
    let flipped = with_map(ComicStyle::default().with(Desaturation::default()), flip);
    check(&mut small, None, [("flipped".into(), flipped)]);
}

/// Every operator in both forms, and every width.
#[test]
fn contours_match_the_reference() {
    let operators = [
        ContourOperator::Prewitt,
        ContourOperator::Sobel,
        ContourOperator::Laplace,
        ContourOperator::Roberts,
    ];
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for (i, operator) in operators.into_iter().enumerate() {
        let styles = [0, 1].map(|j| {
            let contours = Contours {
                operator,
                equations: FORMS[j],
                width: [0.5, 1.0, 3.0, 7.5][(i + 2 * j) % 4],
                softness: 0.3,
                threshold: 0.08,
                ..default()
            };
            (format!("{contours:?}"), outlined(contours))
        });
        check(&mut small, None, styles);
    }
}

pub fn outlined(lines: impl Effect) -> ComicStyle {
    ComicStyle::default().with(lines)
}

/// Checks outlines of every kind and form, and of these widths.
fn check_outlines(msaa: Msaa, widths: &[f32]) {
    let all = Outlines::default();
    let faithful = Silhouettes {
        equations: Equations::Faithful,
        threshold: 0.0008,
        ..default()
    };
    let wide = widths.iter().map(|&width| Outlines {
        width,
        width_fade: 0.3,
        opacity_fade: 0.5,
        ..all
    });
    let kinds = (0..3).map(|kind| Outlines {
        silhouettes: all.silhouettes.filter(|_| kind == 0),
        creases: all.creases.filter(|_| kind == 1),
        objects: all.objects.filter(|_| kind == 2),
        width: 3.0,
        ..all
    });
    let forms = [
        Outlines {
            silhouettes: Some(Silhouettes {
                edge_limit: 0.7,
                ..faithful
            }),
            creases: Some(Creases {
                equations: Equations::Faithful,
                color: Color::srgb(0.6, 0.1, 0.1),
                ..default()
            }),
            ..all
        },
        // Measured creases have no line at a jump, which faithful silhouettes have no measure of.
        Outlines {
            silhouettes: Some(faithful),
            ..all
        },
    ];
    let mut small = Small::new(UVec2::new(72, 48), msaa);
    let all = wide.chain(kinds).chain(forms);
    let styles = all.map(|s| (format!("{s:?}, {msaa:?}"), outlined(s)));
    check(&mut small, None, styles);
}

#[test]
fn outlines_of_every_kind_and_form_match_the_reference() {
    check_outlines(Msaa::Off, &[0.5, 1.7, 4.0]);
}

#[test]
fn multisampled_outlines_match_the_reference() {
    check_outlines(Msaa::Sample4, &[1.0]);
}

/// The two papers on one camera in one pass.
#[test]
fn everything_at_once_matches_the_reference() {
    let both = corrected(ColorizationMode::SquareRoot)
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
    let sketched = both.clone().with(Sketch {
        wash: 0.5,
        ..default()
    });
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    let styles = [("both papers", both), ("sketched", sketched)];
    let styles = styles.map(|(what, style)| (what.to_string(), style));
    check(&mut small, None, styles);
}

#[test]
fn tone_bands_match_the_reference() {
    // Large, since every pixel of an edge lies on a steep step between bands.
    let mut small = Small::new(UVec2::new(144, 96), Msaa::Off);
    for equations in FORMS {
        let styles = [0.0, 1.0, 3.0].map(|softness| {
            let bands = ToneBands {
                equations,
                softness,
                ..default()
            };
            (format!("{bands:?}"), ComicStyle::default().with(bands))
        });
        check(&mut small, None, styles);
    }
}

/// A camera with a viewport smaller than its target.
#[test]
fn a_viewport_is_styled_inside_and_untouched_outside() {
    let mut small = Small::new(UVec2::new(90, 60), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let viewport = [13, 7, 51, 41];
        small.see_in(viewport);
        let style = corrected(ColorizationMode::SquareRoot);
        let styles = [(format!("{msaa:?}"), style)];
        check(&mut small, Some(viewport), styles);
    }
}

/// Storage in display codes (`CompositingSpace::Srgb`). Bevy 0.19.1 draws unlit
/// meshes darker there, with or without a style, so the picture is compared with
/// the reference of the pass and not with that of a linear camera.
#[test]
fn a_camera_that_stores_display_codes_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 48), Msaa::Off);
    small.insert(CompositingSpace::Srgb);
    let style = corrected(ColorizationMode::Linear);
    check(&mut small, None, [("display codes".into(), style)]);
}

/// HDR storage, with a sky above 1 that desaturation brings below.
#[test]
fn an_hdr_camera_matches_the_reference() {
    let mut small = Small::new(UVec2::new(64, 48), Msaa::Off);
    small.insert(Hdr);
    fill(&mut small, Color::linear_rgb(1.5, 0.2, 0.1));
    let form = Equations::Faithful;
    let faithful = everything(
        form,
        ColorizationMode::SquareRoot,
        form,
        DepthMapping::MinMax,
    );
    let styles = [
        ("corrected".into(), corrected(ColorizationMode::Linear)),
        ("faithful".into(), faithful),
    ];
    check(&mut small, None, styles);
}

/// With fixed borders, over a background that shows through; those that are found are tested in
/// `depth_layers.rs`.
#[test]
fn layers_match_the_reference() {
    let mut small = Small::new(UVec2::new(72, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        small.camera_settings().clear_color = Color::srgba(0.1, 0.2, 0.3, 0.4).into();
        let styles = [(0, false), (3, false), (0, true)].map(|(bands, flip)| {
            let layers = DepthLayers {
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
            let what = format!("{msaa:?}, {bands} bands, flip: {flip}");
            (what, with_map(ComicStyle::new().with(layers), map))
        });
        check(&mut small, None, styles);
    }
}
