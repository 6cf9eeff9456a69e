//! Lines in the color of the surfaces that they belong to.

use image::RgbaImage;

use crate::{
    line_scenes::{alike, silhouettes, turned},
    outlines::put,
    prelude::*,
};

const SIZE: u32 = 80;

/// A red square of 40 pixels in front of a blue sky.
fn spawn(small: &mut Small, msaa: Msaa) -> Entity {
    small.empty_view(msaa, Color::linear_rgb(0.0, 0.0, 1.0));
    let square = Rectangle::from_length(40.4);
    let at = Transform::from_xyz(0.0, 0.0, -0.5 * SIZE as f32);
    put(small, square, Color::linear_rgb(0.8, 0.2, 0.2), at)
}

fn lines(width: f32, darken: f32) -> Outlines {
    Outlines {
        color: LineColor::Surface {
            darken,
            saturate: 1.0,
        },
        ..silhouettes(width)
    }
}

fn assert_alike(picture: &RgbaImage, x: u32, y: u32, want: [f64; 3]) {
    let color = linear(picture, x, y);
    assert!(alike(color, want), "{x}, {y}: {color:?}, {want:?}");
}

/// All pixels of a line have the darker color of the square, also those in front of the
/// sky, and also where the rim of the square is mixed with the sky.
#[test]
fn lines_have_the_color_of_their_surface() {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        spawn(&mut small, msaa);
        for width in [2.0, 4.0, 12.0] {
            let picture = small.outlined(lines(width, 0.5));
            let half = width as u32 / 2;
            // With four samples per pixel, the square begins and ends a pixel further out, and the
            // corners bend its sides: the outermost pixels of lines are not all ink.
            let out = u32::from(msaa != Msaa::Off);
            for middle in [20 - out, 60 + out] {
                for x in middle - half + out..middle + half - out {
                    assert_alike(&picture, x, 37, [0.4, 0.1, 0.1]);
                }
            }
            assert_alike(&picture, 5, 5, [0.0, 0.0, 1.0]);
            assert_alike(&picture, 40, 40, [0.8, 0.2, 0.2]);
        }
    }
}

/// The color is that after the effects that change colors, and of objects that these leave
/// alone, that before them.
#[test]
fn the_color_is_that_of_the_styled_surface() {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Off);
    let square = spawn(&mut small, Msaa::Off);
    let gray = Desaturation {
        amount: 1.0,
        ..default()
    };
    let style = ComicStyle::default().with(lines(6.0, 0.5)).with(gray);
    let picture = small.shot(&style);
    let inside = linear(&picture, 40, 40);
    for x in 18..22 {
        assert_alike(&picture, x, 37, inside.map(|c| 0.5 * c));
    }
    small.on(square).insert(NoStyle::default());
    let picture = small.settle().picture();
    for x in 18..22 {
        assert_alike(&picture, x, 37, [0.4, 0.1, 0.1]);
    }
}

/// Of a slanted square, no line has the color of the sky, at any width: lines that run straight
/// through the steps of pixels lie away from the pixels that own them.
#[test]
fn slanted_lines_have_the_color_of_their_surface() {
    let mut small = Small::new(UVec2::splat(SIZE), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let square = spawn(&mut small, msaa);
        for width in [1.0, 2.0, 3.0, 7.5] {
            small.outlined(lines(width, 0.5));
            for turn in [0.1, 0.35, 0.6, 0.785] {
                let at = turned(0.0, 0.0, -0.5 * SIZE as f32, turn);
                small.on(square).insert(at);
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
                let what = format!("{msaa:?}, {turn}, {width}: {wrong} of {inked}");
                assert!(wrong <= most, "{what}");
                assert!(inked > (100.0 * width) as usize, "{what}");
            }
        }
    }
}
