//! Extreme views: the picture is defined and finite. Extreme numbers (ratios of
//! near to far, narrow ranges, square roots at the ends) are tested in
//! `functions/`, extreme inputs of the range (denormal depth, odd sizes,
//! viewports, samples) in `range.rs`.

use crate::prelude::*;

/// An empty scene, seen from the origin.
fn bare(size: UVec2) -> Small {
    let mut small = Small::new(size, Msaa::Off);
    empty(&mut small);
    small
}

/// Starts over with an empty scene.
fn empty(small: &mut Small) {
    small.restart(Msaa::Off);
    small.clear();
    small.insert((Transform::IDENTITY, VisibleDepthRange::default()));
}

fn wall(small: &mut Small, size: f32, distance: f32, color: Color) {
    small.put(
        Rectangle::new(size, size),
        unlit(color),
        Transform::from_xyz(0.0, 0.0, -distance),
    );
}

fn full() -> ComicStyle {
    ComicStyle::default()
        .with(Desaturation {
            exponent: 0.5,
            ..default()
        })
        .with(Colorization::default())
        .with(Contours::default())
        .with(ToneBands::default())
        .with(Outlines::default())
}

fn assert_finite(small: &Small, what: &str) {
    let (_, output) = small.pass();
    assert!(
        output.pixels.iter().flatten().all(|c| c.is_finite()),
        "{what}: not finite"
    );
}

#[test]
fn a_flat_wall_keeps_its_colour_and_has_no_line() {
    let mut small = bare(UVec2::new(40, 30));
    for distance in [0.2f32, 3.0, 500.0, 90_000.0] {
        empty(&mut small);
        wall(
            &mut small,
            distance * 10.0,
            distance,
            Color::srgb(0.8, 0.3, 0.2),
        );
        small.settle();
        let original = small.picture();
        // Tone bands change flat colours by design.
        small.style(&full().without::<ToneBands>());
        small.settle();
        assert!(small.ran(ComicsStage::Stylize));
        // D = 0 everywhere: the picture stays constant and unchanged.
        let picture = small.picture();
        let first = *picture.get_pixel(0, 0);
        assert!(
            picture.pixels().all(|p| *p == first),
            "a wall at {distance} is not constant"
        );
        let same = (0..3).all(|i| first.0[i].abs_diff(original.get_pixel(0, 0).0[i]) <= 1);
        assert!(same, "a wall at {distance} changed its colour");
    }
}

#[test]
fn all_sky_takes_the_atmosphere_and_nothing_else() {
    let mut small = bare(UVec2::new(40, 30));
    small.style(&full());
    small.settle();
    assert_eq!(small.range(), Some(VisibleDepthRange::Empty));
    let picture = small.picture();
    let first = *picture.get_pixel(0, 0);
    assert!(picture.pixels().all(|p| *p == first));
    assert!(
        first.0[0] > first.0[2],
        "the default atmosphere is warm: {first:?}"
    );
    assert_finite(&small, "all sky");
}

#[test]
fn one_pixel_of_geometry_is_a_range_of_one_depth() {
    let mut small = bare(UVec2::new(41, 31));
    wall(&mut small, 0.1, 5.0, Color::WHITE);
    small.style(&full());
    small.settle();
    let Some((near, far)) = small.range().and_then(VisibleDepthRange::distances) else {
        panic!("nothing was seen");
    };
    assert_eq!(near, far);
    assert!((near - 5.0).abs() < 1e-4, "{near}");
    assert_finite(&small, "one pixel");
}

#[test]
fn a_target_of_one_pixel_is_styled() {
    let mut small = bare(UVec2::ONE);
    for size in [UVec2::ONE, UVec2::new(1, 9), UVec2::new(9, 1)] {
        small.headless.resize(size, 1.0);
        empty(&mut small);
        wall(&mut small, 30.0, 4.0, Color::srgb(0.2, 0.4, 0.9));
        small.style(&full());
        small.settle();
        assert!(
            small.ran(ComicsStage::Stylize) && small.ran(ComicsStage::DepthRange),
            "{size}"
        );
        assert_finite(&small, "one pixel of target");
    }
}

#[test]
fn a_range_of_depth_buffer_noise_does_not_become_a_pattern() {
    // Two walls whose distances differ by 1e-6: with the floor of 2^-14 they span
    // 1.7 % of the map, at most five codes of 255.
    let mut small = bare(UVec2::new(40, 30));
    wall(&mut small, 40.0, 5.0, Color::srgb(0.7, 0.2, 0.2));
    wall(&mut small, 2.0, 5.0 - 5e-6, Color::srgb(0.7, 0.2, 0.2));
    small.insert((
        Desaturation::default(),
        Colorization {
            mode: ColorizationMode::Linear,
            ..default()
        },
    ));
    small.settle();
    let picture = small.picture();
    let first = *picture.get_pixel(0, 0);
    let apart = picture
        .pixels()
        .map(|p| {
            (0..3)
                .map(|i| p.0[i].abs_diff(first.0[i]))
                .max()
                .unwrap_or(0)
        })
        .max();
    assert!(apart <= Some(5), "noise spans {apart:?} codes");
}

#[test]
fn greys_stay_grey_under_the_faithful_equations() {
    let mut small = bare(UVec2::new(60, 40));
    for (i, grey) in [0.1f32, 0.5, 0.9].into_iter().enumerate() {
        wall(
            &mut small,
            3.0,
            4.0 + 3.0 * i as f32,
            Color::srgb(grey, grey, grey),
        );
    }
    small.insert(Camera {
        clear_color: Color::srgb(0.3, 0.3, 0.3).into(),
        ..default()
    });
    for mode in [
        ColorizationMode::Atmosphere,
        ColorizationMode::Linear,
        ColorizationMode::Quadratic,
    ] {
        small
            .insert((
                Desaturation::QUADRATIC,
                Colorization {
                    mode,
                    equations: Equations::Faithful,
                    ..default()
                },
            ))
            .settle();
        let picture = small.picture();
        assert!(
            picture
                .pixels()
                .all(|p| p.0[0] == p.0[1] && p.0[1] == p.0[2]),
            "{mode:?} tinted a grey"
        );
    }
}

#[test]
fn bright_light_grows_with_its_gain() {
    let mut last = 0.0f32;
    let mut small = bare(UVec2::new(16, 12));
    for gain in [0.5f32, 1.0, 4.0, 100.0, 10_000.0, 65_504.0] {
        empty(&mut small);
        small.insert(Hdr);
        wall(
            &mut small,
            30.0,
            4.0,
            Color::linear_rgb(gain, 0.4 * gain, 0.1 * gain),
        );
        wall(&mut small, 1.0, 2.0, Color::WHITE);
        small.style(&full());
        small.settle();
        let (_, output) = small.pass();
        let red = output.pixels[0][0];
        assert!(
            red.is_finite() && red >= last,
            "gain {gain}: {red} after {last}"
        );
        last = red;
    }
}

#[test]
fn a_transparent_surface_is_coloured_by_the_depth_behind_it() {
    // A red pane close to the camera, in front of a far wall: it is coloured by
    // the depth of the wall.
    let mut small = bare(UVec2::new(60, 40));
    wall(&mut small, 400.0, 100.0, Color::srgb(0.5, 0.5, 0.5));
    wall(&mut small, 0.4, 1.0, Color::srgb(0.5, 0.5, 0.5));
    wall(&mut small, 0.5, 0.9, Color::srgba(0.9, 0.1, 0.1, 0.5));
    let panes: Vec<_> = {
        let world = small.world();
        let mut query = world.query::<(&MeshMaterial3d<StandardMaterial>, &Transform)>();
        query
            .iter(world)
            .filter(|(_, at)| at.translation.z == -0.9)
            .map(|(m, _)| m.0.clone())
            .collect()
    };
    for pane in panes {
        let mut assets = small.world().resource_mut::<Assets<StandardMaterial>>();
        assets.get_mut(&pane).expect("the pane").alpha_mode = AlphaMode::Blend;
    }
    small
        .insert((Desaturation::default(), DepthMap::default()))
        .settle();
    let picture = small.picture();
    let saturation = |x: u32, y: u32| {
        let p = picture.get_pixel(x, y).0;
        p[..3].iter().max().copied().unwrap_or(0) - p[..3].iter().min().copied().unwrap_or(0)
    };
    // In front of the near wall the pane keeps its red; beside that wall the depth
    // of the far wall colours it.
    let row: Vec<u8> = (0..60).map(|x| saturation(x, 20)).collect();
    assert!(row[30] > 60, "before the near wall: {row:?}");
    assert!(
        row.iter().filter(|s| **s > 20).count() < 24,
        "the pane kept its colour before the far wall: {row:?}"
    );
}
