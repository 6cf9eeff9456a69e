//! Near, middle and far in whole views.

use bevy_comics_testkit::{reference::color, work::along_cracks};

use crate::prelude::*;

/// What the debug view shows of near, middle and far, in codes.
const SHOWN: [[u8; 3]; 3] = [[203, 69, 39], [231, 203, 89], [48, 108, 188]];

/// Three cards one above the other, at these distances, before the sky.
fn cards(small: &mut Small, distances: [f32; 3]) {
    small.clear();
    small.insert(Transform::IDENTITY);
    for (row, distance) in [1.0, 0.0, -1.0].into_iter().zip(distances) {
        let height = 0.25 * distance;
        let at = Transform::from_xyz(0.0, row * 0.27 * distance, -distance);
        let material = StandardMaterial {
            unlit: true,
            ..default()
        };
        small.put(Rectangle::new(0.5 * distance, height), material, at);
    }
}

/// The codes at the middles of the cards, and in a corner.
fn seen(small: &mut Small) -> [[u8; 3]; 4] {
    let picture = small.settle().picture();
    let [x, h] = [picture.width() / 2, picture.height()];
    let at = |x: u32, y: u32| {
        let [r, g, b, _] = picture.get_pixel(x, y).0;
        [r, g, b]
    };
    let row = |row: f32| (h as f32 * (0.5 - row * 0.27 / (2.0 * 0.414_213_57))) as u32;
    [at(x, row(1.0)), at(x, row(0.0)), at(x, row(-1.0)), at(2, 2)]
}

fn assert_three_layers(found: [[u8; 3]; 4], what: &str) {
    let wanted = [SHOWN[0], SHOWN[1], SHOWN[2], SHOWN[2]];
    for (found, wanted) in found.iter().zip(wanted) {
        let apart = found.iter().zip(wanted).map(|(a, b)| a.abs_diff(b));
        assert!(apart.max() <= Some(1), "{what}: {found:?} for {wanted:?}");
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
                let entity = small.camera;
                small.world().trigger(CameraCut { entity });
                let what = format!("{msaa:?}, {distances:?}, {mapping:?}");
                assert_three_layers(seen(&mut small), &what);
            }
        }
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn an_orthographic_view_has_three_layers() {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    cards(&mut small, [2.0, 2.0, 2.0]);
    small.insert((
        DebugView::Effect("depth_layers"),
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 2.0 * 2.0 * 0.414_213_57,
            },
            near: 0.0,
            far: 1000.0,
            ..OrthographicProjection::default_3d()
        }),
    ));
    let world = small.world();
    let mut cards = world.query_filtered::<&mut Transform, With<Mesh3d>>();
    let mut z = [-10.0, -14.0, -40.0].into_iter();
    for mut card in cards.iter_mut(world) {
        card.translation.z = z.next().expect("three cards");
    }
    let layers = DepthLayers {
        softness: 0.0,
        ..default()
    };
    small.style(&ComicStyle::new().with(layers));
    assert_three_layers(seen(&mut small), "orthographic");
}

/// Fixed borders are where they say, and the near end is never behind the start of the far
/// layer.
#[test]
fn fixed_borders_are_in_the_depth_map() {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    small.insert(DebugView::Effect("depth_layers"));
    cards(&mut small, [10.0, 30.0, 90.0]);
    let layers = |near_end, far_start| DepthLayers {
        borders: LayerBorders::Fixed,
        softness: 0.0,
        foreground_end: near_end,
        background_start: far_start,
        ..default()
    };
    let map = DepthMap {
        mapping: DepthMapping::Fixed {
            from: 1.0,
            to: 101.0,
        },
        ..default()
    };
    let mut seen_with = |near_end, far_start| {
        small.style(&with_map(
            ComicStyle::new().with(layers(near_end, far_start)),
            map,
        ));
        seen(&mut small)
    };
    // The cards are at 0.09, 0.29 and 0.89.
    assert_three_layers(seen_with(0.2, 0.5), "between the cards");
    let found = seen_with(0.95, 0.5);
    assert!(
        found[..3].iter().all(|c| *c == found[0]),
        "{found:?} are all near"
    );
    let found = seen_with(0.05, 0.06);
    assert!(
        found[..3].iter().all(|c| *c == found[3]),
        "{found:?} are all far"
    );
}

/// A flat wall cannot be divided: the fixed borders apply.
#[test]
fn a_view_of_one_depth_has_the_fixed_borders() {
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    small.insert(DebugView::Effect("depth_layers"));
    cards(&mut small, [10.0, 10.0, 10.0]);
    let map = DepthMap {
        mapping: DepthMapping::Fixed {
            from: 1.0,
            to: 101.0,
        },
        ..default()
    };
    let layers = DepthLayers {
        foreground_end: 0.05,
        background_start: 0.5,
        softness: 0.0,
        ..default()
    };
    small.style(&with_map(ComicStyle::new().with(layers), map));
    let found = seen(&mut small);
    for card in &found[..3] {
        let apart = card.iter().zip(SHOWN[1]).map(|(a, b)| a.abs_diff(b));
        assert!(apart.max() <= Some(1), "{found:?}");
    }
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
    let is = |p: &image::Rgba<u8>, k: usize| {
        let apart = p.0.iter().zip(SHOWN[k]).map(|(a, b)| a.abs_diff(b));
        apart.max() <= Some(1)
    };
    let has = |k| picture.pixels().any(|p| is(p, k));
    // Near 0, middle 1, far a blank.
    let rows = picture.rows().map(|row| {
        let letter = |p| match (0..3).find(|k| is(p, *k)) {
            Some(2) => ' ',
            Some(0) => '0',
            Some(1) => '1',
            _ => '?',
        };
        row.map(letter).collect::<String>() + "\n"
    });
    let drawn: String = rows.filter(|row| !row.trim().is_empty()).collect();
    println!("{drawn}");
    assert!(!drawn.contains('?'), "a pixel is between layers");
    [has(0), has(1)]
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
    small.style(&at_a_quarter(Granularity::Pixel));
    small.settle();
    assert_eq!(layers_before_the_sky(&mut small), [true, true], "pixels");
    small.style(&at_a_quarter(Granularity::Object));
    small.settle();
    assert_eq!(
        layers_before_the_sky(&mut small),
        [false, true],
        "an object"
    );
    small.clear();
    let ground = Cuboid::new(40.0, 1.0, 90.0);
    let at = Transform::from_xyz(0.0, -4.0, -50.0);
    small.put(ground, StandardMaterial::default(), at);
    small.settle();
    let by_object = small.picture();
    small.style(&at_a_quarter(Granularity::Pixel));
    small.settle();
    assert_eq!(
        layers_before_the_sky(&mut small),
        [true, true],
        "the ground"
    );
    assert_eq!(by_object, small.picture());
}

/// D of its centre changes by up to 0.02 from frame to frame, at the border.
#[test]
fn an_object_that_jitters_at_a_border_stays_in_its_layer() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let figure = long_box(&mut small, 26.3);
    small.style(&at_a_quarter(Granularity::Object));
    small.settle();
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

/// The place of a box is that of its centre, also of an orthographic view, of one with samples,
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
        small.style(&at_a_quarter(Granularity::Object));
        small.settle();
        let picture = small.picture();
        let close = |p: &&image::Rgba<u8>, k: usize| {
            p.0.iter().zip(SHOWN[k]).all(|(a, b)| a.abs_diff(b) <= 1)
        };
        let count = |k| picture.pixels().filter(|p| close(p, k)).count();
        assert!(
            count(1) > 50 && count(0) == 0,
            "{msaa:?}, {origin}: {}, {}",
            count(0),
            count(1)
        );
    }
}

/// Size of the pictures with lines.
const LINED: UVec2 = UVec2::new(64, 64);

/// Lines on white cards, black: near, in the middle, far.
fn line_widths(small: &mut Small, layers: DepthLayers, map: DepthMap) -> [f64; 3] {
    let outlines = Outlines {
        width: 4.0,
        creases: None,
        objects: None,
        ..along_cracks()
    };
    small.style(&with_map(
        ComicStyle::new().with(outlines).with(layers),
        map,
    ));
    small.settle();
    let picture = small.picture();
    let half = picture.width() / 2;
    [1.0, 0.0, -1.0].map(|row: f32| {
        let y = picture.height() as f32 * (0.5 - row * 0.27 / (2.0 * 0.414_213_57));
        let ink = |x: u32| {
            let code = f64::from(picture.get_pixel(x, y as u32).0[1]) / 255.0;
            1.0 - color::srgb_decode_one(code)
        };
        // Across the left edge of the card.
        (0..half).map(ink).sum()
    })
}

/// What is in a layer, and how the layers are divided.
type Division = (Granularity, LayerBorders);

/// Every two of the sample count, the unit and the borders together.
const PAIRS: [(Msaa, &[Division]); 2] = [
    (
        Msaa::Off,
        &[
            (Granularity::Object, LayerBorders::Auto),
            (Granularity::Pixel, LayerBorders::Fixed),
        ],
    ),
    (
        Msaa::Sample4,
        &[
            (Granularity::Object, LayerBorders::Fixed),
            (Granularity::Pixel, LayerBorders::Auto),
        ],
    ),
];

/// All three together.
const ALL: [(Msaa, &[Division]); 2] = {
    const EVERY: [Division; 4] = [
        (Granularity::Object, LayerBorders::Auto),
        (Granularity::Object, LayerBorders::Fixed),
        (Granularity::Pixel, LayerBorders::Auto),
        (Granularity::Pixel, LayerBorders::Fixed),
    ];
    [(Msaa::Off, &EVERY), (Msaa::Sample4, &EVERY)]
};

#[test]
fn lines_have_the_width_and_opacity_of_their_layer() {
    assert_width_and_opacity(PAIRS);
}

#[test]
#[ignore = "long: every division of layers at every sample count"]
fn lines_have_the_width_and_opacity_of_every_kind_of_layer() {
    assert_width_and_opacity(ALL);
}

fn assert_width_and_opacity(cases: [(Msaa, &[Division]); 2]) {
    let mut small = Small::new(LINED, Msaa::Off);
    for (msaa, divisions) in cases {
        small.restart(msaa);
        small.insert(Camera {
            clear_color: Color::WHITE.into(),
            ..default()
        });
        cards(&mut small, [10.0, 30.0, 90.0]);
        let mut layers = DepthLayers::PLAIN;
        let even = line_widths(&mut small, layers, hundred());
        for width in even {
            assert!(
                (width - 4.0).abs() < 0.05,
                "{msaa:?}: {even:?} of even lines"
            );
        }
        layers.middle.line_width = 0.5;
        layers.background.line_opacity = 0.25;
        for &(by, borders) in divisions {
            let layers = DepthLayers {
                granularity: by,
                borders,
                foreground_end: 0.2,
                background_start: 0.5,
                ..layers
            };
            for flip in [false, true] {
                let map = DepthMap { flip, ..hundred() };
                let mut found = line_widths(&mut small, layers, map);
                if flip {
                    found.reverse();
                }
                let apart = [4.0, 2.0, 1.0].into_iter().zip(found);
                // Opacity is stored in eight bits, in draws of a byte of ink.
                let worst = apart.map(|(a, b)| f64::abs(a - b)).fold(0.0, f64::max);
                assert!(
                    worst < 0.06,
                    "{msaa:?}, {by:?}, {borders:?}, {flip}: {found:?}"
                );
            }
        }
        assert_eq!(small.errors(), 0);
    }
}

/// A line has the colour of the layer of the card in front, on both sides of its edge.
#[test]
fn lines_have_the_colour_of_their_layer() {
    assert_colour(PAIRS);
}

#[test]
#[ignore = "long: every division of layers at every sample count"]
fn lines_have_the_colour_of_every_kind_of_layer() {
    assert_colour(ALL);
}

fn assert_colour(cases: [(Msaa, &[Division]); 2]) {
    let mut small = Small::new(LINED, Msaa::Off);
    for (msaa, divisions) in cases {
        small.restart(msaa);
        small.insert(Camera {
            clear_color: Color::WHITE.into(),
            ..default()
        });
        cards(&mut small, [10.0, 30.0, 90.0]);
        let mut layers = DepthLayers {
            foreground_end: 0.2,
            background_start: 0.5,
            ..DepthLayers::PLAIN
        };
        layers.foreground.line_color = Color::srgb(1.0, 0.0, 0.0);
        layers.foreground.line_color_amount = 1.0;
        // Half of black lines: 0.5 in linear light.
        layers.background.line_color = Color::srgb(0.0, 0.0, 1.0);
        layers.background.line_color_amount = 0.5;
        let half = (255.0 * color::srgb_encode([0.5; 3])[0]).round() as u8;
        let wanted = [[255, 0, 0], [0, 0, 0], [0, 0, half]];
        for &(by, borders) in divisions {
            for flip in [false, true] {
                let mut wanted = wanted;
                if flip {
                    wanted.reverse();
                }
                let layers = DepthLayers {
                    granularity: by,
                    borders,
                    ..layers
                };
                let map = DepthMap { flip, ..hundred() };
                line_widths(&mut small, layers, map);
                let found = line_colors(&small.picture());
                for (found, wanted) in found.iter().zip(wanted) {
                    let is_close =
                        |code: &[u8; 3]| code.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 1);
                    // A line of 4 pixels covers at least 3 of a row.
                    let full = found.iter().filter(|code| is_close(code)).count();
                    assert!(
                        full >= 3,
                        "{msaa:?}, {by:?}, {borders:?}, {flip}: {found:?} for {wanted:?}"
                    );
                }
            }
        }
        assert_eq!(small.errors(), 0);
    }
}

/// The codes of the pixels across the left edge of every card that are not white.
fn line_colors(picture: &image::RgbaImage) -> [Vec<[u8; 3]>; 3] {
    [1.0, 0.0, -1.0].map(|row: f32| {
        let y = picture.height() as f32 * (0.5 - row * 0.27 / (2.0 * 0.414_213_57));
        let codes = (0..picture.width() / 2).map(|x| {
            let [r, g, b, _] = picture.get_pixel(x, y as u32).0;
            [r, g, b]
        });
        codes.filter(|code| *code != [255; 3]).collect()
    })
}

/// A layer without hatching and dots looks as if the effects were not there; one with all of them
/// has them.
#[test]
fn hatching_and_dots_are_as_strong_as_in_their_layer() {
    let hatching = Hatching {
        anchor: HatchingAnchor::Page,
        ground: HatchingGround::Paper,
        highlights: 1.0,
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
        small.style(&with_map(style.with(layers), hundred()));
        small.settle();
        let picture = small.picture();
        // The spread of codes in a square in the middle of each card.
        let spread = [1.0, 0.0, -1.0].map(|row: f32| {
            let y = (128.0 * (0.5 - row * 0.27 / (2.0 * 0.414_213_57))) as u32;
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
