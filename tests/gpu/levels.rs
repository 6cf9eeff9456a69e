//! Levels of detail that fade into each other.

use bevy::camera::visibility::VisibilityRange;

use bevy_comics::testing::ObjectWork;

use crate::{prelude::*, small};

/// A sphere that is seen between two margins.
fn put_level(small: &mut Small, start_margin: Range<f32>, end_margin: Range<f32>, detail: u32) {
    let mesh = Sphere::new(1.0).mesh().ico(4 * detail).expect("a sphere");
    let sphere = small.put(mesh, unlit(Color::srgb(0.9, 0.5, 0.2)), Transform::IDENTITY);
    small.world().entity_mut(sphere).insert(VisibilityRange {
        start_margin,
        end_margin,
        use_aabb: false,
    });
}

fn away(distance: f32) -> Transform {
    Transform::from_xyz(0.0, 0.0, distance).looking_at(Vec3::ZERO, Vec3::Y)
}

/// The radius of the sphere in pixels of a picture of this height: the field of view of 45 degrees of the default.
fn radius_of(height: f32, distance: f32) -> f32 {
    height / 2.0 / std::f32::consts::FRAC_PI_8.tan() / (distance * distance - 1.0).sqrt()
}

/// Two spheres of other detail at one place, of which the near one fades into the far one between 8 and 12 units, and
/// the camera at this distance.
fn show(small: &mut Small, distance: f32) {
    small.clear();
    let margin = 8.0..12.0;
    put_level(small, 0.0..0.0, margin.clone(), 5);
    put_level(small, margin, 50.0..50.0, 3);
    small.insert(away(distance)).settle();
    small.settle();
}

/// Ink, of the length of the sphere's outline, and the pixels of ink well inside of it.
fn ink(small: &mut Small, distance: f32) -> (f32, usize) {
    show(small, distance);
    let picture = small.picture();
    let size = UVec2::new(picture.width(), picture.height()).as_vec2();
    let radius = radius_of(size.y, distance);
    let dark = picture
        .enumerate_pixels()
        .filter(|(.., pixel)| pixel.0[0] < 60);
    let (mut count, mut inside) = (0, 0);
    for (x, y, _) in dark {
        let from_center = (Vec2::new(x as f32, y as f32) + 0.5 - 0.5 * size).length();
        count += 1;
        inside += usize::from(from_center < 0.8 * radius);
    }
    (count as f32 / radius, inside)
}

/// While they fade, the outline is that of one sphere, with nothing inside; a picture without lines has no hole.
#[test]
fn levels_keep_their_outline_while_they_fade() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut small = Small::new(UVec2::new(192, 128), msaa);
        small.style(&ComicStyle::new().with(Outlines::default()));
        let whole: Vec<_> = [4.5, 16.0].map(|at| ink(&mut small, at)).to_vec();
        let expected = (whole[0].0 + whole[1].0) / 2.0;
        let (found, inside) = ink(&mut small, 10.0);
        assert!(expected > 5.0, "{expected}");
        assert!(
            (0.8..1.25).contains(&(found / expected)),
            "{msaa:?}: {found}, {expected}"
        );
        assert_eq!(inside, 0, "{msaa:?}");
    }
}

/// An effect that reads depth alone: without normals, the engine's prepass does not fade, and the main pass would leave
/// holes.
#[test]
fn there_are_no_holes_with_depth_alone() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Off);
    let background = Color::srgb(0.1, 0.2, 0.9);
    small.camera_settings().clear_color = background.into();
    small.style(&ComicStyle::new().with(Desaturation {
        amount: 0.01,
        ..default()
    }));
    show(&mut small, 10.0);
    let picture = small.picture();
    let blue = |x, y| {
        let [r, _, b, _] = picture.get_pixel(x, y).0;
        b > r
    };
    let holes = (90..102).flat_map(|x| (58..70).map(move |y| (x, y)));
    assert_eq!(holes.filter(|(x, y)| blue(*x, *y)).count(), 0);
    assert!(blue(4, 4));
}

/// Two cameras, each with a half of the picture.
fn split(small: &mut Small) -> [Entity; 2] {
    let target = small.headless.render_target();
    let second = small.world().spawn(small::camera(target, Msaa::Off)).id();
    let cameras = [small.camera, second];
    for (camera, order) in cameras.into_iter().zip(0_u8..) {
        let viewport = Viewport {
            physical_position: UVec2::new(96 * u32::from(order), 0),
            physical_size: UVec2::new(96, 128),
            ..default()
        };
        let settings = Camera {
            viewport: Some(viewport),
            order: order.into(),
            clear_color: if order == 0 {
                Color::srgb(0.3, 0.5, 0.8).into()
            } else {
                ClearColorConfig::None
            },
            ..default()
        };
        small.on(camera).insert(settings);
        let world = small.world();
        let style = ComicStyle::new().with(Outlines::default());
        style.apply(&mut world.commands().entity(camera));
        world.flush();
    }
    cameras
}

/// A mesh that fades to nothing has its whole outline until half of it is gone, and then none, in each view by its
/// own distance.
#[test]
fn what_fades_to_nothing_has_no_lines_in_the_end() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Off);
    small.clear();
    put_level(&mut small, 0.0..0.0, 8.0..12.0, 5);
    let cameras = split(&mut small);
    // Of both halves: ink, of the length of the outline, and the pixels that show the sphere.
    let mut drawn = |distances: [f32; 2]| {
        for (camera, distance) in cameras.into_iter().zip(distances) {
            small.on(camera).insert(away(distance));
        }
        small.settle();
        let picture = small.settle().picture();
        [0, 1].map(|half: u32| {
            let pixels = picture.enumerate_pixels().filter(|(x, ..)| x / 96 == half);
            let reds: Vec<_> = pixels.map(|(.., pixel)| pixel.0[0]).collect();
            let ink = reds.iter().filter(|red| **red < 60).count() as f32;
            let sphere = reds.iter().filter(|red| **red > 200).count();
            (ink / radius_of(128.0, distances[half as usize]), sphere)
        })
    };
    let [(whole, _), (half_gone, sphere)] = drawn([7.5, 10.4]);
    let [(fading, _), gone] = drawn([9.2, 12.5]);
    assert!(whole > 5.0, "{whole}");
    assert!(fading > 0.8 * whole, "{fading}, {whole}");
    assert!(sphere > 100, "{sphere}");
    assert_eq!(half_gone, 0.0);
    assert_eq!(gone, (0.0, 0));
}

/// A mesh that fades is queued by itself.
#[test]
fn a_fade_queues_only_its_own_levels() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    small.style(&ComicStyle::new().with(Outlines::default()));
    show(&mut small, 4.5);
    small::spawn_objects(small.world());
    small.settle();
    let queued = |small: &Small| ObjectWork::of(small.render_world()).queued;
    let before = queued(&small);
    small.insert(away(10.0)).settle();
    let fading = queued(&small);
    assert!((1..=4).contains(&(fading - before)), "{}", fading - before);
    small.insert(away(4.5)).settle();
    assert!(queued(&small) - fading <= 4);
}
