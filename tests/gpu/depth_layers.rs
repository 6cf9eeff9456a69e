//! Near, middle and far in whole views.

use bevy_comics_testkit::{reference::color, work::along_cracks};

use crate::prelude::*;

/// What the debug view shows of near, middle and far, in codes.
const SHOWN: [[u8; 3]; 3] = [[203, 69, 39], [231, 203, 89], [48, 108, 188]];

/// The tangent of half the field of view.
const TAN: f32 = 0.414_213_57;

/// Three cards one above the other, at these distances, before the sky.
fn cards(small: &mut Small, distances: [f32; 3]) {
    small.clear();
    small.insert(Transform::IDENTITY);
    for (row, distance) in [1.0, 0.0, -1.0].into_iter().zip(distances) {
        let card = Rectangle::new(0.5 * distance, 0.25 * distance);
        let at = Transform::from_xyz(0.0, row * 0.27 * distance, -distance);
        small.put(card, unlit(Color::WHITE), at);
    }
}

/// The rows of pixels through the middles of the cards.
fn rows(picture: &image::RgbaImage) -> [u32; 3] {
    let height = picture.height() as f32;
    [1.0, 0.0, -1.0].map(|row: f32| (height * (0.5 - row * 0.27 / (2.0 * TAN))) as u32)
}

fn code(picture: &image::RgbaImage, x: u32, y: u32) -> [u8; 3] {
    let [r, g, b, _] = picture.get_pixel(x, y).0;
    [r, g, b]
}

fn is_close(a: &[u8; 3], b: &[u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1)
}

/// The codes at the middles of the cards, and in a corner.
fn seen(small: &mut Small) -> [[u8; 3]; 4] {
    let picture = small.settle().picture();
    let [near, middle, far] = rows(&picture).map(|y| code(&picture, picture.width() / 2, y));
    [near, middle, far, code(&picture, 2, 2)]
}

fn assert_three_layers(found: [[u8; 3]; 4], what: &str) {
    let wanted = [SHOWN[0], SHOWN[1], SHOWN[2], SHOWN[2]];
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!(is_close(found, wanted), "{what}: {found:?} for {wanted:?}");
    }
}

/// Whatever their distances are, and however depth is mapped.
#[test]
fn three_groups_of_distances_are_three_layers() {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        small.insert(DebugView::Effect("depth_layers"));
        for distances in [[2.0, 3.0, 5.0], [2.0, 20.0, 24.0], [20.0, 30.0, 900.0]] {
            cards(&mut small, distances);
            for mapping in [
                DepthMapping::MinMax,
                DepthMapping::MinMaxLogarithmic,
                DepthMapping::Fixed {
                    from: 1.0,
                    to: 1000.0,
                },
            ] {
                // Bands of the linear map are narrow where it is steep.
                let layers = DepthLayers {
                    softness: 0.0,
                    ..default()
                };
                let map = DepthMap {
                    mapping,
                    smoothing: None,
                    ..default()
                };
                small.style(&with_map(ComicStyle::new().with(layers), map));
                small.cut();
                let what = format!("{msaa:?}, {distances:?}, {mapping:?}");
                assert_three_layers(seen(&mut small), &what);
            }
        }
    }
}

#[test]
fn an_orthographic_view_has_three_layers() {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    cards(&mut small, [2.0, 2.0, 2.0]);
    small.insert((
        DebugView::Effect("depth_layers"),
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 2.0 * 2.0 * TAN,
            },
            near: 0.0,
            far: 1000.0,
            ..OrthographicProjection::default_3d()
        }),
    ));
    let world = small.world();
    let mut cards = world.query_filtered::<&mut Transform, With<Mesh3d>>();
    for (mut card, z) in cards.iter_mut(world).zip([-10.0, -14.0, -40.0]) {
        card.translation.z = z;
    }
    let layers = DepthLayers {
        softness: 0.0,
        ..default()
    };
    small.style(&ComicStyle::new().with(layers));
    assert_three_layers(seen(&mut small), "orthographic");
}

/// What the debug view shows of cards with the fixed borders, or borders that are found.
fn seen_with_borders(
    distances: [f32; 3],
    borders: LayerBorders,
    [foreground_end, background_start]: [f32; 2],
) -> [[u8; 3]; 4] {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    small.insert(DebugView::Effect("depth_layers"));
    cards(&mut small, distances);
    let layers = DepthLayers {
        borders,
        softness: 0.0,
        foreground_end,
        background_start,
        ..default()
    };
    small.style(&with_map(ComicStyle::new().with(layers), hundred()));
    seen(&mut small)
}

/// Fixed borders are where they say, and the near end is never behind the start of the far
/// layer.
#[test]
fn fixed_borders_are_in_the_depth_map() {
    // The cards are at 0.09, 0.29 and 0.89.
    let seen_with = |ends| seen_with_borders([10.0, 30.0, 90.0], LayerBorders::Fixed, ends);
    assert_three_layers(seen_with([0.2, 0.5]), "between the cards");
    let found = seen_with([0.95, 0.5]);
    assert!(
        found[..3].iter().all(|c| *c == found[0]),
        "{found:?} are all near"
    );
    let found = seen_with([0.05, 0.06]);
    assert!(
        found[..3].iter().all(|c| *c == found[3]),
        "{found:?} are all far"
    );
}

/// A flat wall cannot be divided: the fixed borders apply.
#[test]
fn a_view_of_one_depth_has_the_fixed_borders() {
    let borders = DepthLayers::default().borders;
    let found = seen_with_borders([10.0; 3], borders, [0.05, 0.5]);
    let is_middle = |card: &[u8; 3]| is_close(card, &SHOWN[1]);
    assert!(found[..3].iter().all(is_middle), "{found:?}");
}

/// The game and the panel read where the borders are.
#[test]
fn the_borders_are_read_back() {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    cards(&mut small, [2.0, 10.0, 60.0]);
    small.insert(DepthHistogram::default());
    small.style(&ComicStyle::new().with(DepthLayers::default()));
    small.settle().settle();
    let read = |small: &mut Small| {
        let camera = small.camera;
        let found = small.world().get::<DepthHistogram>(camera);
        found.expect("inserted").borders
    };
    let (near, far) = read(&mut small).expect("found");
    assert!(
        (2.0..10.0).contains(&near) && (10.0..60.0).contains(&far),
        "{near}, {far}"
    );
    let fixed = DepthLayers {
        borders: LayerBorders::Fixed,
        ..default()
    };
    small.style(&ComicStyle::new().with(fixed));
    small.settle().settle();
    assert_eq!(read(&mut small), None);
}

/// Depth from 1 to 101 units.
fn hundred() -> DepthMap {
    DepthMap {
        mapping: DepthMapping::Fixed {
            from: 1.0,
            to: 101.0,
        },
        ..default()
    }
}

/// A border at D = 0.25, 26 units away.
fn at_a_quarter(by: Granularity) -> ComicStyle {
    let layers = DepthLayers {
        granularity: by,
        borders: LayerBorders::Fixed,
        foreground_end: 0.25,
        background_start: 0.9,
        softness: 0.0,
        ..default()
    };
    with_map(ComicStyle::new().with(layers), hundred())
}

/// The layers that the pixels before the sky are in: near, middle.
fn layers_before_the_sky(small: &mut Small) -> [bool; 2] {
    let picture = small.picture();
    let mut has = [false; 3];
    for (x, y, _) in picture.enumerate_pixels() {
        let found = code(&picture, x, y);
        let layer = (0..3).find(|k| is_close(&found, &SHOWN[*k]));
        has[layer.unwrap_or_else(|| panic!("{found:?} at ({x}, {y}) is between layers"))] = true;
    }
    [has[0], has[1]]
}

/// A long box below the eye, whose middle is this far away, seen with its top.
fn long_box(small: &mut Small, distance: f32) -> Entity {
    small.clear();
    small.insert((Transform::IDENTITY, DebugView::Effect("depth_layers")));
    let at = Transform::from_xyz(0.0, -4.0, -distance);
    small.put(Cuboid::new(4.0, 2.0, 8.0), StandardMaterial::default(), at)
}

#[test]
fn a_figure_is_in_one_layer_and_the_ground_in_all() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    long_box(&mut small, 26.5);
    small.style(&at_a_quarter(Granularity::Pixel)).settle();
    assert_eq!(layers_before_the_sky(&mut small), [true, true], "pixels");
    small.style(&at_a_quarter(Granularity::Object)).settle();
    assert_eq!(
        layers_before_the_sky(&mut small),
        [false, true],
        "an object"
    );
    small.clear();
    let ground = Cuboid::new(40.0, 1.0, 90.0);
    let at = Transform::from_xyz(0.0, -4.0, -50.0);
    small.put(ground, StandardMaterial::default(), at);
    let by_object = small.settle().picture();
    small.style(&at_a_quarter(Granularity::Pixel)).settle();
    assert_eq!(
        layers_before_the_sky(&mut small),
        [true, true],
        "the ground"
    );
    assert_eq!(by_object, small.picture());
}

/// D of its center changes by up to 0.02 from frame to frame, at the border.
#[test]
fn an_object_that_jitters_at_a_border_stays_in_its_layer() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let figure = long_box(&mut small, 26.3);
    small.style(&at_a_quarter(Granularity::Object)).settle();
    let first = layers_before_the_sky(&mut small);
    assert_ne!(first[0], first[1], "one layer");
    let place = |small: &mut Small, distance: f32| {
        let world = small.world();
        let mut at = world.get_mut::<Transform>(figure).expect("there");
        at.translation.z = -distance;
        small.headless.step(2);
    };
    for step in [2.0, -2.0, 1.0, -1.5, 2.0, -2.0] {
        place(&mut small, 26.3 + step);
        assert_eq!(layers_before_the_sky(&mut small), first, "moved by {step}");
    }
    // Farther away than the hysteresis, it is where it belongs.
    for (distance, wanted) in [(32.0, [false, true]), (20.0, [true, false])] {
        place(&mut small, distance);
        assert_eq!(layers_before_the_sky(&mut small), wanted, "at {distance}");
    }
}

/// The place of a box is that of its center, also of an orthographic view, of one with samples,
/// and far from the origin.
#[test]
fn objects_have_layers_in_other_views_too() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for (msaa, origin) in [(Msaa::Sample4, 0.0), (Msaa::Off, 1e4)] {
        small.restart(msaa);
        let figure = long_box(&mut small, 26.5);
        small.insert(Transform::from_xyz(origin, 0.0, origin));
        let mut at = small.world().get_mut::<Transform>(figure).expect("there");
        at.translation += Vec3::new(origin, 0.0, origin);
        let picture = small.shot(&at_a_quarter(Granularity::Object));
        let places = picture.enumerate_pixels();
        let found: Vec<_> = places.map(|(x, y, _)| code(&picture, x, y)).collect();
        let count = |k: usize| {
            found
                .iter()
                .filter(|code| is_close(code, &SHOWN[k]))
                .count()
        };
        let [near, middle] = [count(0), count(1)];
        assert!(
            middle > 50 && near == 0,
            "{msaa:?}, {origin}: {near}, {middle}"
        );
    }
}

/// The picture of white cards with black lines.
fn lined(small: &mut Small, layers: DepthLayers, flip: bool) -> image::RgbaImage {
    let outlines = Outlines {
        width: 4.0,
        creases: None,
        objects: None,
        ..along_cracks()
    };
    let style = ComicStyle::new().with(outlines).with(layers);
    let map = DepthMap { flip, ..hundred() };
    small.shot(&with_map(style, map))
}

/// The width of the lines across the left edges of the cards.
fn line_widths(picture: &image::RgbaImage) -> [f64; 3] {
    let ink = |x, y| 1.0 - color::srgb_decode_one(f64::from(picture.get_pixel(x, y).0[1]) / 255.0);
    rows(picture).map(|y| (0..picture.width() / 2).map(|x| ink(x, y)).sum())
}

/// How many pixels across the left edges of the cards have the colors wanted.
fn colored(picture: &image::RgbaImage, wanted: [[u8; 3]; 3]) -> [usize; 3] {
    let rows = rows(picture);
    std::array::from_fn(|k| {
        let codes = (0..picture.width() / 2).map(|x| code(picture, x, rows[k]));
        codes.filter(|code| is_close(code, &wanted[k])).count()
    })
}

/// What is in a layer, and how the layers are divided.
type Division = (Granularity, LayerBorders);

/// With [`CROSSED`], every two of the sample count, the unit and the borders together.
const PAIRED: [Division; 2] = [
    (Granularity::Object, LayerBorders::Auto),
    (Granularity::Pixel, LayerBorders::Fixed),
];

const CROSSED: [Division; 2] = [
    (Granularity::Object, LayerBorders::Fixed),
    (Granularity::Pixel, LayerBorders::Auto),
];

#[test]
fn lines_have_the_width_opacity_and_color_of_their_layer() {
    assert_lines_of_layers(Msaa::Off, &PAIRED);
    assert_lines_of_layers(Msaa::Sample4, &CROSSED);
}

#[test]
#[ignore = "long: every division of layers at every sample count"]
fn lines_have_the_width_opacity_and_color_of_every_kind_of_layer() {
    assert_lines_of_layers(Msaa::Off, &CROSSED);
    assert_lines_of_layers(Msaa::Sample4, &PAIRED);
}

fn assert_lines_of_layers(msaa: Msaa, divisions: &[Division]) {
    let mut small = Small::new(UVec2::new(64, 64), msaa);
    small.camera_settings().clear_color = Color::WHITE.into();
    cards(&mut small, [10.0, 30.0, 90.0]);
    let even = line_widths(&lined(&mut small, DepthLayers::PLAIN, false));
    assert!(
        even.iter().all(|width| (width - 4.0).abs() < 0.05),
        "{msaa:?}: {even:?} of even lines"
    );
    let mut weighted = DepthLayers {
        foreground_end: 0.2,
        background_start: 0.5,
        ..DepthLayers::PLAIN
    };
    let mut tinted = weighted;
    weighted.middle.line_width = 0.5;
    weighted.background.line_opacity = 0.25;
    tinted.foreground.line_color = Color::srgb(1.0, 0.0, 0.0);
    tinted.foreground.line_color_amount = 1.0;
    // Half of black lines: 0.5 in linear light.
    tinted.background.line_color = Color::srgb(0.0, 0.0, 1.0);
    tinted.background.line_color_amount = 0.5;
    let half = (255.0 * color::srgb_encode([0.5; 3])[0]).round() as u8;
    // The card in the middle is at 0.29, at 0.7 of a soft border: smoothstep of it is in its layer.
    let soft = DepthLayers {
        borders: LayerBorders::Fixed,
        foreground_end: 0.25,
        softness: 0.2,
        ..weighted
    };
    let (own, other) = (0.784, 0.216);
    let [width, opacity] = [0.5 * own + other, own + 0.25 * other];
    for (flip, want) in [(false, 4.0 * width), (true, 4.0 * width * opacity)] {
        let [_, found, _] = line_widths(&lined(&mut small, soft, flip));
        assert!(
            (found - want).abs() < 0.06,
            "{msaa:?}, {flip}: {found}, not {want}"
        );
    }
    for (&(granularity, borders), flip) in divisions.iter().flat_map(|d| [(d, false), (d, true)]) {
        let what = format!("{msaa:?}, {granularity:?}, {borders:?}, {flip}");
        let divided = |layers: DepthLayers| DepthLayers {
            granularity,
            borders,
            ..layers
        };
        let mut widths = [4.0, 2.0, 1.0];
        let mut colors = [[255, 0, 0], [0, 0, 0], [0, 0, half]];
        if flip {
            widths.reverse();
            colors.reverse();
        }
        let found = line_widths(&lined(&mut small, divided(weighted), flip));
        // Opacity is stored in eight bits, in draws of a byte of ink.
        let is_right = |k: usize| (found[k] - widths[k]).abs() < 0.06;
        assert!((0..3).all(is_right), "{what}: {found:?}, not {widths:?}");
        // A line has the color of the layer of the card in front, on both sides of its edge:
        // 4 pixels cover at least 3 of a row.
        let counts = colored(&lined(&mut small, divided(tinted), flip), colors);
        assert!(counts.iter().all(|n| *n >= 3), "{what}: {counts:?}");
    }
}

/// A layer without hatching and dots looks as if the effects were not there; one with all of them
/// has them.
#[test]
fn hatching_and_dots_are_as_strong_as_in_their_layer() {
    let hatching = Hatching {
        anchor: HatchingAnchor::Page,
        ground: HatchingGround::Paper,
        bare_above: 1.0,
        ..default()
    };
    let halftone = Halftone {
        mode: HalftoneMode::Spot,
        sampling: ScreenSampling::Pixel,
        ..default()
    };
    let printed = [
        ComicStyle::new().with(hatching),
        ComicStyle::new().with(halftone),
    ];
    let mut small = Small::new(UVec2::new(128, 128), Msaa::Off);
    for style in printed {
        cards(&mut small, [10.0, 30.0, 90.0]);
        let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
        for (_, material) in materials.iter_mut() {
            material.base_color = Color::srgb(0.5, 0.5, 0.5);
        }
        let mut layers = DepthLayers {
            borders: LayerBorders::Fixed,
            foreground_end: 0.2,
            background_start: 0.5,
            ..DepthLayers::PLAIN
        };
        layers.background.hatching = 0.0;
        layers.background.halftone = 0.0;
        let picture = small.shot(&with_map(style.with(layers), hundred()));
        // The spread of codes in a square in the middle of each card.
        let spread = rows(&picture).map(|y| {
            let codes = (0..400).map(|k| picture.get_pixel(54 + k % 20, y - 10 + k / 20).0[1]);
            let (low, high) = codes.fold((255, 0), |(low, high), c| (c.min(low), c.max(high)));
            high - low
        });
        assert!(
            spread[0] > 100 && spread[1] > 100 && spread[2] <= 1,
            "{spread:?}"
        );
    }
}
