//! Outlines of selected objects, and of the hidden parts of others.

use bevy_comics::{SelectionOutline, XRayOutline};

use crate::{line_scenes::alike, outlines::put, prelude::*, walls::wall};

/// Width and height of the picture; a unit of the scene is a pixel at the distance `half`.
const SIZE: u32 = 96;
const HALF: f32 = 0.5 * SIZE as f32;

/// A white square of 40 pixels in the middle, and a white wall in front of its left half.
fn scene() -> (Small, Entity, Entity) {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Off);
    let (square, wall) = spawn(&mut small, Msaa::Off);
    (small, square, wall)
}

/// Starts over with the scene.
fn spawn(small: &mut Small, msaa: Msaa) -> (Entity, Entity) {
    small.empty_view(msaa, Color::WHITE);
    let square = Rectangle::from_length(40.0);
    let at = Transform::from_xyz(0.0, 0.0, -HALF);
    let square = put(small, square, Color::WHITE, at);
    let (side, distance) = (0.8 * HALF, 0.8 * HALF);
    let wall = wall(small, [-side, -side], [0.0, side], distance);
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

const WHITE: [f64; 3] = [1.0; 3];
const GREEN: [f64; 3] = [0.0, 1.0, 0.0];
const RED: [f64; 3] = [1.0, 0.0, 0.0];

/// The colors of pixels in a new picture.
fn colors<const N: usize>(small: &mut Small, at: [[u32; 2]; N]) -> [[f64; 3]; N] {
    let picture = small.settle().picture();
    at.map(|[x, y]| linear(&picture, x, y))
}

/// The colors at the middles of the four sides of the square: left, right, top at the left,
/// top at the right; and in its middle.
fn sides(small: &mut Small) -> [[f64; 3]; 5] {
    colors(small, [[28, 47], [68, 47], [38, 28], [58, 28], [58, 47]])
}

#[test]
fn a_selected_object_has_an_outline_also_where_it_is_hidden() {
    let (mut small, ..) = scene();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let (square, _) = spawn(&mut small, msaa);
        assert_eq!(sides(&mut small), [WHITE; 5]);
        assert!(!small.ran(ComicsStage::HighlightedObjects));
        small.on(square).insert(green(1.0));
        for (i, color) in sides(&mut small).into_iter().enumerate() {
            let want = if i < 4 { GREEN } else { WHITE };
            assert!(alike(color, want), "{msaa:?}, {i}: {color:?}");
        }
        assert!(small.ran(ComicsStage::HighlightedObjects));
        // The line is as wide as asked: ink along a row through the middle. Of two lines, the ink
        // of four pixels is rounded, each by less than 0.01.
        let ink = black_ink(&small.picture(), (0..SIZE).map(|x| (x, 47)));
        assert!((ink - 8.0).abs() < 0.04, "{msaa:?}: {ink}");
        small.on(square).insert(green(0.5));
        for color in &sides(&mut small)[..4] {
            assert!(alike(*color, [0.5, 1.0, 0.5]), "{msaa:?}: {color:?}");
        }
        small.on(square).remove::<SelectionOutline>();
        assert_eq!(sides(&mut small), [WHITE; 5]);
        assert!(!small.ran(ComicsStage::HighlightedObjects));
    }
}

#[test]
fn only_the_hidden_or_the_visible_part_of_an_object_has_lines() {
    let (mut small, ..) = scene();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let (square, wall) = spawn(&mut small, msaa);
        small.on(square).insert(x_ray());
        let found = sides(&mut small);
        for (color, want) in found.into_iter().zip([RED, WHITE, RED, WHITE, WHITE]) {
            assert!(alike(color, want), "{msaa:?}: {found:?}");
        }
        // The line ends where the wall does, at half of the picture.
        let picture = small.picture();
        let above: f64 = (30..66).map(|x| 1.0 - linear(&picture, x, 28)[1]).sum();
        assert!((above - 18.0).abs() < 2.5, "{msaa:?}: {above}");
        small.on(square).insert(SelectionOutline {
            occluded: false,
            ..green(1.0)
        });
        let found = sides(&mut small);
        for (color, want) in found.into_iter().zip([WHITE, GREEN, WHITE, GREEN, WHITE]) {
            assert!(alike(color, want), "{msaa:?}: {found:?}");
        }
        small.on(square).remove::<SelectionOutline>();
        // Nothing hides it any more.
        small.world().despawn(wall);
        assert_eq!(sides(&mut small), [WHITE; 5]);
    }
}

/// The meshes of one selection have one outline, those of two selections two.
#[test]
fn children_share_the_outline_of_their_parent() {
    let (mut small, square, wall) = scene();
    small.world().despawn(wall);
    let at = Transform::from_xyz(0.0, 0.0, 1.0);
    let other = put(&mut small, Rectangle::new(16.0, 60.0), Color::WHITE, at);
    small.on(square).add_child(other).insert(green(1.0));
    // Inside, where the other crosses the rim of the square, and at the rim of the other.
    let found = colors(&mut small, [[47, 28], [40, 40], [47, 17]]);
    for (color, want) in found.into_iter().zip([WHITE, WHITE, GREEN]) {
        assert!(alike(color, want), "{found:?}");
    }
    small.on(other).insert(SelectionOutline {
        color: Color::linear_rgb(1.0, 0.0, 0.0),
        ..green(1.0)
    });
    let [rim] = colors(&mut small, [[39, 40]]);
    assert!(alike(rim, RED), "{rim:?}");
    small.on(other).remove::<SelectionOutline>();
    small.on(square).insert(SelectionOutline {
        inherit: false,
        ..green(1.0)
    });
    let [rim] = colors(&mut small, [[47, 17]]);
    assert!(alike(rim, WHITE), "{rim:?}");
}

/// A highlight has a layer of its own: id, style and sections of its object stay in the texture of ids.
#[test]
fn a_selected_object_keeps_its_id_and_its_style() {
    let (mut small, square, _) = scene();
    for is_highlighted in [true, false] {
        small.insert(Outlines::default());
        small
            .on(square)
            .insert((NoOutlines::default(), NoStyle::default()));
        let before = small.settle().object_ids().expect("drawn");
        if is_highlighted {
            small.on(square).insert(green(1.0));
        } else {
            small.on(square).insert(x_ray());
        }
        assert_eq!(small.settle().object_ids().as_ref(), Some(&before));
        small.on(square).remove::<(SelectionOutline, XRayOutline)>();
    }
}

/// The outline lies over the effects of the camera, in sub-viewports too, and the effects are
/// the same beside it.
#[test]
fn the_outline_lies_over_the_effects() {
    let (mut small, square, _) = scene();
    let style = ComicStyle::default()
        .with(Outlines::default())
        .with(Desaturation::default());
    let before = small.shot(&style);
    small.on(square).insert(green(1.0));
    let after = small.settle().picture();
    let pixels = after.enumerate_pixels();
    let changed = pixels.filter(|(x, y, pixel)| *pixel != before.get_pixel(*x, *y));
    let changed: Vec<[f64; 3]> = changed.map(|(x, y, _)| linear(&after, x, y)).collect();
    let is_green = |color: &[f64; 3]| color[1] > 0.2 && color[0] <= color[1];
    assert!(changed.iter().all(is_green), "{changed:?}");
    assert!((500..900).contains(&changed.len()), "{}", changed.len());
}

#[test]
fn cameras_come_and_go_beside_highlighted_objects() {
    let (mut small, square, _) = scene();
    small.on(square).insert(green(1.0));
    small.settle();
    for (msaa, size) in [
        (Msaa::Sample4, UVec2::new(64, 80)),
        (Msaa::Off, UVec2::splat(SIZE)),
    ] {
        small.headless.resize(size, 1.0);
        let (square, _) = spawn(&mut small, msaa);
        small.on(square).insert(x_ray());
        small.settle();
    }
    let colors = sides(&mut small);
    assert!(alike(colors[0], RED), "{colors:?}");
    small.camera_settings().is_active = false;
    small.headless.step(3);
    small.camera_settings().is_active = true;
    assert!(alike(sides(&mut small)[0], RED));
}

#[test]
fn bad_values_are_clamped() {
    let (mut small, square, _) = scene();
    for bad in [f32::NAN, f32::INFINITY, -1.0, 1e30] {
        let selected = SelectionOutline {
            color: Color::linear_rgb(bad, bad, bad),
            width: bad,
            ..green(bad)
        };
        let hidden = XRayOutline {
            width: bad,
            opacity: bad,
            ..x_ray()
        };
        let (a, b) = (selected.sanitized(), hidden.sanitized());
        for (width, opacity) in [(a.width, a.opacity), (b.width, b.opacity)] {
            assert!((0.5..=16.0).contains(&width) && (0.0..=1.0).contains(&opacity));
        }
        small.on(square).insert(selected);
        small.settle();
    }
}
