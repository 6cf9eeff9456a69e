//! Views whose main pass has a lower resolution than the picture, as with upscalers: depth
//! and ids fill a corner of their textures.
//!
//! No upscaler runs here, so the picture shows the scene in its corner. The fraction of
//! light that the pass removes is where it belongs all the same.

use bevy::{
    camera::MainPassResolutionOverride,
    render::{Extract, ExtractSchedule, Render, RenderSystems, camera::ExtractedCamera},
};

use crate::{
    outlines::{look, put, removed},
    prelude::*,
    walls::{towards_the_sky, unit_per_pixel, wall},
};

/// The size of the main pass of a camera.
#[derive(Component, Clone, Copy)]
struct MainPass(UVec2);

/// Gives views the size of their main pass at the time when upscalers do.
pub struct OverrideMainPass;

impl Plugin for OverrideMainPass {
    fn build(&self, app: &mut App) {
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            render
                .add_systems(ExtractSchedule, extract)
                .add_systems(Render, override_views.in_set(RenderSystems::PrepareViews));
        }
    }
}

fn extract(
    mut commands: Commands,
    cameras: Extract<Query<(RenderEntity, Option<&MainPass>), With<Camera>>>,
) {
    for (view, main_pass) in &cameras {
        match main_pass {
            Some(size) => commands.entity(view).insert(*size),
            None => commands.entity(view).remove::<MainPass>(),
        };
    }
}

fn override_views(
    mut commands: Commands,
    views: Query<(Entity, Option<&MainPass>), With<ExtractedCamera>>,
) {
    for (view, main_pass) in &views {
        match main_pass {
            Some(size) => commands
                .entity(view)
                .insert(MainPassResolutionOverride(size.0)),
            None => commands.entity(view).remove::<MainPassResolutionOverride>(),
        };
    }
}

/// Sets the size of the main pass of the camera, as upscalers do.
pub fn override_main_pass(small: &mut Small, size: Option<UVec2>) {
    let mut camera = small.camera_mut();
    match size {
        Some(size) => camera.insert(MainPass(size)),
        None => camera.remove::<MainPass>(),
    };
}

const WIDTH: u32 = 240;
const HEIGHT: u32 = 180;

/// Pixels of the picture per pixel of the main pass.
const SCALES: [f32; 3] = [1.0, 1.5, 2.0];

fn main_pass(scale: f32) -> Option<UVec2> {
    let size = UVec2::new(WIDTH, HEIGHT).as_vec2() / scale;
    (scale > 1.0).then_some(size.as_uvec2())
}

fn new() -> Small {
    Small::new(UVec2::new(WIDTH, HEIGHT), Msaa::Off)
}

/// The ink of every pixel under a style.
fn ink(small: &mut Small, style: &ComicStyle) -> Vec<f32> {
    small.style(style).settle();
    removed(small)
}

fn of<E: Effect>(effect: E) -> ComicStyle {
    ComicStyle::new().with(effect)
}

/// A small box in front of a large one, before the sky: left, top, right, bottom in pixels, and the
/// distance.
const BOXES: [([f32; 4], f32); 2] = [
    ([50.3, 40.8, 190.7, 139.4], 60.0),
    ([90.6, 60.2, 140.9, 110.55], 5.0),
];

/// An orthographic view, one unit per pixel, of the boxes.
fn boxes() -> Small {
    let size = UVec2::new(WIDTH, HEIGHT);
    let mut small = towards_the_sky(size);
    small.insert(Projection::Orthographic(OrthographicProjection {
        far: 100.0,
        ..unit_per_pixel(size)
    }));
    let half = Vec2::new(WIDTH as f32, HEIGHT as f32) * 0.5;
    for ([left, top, right, bottom], distance) in BOXES {
        let low = [left - half.x, half.y - bottom];
        let high = [right - half.x, half.y - top];
        wall(&mut small, low, high, distance);
    }
    small
}

/// Distance in pixels from a position to the nearest side of a box; the larger of the
/// distances across and down if `square`.
fn distance(at: Vec2, square: bool) -> f32 {
    let sides = BOXES.iter().flat_map(|([left, top, right, bottom], _)| {
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
        let corners = corners.map(|[x, y]| Vec2::new(*x, *y));
        (0..4).map(move |i| (corners[i], corners[(i + 1) % 4]))
    });
    let away = sides.map(|(a, b)| {
        let away = (at - at.clamp(a.min(b), a.max(b))).abs();
        if square {
            away.max_element()
        } else {
            away.length()
        }
    });
    away.fold(f32::MAX, f32::min)
}

fn centers() -> impl Iterator<Item = (usize, Vec2)> {
    (0..WIDTH * HEIGHT).map(|i| {
        let at = UVec2::new(i % WIDTH, i / WIDTH).as_vec2() + 0.5;
        (i as usize, at)
    })
}

/// Ink lies along the sides of the boxes: `most` pixels away at most. Every place on a side
/// has ink at most `least` pixels away. A line of 1 px between two pixels has half of its
/// ink in each.
fn assert_along_sides(ink: &[f32], (most, least): (f32, f32), square: bool, what: &str) {
    for (i, at) in centers() {
        let away = distance(at, square);
        assert!(
            ink[i] < 0.02 || away <= most,
            "{what}: ink of {} at {at}, {away} px from a side",
            ink[i]
        );
    }
    for ([left, top, right, bottom], _) in BOXES {
        for k in 0..400 {
            let t = k as f32 / 400.0;
            let (x, y) = (left + t * (right - left), top + t * (bottom - top));
            for side in [[x, top], [x, bottom], [left, y], [right, y]] {
                let side = Vec2::from(side);
                let (low, high) = ((side - least).floor(), (side + least).ceil());
                let columns = low.x as u32..high.x as u32;
                let mut near = (low.y as u32..high.y as u32)
                    .flat_map(|y| columns.clone().map(move |x| UVec2::new(x, y)));
                let found = near.any(|at| {
                    let is_near = (at.as_vec2() + 0.5).distance(side) <= least;
                    is_near && ink[(at.y * WIDTH + at.x) as usize] > 0.4
                });
                assert!(found, "{what}: no ink within {least} px of {side}");
            }
        }
    }
}

/// The mean width of a line along all sides. Sides are drawn up to half a texel longer or
/// shorter at both ends, and lines overlap at eight corners.
fn assert_width(ink: &[f32], width: f32, scale: f32, what: &str) {
    let around = BOXES.map(|([l, t, r, b], _)| 2.0 * (r - l + b - t));
    let area: f32 = ink.iter().sum();
    let wanted = (around[0] + around[1]) * width;
    let most = 8.0 * (scale * width + width * width);
    assert!(
        (area - wanted).abs() <= most,
        "{what}: {area}, not {wanted}"
    );
}

/// Scales of the main pass, and widths of lines.
fn assert_outlines(cases: impl IntoIterator<Item = (f32, f32)>) {
    let mut small = boxes();
    for (scale, width) in cases {
        override_main_pass(&mut small, main_pass(scale));
        let what = format!("outlines of {width} px, scale {scale}");
        let lines = Outlines {
            width,
            ..Outlines::SILHOUETTES
        };
        let ink = ink(&mut small, &of(lines));
        // The crack is half a texel from the side at most, a line of odd width is half
        // a texel further in, and half a pixel is covered partly.
        // At corners, both of these count twice, across and down.
        let odd = if width == 2.0 { 0.0 } else { 0.5 * scale };
        let middle = (0.5 * scale + odd) * 2f32.sqrt();
        let most = middle + 0.5 * width + 0.5;
        let least = middle + 0.5 * 2f32.sqrt();
        assert_along_sides(&ink, (most, least), false, &what);
        assert_width(&ink, width, scale, &what);
    }
}

#[test]
fn outlines_are_where_the_geometry_is() {
    assert_outlines([(1.0, 1.0), (1.0, 5.0), (1.5, 2.0), (2.0, 1.0), (2.0, 5.0)]);
}

#[test]
#[ignore = "long: every width at every scale"]
fn outlines_of_every_width_are_where_the_geometry_is() {
    assert_outlines(
        SCALES
            .into_iter()
            .flat_map(|scale| [1.0, 2.0, 5.0].map(|width| (scale, width))),
    );
}

const OPERATORS: [ContourOperator; 3] = [
    ContourOperator::Prewitt,
    ContourOperator::Sobel,
    ContourOperator::Laplace,
];

fn assert_contours(cases: impl IntoIterator<Item = (f32, ContourOperator)>) {
    let width = Contours::default().width;
    let mut small = boxes();
    for (scale, operator) in cases {
        override_main_pass(&mut small, main_pass(scale));
        let what = format!("{operator:?} contours, scale {scale}");
        let contours = Contours {
            operator,
            ..default()
        };
        let ink = ink(&mut small, &of(contours));
        let most = 0.5 * scale + 0.5 * width;
        let least = 0.5 * scale * 2f32.sqrt() + 0.5 * 2f32.sqrt();
        assert_along_sides(&ink, (most, least), true, &what);
        assert_width(&ink, width, scale, &what);
    }
}

#[test]
fn contours_are_where_the_geometry_is() {
    let prewitt = [1.0, 2.0].map(|scale| (scale, ContourOperator::Prewitt));
    assert_contours(
        prewitt
            .into_iter()
            .chain(OPERATORS.map(|operator| (1.5, operator))),
    );
}

#[test]
#[ignore = "long: every operator at every scale"]
fn contours_of_every_operator_are_where_the_geometry_is() {
    assert_contours(
        SCALES
            .into_iter()
            .flat_map(|scale| OPERATORS.map(|operator| (scale, operator))),
    );
}

/// Lines in a viewport that does not begin in the corner of the picture are those of a
/// picture of its size.
#[test]
fn lines_do_not_depend_on_the_place_of_the_viewport() {
    let size = UVec2::new(160, 120);
    let first = UVec2::new(60, 40);
    let style = of(Outlines::default()).with(Contours::default());
    let viewport = Viewport {
        physical_position: first,
        physical_size: size,
        ..default()
    };
    let mut small = new();
    let mut drawn = |size: UVec2, viewport: Option<Viewport>, main_pass| {
        small.headless.resize(size, 1.0);
        small.restart(Msaa::Off);
        small.insert(Camera {
            viewport,
            ..default()
        });
        override_main_pass(&mut small, main_pass);
        ink(&mut small, &style)
    };
    for main_pass in [None, Some(UVec2::new(80, 60))] {
        let part = drawn(UVec2::new(WIDTH, HEIGHT), Some(viewport.clone()), main_pass);
        let whole = drawn(size, None, main_pass);
        assert!(whole.iter().sum::<f32>() > 500.0);
        for (i, at) in centers() {
            let inside = at.as_ivec2() - first.as_ivec2();
            let wanted = if inside.cmpge(IVec2::ZERO).all() && inside.cmplt(size.as_ivec2()).all() {
                whole[(inside.y * size.x as i32 + inside.x) as usize]
            } else {
                0.0
            };
            let got = part[i];
            assert!((got - wanted).abs() < 0.01, "{at}: {got}, not {wanted}");
        }
    }
}

/// The row of the horizon, in pixels from the top, at a column.
fn horizon(camera: &Transform, x: f32) -> f32 {
    let tan = (std::f32::consts::PI / 8.0).tan();
    let half = Vec2::new(WIDTH as f32, HEIGHT as f32) * 0.5;
    let across = (x - half.x) / half.y * tan;
    // The ray of a pixel is level where forward.y + across * right.y + up.y * v = 0.
    let v = -(camera.forward().y + across * camera.right().y) / camera.up().y;
    half.y - v / tan * half.y
}

#[test]
fn a_grazing_plane_has_lines_at_its_horizon_alone() {
    let mut small = new();
    small.clear();
    let plane = Plane3d::default().mesh().size(40_000.0, 40_000.0);
    let color = Color::srgb(0.8, 0.7, 0.5);
    put(&mut small, plane, color, Transform::IDENTITY);
    let eye = Vec3::new(0.0, 0.05, 0.0);
    let target = eye - Vec3::new(0.3, 0.02, 1.0);
    look(&mut small, eye, target, 0.1);
    let camera = Transform::from_translation(eye).looking_at(target, Vec3::Y);
    for scale in SCALES {
        override_main_pass(&mut small, main_pass(scale));
        let wide = Contours {
            width: 5.0,
            ..default()
        };
        for (name, width, style) in [
            ("outlines", 2.0, of(Outlines::default())),
            ("contours", 2.0, of(Contours::default())),
            ("wide contours", 5.0, of(wide)),
        ] {
            let ink = ink(&mut small, &style);
            // Half a texel, half the line, and a pixel for the odd part of its width; the plane
            // ends before the horizon, by 0.02 pixels.
            let most = scale + 0.5 * width + 1.0;
            let is_wrong = |(i, at): &(usize, Vec2)| {
                ink[*i] > 0.02 && (at.y - horizon(&camera, at.x)).abs() > most
            };
            let wrong = centers().filter(is_wrong).count();
            assert_eq!(wrong, 0, "{name}, scale {scale}: pixels of false ink");
            let lined = ink.iter().any(|i| *i > 0.4);
            assert!(lined, "{name}, scale {scale}: no horizon");
        }
    }
}

/// The paper's contours include slopes, and its outlines compare 5 x 5 neighbors, between which a
/// slope would be a staircase: both are those of a view of the main pass's size.
#[test]
fn faithful_lines_are_those_of_a_view_of_the_main_passs_size() {
    let contours = |width| {
        of(Contours {
            equations: Equations::Faithful,
            width,
            ..default()
        })
    };
    let outlines = of(Outlines {
        silhouettes: Some(Silhouettes {
            equations: Equations::Faithful,
            threshold: 0.002,
            ..default()
        }),
        creases: Some(Creases {
            equations: Equations::Faithful,
            ..default()
        }),
        objects: None,
        ..default()
    });
    let size = UVec2::new(WIDTH, HEIGHT) / 2;
    let mut small = Small::new(size, Msaa::Off);
    let at_half = [contours(2.0), outlines.clone()].map(|style| ink(&mut small, &style));
    small.headless.resize(UVec2::new(WIDTH, HEIGHT), 1.0);
    small.restart(Msaa::Off);
    override_main_pass(&mut small, Some(size));
    // A pixel of the main pass on either side is the least.
    for (name, low, style) in [
        ("contours of 2 px", &at_half[0], contours(2.0)),
        ("contours of 4 px", &at_half[0], contours(4.0)),
        ("outlines", &at_half[1], outlines),
    ] {
        let high = ink(&mut small, &style);
        let mut inked = 0;
        for (i, at) in centers() {
            let texel = (0.5 * at).as_uvec2();
            let wanted = low[(texel.y * size.x + texel.x) as usize];
            // Eight bits, over two colors of the picture.
            let same = (high[i] - wanted).abs() <= 0.03;
            assert!(same, "{name}, {at}: {}, {wanted}", high[i]);
            inked += usize::from(wanted > 0.5);
        }
        assert!(inked > 500, "{name}: {inked}");
    }
}

/// A tilted plane fills the view, so that the depth map spans 0 to 1 from its top to its
/// bottom: its slope is 1/512 per 1/512 of the height, everywhere.
#[test]
fn an_even_slope_is_as_steep_at_every_resolution() {
    let mut small = boxes();
    small.clear();
    put(
        &mut small,
        Rectangle::new(2000.0, 2000.0),
        Color::WHITE,
        Transform::from_xyz(0.0, 0.0, -400.0)
            .with_rotation(Quat::from_rotation_x(-std::f32::consts::FRAC_PI_3)),
    );
    small.insert(Projection::Orthographic(OrthographicProjection {
        far: 1000.0,
        ..unit_per_pixel(UVec2::new(WIDTH, HEIGHT))
    }));
    for scale in SCALES {
        override_main_pass(&mut small, main_pass(scale));
        // The range ends at centers of texels: half a texel of the border is missing at
        // both ends, so the slope is steeper by 1 % at most.
        for (threshold, filled) in [(0.85, true), (1.15, false)] {
            let flats = BlackFlats {
                slope: Some(threshold * 6.0 / 512.0),
                value: None,
                softness: 0.0,
                ..default()
            };
            let ink = ink(&mut small, &of(flats));
            // The window ends at the border of the picture, where the slope is halved.
            let inside = |at: Vec2| {
                let size = Vec2::new(WIDTH as f32, HEIGHT as f32);
                at.cmpgt(Vec2::splat(4.0)).all() && at.cmplt(size - 4.0).all()
            };
            let wrong = centers().filter(|(i, at)| inside(*at) && (ink[*i] > 0.5) != filled);
            assert_eq!(wrong.count(), 0, "scale {scale}, threshold {threshold}");
        }
    }
}

#[test]
fn the_range_is_that_of_a_view_of_the_main_passs_size() {
    let mut small = new();
    for scale in [1.5, 2.0] {
        let low = main_pass(scale).expect("smaller");
        let mut range = |size: UVec2, main_pass| {
            small.headless.resize(size, 1.0);
            small.restart(Msaa::Off);
            override_main_pass(&mut small, main_pass);
            small.insert(VisibleDepthRange::default());
            small.style(&of(Contours::default()));
            small.headless.step(8);
            small.range().expect("read back")
        };
        let native = range(low, None);
        let upscaled = range(UVec2::new(WIDTH, HEIGHT), Some(low));
        assert!(matches!(native, VisibleDepthRange::Visible { .. }));
        assert_eq!(native, upscaled, "scale {scale}");
    }
}

/// Dots, grain and speed lines are drawn in the pixels of the picture: a flat field has the same,
/// whatever the size of the main pass.
fn assert_page(scales: &[f32]) {
    let size = UVec2::new(120, 90);
    let mut small = Small::new(size, Msaa::Off);
    small.clear();
    let dots = |shape| of(Halftone { shape, ..default() });
    let cells = of(Halftone {
        sampling: ScreenSampling::Cell,
        at_near: 0.5,
        shape: ScreenShape::Round,
        ..default()
    });
    let lines = SpeedLines {
        rate: 0.0,
        ..default()
    };
    let rough = Paper {
        ink_bleed: 1.0,
        ..default()
    };
    let styles = SHAPES.map(dots).into_iter().chain([
        cells.clone().with(Misregistration::default()),
        cells.with(rough),
        of(Paper::default()).with(lines),
    ]);
    override_main_pass(&mut small, None);
    let plain = small.shot(&ComicStyle::new());
    for style in styles {
        override_main_pass(&mut small, None);
        let whole = small.shot(&style);
        assert_ne!(whole, plain, "{style:?}");
        for &scale in scales {
            let main_pass = (size.as_vec2() / scale).as_uvec2();
            override_main_pass(&mut small, Some(main_pass));
            assert_eq!(small.shot(&style), whole, "{scale}: {style:?}");
        }
    }
}

#[test]
fn the_page_has_the_size_of_the_picture() {
    assert_page(&[1.5]);
}

#[test]
#[ignore = "long: more scales"]
fn the_page_has_the_size_of_the_picture_at_every_scale() {
    assert_page(&[1.5, 2.0]);
}
