//! Lines that are drawn again several times a second.

use crate::{
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

fn boiling(amplitude: f32, rate: f32) -> Outlines {
    Outlines {
        width: 2.0,
        boil: LineBoil {
            amplitude,
            wavelength: 20.0,
            rate,
        },
        ..Outlines::SILHOUETTES
    }
}

/// Every pixel, at widths for which all cracks around a pixel are searched. Wider lines are
/// searched by columns, of which two cracks are kept: where two are as near to the middle of
/// a pixel, rounding decides which the line of a displaced place is.
#[test]
fn boiling_lines_match_the_reference() {
    let mut small = Small::new(SIZE, Msaa::Off);
    for (width, amplitude) in [(1.0, 3.0), (2.0, 0.7), (2.0, 3.0)] {
        let outlines = Outlines {
            width,
            silhouettes: Some(default()),
            creases: Some(default()),
            objects: Some(default()),
            ..boiling(amplitude, 0.0)
        };
        let what = format!("{width} px, boiling by {amplitude} px");
        assert_pass_matches_the_reference(&mut small, &outlined(outlines), None, &what);
    }
    assert_eq!(small.errors(), 0);
}

/// An upright edge in the middle of the picture.
fn edge() -> Small {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 200.0);
    wall(&mut small, [-60.0, -40.0], [0.0, 40.0], 100.0);
    small
}

/// The middle of the line in every row, less where the edge is.
fn strays(picture: &image::RgbaImage) -> Vec<f64> {
    let row = |y: u32| {
        let ink = |x: u32| 1.0 - linear(picture, x, y)[0];
        let sum: f64 = (40..56).map(ink).sum();
        let moment: f64 = (40..56).map(|x| ink(x) * (f64::from(x) + 0.5)).sum();
        moment / sum - 48.0
    };
    (0..SIZE.y).map(row).collect()
}

/// Truth: lines stray by at most the amplitude, and use much of it; they keep their ink,
/// and are whole.
#[test]
fn lines_stray_by_their_amplitude() {
    let mut small = edge();
    for (amplitude, width) in [(0.5, 2.0), (1.5, 2.0), (3.0, 2.0), (1.5, 5.0)] {
        let outlines = Outlines {
            width,
            ..boiling(amplitude, 0.0)
        };
        small.style(&ComicStyle::new().with(outlines));
        small.settle();
        let picture = small.picture();
        let strays = strays(&picture);
        let most = strays
            .iter()
            .fold(0.0f64, |most, stray| most.max(stray.abs()));
        let amplitude = f64::from(amplitude);
        assert!(most <= amplitude + 0.05, "{amplitude}: {most}");
        assert!(most > 0.4 * amplitude, "{amplitude}: {most}");
        for y in 0..SIZE.y {
            let ink = black_ink(&picture, (0..SIZE.x).map(|x| (x, y)));
            // Noise changes by up to 1.5 * 2 * amplitude over a wave of 20 pixels: lines are
            // stretched across and lean by that much.
            let change = 3.0 * amplitude / 20.0;
            let (least, most) = (
                f64::from(width) / (1.0 + change),
                f64::from(width) / (1.0 - change) * 1f64.hypot(change),
            );
            assert!(
                (least - 0.1..most + 0.1).contains(&ink),
                "{amplitude}, {y}: {ink}"
            );
        }
    }
}

/// Wide lines stray less: by 8 square pixels over their width, counting their widest part.
#[test]
fn wide_lines_stray_less() {
    let mut small = edge();
    for (width, outer, most) in [
        (2.0, 1.0, 3.0),
        (4.0, 1.0, 2.0),
        (4.0, 2.0, 1.0),
        (12.0, 1.0, 0.67),
    ] {
        let outlines = Outlines {
            width,
            weight: LineWeight {
                outer,
                ..LineWeight::EVEN
            },
            ..boiling(3.0, 0.0)
        };
        small.style(&ComicStyle::new().with(outlines));
        small.settle();
        let strays = strays(&small.picture());
        let found = (strays.iter()).fold(0.0f64, |most, stray| most.max(stray.abs()));
        println!("{width} px, outer {outer}: strays by {found:.2}");
        assert!(found <= most + 0.05, "{width}, {outer}: {found}");
        assert!(found > 0.4 * most, "{width}, {outer}: {found}");
    }
}

/// A drawing stays for as long as the rate says, then comes another one; at rate 0 nothing
/// ever moves.
#[test]
fn drawings_change_at_their_rate() {
    let mut small = edge();
    let mut drawings = |rate: f32, frames: u32| {
        small.style(&ComicStyle::new().with(boiling(2.0, rate)));
        small.settle();
        let mut pictures = vec![small.picture()];
        for _ in 0..frames {
            small.headless.step(1);
            let next = small.picture();
            if Some(&next) != pictures.last() {
                pictures.push(next);
            }
        }
        pictures.len()
    };
    assert_eq!(drawings(0.0, 12), 1);
    let many = drawings(60.0, 12);
    let few = drawings(6.0, 12);
    assert!(many > few && few > 1, "{many}, {few}");
}
