//! Tones of the picture by depth.

use bevy_comics_testkit::{reference::tone_ramp, studio::set_style};

use crate::{pictures::check, prelude::*, ramp::room};

fn gray_wall(small: &mut Small, light: f32) -> Entity {
    let wall = Plane3d::new(Vec3::Z, Vec2::splat(9.0)).mesh().build();
    let material = unlit(Color::linear_rgb(light, light, light));
    small.put(wall, material, Transform::IDENTITY)
}

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
        mapping: DepthMapping::Fixed { from: 1.0, to: 9.0 },
        ..DepthMap::default()
    };
    small.style(&ComicStyle::new().with(ramp));
    small.insert(map);
    let gray = 0.2;
    let wall = gray_wall(&mut small, gray);
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
}

/// Whole pictures, pixel by pixel: by themselves, with the depth map turned round, and with effects
/// that follow.
#[test]
fn pictures_in_tones_match_the_reference() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    let hard = ToneRamp {
        distant_softness: 0.0,
        keep_color: 0.4,
        focus: 0.3,
        reach: 0.5,
        ..ToneRamp::default()
    };
    let partial = ToneRamp {
        softness: 0.3,
        amount: 0.6,
        ..ToneRamp::default()
    };
    let flipped = DepthMap {
        flip: true,
        ..DepthMap::default()
    };
    let style = |ramp: ToneRamp| ComicStyle::new().with(ramp);
    let default = style(ToneRamp::default());
    let bands = default.clone().with(ToneBands::default());
    let cases = [
        ("tones", default.clone()),
        ("hard tones", style(hard)),
        ("some of the tones", style(partial)),
        ("tones, turned round", with_map(default, flipped)),
        (
            "tones, then bands and grays",
            bands.with(Desaturation::default()),
        ),
    ];
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let cases = cases.clone().into_iter();
        check(
            &mut small,
            None,
            cases.map(|(name, style)| (format!("{name}, {msaa:?}"), style)),
        );
    }
}

/// The spread of a flat wall whose lightness is where a tone begins, in codes.
fn spread_at_an_edge(small: &mut Small, ramp: ToneRamp, dither: DebandDither) -> u8 {
    small.clear();
    let style = ComicStyle::new().with(ramp);
    let camera = small.camera;
    set_style(&mut small.world().commands().entity(camera), &style);
    small.world().flush();
    let worn = small.headless.app.world().get::<DebandDither>(camera);
    assert_eq!(worn, Some(&DebandDither::Disabled));
    small.insert((dither, Tonemapping::Reinhard));
    // After this tonemapping, the square of the place.
    let at = ramp.middle_at * ramp.middle_at;
    let gray = at / (1.0 - at);
    gray_wall(small, gray);
    small.headless.step(6);
    let picture = small.picture();
    let reds = || picture.pixels().map(|p| p.0[0]);
    reds().max().expect("pixels") - reds().min().expect("pixels")
}

/// The dither of a flat area speckles at a hard edge, which is why cameras switch it off; without
/// it, or at a soft edge, the area is flat.
#[test]
fn flat_areas_at_an_edge_have_no_speckles() {
    let hard = ToneRamp {
        keep_color: 0.0,
        distant_softness: 0.0,
        distant_dark: ToneRamp::default().dark,
        distant_middle: ToneRamp::default().middle,
        ..ToneRamp::default()
    };
    let soft = ToneRamp {
        softness: 1.0,
        distant_softness: 1.0,
        ..hard
    };
    let mut small = room(UVec2::splat(64), 0.0);
    let mut spread = |ramp, dither| spread_at_an_edge(&mut small, ramp, dither);
    assert!(spread(hard, DebandDither::Enabled) > 8);
    assert_eq!(spread(hard, DebandDither::Disabled), 0);
    assert!(spread(soft, DebandDither::Enabled) <= 2);
}
