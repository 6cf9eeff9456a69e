//! Where the default contours draw lines, and where they must not.

use bevy_comics_testkit::read_back::DepthImage;

use crate::{
    outlines::{look, put},
    prelude::*,
};

const OPERATORS: [ContourOperator; 4] = [
    ContourOperator::Prewitt,
    ContourOperator::Sobel,
    ContourOperator::Laplace,
    ContourOperator::Roberts,
];

/// A plane through the origin.
fn plane(size: f32) -> Plane3d {
    Plane3d::new(Vec3::Y, Vec2::splat(0.5 * size))
}

/// Starts over with white things before a white sky, without anti-aliasing: every dark pixel is
/// ink.
fn show<const N: usize>(small: &mut Small, msaa: Msaa, things: [(Mesh, Transform); N]) {
    small.restart(msaa);
    small.clear();
    small.camera_settings().clear_color = Color::WHITE.into();
    for (mesh, at) in things {
        put(small, mesh, Color::WHITE, at);
    }
}

/// The inked pixels of the next picture.
fn ink(small: &mut Small, contours: Contours) -> Vec<(u32, u32)> {
    small.insert(contours);
    let picture = small.settle().picture();
    let pixels = picture.enumerate_pixels();
    let inked = pixels.filter(|(_, _, pixel)| pixel.0[0] < 200);
    inked.map(|(x, y, _)| (x, y)).collect()
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
            let ground = (plane(4000.0).into(), Transform::IDENTITY);
            show(&mut small, Msaa::Off, [ground]);
            let eye = Transform::from_xyz(0.0, eye, 0.0);
            small.insert(eye.looking_to(Vec3::new(0.3, -0.05, -1.0), Vec3::Y));
            let contours = Contours {
                operator,
                softness: 0.0,
                ..default()
            };
            let inked = ink(&mut small, contours);
            let depth = small.depth().expect("depth");
            let far = |(x, y): &&(u32, u32)| !at_the_skyline(&depth, *x, *y, 2);
            let false_lines: Vec<_> = inked.iter().filter(far).collect();
            let what = format!("{operator:?} from {name}");
            assert!(false_lines.is_empty(), "{what}: {false_lines:?}");
            let columns: HashSet<_> = inked.iter().map(|(x, _)| *x).collect();
            // Pixels at the border of the picture lack a neighbor.
            let count = columns.len();
            assert!(count >= 196, "{what}: skyline in {count} of 200 columns");
        }
    }
}

#[test]
fn the_border_of_the_picture_is_no_line() {
    let mut small = Small::new(UVec2::new(80, 60), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        for operator in OPERATORS {
            let tilted = Transform::from_rotation(Quat::from_rotation_x(0.9));
            show(&mut small, msaa, [(plane(40.0).into(), tilted)]);
            let eye = Transform::from_xyz(0.0, 3.0, 9.0);
            small.insert(eye.looking_at(Vec3::ZERO, Vec3::Y));
            let contours = Contours {
                operator,
                width: 6.0,
                ..default()
            };
            let inked = ink(&mut small, contours);
            let depth = small.depth().expect("depth");
            for (x, y) in inked {
                let right = at_the_skyline(&depth, x, y, 4);
                assert!(right, "{msaa:?} {operator:?}: ({x}, {y})");
            }
        }
    }
}

#[test]
fn the_farthest_object_has_a_line_against_the_sky_and_the_sky_has_none() {
    let mut small = Small::new(UVec2::new(100, 80), Msaa::Off);
    let near = Transform::from_xyz(-1.5, 0.0, 0.0);
    let far = Transform::from_xyz(3.0, 0.0, -9.0).with_scale(Vec3::splat(3.0));
    let cubes = [near, far].map(|at| (Cuboid::default().into(), at));
    show(&mut small, Msaa::Off, cubes);
    small.insert(Transform::from_xyz(0.0, 0.0, 6.0));
    let inked = ink(&mut small, Contours::default());
    let depth = small.depth().expect("depth");
    // Every pixel along the border of the object, on its side, has ink.
    let mut outline = 0;
    for y in 1..depth.height - 1 {
        for x in 1..depth.width - 1 {
            if !is_sky(&depth, x, y) && at_the_skyline(&depth, x, y, 1) {
                outline += 1;
                let has_ink = inked.contains(&(x, y));
                assert!(has_ink, "({x}, {y}) is an edge against the sky");
            }
        }
    }
    assert!(outline > 80, "only {outline} pixels of outline");
    for (x, y) in inked {
        let right = at_the_skyline(&depth, x, y, 1) || !is_sky(&depth, x, y);
        assert!(right, "({x}, {y}) lies in the sky");
    }
}

#[test]
fn an_orthographic_view_draws_the_same_lines() {
    let mut small = Small::new(UVec2::new(100, 80), Msaa::Off);
    let cube = (Cuboid::default().into(), Transform::from_xyz(0.0, 0.5, 0.0));
    let ground = (plane(30.0).into(), Transform::IDENTITY);
    show(&mut small, Msaa::Off, [cube, ground]);
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
    ));
    let contours = Contours {
        threshold: 0.03,
        softness: 0.0,
        ..default()
    };
    let inked = ink(&mut small, contours);
    assert!(inked.len() > 60, "{} pixels of ink", inked.len());
    let at_border = |(x, y): &&(u32, u32)| *x == 0 || *y == 0 || *x == 99 || *y == 79;
    let border = inked.iter().filter(at_border).count();
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
        let wall = Rectangle::new(20.0, 40.0).into();
        let left = Transform::from_xyz(-10.0, 0.0, 0.0);
        show(&mut small, Msaa::Off, [(wall, left)]);
        small.insert(Transform::from_xyz(0.0, 0.0, 6.0));
        ink(&mut small, Contours { width, ..default() });
        // Across the vertical edge in the middle row.
        let covered = black_ink(&small.picture(), (0..120).map(|x| (x, 30)));
        let asked = f64::from(width * scale);
        let what = format!("{width} px at scale {scale}: {covered} for {asked}");
        assert!((covered - asked).abs() <= 0.5, "{what}");
    }
}

/// A world scaled by 1/1000 and by 1000 gives the same picture.
#[test]
fn one_threshold_serves_every_scale_of_world() {
    let mut small = Small::new(UVec2::new(100, 70), Msaa::Off);
    let pictures = [1e-3f32, 1.0, 1e3].map(|scale| {
        let larger = Transform::from_scale(Vec3::splat(scale));
        let cube = (
            Cuboid::default().into(),
            larger.with_translation(0.5 * scale * Vec3::Y),
        );
        show(&mut small, Msaa::Off, [cube, (plane(9.0).into(), larger)]);
        look(
            &mut small,
            Vec3::new(2.0, 2.0, 4.0) * scale,
            Vec3::ZERO,
            0.01 * scale,
        );
        small.insert(DepthMap {
            mapping: DepthMapping::MinMax,
            ..default()
        });
        ink(&mut small, Contours::default())
    });
    for other in &pictures[1..] {
        let both = pictures[0].iter().filter(|p| other.contains(p)).count();
        let any = pictures[0].len() + other.len() - both;
        assert!(
            both as f64 >= 0.99 * any as f64,
            "{both} of {any} inked pixels agree"
        );
    }
}
