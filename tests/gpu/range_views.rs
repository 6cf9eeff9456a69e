//! The depth range of rendered views, as the game reads it.

use bevy::camera::Projection;
use bevy_comics_testkit::{headless, reference::range};

use crate::{prelude::*, small::Reshaped};

/// Fails unless the game reads the range of a scan of the depth texture.
pub fn assert_range_is_the_scan(small: &Small, rect: Option<[u32; 4]>, what: &str) {
    let depth = small.depth().unwrap_or_else(|| panic!("{what}: no depth"));
    let [x, y, w, h] = rect.unwrap_or([0, 0, depth.width, depth.height]);
    let pixels = (y..y + h).flat_map(|y| (x..x + w).map(move |x| (x, y)));
    let samples = |(x, y)| (0..depth.samples).map(move |s| (x, y, s));
    let scan = range::scan(pixels.flat_map(samples).map(|(x, y, s)| depth.at(x, y, s)));
    let found = match small.range() {
        Some(VisibleDepthRange::Visible {
            raw_nearest,
            raw_farthest,
            ..
        }) => Some([raw_nearest.to_bits(), raw_farthest.to_bits()]),
        Some(VisibleDepthRange::Empty) => None,
        unknown => panic!("{what}: {unknown:?}"),
    };
    assert_eq!(found, scan, "{what}");
}

/// The range that the game reads, and the picture, which follows percentiles within the outermost
/// bins: they are clamped to the extremes.
#[test]
fn every_method_reads_every_sample_of_a_rendered_view() {
    let samples = headless::adapter().expect("an adapter").samples;
    let mut small = Small::new(UVec2::new(71, 53), Msaa::Off);
    for samples in samples {
        small.restart(Msaa::from_samples(samples));
        small.insert((Colorization::default(), VisibleDepthRange::default()));
        let mut drawn = |map: DepthMap| {
            small.insert(map).settle();
            let what = format!("{:?}, {samples} samples", map.reduction);
            assert!(small.ran(ComicsStage::DepthRange), "{what}");
            assert_range_is_the_scan(&small, None, &what);
            let smooths = small.ran(ComicsStage::RangeSmoothing);
            assert_eq!(smooths, map.smoothing.is_some(), "{what}");
            small.picture()
        };
        let plain = drawn(DepthMap {
            smoothing: None,
            ..default()
        });
        for reduction in [
            ReductionMethod::Auto,
            ReductionMethod::BarrierFree,
            ReductionMethod::Subgroup,
            ReductionMethod::SharedMemory,
            ReductionMethod::PingPong,
        ] {
            let smoothing = Some(RangeSmoothing {
                outliers: 1e-7,
                ..default()
            });
            let smoothed = drawn(DepthMap {
                reduction,
                smoothing,
                ..default()
            });
            assert!(smoothed == plain, "{reduction:?}, {samples} samples");
        }
    }
}

fn oblique(clip: Mat4) -> Mat4 {
    let mut rows = clip.transpose();
    rows.z_axis.y = 0.02;
    rows.transpose()
}

/// A projection with an oblique near plane, as mirrors use.
#[derive(Clone, Debug)]
pub struct Tilted(pub PerspectiveProjection);

impl bevy::camera::CameraProjection for Tilted {
    fn get_clip_from_view(&self) -> Mat4 {
        oblique(self.0.get_clip_from_view())
    }
    fn get_clip_from_view_for_sub(&self, view: &bevy::camera::SubCameraView) -> Mat4 {
        oblique(self.0.get_clip_from_view_for_sub(view))
    }
    fn update(&mut self, width: f32, height: f32) {
        self.0.update(width, height);
    }
    fn far(&self) -> f32 {
        self.0.far
    }
    fn get_frustum_corners(&self, near: f32, far: f32) -> [Vec3A; 8] {
        self.0.get_frustum_corners(near, far)
    }
}

/// A perspective projection with a far plane; the engine's has none.
pub fn finite(projection: PerspectiveProjection) -> Projection {
    Projection::custom(Reshaped {
        projection,
        plane: Vec4::ZERO,
        matrix: |p, _| Mat4::perspective_rh(p.fov, p.aspect_ratio, p.far, p.near),
    })
}

/// Distances are those of the geometry, under every projection.
#[test]
fn distances_are_right_under_every_projection() {
    let ortho = OrthographicProjection {
        near: -5.0,
        far: 60.0,
        scaling_mode: ScalingMode::FixedVertical {
            viewport_height: 6.0,
        },
        ..OrthographicProjection::default_3d()
    };
    let perspective = PerspectiveProjection {
        near: 0.1,
        far: 40.0,
        ..default()
    };
    let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
    for (name, projection) in [
        ("perspective", Projection::Perspective(perspective.clone())),
        ("orthographic", Projection::Orthographic(ortho)),
        ("finite", finite(perspective.clone())),
        ("oblique", Projection::custom(Tilted(perspective))),
    ] {
        small.restart(Msaa::Off);
        // Only a wall across the view, at distance 7.
        small.clear();
        small.put(
            Rectangle::new(200.0, 200.0),
            Color::WHITE.into(),
            Transform::from_xyz(0.0, 0.0, -7.0),
        );
        small
            .insert((
                projection,
                Transform::IDENTITY,
                VisibleDepthRange::default(),
            ))
            .settle();
        let Some((near, far)) = small.range().and_then(VisibleDepthRange::distances) else {
            panic!("{name}: {:?}", small.range());
        };
        // Depth is interpolated in single precision between corners that are
        // 100 units away.
        for distance in [near, far] {
            assert!((distance - 7.0).abs() < 2e-3, "{name}: {near} to {far}");
        }
        if name != "oblique" {
            assert_range_is_the_scan(&small, None, name);
        }
    }
}

/// Depth outside the viewport of the camera does not count.
#[test]
fn the_range_stays_inside_the_viewport() {
    let mut small = Small::new(UVec2::new(90, 60), Msaa::Off);
    small.insert((
        Camera {
            viewport: Some(Viewport {
                physical_position: UVec2::new(13, 7),
                physical_size: UVec2::new(41, 37),
                ..default()
            }),
            ..default()
        },
        VisibleDepthRange::default(),
    ));
    small.settle();
    assert_range_is_the_scan(&small, Some([13, 7, 41, 37]), "viewport");
}

/// Nothing that writes depth is in view.
#[test]
fn an_empty_and_a_transparent_view_have_an_empty_range_and_a_defined_picture() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Sample4);
    // Eight bits are always finite.
    small.insert((Hdr, VisibleDepthRange::default()));
    small.insert((Contours::default(), Desaturation::default()));
    small.settle();
    assert!(matches!(
        small.range(),
        Some(VisibleDepthRange::Visible { .. })
    ));
    let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
    for (_, material) in materials.iter_mut() {
        material.alpha_mode = AlphaMode::Blend;
    }
    small.settle();
    assert_eq!(
        small.range(),
        Some(VisibleDepthRange::Empty),
        "transparent things have no depth"
    );
    assert!(small.ran(ComicsStage::Stylize));
    let (_, output) = small.pass();
    assert!(output.pixels.iter().flatten().all(|c| c.is_finite()));
}

/// The slope of the depth map where there is nothing: no ink, and no NaN.
#[test]
fn the_sky_has_no_slope() {
    let flats = BlackFlats {
        slope: Some(0.02),
        value: None,
        ..default()
    };
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    small.clear();
    for mapping in [
        DepthMapping::MinMax,
        DepthMapping::MinMaxLogarithmic,
        DepthMapping::Fixed {
            from: 1.0,
            to: 1e36,
        },
    ] {
        for (name, projection) in [
            ("infinite", Projection::default()),
            ("finite", finite(PerspectiveProjection::default())),
        ] {
            let map = DepthMap {
                mapping,
                ..default()
            };
            small.insert((flats, map, projection)).settle();
            assert!(small.ran(ComicsStage::Stylize), "{mapping:?}, {name}");
            let (input, output) = small.pass();
            assert_eq!(input, output, "{mapping:?}, {name}");
        }
    }
}
