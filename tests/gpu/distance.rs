//! What counts as distance: skies that are meshes, the far plane, and the resolution.

use bevy::camera::Projection;
use bevy_comics::{cameras::BeyondPrepass, objects::Backdrop};

use crate::prelude::*;

/// A sky around the small scene, with the color of its background.
fn dome(small: &mut Small) -> Entity {
    let material = StandardMaterial {
        cull_mode: None,
        ..unlit(Color::srgb(0.3, 0.5, 0.8))
    };
    small.put(
        Sphere::new(200.0).mesh().uv(24, 16),
        material,
        Transform::IDENTITY,
    )
}

/// Lines and colors by distance.
fn style() -> ComicStyle {
    ComicStyle::new()
        .with(Desaturation {
            amount: 1.0,
            ..default()
        })
        .with(Outlines::default())
}

/// With a dome that is a backdrop, or beyond the distance where the sky begins, the range is that
/// without the dome, bit for bit, and so is the picture; taken off, it counts again.
#[test]
fn a_sky_dome_is_sky() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut small = Small::new(size(), msaa);
        small.insert(VisibleDepthRange::default());
        // Smoothed, it would take some seconds until the range has come back.
        let map = DepthMap {
            smoothing: None,
            ..default()
        };
        small.insert(map);
        small.style(&style()).settle();
        let (range, picture) = (small.range(), small.picture());
        let dome = dome(&mut small);
        // Two of its parts have other ids.
        let cloud = Transform::from_xyz(10.0, 30.0, -150.0).with_scale(Vec3::splat(20.0));
        let blue = unlit(Color::srgb(0.3, 0.5, 0.8));
        let cloud = small.put(Cuboid::default(), blue, cloud);
        small.settle();
        assert_ne!(small.range(), range, "the dome stretches the range");
        assert!(apart(&small.picture(), &picture) > 1);
        for sky in [dome, cloud] {
            small.world().entity_mut(sky).insert(Backdrop::default());
        }
        small.settle();
        small.settle();
        assert_eq!(small.range(), range, "{msaa:?}");
        assert!(apart(&small.picture(), &picture) <= 1, "{msaa:?}");
        for sky in [dome, cloud] {
            small.world().entity_mut(sky).remove::<Backdrop>();
        }
        if msaa == Msaa::Off {
            small.settle();
            small.settle();
            assert_ne!(small.range(), range, "it counts again");
        }
        small.insert(DepthMap {
            sky_beyond: Some(100.0),
            ..map
        });
        small.settle();
        small.settle();
        assert_eq!(small.range(), range, "{msaa:?}");
        assert!(apart(&small.picture(), &picture) <= 1, "{msaa:?}");
    }
}

/// The dome is not in the prepass, but it is no foreign surface.
#[test]
fn a_backdrop_is_styled_as_the_sky() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Off);
    let dome = dome(&mut small);
    small.world().entity_mut(dome).insert(Backdrop::default());
    let styled = small.shot(&style());
    small.insert(BeyondPrepass::Plain);
    assert!(small.settle().picture() == styled);
}

/// Ink of a white square before a black sky, seen in parallel at a fraction of the distance of the far plane.
fn ink_at(small: &mut Small, fraction: f32) -> u64 {
    let far = 100.0;
    small.clear();
    let at = Transform::from_xyz(0.0, 0.0, -fraction * far);
    small.put(Rectangle::new(10.0, 10.0), unlit(Color::WHITE), at);
    let projection = OrthographicProjection {
        near: 0.0,
        far,
        scaling_mode: ScalingMode::FixedVertical {
            viewport_height: 20.0,
        },
        ..OrthographicProjection::default_3d()
    };
    small.insert((Transform::IDENTITY, Projection::Orthographic(projection)));
    let picture = small.settle().picture();
    let dark = |pixel: &image::Rgba<u8>| u64::from(255 - pixel.0[0]);
    let row = picture.height() / 2;
    (0..picture.width())
        .map(|x| dark(picture.get_pixel(x, row)))
        .sum()
}

/// A surface right before the far plane of an orthographic view has the outline that it has in its middle: the sky
/// is no surface at that plane.
#[test]
fn the_sky_is_no_surface_at_the_far_plane() {
    let mut small = Small::new(size(), Msaa::Off);
    let clear = Camera {
        clear_color: Color::WHITE.into(),
        ..default()
    };
    small.insert(clear);
    // Edges between objects would be there in any case.
    let outlines = Outlines {
        creases: None,
        objects: None,
        ..default()
    };
    small.style(&ComicStyle::new().with(outlines));
    let [middle, end] = [0.5, 0.999].map(|fraction| ink_at(&mut small, fraction));
    assert!(middle > 500, "{middle}");
    assert_eq!(middle, end);
}
