//! The smoothed range in an app: what resets it and what does not.

use bevy::camera::CameraProjection;

use crate::{
    prelude::*, range_views::assert_range_is_the_scan, small::Reshaped,
    upscaled::override_main_pass,
};

/// Slow enough to see, exact once it has arrived.
const SLOW: RangeSmoothing = RangeSmoothing {
    outliers: 0.0,
    despike: false,
    hysteresis: 0.07,
    expand: 5.0,
    shrink: 5.0,
};

fn look(smoothing: Option<RangeSmoothing>) -> ComicStyle {
    let map = DepthMap {
        smoothing,
        ..default()
    };
    with_map(ComicStyle::default().with(Colorization::default()), map)
}

fn small() -> Small {
    let mut small = Small::new(size(), Msaa::Off);
    small.style(&look(Some(SLOW))).settle();
    small
}

/// A wall close to the camera, in a corner of the view.
fn intrude(small: &mut Small) -> Entity {
    let at = Transform::from_xyz(1.0, 2.3, 4.9);
    small.put(Cuboid::from_length(0.3), unlit(Color::WHITE), at)
}

/// The picture after the range was reset.
fn unsmoothed(small: &mut Small) -> image::RgbaImage {
    let picture = small.shot(&look(None));
    small.style(&look(Some(SLOW)));
    picture
}

fn perspective(near: f32, fov: f32) -> Projection {
    Projection::Perspective(PerspectiveProjection {
        near,
        fov,
        ..default()
    })
}

#[test]
fn a_new_view_starts_with_its_own_range_and_then_lags() {
    let mut small = small();
    assert!(small.ran(ComicsStage::RangeSmoothing));
    let smoothed = small.picture();
    assert_eq!(smoothed, unsmoothed(&mut small));
    small.settle();
    intrude(&mut small);
    assert_ne!(small.settle().picture(), unsmoothed(&mut small), "it lags");
}

#[test]
fn a_cut_a_resize_and_another_near_plane_start_anew() {
    type Change = fn(&mut Small);
    let changes: [(&str, Change); 3] = [
        ("cut", Small::cut),
        ("resize", |small| {
            small.headless.resize(size() + UVec2::new(8, 4), 1.0);
            let target = small.headless.render_target();
            small.insert(target);
        }),
        ("projection", |small| {
            let fov = PerspectiveProjection::default().fov;
            small.insert(perspective(0.2, fov));
        }),
    ];
    for (name, change) in changes {
        let mut small = small();
        intrude(&mut small);
        small.settle();
        change(&mut small);
        let anew = small.settle().picture();
        assert_eq!(anew, unsmoothed(&mut small), "{name}");
    }
}

/// Games lower the resolution of the main pass while they run.
#[test]
fn another_resolution_does_not_start_anew() {
    let mut small = small();
    intrude(&mut small);
    small.headless.step(1);
    let scaled = |scale: f32| Some((size().as_vec2() * scale).as_uvec2());
    for scale in [0.7, 1.0, 0.7, 1.0] {
        override_main_pass(&mut small, scaled(scale));
        small.headless.step(1);
    }
    override_main_pass(&mut small, None);
    small.headless.step(1);
    assert!(small.picture() != unsmoothed(&mut small));
}

#[test]
fn zooming_does_not_start_anew() {
    let mut small = small();
    small.insert(perspective(PerspectiveProjection::default().near, 0.5));
    small.settle();
    intrude(&mut small);
    assert_ne!(small.settle().picture(), unsmoothed(&mut small));
}

/// A perspective projection whose near plane is a plane in view space, as mirrors and
/// portals use: normal into the view, and distance.
fn mirror(tilt: f32, distance: f32) -> Projection {
    Projection::custom(Reshaped {
        projection: PerspectiveProjection::default(),
        plane: Vec4::new(tilt, 0.0, -1.0, -distance),
        matrix: |p, plane| {
            let mut rows = p.get_clip_from_view().transpose();
            // 1 on the plane, and 0 or more at infinity inside of the view.
            rows.z_axis = rows.w_axis - plane / 1.6;
            rows.transpose()
        },
    })
}

#[test]
fn an_oblique_near_plane_that_moves_does_not_start_anew() {
    for moves in [false, true] {
        let mut small = Small::new(size(), Msaa::Off);
        small.insert(mirror(0.1, 0.2));
        small.style(&look(Some(SLOW))).settle();
        intrude(&mut small);
        for i in 0..5 {
            if moves {
                small.insert(mirror(0.1 + 0.01 * i as f32, 0.2 + 0.01 * i as f32));
            }
            small.headless.step(1);
        }
        let lagging = small.picture();
        assert_ne!(lagging, unsmoothed(&mut small), "it lags, {moves}");
    }
}

#[test]
fn a_lock_holds_the_range_until_it_is_taken_away() {
    let mut small = Small::new(size(), Msaa::Off);
    let lock = |small: &mut Small, locked| {
        let map = DepthMap {
            locked,
            smoothing: None,
            ..default()
        };
        small.shot(&with_map(look(None), map))
    };
    let background = |p: &image::RgbaImage| *p.get_pixel(3, 60);
    // Locked before the first range: it takes the first one.
    let first = lock(&mut small, true);
    let intruder = intrude(&mut small);
    let held = lock(&mut small, true);
    assert!(small.ran(ComicsStage::RangeSmoothing));
    assert_eq!(background(&held), background(&first));
    let free = lock(&mut small, false);
    assert!(!small.ran(ComicsStage::RangeSmoothing));
    assert_ne!(background(&free), background(&first));
    small.world().despawn(intruder);
    assert_eq!(small.settle().picture(), first);
}

#[test]
fn a_locked_range_is_no_older_than_the_planes_and_follows_a_cut_once_free() {
    let map = |locked| DepthMap {
        smoothing: Some(SLOW),
        locked,
        ..default()
    };
    let mut small = small();
    small.insert(map(true)).settle();
    // With another near plane the same raw depth is another distance, so the
    // locked range would be wrong.
    let fov = PerspectiveProjection::default().fov;
    small.insert(perspective(0.4, fov)).settle();
    let locked = small.picture();
    assert_eq!(locked, unsmoothed(&mut small));

    small.insert(map(true)).settle();
    intrude(&mut small);
    small.cut();
    let held = small.settle().picture();
    small.insert(map(false)).settle();
    let free = small.picture();
    assert_ne!(held, free, "a lock holds through a cut");
    assert_eq!(free, unsmoothed(&mut small), "and the cut is not forgotten");
}

#[test]
fn the_range_that_the_game_reads_is_the_exact_one() {
    let mut small = small();
    small.insert(VisibleDepthRange::default());
    intrude(&mut small);
    small.settle();
    assert_range_is_the_scan(&small, None, "a range that lags");
}

#[test]
fn wild_settings_are_clamped() {
    let mut small = Small::new(size(), Msaa::Off);
    let mut shoot = |style: &ComicStyle| {
        small.restart(Msaa::Off);
        small.style(style).settle();
        small.picture()
    };
    for wild in [f32::NAN, f32::INFINITY, -3.0, 1e30] {
        let style = look(Some(RangeSmoothing {
            outliers: wild,
            despike: true,
            hysteresis: wild,
            expand: wild,
            shrink: wild,
        }));
        let style = style.with(Contours::default());
        assert_eq!(shoot(&style), shoot(&style.sanitized()), "{wild}");
    }
}
