//! Tones of the picture by depth.

use bevy::prelude::*;
use bevy_comics::{ComicStyle, DepthMap, DepthMapping, ToneRamp};
use bevy_comics_testkit::reference::tone_ramp;

use crate::{ramp::room, small::linear};

/// Unlit walls at several distances have the tones that the map says.
#[test]
fn tones_change_with_the_distance() {
    let mut small = room(UVec2::splat(64), 0.0);
    small.insert(Transform::IDENTITY);
    let ramp = ToneRamp {
        keep_color: 0.0,
        ..ToneRamp::default()
    };
    let map = DepthMap {
        mapping: DepthMapping::Fixed {
            near: 1.0,
            far: 9.0,
        },
        ..DepthMap::default()
    };
    small.style(&ComicStyle::new().with(ramp));
    small.insert(map);
    let gray = 0.2;
    let material = StandardMaterial {
        base_color: Color::linear_rgb(gray, gray, gray),
        unlit: true,
        ..default()
    };
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
    let wall = small.put(wall, material, Transform::IDENTITY);
    let mut all = vec![];
    for z in [1.0f32, 3.0, 5.0, 7.0, 9.0] {
        let at = Transform::from_xyz(0.0, 0.0, -z);
        small.world().entity_mut(wall).insert(at);
        small.headless.step(6);
        let picture = small.picture();
        let detail = 1.0 - f64::from((z - 1.0) / 8.0);
        let wanted = tone_ramp::toned(&ramp, [f64::from(gray); 3], 0.0, detail);
        let found = linear(&picture, 32, 32);
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!((found - wanted).abs() < 0.015, "{z}: {found}, not {wanted}");
        }
        all.push(found[0]);
    }
    assert!(all.is_sorted(), "{all:?}");
    assert_eq!(small.errors(), 0);
}
