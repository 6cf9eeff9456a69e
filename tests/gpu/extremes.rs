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

/// A square in the middle of the view.
fn wall(small: &mut Small, size: f32, distance: f32, material: StandardMaterial) {
    let at = Transform::from_xyz(0.0, 0.0, -distance);
    small.put(Rectangle::new(size, size), material, at);
}

/// The largest difference of a pixel from the first one, in codes.
fn spread(picture: &image::RgbaImage) -> u8 {
    let first = picture.get_pixel(0, 0).0;
    let apart = |p: &image::Rgba<u8>| (0..3).map(|i| p.0[i].abs_diff(first[i])).max();
    picture.pixels().filter_map(apart).max().unwrap_or(0)
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

/// D = 0 everywhere. Tone bands change flat colors by design.
#[test]
fn a_flat_wall_keeps_its_color_and_has_no_line() {
    let mut small = bare(UVec2::new(40, 30));
    for distance in [0.2f32, 3.0, 500.0, 90_000.0] {
        empty(&mut small);
        let color = unlit(Color::srgb(0.8, 0.3, 0.2));
        wall(&mut small, distance * 10.0, distance, color);
        let original = small.shot(&ComicStyle::new());
        let picture = small.shot(&full().without::<ToneBands>());
        assert!(small.ran(ComicsStage::Stylize));
        assert_eq!(spread(&picture), 0, "a wall at {distance}");
        let [found, before] = [&picture, &original].map(|picture| picture.get_pixel(0, 0).0);
        let same = (0..3).all(|i| found[i].abs_diff(before[i]) <= 1);
        assert!(same, "a wall at {distance} changed its color");
    }
}

#[test]
fn all_sky_takes_the_atmosphere_and_nothing_else() {
    let mut small = bare(UVec2::new(40, 30));
    let picture = small.shot(&full());
    assert_eq!(small.range(), Some(VisibleDepthRange::Empty));
    assert_eq!(spread(&picture), 0);
    let first = picture.get_pixel(0, 0).0;
    assert!(first[0] > first[2], "the atmosphere is warm: {first:?}");
}

/// Two walls whose distances differ by 1e-6: with the floor of 2^-14 they span 1.7 % of the map, at
/// most five codes of 255.
#[test]
fn a_range_of_depth_buffer_noise_does_not_become_a_pattern() {
    let mut small = bare(UVec2::new(40, 30));
    for (size, distance) in [(40.0, 5.0), (2.0, 5.0 - 5e-6)] {
        let red = unlit(Color::srgb(0.7, 0.2, 0.2));
        wall(&mut small, size, distance, red);
    }
    let linear = Colorization {
        mode: ColorizationMode::Linear,
        ..default()
    };
    let style = ComicStyle::new().with(Desaturation::default()).with(linear);
    let apart = spread(&small.shot(&style));
    assert!(apart <= 5, "noise spans {apart} codes");
}

#[test]
fn grays_stay_gray_under_the_faithful_equations() {
    let mut small = bare(UVec2::new(60, 40));
    for (distance, gray) in [(4.0, 0.1f32), (7.0, 0.5), (10.0, 0.9)] {
        wall(
            &mut small,
            3.0,
            distance,
            unlit(Color::srgb(gray, gray, gray)),
        );
    }
    small.camera_settings().clear_color = Color::srgb(0.3, 0.3, 0.3).into();
    for mode in [
        ColorizationMode::Atmosphere,
        ColorizationMode::Linear,
        ColorizationMode::SquareRoot,
    ] {
        let colorization = Colorization {
            mode,
            equations: Equations::Faithful,
            ..default()
        };
        let style = ComicStyle::new().with(Desaturation::SQUARE_ROOT);
        let picture = small.shot(&style.with(colorization));
        let mut pixels = picture.pixels();
        let gray = pixels.all(|p| p.0[0] == p.0[1] && p.0[1] == p.0[2]);
        assert!(gray, "{mode:?} tinted a gray");
    }
}

#[test]
fn bright_light_grows_with_its_gain() {
    let mut last = 0.0f32;
    let mut small = bare(UVec2::new(16, 12));
    for gain in [0.5f32, 1.0, 4.0, 100.0, 10_000.0, 65_504.0] {
        empty(&mut small);
        small.insert(Hdr);
        let light = Color::linear_rgb(gain, 0.4 * gain, 0.1 * gain);
        wall(&mut small, 30.0, 4.0, unlit(light));
        wall(&mut small, 1.0, 2.0, unlit(Color::WHITE));
        small.shot(&full());
        let (_, output) = small.pass();
        let red = output.pixels[0][0];
        assert!(
            red.is_finite() && red >= last,
            "gain {gain}: {red} after {last}"
        );
        last = red;
    }
}

/// A red pane close to the camera is gray where the wall behind it is far, and red where that is
/// near.
#[test]
fn a_transparent_surface_is_colored_by_the_depth_behind_it() {
    let mut small = bare(UVec2::new(60, 40));
    for (size, distance) in [(400.0, 100.0), (0.4, 1.0)] {
        wall(
            &mut small,
            size,
            distance,
            unlit(Color::srgb(0.5, 0.5, 0.5)),
        );
    }
    let pane = StandardMaterial {
        alpha_mode: AlphaMode::Blend,
        ..unlit(Color::srgba(0.9, 0.1, 0.1, 0.5))
    };
    wall(&mut small, 0.5, 0.9, pane);
    let picture = small.shot(&ComicStyle::new().with(Desaturation::default()));
    let saturation = |x: u32| {
        let [r, g, b, _] = picture.get_pixel(x, 20).0;
        r.max(g).max(b) - r.min(g).min(b)
    };
    let row: Vec<u8> = (0..60).map(saturation).collect();
    assert!(row[30] > 60, "before the near wall: {row:?}");
    assert!(
        row.iter().filter(|s| **s > 20).count() < 24,
        "the pane kept its color before the far wall: {row:?}"
    );
}
