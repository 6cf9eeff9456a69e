//! Screens that follow objects.

use bevy_comics_testkit::{
    reference::{
        halftone::{Plate, followed_cover},
        similarity::{Similarity, similarity_of},
    },
    screens::ideal,
};

use crate::prelude::*;

const SIZE: UVec2 = UVec2::new(120, 90);

/// One ink, of which a dot of a tone has exactly its area.
fn spot() -> Halftone {
    Halftone {
        mode: HalftoneMode::Spot,
        shape: ScreenShape::Round,
        cell_size: 7.0,
        ..ideal()
    }
}

fn printed(small: &mut Small, anchor: ScreenAnchor) -> image::RgbaImage {
    small.shot(&ComicStyle::new().with(Halftone { anchor, ..spot() }))
}

/// A gray board of 80 by 60 pixels in front of a view in which a unit is a pixel.
fn board() -> (Small, Entity) {
    let mut small = Small::with(options(SIZE), Msaa::Off);
    small.clear();
    small.insert((
        Projection::Orthographic(OrthographicProjection {
            scaling_mode: ScalingMode::WindowSize,
            ..OrthographicProjection::default_3d()
        }),
        Transform::from_xyz(0.0, 0.0, 50.0),
    ));
    let gray = unlit(Color::linear_rgb(0.6, 0.6, 0.6));
    let board = small.put(Rectangle::new(80.0, 60.0), gray, Transform::IDENTITY);
    (small, board)
}

/// The similarity of an object in the view of the board.
fn followed(at: Transform) -> Similarity {
    let (width, height) = (f64::from(SIZE.x), f64::from(SIZE.y));
    let to_clip = DMat4::from_scale(DVec3::new(2.0 / width, 2.0 / height, 0.001));
    let size = f64::from(at.scale.x);
    let rotation = DQuat::from_array(at.rotation.to_array().map(f64::from));
    let center = at.translation.as_dvec3();
    similarity_of(to_clip, [0.0, 0.0, width, height], center, size, rotation).expect("in front")
}

/// Pixels that the board covers wherever it is in these tests, more than a cell from its edge.
fn inner() -> impl Iterator<Item = (u32, u32)> {
    (36..58).flat_map(|y| (44..76).map(move |x| (x, y)))
}

/// At every place, turn and size, by whole and fractional pixels: each dot is where it is on the
/// object. A code of the display is up to 0.009 in light.
#[test]
fn dots_lie_on_their_object() {
    let (mut small, board) = board();
    let plain = small.shot(&ComicStyle::new());
    let tone = 1.0 - linear(&plain, 60, 45)[0];
    let turned = Quat::from_rotation_z(0.4);
    for at in [
        Transform::IDENTITY,
        Transform::from_xyz(5.0, -3.0, 0.0),
        Transform::from_xyz(0.25, 0.5, 0.0),
        Transform::from_xyz(-3.5, 2.125, 4.0).with_rotation(turned),
        Transform::from_xyz(1.0, 0.0, 0.0).with_scale(Vec3::splat(1.3)),
        Transform::from_xyz(0.0, 2.75, 0.0).with_scale(Vec3::splat(0.97)),
        // Between two octaves.
        Transform::from_scale(Vec3::splat(1.41)),
        Transform::from_rotation(Quat::from_rotation_y(0.6) * turned),
    ] {
        let anchor = PatternAnchor::default();
        small.world().entity_mut(board).insert((anchor, at));
        let plate = Plate::all(&spot(), 1.0)[3];
        let cover = followed_cover(spot().shape, plate, &followed(at), tone, &|_, _| 0.5);
        for sampling in [ScreenSampling::Pixel, ScreenSampling::Cell] {
            let s = Halftone {
                sampling,
                anchor: ScreenAnchor::Object,
                ..spot()
            };
            let picture = small.shot(&ComicStyle::new().with(s));
            assert!(small.ran(ComicsStage::of::<Halftone>()));
            let mut inked = 0;
            for (x, y) in inner() {
                let want = 1.0 - cover([f64::from(x) + 0.5, f64::from(y) + 0.5]);
                let found = linear(&picture, x, y)[0];
                let what = format!("{at:?}, {sampling:?}, ({x}, {y})");
                assert!((found - want).abs() < 0.012, "{what}: {found}, {want}");
                inked += usize::from(want < 0.1);
            }
            assert!(inked > 50, "{inked} of 704 pixels are all ink");
        }
    }
}

/// A board that moves by whole pixels has the same picture there, to a code of rounding; with
/// screens on the page it has not.
#[test]
fn a_moved_object_carries_its_dots() {
    let (mut small, board) = board();
    let mut differences = |anchor| {
        let [before, after] = [[0.375, 0.5], [3.375, -1.5]].map(|[x, y]| {
            let at = (PatternAnchor::default(), Transform::from_xyz(x, y, 0.0));
            small.world().entity_mut(board).insert(at);
            printed(&mut small, anchor)
        });
        let is_apart = |(x, y)| {
            let (from, to) = (before.get_pixel(x, y), after.get_pixel(x + 3, y + 2));
            from.0[0].abs_diff(to.0[0]) > 1
        };
        inner().filter(|at| is_apart(*at)).count()
    };
    assert_eq!(differences(ScreenAnchor::Object), 0);
    assert!(differences(ScreenAnchor::View) > 100);
}

/// Without a `PatternAnchor`, dots are those of the page. With one that is inherited, a figure of
/// two meshes has one screen.
#[test]
fn only_anchored_objects_carry_dots() {
    let (mut small, board) = board();
    let at = Transform::from_xyz(2.5, 1.25, 0.0);
    small.world().entity_mut(board).insert(at);
    let page = printed(&mut small, ScreenAnchor::View);
    assert_eq!(printed(&mut small, ScreenAnchor::Object), page);
    let world = small.world();
    let figure = (at, Visibility::default(), PatternAnchor::default());
    let part = (ChildOf(world.spawn(figure).id()), Transform::IDENTITY);
    world.entity_mut(board).insert(part);
    let whole = printed(&mut small, ScreenAnchor::Object);
    assert_ne!(whole, page);
    // The figure stays, its mesh moves within it: the dots stay.
    let moved = Transform::from_xyz(2.0, -3.0, 0.0);
    small.world().entity_mut(board).insert(moved);
    let moved = printed(&mut small, ScreenAnchor::Object);
    assert!(inner().all(|(x, y)| whole.get_pixel(x, y) == moved.get_pixel(x, y)));
}

/// Coverages by a screen with cells of 8 pixels on an object of an apparent size.
fn cover_of_size(shape: ScreenShape, size: f64, tone: f64) -> impl Fn([f64; 2]) -> f64 {
    let s = Halftone {
        cell_size: 8.0,
        ..default()
    };
    let (at, viewport) = (DMat4::IDENTITY, [0.0, 0.0, 2.0, 2.0]);
    let follows = similarity_of(at, viewport, DVec3::ZERO, size, DQuat::IDENTITY);
    let follows = follows.expect("in front");
    followed_cover(shape, Plate::all(&s, 1.0)[0], &follows, tone, &|_, _| 0.5)
}

/// The mean of a flat tone stays at every size, also where two octaves are mixed: as exact as on
/// the page (`halftone::flat_fields_have_their_tone`) for cells of 5.6 pixels and more. Weighted by
/// a window, since cells end anywhere.
#[test]
fn every_size_has_the_tone() {
    assert_tones_of_sizes(&[0.72, 1.0, 1.36], &[0.2, 0.85]);
}

#[test]
#[ignore = "long: more sizes and tones"]
fn every_size_has_every_tone() {
    assert_tones_of_sizes(&[0.72, 0.9, 1.0, 1.31, 1.36, 1.41], &[0.2, 0.5, 0.85]);
}

fn assert_tones_of_sizes(sizes: &[f64], tones: &[f64]) {
    const SIDE: i32 = 160;
    let window = |v: i32| 1.0 - (std::f64::consts::TAU * f64::from(v) / f64::from(SIDE)).cos();
    let without_grains = SHAPES
        .into_iter()
        .filter(|shape| *shape != ScreenShape::Stochastic);
    for shape in without_grains {
        for &size in sizes {
            for &tone in tones {
                let cover = cover_of_size(shape, size, tone);
                let (mut sum, mut weights) = (0.0, 0.0);
                for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
                    let weight = window(x) * window(y);
                    sum += weight * cover([f64::from(x) + 0.3, f64::from(y) + 0.6]);
                    weights += weight;
                }
                let off = (sum / weights - tone).abs();
                assert!(off < 0.01, "{shape:?}, {size}, {tone}: {off}");
            }
        }
    }
}

/// An object that comes nearer by 1/512 of an octave a frame, over two octaves: its dots grow, and
/// nothing jumps. At 40 pixels from the center, a dot moves by 0.054 pixels, and an edge is one
/// pixel wide; what fades changes by 1/120 a frame.
#[test]
fn octaves_follow_each_other_without_a_jump() {
    for shape in [ScreenShape::Round, ScreenShape::Line] {
        let mut before: Option<[f64; 60]> = None;
        for frame in 0..=1024 {
            let size = (f64::from(frame) / 512.0 - 1.0).exp2();
            let cover = cover_of_size(shape, size, 0.3);
            let found = std::array::from_fn(|i| {
                let (y, x) = (i as f64 * 2.4).sin_cos();
                cover([1.0 + 40.0 * x, 1.0 + 40.0 * y])
            });
            for (found, before) in found.iter().zip(before.iter().flatten()) {
                assert!((found - before).abs() < 0.1, "{shape:?}, frame {frame}");
            }
            before = Some(found);
        }
    }
}
