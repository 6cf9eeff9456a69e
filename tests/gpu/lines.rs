//! Where the default contours draw lines, and where they must not.

use bevy_comics_testkit::read_back::DepthImage;

use crate::prelude::*;

const OPERATORS: [ContourOperator; 4] = [
    ContourOperator::Prewitt,
    ContourOperator::Sobel,
    ContourOperator::Laplace,
    ContourOperator::Roberts,
];

/// A white scene without anti-aliasing: every dark pixel is ink.
fn empty_world(size: UVec2, msaa: Msaa) -> Small {
    let mut small = Small::new(size, msaa);
    empty(&mut small, msaa);
    small
}

/// Starts over with an empty, white scene.
fn empty(small: &mut Small, msaa: Msaa) {
    small.restart(msaa);
    small.clear();
    small.insert(Camera {
        clear_color: Color::WHITE.into(),
        ..default()
    });
}

fn add(small: &mut Small, mesh: impl Into<Mesh>, at: Transform) {
    let material = StandardMaterial {
        cull_mode: None,
        ..unlit(Color::WHITE)
    };
    small.put(mesh, material, at);
}

/// Coordinates of the inked pixels.
fn ink(small: &mut Small) -> Vec<(u32, u32)> {
    let picture = small.picture();
    picture
        .enumerate_pixels()
        .filter(|(_, _, p)| p.0[0] < 200)
        .map(|(x, y, _)| (x, y))
        .collect()
}

fn is_sky(depth: &DepthImage, x: u32, y: u32) -> bool {
    depth.at(x, y, 0) == 0.0
}

/// Whether sky and geometry meet within `reach` pixels.
fn at_the_skyline(depth: &DepthImage, x: u32, y: u32, reach: u32) -> bool {
    let columns = x.saturating_sub(reach)..=(x + reach).min(depth.width - 1);
    let mut seen = [false; 2];
    for i in columns {
        for j in y.saturating_sub(reach)..=(y + reach).min(depth.height - 1) {
            seen[usize::from(is_sky(depth, i, j))] = true;
        }
    }
    seen == [true; 2]
}

#[test]
fn a_grazing_ground_to_the_horizon_has_one_line_the_skyline() {
    let mut small = Small::new(UVec2::new(200, 120), Msaa::Off);
    for operator in OPERATORS {
        for (name, eye) in [("10 cm", 0.1), ("eye height", 1.7), ("40 m", 40.0)] {
            empty(&mut small, Msaa::Off);
            add(
                &mut small,
                Plane3d::default().mesh().size(4000.0, 4000.0),
                Transform::IDENTITY,
            );
            small.insert((
                Transform::from_xyz(0.0, eye, 0.0).looking_to(Vec3::new(0.3, -0.05, -1.0), Vec3::Y),
                Contours {
                    operator,
                    softness: 0.0,
                    ..default()
                },
            ));
            small.settle();
            let depth = small.depth().expect("depth");
            let inked = ink(&mut small);
            let false_lines: Vec<_> = inked
                .iter()
                .filter(|(x, y)| !at_the_skyline(&depth, *x, *y, 2))
                .collect();
            assert!(
                false_lines.is_empty(),
                "{operator:?} from {name}: {false_lines:?}"
            );
            let columns: HashSet<_> = inked.iter().map(|(x, _)| *x).collect();
            // Pixels at the border of the picture lack a neighbour.
            assert!(
                columns.len() >= 196,
                "{operator:?} from {name}: skyline in {} of 200 columns",
                columns.len()
            );
        }
    }
}

#[test]
fn the_border_of_the_picture_is_no_line() {
    let mut small = Small::new(UVec2::new(80, 60), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        for operator in OPERATORS {
            empty(&mut small, msaa);
            add(
                &mut small,
                Plane3d::default().mesh().size(40.0, 40.0),
                Transform::from_rotation(Quat::from_rotation_x(0.9)),
            );
            small.insert((
                Transform::from_xyz(0.0, 3.0, 9.0).looking_at(Vec3::ZERO, Vec3::Y),
                Contours {
                    operator,
                    width: 6.0,
                    ..default()
                },
            ));
            small.settle();
            let depth = small.depth().expect("depth");
            for (x, y) in ink(&mut small) {
                assert!(
                    at_the_skyline(&depth, x, y, 4),
                    "{msaa:?} {operator:?}: ({x}, {y})"
                );
            }
        }
    }
}

#[test]
fn the_farthest_object_has_a_line_against_the_sky_and_the_sky_has_none() {
    let mut small = empty_world(UVec2::new(100, 80), Msaa::Off);
    add(
        &mut small,
        Cuboid::default(),
        Transform::from_xyz(-1.5, 0.0, 0.0),
    );
    add(
        &mut small,
        Cuboid::default(),
        Transform::from_xyz(3.0, 0.0, -9.0).with_scale(Vec3::splat(3.0)),
    );
    small.insert((
        Transform::from_xyz(0.0, 0.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y),
        Contours::default(),
    ));
    small.settle();
    let depth = small.depth().expect("depth");
    let inked = ink(&mut small);
    // Every pixel along the border of the object, on its side, has ink.
    let mut outline = 0;
    for y in 1..depth.height - 1 {
        for x in 1..depth.width - 1 {
            if !is_sky(&depth, x, y) && at_the_skyline(&depth, x, y, 1) {
                outline += 1;
                assert!(
                    inked.contains(&(x, y)),
                    "({x}, {y}) is an edge against the sky"
                );
            }
        }
    }
    assert!(outline > 80, "only {outline} pixels of outline");
    for (x, y) in inked {
        assert!(
            at_the_skyline(&depth, x, y, 1) || !is_sky(&depth, x, y),
            "({x}, {y}) lies in the sky"
        );
    }
}

#[test]
fn an_orthographic_view_draws_the_same_lines() {
    let mut small = empty_world(UVec2::new(100, 80), Msaa::Off);
    add(
        &mut small,
        Cuboid::default(),
        Transform::from_xyz(0.0, 0.5, 0.0),
    );
    add(
        &mut small,
        Plane3d::default().mesh().size(30.0, 30.0),
        Transform::IDENTITY,
    );
    small.insert((
        Projection::Orthographic(OrthographicProjection {
            near: -50.0,
            far: 200.0,
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 4.0,
            },
            ..OrthographicProjection::default_3d()
        }),
        Transform::from_xyz(3.0, 2.5, 6.0).looking_at(Vec3::Y * 0.4, Vec3::Y),
        Contours {
            threshold: 0.03,
            softness: 0.0,
            ..default()
        },
    ));
    small.settle();
    let inked = ink(&mut small);
    assert!(inked.len() > 60, "{} pixels of ink", inked.len());
    let border = inked
        .iter()
        .filter(|(x, y)| *x == 0 || *y == 0 || *x == 99 || *y == 79)
        .count();
    assert_eq!(border, 0, "lines at the border");
    // The ground is a plane: no line at its corners.
    for corner in [(5, 75), (95, 75), (5, 5), (95, 5)] {
        assert!(!inked.contains(&corner), "ink at {corner:?}");
    }
}

#[test]
fn a_line_is_as_wide_as_asked_at_every_scale() {
    let mut small = Small::new(UVec2::new(120, 60), Msaa::Off);
    for (width, scale) in [
        (1.0f32, 1.0f32),
        (2.0, 1.0),
        (3.0, 1.0),
        (4.0, 1.0),
        (2.0, 1.5),
        (2.0, 2.0),
        (8.0, 1.0),
    ] {
        small.headless.options.scale_factor = scale;
        empty(&mut small, Msaa::Off);
        add(
            &mut small,
            Rectangle::new(20.0, 40.0),
            Transform::from_xyz(-10.0, 0.0, 0.0),
        );
        small.insert((
            Transform::from_xyz(0.0, 0.0, 6.0),
            Contours { width, ..default() },
        ));
        small.settle();
        let picture = small.picture();
        // Coverage across the vertical edge in the middle row: black ink over
        // white, in linear light.
        let covered = black_ink(&picture, (0..120).map(|x| (x, 30)));
        let asked = f64::from(width * scale);
        assert!(
            (covered - asked).abs() <= 0.5,
            "{width} px at scale {scale}: {covered} for {asked}"
        );
    }
}

#[test]
fn one_threshold_serves_every_scale_of_world() {
    // A world scaled by 1/1000 and by 1000 gives the same picture.
    let mut pictures = Vec::new();
    let mut small = Small::new(UVec2::new(100, 70), Msaa::Off);
    for scale in [1e-3f32, 1.0, 1e3] {
        empty(&mut small, Msaa::Off);
        add(
            &mut small,
            Cuboid::default(),
            Transform::from_xyz(0.0, 0.5 * scale, 0.0).with_scale(Vec3::splat(scale)),
        );
        add(
            &mut small,
            Plane3d::default().mesh().size(9.0, 9.0),
            Transform::from_scale(Vec3::splat(scale)),
        );
        small.insert((
            Projection::Perspective(PerspectiveProjection {
                near: 0.01 * scale,
                far: 1e6,
                ..default()
            }),
            Transform::from_xyz(2.0 * scale, 2.0 * scale, 4.0 * scale)
                .looking_at(Vec3::ZERO, Vec3::Y),
            Contours::default(),
            DepthMap {
                mapping: DepthMapping::MinMax,
                ..default()
            },
        ));
        small.settle();
        pictures.push(ink(&mut small));
    }
    for other in &pictures[1..] {
        let both = pictures[0].iter().filter(|p| other.contains(p)).count();
        let any = pictures[0].len() + other.len() - both;
        assert!(
            both as f64 >= 0.99 * any as f64,
            "{both} of {any} inked pixels agree"
        );
    }
}
