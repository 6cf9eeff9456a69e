//! Outlines of selected objects, and of the hidden parts of others.

use bevy_comics::{SelectionOutline, XRayOutline};

use crate::{outlines::put, prelude::*};

/// Width and height of the picture; a unit of the scene is a pixel at the distance `half`.
const SIZE: u32 = 96;
const HALF: f32 = 0.5 * SIZE as f32;

/// A white square of 40 pixels in the middle, and a grey wall in front of its left half.
fn scene() -> (Small, Entity, Entity) {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Off);
    let (square, wall) = spawn(&mut small, Msaa::Off);
    (small, square, wall)
}

/// Starts over with the scene.
fn spawn(small: &mut Small, msaa: Msaa) -> (Entity, Entity) {
    small.restart(msaa);
    small.clear();
    small.insert((
        Transform::IDENTITY,
        Projection::Perspective(PerspectiveProjection {
            fov: std::f32::consts::FRAC_PI_2,
            ..default()
        }),
    ));
    let camera = small.camera;
    let mut camera = small.world().get_mut::<Camera>(camera).expect("a camera");
    camera.clear_color = Color::WHITE.into();
    let square = put(
        small,
        Rectangle::new(40.0, 40.0),
        Color::WHITE,
        Transform::from_xyz(0.0, 0.0, -HALF),
    );
    let wall = put(
        small,
        Rectangle::new(HALF, 2.0 * HALF),
        Color::WHITE,
        Transform::from_xyz(-0.5 * HALF, 0.0, -0.8 * HALF).with_scale(Vec3::splat(0.8)),
    );
    let mut at = small.world().get_mut::<Transform>(wall).expect("a wall");
    at.translation.x = -0.4 * HALF;
    (square, wall)
}

fn green(opacity: f32) -> SelectionOutline {
    SelectionOutline {
        color: Color::linear_rgb(0.0, 1.0, 0.0),
        width: 4.0,
        opacity,
        ..default()
    }
}

fn x_ray() -> XRayOutline {
    XRayOutline {
        color: Color::linear_rgb(1.0, 0.0, 0.0),
        width: 4.0,
        opacity: 1.0,
        ..default()
    }
}

/// Whether two colours are equal within a code of the picture.
fn alike(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.006)
}

const WHITE: [f64; 3] = [1.0; 3];
const GREEN: [f64; 3] = [0.0, 1.0, 0.0];
const RED: [f64; 3] = [1.0, 0.0, 0.0];

/// The colours at the middles of the four sides of the square: left, right, top at the left,
/// top at the right; and in its middle.
fn sides(small: &mut Small) -> [[f64; 3]; 5] {
    small.settle();
    let picture = small.picture();
    [[28, 47], [68, 47], [38, 28], [58, 28], [58, 47]].map(|[x, y]| linear(&picture, x, y))
}

#[test]
fn a_selected_object_has_an_outline_also_where_it_is_hidden() {
    let (mut small, ..) = scene();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let (square, _) = spawn(&mut small, msaa);
        assert_eq!(sides(&mut small), [WHITE; 5]);
        assert!(!small.ran(ComicsStage::MarkedObjects));
        small.world().entity_mut(square).insert(green(1.0));
        for (i, color) in sides(&mut small).into_iter().enumerate() {
            let want = if i < 4 { GREEN } else { WHITE };
            assert!(alike(color, want), "{msaa:?}, {i}: {color:?}");
        }
        assert!(small.ran(ComicsStage::MarkedObjects));
        // The line is as wide as asked: ink along a row through the middle. Of two lines, the ink of
        // four pixels is rounded, each by less than 0.01.
        let picture = small.picture();
        let ink: f64 = (0..SIZE).map(|x| 1.0 - linear(&picture, x, 47)[0]).sum();
        assert!((ink - 8.0).abs() < 0.04, "{msaa:?}: {ink}");
        small.world().entity_mut(square).insert(green(0.5));
        for color in &sides(&mut small)[..4] {
            assert!(alike(*color, [0.5, 1.0, 0.5]), "{msaa:?}: {color:?}");
        }
        small
            .world()
            .entity_mut(square)
            .remove::<SelectionOutline>();
        assert_eq!(sides(&mut small), [WHITE; 5]);
        assert!(!small.ran(ComicsStage::MarkedObjects));
        assert_eq!(small.errors(), 0);
    }
}

#[test]
fn only_the_hidden_part_of_an_object_has_x_ray_lines() {
    let (mut small, ..) = scene();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let (square, wall) = spawn(&mut small, msaa);
        small.world().entity_mut(square).insert(x_ray());
        let [left, right, top_left, top_right, middle] = sides(&mut small);
        assert!(
            alike(left, RED) && alike(top_left, RED),
            "{msaa:?}: {left:?}, {top_left:?}"
        );
        let seen = [right, top_right, middle];
        assert!(seen.iter().all(|c| alike(*c, WHITE)), "{msaa:?}: {seen:?}");
        // The line ends where the wall does, at half of the picture.
        let picture = small.picture();
        let above: f64 = (30..66).map(|x| 1.0 - linear(&picture, x, 28)[1]).sum();
        assert!((above - 18.0).abs() < 2.5, "{msaa:?}: {above}");
        // Nothing hides it any more.
        small.world().despawn(wall);
        assert_eq!(sides(&mut small), [WHITE; 5]);
        assert_eq!(small.errors(), 0);
    }
}

/// The meshes of one selection have one outline, those of two selections two.
#[test]
fn children_share_the_outline_of_their_parent() {
    let (mut small, square, wall) = scene();
    small.world().despawn(wall);
    let other = put(
        &mut small,
        Rectangle::new(16.0, 60.0),
        Color::WHITE,
        Transform::from_xyz(0.0, 0.0, 1.0),
    );
    small.world().entity_mut(square).add_child(other);
    small.world().entity_mut(square).insert(green(1.0));
    small.settle();
    let picture = small.picture();
    // Inside, where the other crosses the rim of the square, and at the rim of the other.
    assert!(alike(linear(&picture, 47, 28), WHITE));
    assert!(alike(linear(&picture, 40, 40), WHITE));
    assert!(alike(linear(&picture, 47, 17), GREEN));
    small.world().entity_mut(other).insert(SelectionOutline {
        color: Color::linear_rgb(1.0, 0.0, 0.0),
        ..green(1.0)
    });
    small.settle();
    let picture = small.picture();
    assert!(
        alike(linear(&picture, 39, 40), RED),
        "{:?}",
        linear(&picture, 39, 40)
    );
    let alone = SelectionOutline {
        inherit: false,
        ..green(1.0)
    };
    small.world().entity_mut(other).remove::<SelectionOutline>();
    small.world().entity_mut(square).insert(alone);
    small.settle();
    let picture = small.picture();
    assert!(alike(linear(&picture, 47, 17), WHITE));
    assert_eq!(small.errors(), 0);
}

/// The outline lies over the effects of the camera, in sub-viewports too, and the effects are
/// the same beside it.
#[test]
fn the_outline_lies_over_the_effects() {
    let (mut small, square, _) = scene();
    let style = ComicStyle::default()
        .with(Outlines::default())
        .with(Desaturation::default());
    small.style(&style);
    small.settle();
    let before = small.picture();
    small.world().entity_mut(square).insert(green(1.0));
    small.settle();
    let after = small.picture();
    let mut same = 0;
    for (x, y, pixel) in after.enumerate_pixels() {
        let color = linear(&after, x, y);
        if pixel == before.get_pixel(x, y) {
            same += 1;
        } else {
            assert!(
                color[1] > 0.2 && color[0] <= color[1],
                "{x}, {y}: {color:?}"
            );
        }
    }
    let changed = (SIZE * SIZE) as i32 - same;
    assert!((500..900).contains(&changed), "{changed}");
    assert_eq!(small.errors(), 0);
}

#[test]
fn cameras_come_and_go_beside_marked_objects() {
    let (mut small, square, _) = scene();
    small.world().entity_mut(square).insert(green(1.0));
    small.settle();
    for (msaa, size) in [
        (Msaa::Sample4, UVec2::new(64, 80)),
        (Msaa::Off, UVec2::splat(SIZE)),
    ] {
        small.headless.resize(size, 1.0);
        let (square, _) = spawn(&mut small, msaa);
        small.world().entity_mut(square).insert(x_ray());
        small.settle();
        if size.x != SIZE {
            continue;
        }
        let colors = sides(&mut small);
        assert!(alike(colors[0], RED), "{msaa:?}: {colors:?}");
        let camera = small.camera;
        let mut inactive = small.world().get_mut::<Camera>(camera).expect("a camera");
        inactive.is_active = false;
        small.headless.step(3);
        let mut active = small.world().get_mut::<Camera>(camera).expect("a camera");
        active.is_active = true;
        assert!(alike(sides(&mut small)[0], RED));
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn bad_values_are_clamped() {
    let (mut small, square, _) = scene();
    for bad in [f32::NAN, f32::INFINITY, -1.0, 1e30] {
        let selected = SelectionOutline {
            color: Color::linear_rgb(bad, bad, bad),
            width: bad,
            opacity: bad,
            ..default()
        };
        let clean = selected.sanitized();
        assert!((0.5..=16.0).contains(&clean.width) && (0.0..=1.0).contains(&clean.opacity));
        let hidden = XRayOutline {
            width: bad,
            opacity: bad,
            ..default()
        };
        let clean = hidden.sanitized();
        assert!((0.5..=16.0).contains(&clean.width) && (0.0..=1.0).contains(&clean.opacity));
        small.world().entity_mut(square).insert(selected);
        let _ = sides(&mut small);
    }
    assert_eq!(small.errors(), 0);
}
