//! How wide lines are in different places. Widths across upright lines are those asked for within
//! 0.02 pixels: of the ink of two pixels at the borders of a line, each is rounded by 0.004 in the
//! texture of ink and by 0.0045 in the picture of 8 bits.

use bevy::pbr::{DistanceFog, FogFalloff};
use bevy_comics::lines::LineFog;

use crate::{
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

/// All factors together.
const ALL: LineWeight = LineWeight {
    outer: 1.5,
    inner: 0.75,
    crease: 0.6,
    object: 0.75,
    shade: 0.6,
    lit: 0.4,
    perspective: 0.5,
    nib_roundness: 0.4,
    nib_angle: 40.0,
    taper: 20.0,
    pressure: 0.5,
    pressure_length: 30.0,
};

/// Every pixel of the small scene; in a multisampled view, the light is that of the chosen samples.
#[test]
fn every_factor_matches_the_reference() {
    assert_pixels(Msaa::Off, Outlines::default(), &[1.5, 4.0]);
}

#[test]
fn every_factor_of_silhouettes_in_a_multisampled_view_matches_the_reference() {
    assert_pixels(Msaa::Sample4, Outlines::SILHOUETTES, &[3.0]);
}

fn assert_pixels(msaa: Msaa, outlines: Outlines, widths: &[f32]) {
    let mut small = Small::new(UVec2::new(64, 44), msaa);
    let light = Transform::from_xyz(2.0, 3.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y);
    small.world().spawn((KeyLight, light, Object));
    for &width in widths {
        let style = outlined(Outlines {
            width,
            weight: ALL,
            ..outlines
        });
        assert_pass_matches_the_reference(&mut small, &style, None, &format!("{width} px"));
    }
}

/// The width of a line across a row: the sum of its ink.
fn ink_across(picture: &image::RgbaImage, columns: Range<u32>, row: u32) -> f64 {
    black_ink(picture, columns.map(|x| (x, row)))
}

/// Fails unless the line across the middle row has this width.
fn assert_width(small: &mut Small, outlines: Outlines, want: f64) {
    let found = ink_across(&small.outlined(outlines), 30..66, 32);
    let weight = outlines.weight;
    assert!(
        (found - want).abs() < 0.02,
        "{found}, not {want}: {weight:?}"
    );
}

fn silhouettes(width: f32, weight: LineWeight) -> Outlines {
    Outlines {
        width,
        weight,
        ..Outlines::SILHOUETTES
    }
}

/// The rim of a thing in front of another has the outer weight, in front of itself the inner:
/// two walls are two things, or one if they are a group. Ink across the line is its width.
#[test]
fn rims_before_other_objects_are_wider_than_rims_before_the_same() {
    let weight = LineWeight {
        outer: 1.5,
        inner: 0.5,
        ..LineWeight::EVEN
    };
    let mut small = towards_the_sky(SIZE);
    let back = wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 100.0);
    let front = wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 20.0);
    for width in [2.0, 4.0] {
        let outlines = silhouettes(width, weight);
        assert_width(&mut small, outlines, 1.5 * f64::from(width));
        let group = (OutlineGroup, Transform::default(), Visibility::default());
        let group = small.world().spawn((group, Object)).id();
        small.world().entity_mut(group).add_children(&[back, front]);
        assert_width(&mut small, outlines, 0.5 * f64::from(width));
        small.world().entity_mut(group).remove::<OutlineGroup>();
    }
}

/// Edges between objects have a width of their own.
#[test]
fn edges_between_objects_have_their_own_width() {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 50.0);
    wall(&mut small, [0.0, -40.0], [60.0, 40.0], 50.0);
    for factor in [0.5, 1.0, 2.0] {
        let outlines = Outlines {
            silhouettes: None,
            creases: None,
            objects: Some(ObjectEdges::default()),
            width: 2.0,
            weight: LineWeight {
                object: factor,
                ..LineWeight::EVEN
            },
            ..default()
        };
        assert_width(&mut small, outlines, 2.0 * f64::from(factor));
    }
}

/// A sphere in the light from one side: the lit side loses its line, the side in the shade
/// gains, and mirroring the light mirrors the lines.
#[test]
fn lines_follow_the_light() {
    let weight = LineWeight {
        shade: 0.5,
        lit: 1.0,
        ..LineWeight::EVEN
    };
    let mut small = towards_the_sky(SIZE);
    small.put(
        Sphere::new(20.0).mesh().uv(128, 64),
        unlit(Color::WHITE),
        Transform::from_xyz(0.0, 0.0, -100.0),
    );
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 200.0);
    let light = small
        .world()
        .spawn((KeyLight, Transform::default(), Object))
        .id();
    // The steps beside the rim are no lines.
    let rim = Silhouettes {
        threshold: 0.1,
        ..default()
    };
    let outlines = Outlines {
        silhouettes: Some(rim),
        ..silhouettes(4.0, weight)
    };
    for (shine, [left, right]) in [(Vec3::NEG_X, [6.0, 0.0]), (Vec3::X, [0.0, 6.0])] {
        let shine = Transform::default().looking_to(shine, Vec3::Y);
        small.world().entity_mut(light).insert(shine);
        let picture = small.outlined(outlines);
        for (columns, want) in [(18..38, left), (58..78, right)] {
            let found = ink_across(&picture, columns, 32);
            assert!(
                (found - want).abs() < 0.02,
                "{shine:?}: {found}, not {want}"
            );
        }
    }
}

/// A line along the nib's edge is thin, one across it full.
#[test]
fn a_nib_draws_thick_and_thin() {
    let weight = |nib_angle| LineWeight {
        nib_roundness: 0.25,
        nib_angle,
        ..LineWeight::EVEN
    };
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 20.0);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 100.0);
    let oblique = 4.0 * (0.5 + 0.5 * 0.0625f64).sqrt();
    for (angle, want) in [(90.0, 1.0), (0.0, 4.0), (45.0, oblique)] {
        assert_width(&mut small, silhouettes(4.0, weight(angle)), want);
    }
}

/// Near things have wider lines than far things, in proportion to their distance.
#[test]
fn lines_follow_perspective() {
    let weight = LineWeight {
        perspective: 1.0,
        ..LineWeight::EVEN
    };
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small.insert(Transform::IDENTITY);
    // Upper half: a rim at 12 units, lower half: one at 24, before a wall at 30.
    wall(&mut small, [-100.0, 0.0], [0.0, 100.0], 12.0);
    wall(&mut small, [-100.0, -100.0], [0.0, 0.0], 24.0);
    wall(&mut small, [-100.0, -100.0], [100.0, 100.0], 30.0);
    let outlines = silhouettes(4.0, weight);
    let picture = small.outlined(outlines);
    let [near, far] = [16, 48].map(|row| ink_across(&picture, 30..66, row));
    // The middle between 12 and 30 is 21.
    assert!((near - 4.0 * 21.0 / 12.0).abs() < 0.02, "{near}");
    assert!((far - 4.0 * 21.0 / 24.0).abs() < 0.02, "{far}");
    // Nothing is larger for being near in an orthographic view.
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 20.0);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 100.0);
    assert_width(&mut small, outlines, 4.0);
}

/// Lines fade as the engine's fog covers a black surface at the same place, at the middle of
/// the view and at its border, for every falloff.
#[test]
fn lines_fade_as_black_surfaces_do() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small.insert(Transform::IDENTITY);
    // A rim at 20 units along the middle of the view, before a wall at 40.
    let front = wall(&mut small, [-100.0, -100.0], [0.0, 100.0], 20.0);
    wall(&mut small, [-100.0, -100.0], [100.0, 100.0], 40.0);
    let falloffs = [
        FogFalloff::Linear {
            start: 5.0,
            end: 30.0,
        },
        FogFalloff::Exponential { density: 0.04 },
        FogFalloff::ExponentialSquared { density: 0.03 },
        FogFalloff::Atmospheric {
            extinction: Vec3::splat(0.03),
            inscattering: Vec3::splat(0.03),
        },
    ];
    for falloff in falloffs {
        small.insert(DistanceFog {
            color: Color::srgba(1.0, 1.0, 1.0, 0.9),
            falloff: falloff.clone(),
            ..default()
        });
        // The engine's fog over the same wall in black.
        let fogged = fogged_black(&mut small, front);
        for (fog, fades) in [(LineFog::Fade, true), (LineFog::Ignore, false)] {
            let outlines = Outlines {
                fog,
                ..silhouettes(4.0, LineWeight::EVEN)
            };
            let picture = small.outlined(outlines);
            for row in [32, 2] {
                let found = ink_across(&picture, 40..56, row) / 4.0;
                assert_eq!(picture.get_pixel(20, row).0[0], 255);
                let [black, ..] = linear(&fogged, 46, row);
                let want = if fades { 1.0 - black } else { 1.0 };
                assert!(
                    (found - want).abs() < 0.012,
                    "{falloff:?}, row {row}: {found}, {want}"
                );
            }
        }
    }
}

/// Without any fog of the engine: 2 % of a line is left at the visibility, and 14 % at half of it.
#[test]
fn lines_fade_by_visibility() {
    let mut small = towards_the_sky(SIZE);
    small.clear();
    small.insert(Transform::IDENTITY);
    wall(&mut small, [-100.0, -100.0], [0.0, 100.0], 20.0);
    wall(&mut small, [-100.0, -100.0], [100.0, 100.0], 40.0);
    for (distance, left) in [(20.0, 0.02), (40.0, 0.1414), (1e9, 1.0), (f32::NAN, 0.9247)] {
        let outlines = Outlines {
            fog: LineFog::Visibility { distance },
            ..silhouettes(4.0, LineWeight::EVEN)
        };
        let picture = small.outlined(outlines);
        let found = ink_across(&picture, 40..56, 32) / 4.0;
        assert!((found - left).abs() < 0.012, "{distance}: {found}, {left}");
    }
}

/// The picture without lines, of a wall that is painted black.
fn fogged_black(small: &mut Small, wall: Entity) -> image::RgbaImage {
    small.style(&ComicStyle::new());
    let world = small.world();
    let material = world.get::<MeshMaterial3d<StandardMaterial>>(wall);
    let material = material.expect("a material").clone();
    let paint = |small: &mut Small, color| {
        let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
        materials.get_mut(&material).expect("loaded").base_color = color;
    };
    paint(small, Color::BLACK);
    let black = small.settle().picture();
    paint(small, Color::WHITE);
    black
}

/// Ink of every row of the picture between two columns.
fn rows_of_ink(small: &mut Small, outlines: Outlines, columns: Range<u32>) -> Vec<f64> {
    let picture = small.outlined(outlines);
    let ink = |row: u32| black_ink(&picture, columns.clone().map(|x| (x, row)));
    (10..54).map(ink).collect()
}

/// A leaning edge between a lit and a dark face: which face is nearer changes at every step
/// of pixels, but the width does not.
#[test]
fn a_crease_between_light_and_shade_is_even() {
    let mut small = towards_the_sky(SIZE);
    let turned = Quat::from_rotation_z(0.1) * Quat::from_rotation_y(45f32.to_radians());
    small.put(
        Cuboid::from_length(200.0),
        unlit(Color::WHITE),
        Transform::from_xyz(0.0, 0.0, -300.0).with_rotation(turned),
    );
    let light = Transform::default().looking_to(Vec3::NEG_X, Vec3::Y);
    small.world().spawn((KeyLight, light, Object));
    let creases = |weight| Outlines {
        silhouettes: None,
        objects: None,
        width: 4.0,
        weight,
        ..default()
    };
    let weight = LineWeight {
        shade: 0.6,
        lit: 0.6,
        ..LineWeight::EVEN
    };
    let even = rows_of_ink(&mut small, creases(LineWeight::EVEN), 20..76);
    let weighted = rows_of_ink(&mut small, creases(weight), 20..76);
    // One face has 1.6 of the width, the other 0.4: the mean is 1.
    let mean = |ink: &[f64]| ink.iter().sum::<f64>() / ink.len() as f64;
    assert!((mean(&even) - 4.0).abs() < 0.2, "{even:.2?}");
    assert!(
        (mean(&weighted) / mean(&even) - 1.0).abs() < 0.02,
        "{weighted:.2?}"
    );
    for (a, b) in even.iter().zip(&weighted) {
        assert!((a - b).abs() < 0.1, "{even:.2?}, {weighted:.2?}");
    }
}
