//! Invalid settings, invalid colors, missing depth.

use bevy_comics::ComicsSystems;

use super::*;
use crate::prelude::*;

/// Removes the depth prepass as soon as it is requested.
fn forbid_prepass(mut commands: Commands, cameras: Query<Entity, With<DepthPrepass>>) {
    for camera in &cameras {
        commands.entity(camera).remove::<DepthPrepass>();
    }
}

fn is_finite(picture: &FloatImage) -> bool {
    picture.pixels.iter().flatten().all(|c| c.is_finite())
}

#[test]
fn without_a_prepass_effects_without_depth_still_run() {
    let mut small = Small::new(size(), Msaa::Off);
    let original = small.settle().picture();
    small
        .headless
        .app
        .add_systems(Last, forbid_prepass.after(ComicsSystems::Plan));
    small
        .insert((Contours::default(), Desaturation::default()))
        .settle();
    assert_eq!(
        small.picture(),
        original,
        "nothing can be drawn without depth"
    );
    let missing = Some(StageOutcome::Skipped(SkipReason::NoDepthPrepass));
    for stage in [ComicsStage::of::<Contours>(), ComicsStage::DepthRange] {
        assert_eq!(outcome(&small, small.camera, stage), missing);
    }
    small.insert(Colorization::SEPIA).settle();
    assert!(small.ran(ComicsStage::of::<Colorization>()));
    assert_ne!(small.picture(), original);
}

/// No numbers, infinite ones, and ones that are far out of range. `fuzz.rs` has more of them, and
/// all effects.
#[test]
fn absurd_settings_equal_their_sanitized_selves() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    // Eight bits are always finite.
    small.insert(Hdr);
    for (value, other) in [(f32::NAN, -1e30), (f32::INFINITY, 1e30)] {
        let map = DepthMap {
            mapping: DepthMapping::Fixed {
                from: value,
                to: other,
            },
            sky_gap: other,
            floor: value,
            orthographic_floor: other,
            ..default()
        };
        let style = with_map(ComicStyle::default(), map)
            .with(Desaturation {
                amount: value,
                exponent: other,
                ..default()
            })
            .with(Colorization {
                mode: ColorizationMode::Linear,
                color: Color::srgb(value, other, 0.5),
                amount: other,
                ..default()
            })
            .with(BlackFlats {
                slope: Some(value),
                value: Some(other),
                depth_weight: value,
                softness: other,
                color: Color::hsl(other, value, 0.2),
                opacity: value,
            })
            .with(Contours {
                threshold: value,
                width: other,
                softness: value,
                color: Color::srgb(other, value, value),
                opacity: other,
                opacity_fade: value,
                ..default()
            })
            .with(ToneBands {
                softness: value,
                amount: other,
                levels: 1_000_000,
                ..default()
            })
            .with(Outlines {
                silhouettes: Some(Silhouettes {
                    threshold: value,
                    edge_limit: other,
                    softness: value,
                    color: Color::srgb(value, other, 0.1),
                    ..default()
                }),
                creases: Some(Creases {
                    angle: value,
                    edge_limit: value,
                    opacity: other,
                    ..default()
                }),
                width: value,
                width_fade: other,
                opacity_fade: value,
                ..default()
            });
        // Strokes change with time: the comparison needs one drawing.
        let sketch = Sketch {
            wash: other,
            gamma: value,
            jitter: value,
            wavelength: other,
            pressure: value,
            rate: 0.0,
            ..default()
        };
        let style = with_option(style, (other > 0.0).then_some(sketch));
        small.style(&style).settle();
        let (_, output) = small.pass();
        assert!(is_finite(&output), "{value}, {other}");
        let picture = small.picture();
        assert_eq!(picture, small.shot(&style.sanitized()), "{value}, {other}");
    }
}

#[test]
fn non_finite_colors_stay_finite_and_spread_to_no_other_pixel() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert(Hdr);
    small.style(&full_style()).settle();
    let calm = small.pass().1;
    for (name, emissive) in [
        ("NaN", LinearRgba::rgb(f32::NAN, 0.5, 0.5)),
        ("infinity", LinearRgba::rgb(f32::INFINITY, 1.0, 0.0)),
        ("negative", LinearRgba::rgb(-4.0, 0.2, 0.1)),
        ("bright", LinearRgba::rgb(60_000.0, 900.0, 3.0)),
    ] {
        let world = small.world();
        let mut query = world.query_filtered::<&MeshMaterial3d<StandardMaterial>, With<Object>>();
        let material = query.iter(world).next().expect("an object").0.clone();
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        let mut material = materials.get_mut(&material).expect("its material");
        material.base_color = Color::LinearRgba(emissive);
        drop(material);
        small.settle();
        let (input, output) = small.pass();
        assert!(is_finite(&output), "{name} reached the screen");
        for ((read, wrote), was) in input.pixels.iter().zip(&output.pixels).zip(&calm.pixels) {
            // Only pixels that show the object change.
            let ordinary = read.iter().all(|c| (0.0..=1.0).contains(c));
            if ordinary && !(name == "NaN" && read[0] == 0.0) {
                let is_same = |i: usize| (wrote[i] - was[i]).abs() < 0.02;
                assert!((0..3).all(is_same), "{name}: {was:?} became {wrote:?}");
            }
        }
        // Lines alone are blended over a picture that cannot hold such values.
        for lines in [
            ComicStyle::new().with(Outlines::default()),
            ComicStyle::new().with(Contours::default()),
        ] {
            small.style(&lines).settle();
            let (_, output) = small.pass();
            assert!(is_finite(&output), "{name}, under lines alone");
        }
        small.style(&full_style()).settle();
    }
}

/// The faithful equations draw slopes as the paper does; the default ones do not.
#[test]
fn the_default_draws_no_slopes_and_the_faithful_equations_do() {
    let mut small = Small::new(size(), Msaa::Off);
    let mut ink = |equations| {
        let contours = Contours {
            equations,
            threshold: 0.03,
            softness: 0.0,
            ..default()
        };
        let picture = small.insert(contours).settle().picture();
        picture.pixels().filter(|p| p.0[..3] == [0; 3]).count()
    };
    let faithful = ink(Equations::Faithful);
    let plane_aware = ink(Equations::Corrected);
    assert!(
        plane_aware > 100 && faithful > 2 * plane_aware,
        "{plane_aware} and {faithful}"
    );
}
