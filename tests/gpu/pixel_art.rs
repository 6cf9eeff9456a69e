//! Lines of pixel art: whole pixels of ink, one pixel wide.

use std::f32::consts::FRAC_PI_4;

use image::{Rgba, RgbaImage};

use crate::{
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(160, 90);
const INK: Rgba<u8> = Rgba([0, 0, 0, 255]);

/// An orthographic view of a ball, two boxes, a slanted plate, and two plates that touch.
fn scene() -> Small {
    let mut small = towards_the_sky(SIZE);
    let mut put = |mesh: Mesh, color: Color, at: Vec3, turned: Quat| {
        let at = Transform::from_translation(at).with_rotation(turned);
        small.put(mesh, unlit(color), at);
    };
    let ball = Sphere::new(17.3).mesh().uv(64, 32);
    put(
        ball,
        Color::srgb(0.8, 0.3, 0.3),
        Vec3::new(-46.2, 15.1, -100.0),
        Quat::IDENTITY,
    );
    put(
        Cuboid::new(31.0, 24.0, 27.0).into(),
        Color::srgb(0.4, 0.7, 0.4),
        Vec3::new(3.3, -4.2, -120.0),
        // One edge between the visible sides.
        Quat::from_rotation_z(0.3) * Quat::from_rotation_x(0.7),
    );
    put(
        Cuboid::new(20.0, 24.0, 18.0).into(),
        Color::srgb(0.5, 0.4, 0.7),
        Vec3::new(-44.7, -22.3, -130.0),
        // A vertical edge between visible sides.
        Quat::from_rotation_x(0.3) * Quat::from_rotation_y(0.5),
    );
    let plate = |width, height| Rectangle::new(width, height).into();
    put(
        plate(29.0, 21.0),
        Color::srgb(0.3, 0.4, 0.8),
        Vec3::new(50.2, 18.3, -110.0),
        Quat::from_rotation_z(0.4),
    );
    for (x, blue) in [(45.2, 0.2), (57.2, 0.3)] {
        put(
            plate(12.0, 20.0),
            Color::srgb(0.8, 0.7, blue),
            Vec3::new(x, -22.3, -110.0),
            Quat::IDENTITY,
        );
    }
    small
}

fn colors(picture: &RgbaImage) -> HashSet<Rgba<u8>> {
    picture.pixels().copied().collect()
}

fn is_ink(picture: &RgbaImage, x: u32, y: u32) -> bool {
    *picture.get_pixel(x, y) == INK
}

/// Truth: the picture has the flat colors and one more, that of ink. No ink is lighter, and no
/// other pixel is changed.
#[test]
fn pixels_are_ink_or_as_they_were() {
    let mut small = scene();
    let flat = small.settle().picture();
    let inked = small.outlined(Outlines::PIXELS);
    assert_eq!(colors(&inked).len(), colors(&flat).len() + 1);
    let mut count = 0;
    for (before, now) in flat.pixels().zip(inked.pixels()) {
        count += usize::from(*now == INK);
        assert!(*now == INK || now == before, "{before:?} -> {now:?}");
    }
    // The outlines of six shapes, and the edges of boxes.
    assert!((450..750).contains(&count), "{count}");
}

/// Truth: the picture of the mirrored scene is the mirrored picture.
#[test]
fn the_mirrored_scene_has_the_mirrored_picture() {
    // The same objects: the plates that touch have the same ids in both.
    let mut small = scene();
    let picture = small.outlined(Outlines::PIXELS);
    let world = small.world();
    let mut places = world.query_filtered::<&mut Transform, With<Object>>();
    for mut at in places.iter_mut(world) {
        let [x, y, z, w] = at.rotation.to_array();
        at.rotation = Quat::from_xyzw(x, -y, -z, w);
        at.translation.x = -at.translation.x;
    }
    small.cut();
    let mirrored = small.outlined(Outlines::PIXELS);
    assert!(picture != mirrored);
    let differ =
        |(x, y): &(u32, u32)| picture.get_pixel(*x, *y) != mirrored.get_pixel(SIZE.x - 1 - x, *y);
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    let off: Vec<_> = pixels.filter(differ).collect();
    assert!(off.is_empty(), "{off:?}");
}

/// Truth: a lone line has no block of 2 x 2 pixels of ink, whatever its direction, and all of its
/// pixels touch, at least at their corners.
#[test]
fn lone_lines_are_one_pixel_wide() {
    let mut small = towards_the_sky(SIZE);
    for turn in 0..8 {
        small.clear();
        let angle = FRAC_PI_4 * (turn as f32 + 0.37) / 4.0;
        let at = Transform::from_xyz(3.3, 1.2, -100.0);
        let at = at.with_rotation(Quat::from_rotation_z(angle));
        small.put(Rectangle::new(91.0, 47.0), unlit(Color::WHITE), at);
        let picture = small.outlined(Outlines::PIXELS);
        let ink = |x: i32, y: i32| is_ink(&picture, x as u32, y as u32);
        let inner =
            || (1..SIZE.y as i32 - 1).flat_map(|y| (1..SIZE.x as i32 - 1).map(move |x| (x, y)));
        for (x, y) in inner().filter(|(x, y)| ink(*x, *y)) {
            let block = ink(x + 1, y) && ink(x, y + 1) && ink(x + 1, y + 1);
            assert!(!block, "{angle}: a block at {x}, {y}");
            let around = (-1..2).flat_map(|dy| (-1..2).map(move |dx| (x + dx, y + dy)));
            let touching = around.filter(|(x, y)| ink(*x, *y)).count() - 1;
            assert!(touching >= 2, "{angle}: a loose end at {x}, {y}");
        }
    }
}

/// Truth: wider lines grow inwards by whole pixels.
#[test]
fn wide_lines_grow_inwards() {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-40.0, -30.0], [40.0, 30.0], 100.0);
    for (width, pixels) in [(1.0, 1), (1.4, 1), (2.0, 2), (3.0, 3), (8.0, 8)] {
        let picture = small.outlined(Outlines {
            width,
            ..Outlines::PIXELS
        });
        let row: Vec<u32> = (0..SIZE.x).filter(|x| is_ink(&picture, *x, 45)).collect();
        let want: Vec<u32> = (40..40 + pixels).chain(120 - pixels..120).collect();
        assert_eq!(row, want, "{width} px: a row");
        let column: Vec<u32> = (0..SIZE.y).filter(|y| is_ink(&picture, 80, *y)).collect();
        let want: Vec<u32> = (15..15 + pixels).chain(75 - pixels..75).collect();
        assert_eq!(column, want, "{width} px: a column");
    }
}

/// The pixels with lines along creases.
fn creases(small: &mut Small) -> Vec<(u32, u32)> {
    let picture = small.outlined(Outlines {
        silhouettes: None,
        objects: None,
        ..Outlines::PIXELS
    });
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    pixels.filter(|(x, y)| is_ink(&picture, *x, *y)).collect()
}

/// Truth: a line where nothing hides is on one side of the edge all along: the upper one, else the
/// one that faces the camera, and of two that face it alike the one to the right.
#[test]
fn creases_run_on_one_side() {
    let mut small = towards_the_sky(SIZE);
    let [x, y, z] = [
        Quat::from_rotation_x,
        Quat::from_rotation_y,
        Quat::from_rotation_z,
    ];
    // Of one edge between the visible sides of a cube: the axis of the normal of its owner.
    for (turned, axis) in [
        (z(0.3) * x(0.7), 1),
        (z(0.1) * y(0.5), 2),
        (z(-0.1) * y(-0.5), 2),
        (y(FRAC_PI_4), 0),
    ] {
        small.clear();
        let at = Transform::from_xyz(3.3, -4.2, -120.0).with_rotation(turned);
        small.put(Cuboid::from_length(50.0), unlit(Color::WHITE), at);
        let inked = creases(&mut small);
        assert!((40..60).contains(&inked.len()), "{axis}: {}", inked.len());
        let normals = small.normals().expect("normals").pixels;
        for (x, y) in inked {
            let normal = normals[(y * SIZE.x + x) as usize];
            assert!(normal[axis] > 0.6, "{x}, {y}: {normal:?}, {axis}");
        }
    }
}

/// A plate 0.25 pixels before a wall, as one mesh: its sides are not seen. Truth: all of its
/// outline is on the wall, beside the plate.
#[test]
fn lines_along_steps_run_behind() {
    let mut small = towards_the_sky(SIZE);
    let mut mesh: Mesh = Cuboid::new(200.0, 200.0, 5.0).into();
    let plate: Mesh = Cuboid::new(40.0, 30.0, 5.0).into();
    mesh.merge(&plate.translated_by(0.25 * Vec3::Z))
        .expect("the same attributes");
    let at = Transform::from_xyz(1.3, 0.6, -100.0).with_rotation(Quat::from_rotation_z(0.3));
    small.put(mesh, unlit(Color::WHITE), at);
    let inked = creases(&mut small);
    assert!((115..155).contains(&inked.len()), "{}", inked.len());
    for (x, y) in inked {
        let place = Vec2::new(x as f32 - 79.5, 44.5 - y as f32);
        let on_plate = at.rotation.inverse() * (place - at.translation.truncate()).extend(0.0);
        let [across, up] = on_plate.truncate().abs().to_array();
        let is_outside = across > 20.0 || up > 15.0;
        let is_beside = across < 21.5 && up < 16.5;
        assert!(is_outside && is_beside, "{x}, {y}: {on_plate}");
    }
}
