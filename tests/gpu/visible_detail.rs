//! Detail of ramps by the visible range: `view_range.wgsl` and `visible.wgsl` in pictures.

use bevy_comics_testkit::reference::detail;
use image::RgbaImage;

use crate::{
    prelude::*,
    ramp::{bright, drawn, room, set_light, sun},
    ramp_detail::{off, two_tones},
    range_views::{Tilted, finite},
};

const SIZE: UVec2 = UVec2::new(96, 32);

fn light(axis: DetailAxis) -> ToonLight {
    two_tones(axis, RampMode::LightFraction)
}

fn material(small: &mut Small, alpha_mode: AlphaMode) -> MeshMaterial3d<ToonMaterial> {
    let extension = light(DetailAxis::VisibleRange);
    let base = StandardMaterial {
        perceptual_roughness: 1.0,
        alpha_mode,
        ..default()
    };
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    MeshMaterial3d(materials.add(ToonMaterial { base, extension }))
}

/// Where a wall is: in the left, middle or right third of the view (-1, 0, 1), and how far away.
type Place = (f32, f32);

/// A wall that fills most of a third of a view that is `spread` wide there.
fn wall(small: &mut Small, (third, z): Place, spread: f32, alpha_mode: AlphaMode) -> Entity {
    let material = material(small, alpha_mode);
    let at = Transform::from_xyz(third * spread, 0.0, -z).with_scale(Vec3::splat(spread));
    small.put_shared(Rectangle::new(0.9, 0.9), material, at)
}

/// Opaque walls in perspective.
fn walls<const N: usize>(small: &mut Small, places: [Place; N]) -> [Entity; N] {
    places.map(|place| wall(small, place, spread(place.1), AlphaMode::Opaque))
}

/// The width of a third of a perspective view at a distance.
fn spread(z: f32) -> f32 {
    2.0 * std::f32::consts::FRAC_PI_8.tan() * z
}

/// An empty room with a camera in its origin that looks along -Z.
fn hall(projection: Projection) -> Small {
    let mut small = room(SIZE, 0.0);
    small.insert((
        Transform::IDENTITY,
        projection,
        VisibleDepthRange::default(),
    ));
    sun(&mut small, Vec3::Z, bright(1.0));
    small
}

fn wanted(z: f32, near: f32, far: f32) -> f64 {
    let [z, near, far] = [z, near, far].map(f64::from);
    detail::in_range(z, near, far)
}

/// The pixel in the middle of a third.
fn x_of(third: f32) -> u32 {
    (48.0 + 32.0 * third) as u32
}

fn projections(scale: f32) -> [(&'static str, Projection); 4] {
    let perspective = PerspectiveProjection {
        near: 0.1 * scale,
        far: 100.0 * scale,
        ..default()
    };
    let orthographic = OrthographicProjection {
        near: 0.0,
        far: 100.0 * scale,
        scaling_mode: ScalingMode::FixedVertical {
            viewport_height: scale,
        },
        ..OrthographicProjection::default_3d()
    };
    [
        ("infinite", Projection::Perspective(perspective.clone())),
        ("finite", finite(perspective.clone())),
        ("oblique", Projection::custom(Tilted(perspective))),
        ("orthographic", Projection::Orthographic(orthographic)),
    ]
}

/// Truth: detail is the formula in distances, whatever the projection and the unit of the world.
/// Both ends are exact, and what is farther away never has more of it.
#[test]
fn detail_spans_the_visible_range_under_every_projection() {
    assert_detail_spans(&[1.0], &[2.0, 4.0, 24.0, 50.0]);
}

#[test]
#[ignore = "long: two units of the world, and more distances"]
fn detail_spans_the_visible_range_in_every_unit() {
    assert_detail_spans(&[1.0, 1000.0], &[2.0, 2.5, 4.0, 10.0, 24.0, 45.0, 50.0]);
}

fn assert_detail_spans(scales: &[f32], distances: &[f32]) {
    let (near, far) = (2.0f32, 50.0f32);
    let mut small = hall(Projection::default());
    small.insert(DepthMap {
        smoothing: None,
        ..default()
    });
    for &scale in scales {
        for (name, projection) in projections(scale) {
            small.insert(projection);
            let spread = |z: f32| match name {
                "orthographic" => scale,
                _ => spread(z * scale),
            };
            let put = |small: &mut Small, third: f32, z: f32| {
                wall(small, (third, z * scale), spread(z), AlphaMode::Opaque)
            };
            let ends = [(-1.0, near), (1.0, far)].map(|(third, z)| put(&mut small, third, z));
            let mut last = f64::INFINITY;
            for &z in distances {
                let middle = put(&mut small, 0.0, z);
                let picture = drawn(&mut small);
                let detail = wanted(z, near, far);
                let wrong = off(&picture, 48, 16, detail);
                assert!(
                    wrong < 2.0,
                    "{name}, {z} of {scale}: {wrong} codes from {detail}"
                );
                let red = linear(&picture, 48, 16)[0];
                assert!(red <= last, "{name}, {z}: {red} after {last}");
                last = red;
                ends_are_exact(&picture, name);
                small.world().despawn(middle);
            }
            for end in ends {
                small.world().despawn(end);
            }
        }
    }
}

fn ends_are_exact(picture: &RgbaImage, name: &str) {
    for (third, detail) in [(-1.0, 1.0), (1.0, 0.0)] {
        // Half a code of rounding.
        let wrong = off(picture, x_of(third), 16, detail);
        assert!(wrong < 1.0, "{name}: {wrong} codes at {detail}");
    }
}

/// Both ends are the pictures of a constant detail, bit for bit.
#[test]
fn both_ends_are_the_ramps_themselves() {
    let mut small = hall(projections(1.0)[0].1.clone());
    walls(&mut small, [(-1.0, 2.0), (0.0, 9.0), (1.0, 50.0)]);
    let found = drawn(&mut small);
    for (third, detail) in [(-1.0, 1.0), (1.0, 0.0)] {
        set_light(&mut small, &light(DetailAxis::Constant(detail)));
        let constant = drawn(&mut small);
        let at = |picture: &RgbaImage| *picture.get_pixel(x_of(third), 16);
        assert_eq!(at(&found), at(&constant), "{detail}");
    }
}

/// The range is the one that the depth map spans: a locked one stays while things move.
#[test]
fn a_locked_range_is_kept() {
    let mut small = hall(projections(1.0)[0].1.clone());
    let [_, _, far] = walls(&mut small, [(-1.0, 2.0), (0.0, 8.0), (1.0, 32.0)]);
    small.insert(DepthMap {
        locked: true,
        ..default()
    });
    let detail = |small: &mut Small, wanted: f64| {
        let picture = drawn(small);
        let wrong = off(&picture, 48, 16, wanted);
        assert!(wrong < 2.0, "{wrong} codes from {wanted}");
    };
    detail(&mut small, 0.5);
    small.world().despawn(far);
    walls(&mut small, [(1.0, 512.0)]);
    detail(&mut small, 0.5);
    small.insert(DepthMap {
        smoothing: None,
        ..default()
    });
    detail(&mut small, wanted(8.0, 2.0, 512.0));
}

/// There is all detail without a component that asks for depth, and where nothing has written
/// depth.
#[test]
fn without_a_range_there_is_all_detail() {
    let mut small = hall(projections(1.0)[0].1.clone());
    for alpha_mode in [AlphaMode::Blend, AlphaMode::Opaque] {
        let walls = [(-1.0, 2.0), (0.0, 9.0), (1.0, 50.0)]
            .map(|place| wall(&mut small, place, spread(place.1), alpha_mode));
        if alpha_mode == AlphaMode::Opaque {
            let styled = drawn(&mut small);
            assert!(off(&styled, x_of(1.0), 16, 0.0) < 1.0);
            small.camera_mut().remove::<VisibleDepthRange>();
        }
        let picture = drawn(&mut small);
        for third in [-1.0, 0.0, 1.0] {
            let wrong = off(&picture, x_of(third), 16, 1.0);
            assert!(wrong < 1.0, "{alpha_mode:?}, {third}: {wrong}");
        }
        for wall in walls {
            small.world().despawn(wall);
        }
    }
}

/// Each of two cameras has its own range, in one frame and with the same materials.
#[test]
fn every_view_has_its_own_range() {
    let projection = projections(1.0)[0].1.clone();
    let mut small = hall(projection.clone());
    let half = |left: u32| Viewport {
        physical_position: UVec2::new(left, 0),
        physical_size: UVec2::new(48, 32),
        ..default()
    };
    let lens = |left: u32, order| Camera {
        viewport: Some(half(left)),
        order,
        clear_color: if order == 0 {
            Color::BLACK.into()
        } else {
            ClearColorConfig::None
        },
        ..default()
    };
    small.insert(lens(0, 0));
    let target = small.headless.render_target();
    let other = (crate::small::camera(target, Msaa::Off), Exposure::default());
    let other = small.world().spawn(other).id();
    // It looks the other way.
    small.world().entity_mut(other).insert((
        Transform::IDENTITY.looking_to(Vec3::Z, Vec3::Y),
        projection,
        VisibleDepthRange::default(),
        lens(48, 1),
    ));
    // In front of the first camera: 2 and 8 units away; of the other one, 8 and 16.
    for (z, x, far) in [
        (-2.0f32, -0.6, 0.0f32),
        (-8.0, 3.0, 0.0),
        (8.0, 3.0, 1.0),
        (16.0, -4.0, 1.0),
    ] {
        let at = Transform::from_xyz(x, 0.0, z)
            .with_scale(Vec3::splat(z.abs()))
            .with_rotation(Quat::from_rotation_y(far * std::f32::consts::PI));
        let material = material(&mut small, AlphaMode::Opaque);
        small.put_shared(Rectangle::new(0.5, 0.8), material, at);
    }
    let picture = drawn(&mut small);
    let of = |x: u32, detail: f64| off(&picture, x, 16, detail);
    // 8 units are the far end for one camera, and the near end for the other one.
    let found = [of(12, 1.0), of(38, 0.0), of(58, 1.0), of(82, 0.0)];
    assert!(found.iter().all(|wrong| *wrong < 1.0), "{found:?}");
}
