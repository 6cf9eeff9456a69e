//! Lines in the colour of the surfaces that they belong to.

use crate::{outlines::put, prelude::*};

const SIZE: u32 = 80;

/// A red square of 40 pixels in front of a blue sky.
fn scene() -> (Small, Entity) {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Off);
    let square = spawn(&mut small, Msaa::Off);
    (small, square)
}

/// Starts over with the scene.
fn spawn(small: &mut Small, msaa: Msaa) -> Entity {
    small.restart(msaa);
    small.clear();
    let half = 0.5 * SIZE as f32;
    small.insert((
        Transform::IDENTITY,
        Projection::Perspective(PerspectiveProjection {
            fov: std::f32::consts::FRAC_PI_2,
            ..default()
        }),
    ));
    let camera = small.camera;
    let mut camera = small.world().get_mut::<Camera>(camera).expect("a camera");
    camera.clear_color = Color::linear_rgb(0.0, 0.0, 1.0).into();
    put(
        small,
        Rectangle::new(40.4, 40.4),
        Color::linear_rgb(0.8, 0.2, 0.2),
        Transform::from_xyz(0.0, 0.0, -half),
    )
}

fn lines(width: f32, darken: f32) -> Outlines {
    Outlines {
        width,
        color: LineColor::Surface {
            darken,
            saturate: 1.0,
        },
        ..Outlines::SILHOUETTES
    }
}

/// Whether two colours are equal within a code of the picture.
fn alike(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.006)
}

/// All pixels of a line have the darker colour of the square, also those in front of the
/// sky, and also where the rim of the square is mixed with the sky.
#[test]
fn lines_have_the_colour_of_their_surface() {
    let (mut small, _) = scene();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        spawn(&mut small, msaa);
        for width in [2.0, 4.0, 12.0] {
            small.style(&ComicStyle::default().with(lines(width, 0.5)));
            small.settle();
            let picture = small.picture();
            let half = width as u32 / 2;
            // With four samples per pixel, the square begins and ends a pixel further out, and the
            // corners bend its sides: the outermost pixels of lines are not all ink.
            let out = u32::from(msaa != Msaa::Off);
            for middle in [20 - out, 60 + out] {
                for x in middle - half + out..middle + half - out {
                    let color = linear(&picture, x, 37);
                    assert!(
                        alike(color, [0.4, 0.1, 0.1]),
                        "{msaa:?}, {width}, {x}: {color:?}"
                    );
                }
            }
            let sky = linear(&picture, 5, 5);
            assert!(alike(sky, [0.0, 0.0, 1.0]), "{sky:?}");
            let square = linear(&picture, 40, 40);
            assert!(alike(square, [0.8, 0.2, 0.2]), "{square:?}");
        }
        assert_eq!(small.errors(), 0);
    }
}

/// The colour is that after the effects that change colours, and of objects that these leave
/// alone, that before them.
#[test]
fn the_colour_is_that_of_the_styled_surface() {
    let (mut small, square) = scene();
    let grey = Desaturation {
        amount: 1.0,
        ..default()
    };
    let style = ComicStyle::default().with(lines(6.0, 0.5)).with(grey);
    small.style(&style);
    small.settle();
    let picture = small.picture();
    let inside = linear(&picture, 40, 40);
    for x in 18..22 {
        let color = linear(&picture, x, 37);
        assert!(
            alike(color, inside.map(|c| 0.5 * c)),
            "{x}: {color:?}, {inside:?}"
        );
    }
    small.world().entity_mut(square).insert(NoStyle::default());
    small.settle();
    let picture = small.picture();
    for x in 18..22 {
        let color = linear(&picture, x, 37);
        assert!(alike(color, [0.4, 0.1, 0.1]), "{x}: {color:?}");
    }
    assert_eq!(small.errors(), 0);
}

/// Of a slanted square, no line has the colour of the sky, at any width: lines that run straight
/// through the steps of pixels lie away from the pixels that own them.
#[test]
fn slanted_lines_have_the_colour_of_their_surface() {
    let (mut small, _) = scene();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let square = spawn(&mut small, msaa);
        for width in [1.0, 2.0, 3.0, 7.5] {
            small.style(&ComicStyle::default().with(lines(width, 0.5)));
            small.settle();
            for turned in [0.1, 0.35, 0.6, 0.785] {
                let mut at = small
                    .world()
                    .get_mut::<Transform>(square)
                    .expect("a square");
                at.rotation = Quat::from_rotation_z(turned);
                small.headless.step(1);
                let picture = small.picture();
                let [mut inked, mut wrong] = [0; 2];
                for (x, y, _) in picture.enumerate_pixels() {
                    let [r, _, b] = linear(&picture, x, y);
                    // Between the sky and the line, red grows with what blue loses. The rim of
                    // the square itself mixes in more red.
                    let least = 0.4 * (1.0 - b) / 0.9 - 0.02;
                    wrong += usize::from(r < least);
                    inked += usize::from(r < 0.7 && b < 0.9);
                }
                // In multisampled views, the pixel behind the rim may be mixed with the sky
                // too, at corners.
                let most = if msaa == Msaa::Off { 0 } else { inked / 20 };
                assert!(
                    wrong <= most,
                    "{msaa:?}, {turned}, {width}: {wrong} of {inked}"
                );
                assert!(
                    inked > (100.0 * width) as usize,
                    "{msaa:?}, {turned}, {width}: {inked}"
                );
            }
        }
        assert_eq!(small.errors(), 0);
    }
}
