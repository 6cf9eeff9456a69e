//! Lines that are drawn again several times a second.

use crate::{
    line_scenes::runs,
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

/// How far the line strays in any row.
fn most(picture: &image::RgbaImage) -> f64 {
    let strays = strays(picture).into_iter().map(f64::abs);
    strays.fold(0.0, f64::max)
}

/// Truth: lines stray by at most the amplitude, and use much of it; they keep their ink,
/// and are whole.
#[test]
fn lines_stray_by_their_amplitude() {
    let mut small = edge();
    for (amplitude, width) in [(0.5, 2.0), (1.5, 2.0), (3.0, 2.0), (1.5, 5.0)] {
        let picture = small.outlined(Outlines {
            width,
            ..boiling(amplitude, 0.0)
        });
        let most = most(&picture);
        let (amplitude, width) = (f64::from(amplitude), f64::from(width));
        assert!(most <= amplitude + 0.05, "{amplitude}: {most}");
        assert!(most > 0.4 * amplitude, "{amplitude}: {most}");
        // Noise changes by up to 1.5 * 2 * amplitude over a wave of 20 pixels: lines are
        // stretched across and lean by that much.
        let change = 3.0 * amplitude / 20.0;
        let least = width / (1.0 + change) - 0.1;
        let most = width / (1.0 - change) * 1f64.hypot(change) + 0.1;
        for y in 0..SIZE.y {
            let ink = black_ink(&picture, (0..SIZE.x).map(|x| (x, y)));
            assert!((least..most).contains(&ink), "{amplitude}, {y}: {ink}");
        }
    }
}

/// Wide lines stray less: by 8 square pixels over their width, counting their widest part.
#[test]
fn wide_lines_stray_less() {
    let mut small = edge();
    for (width, outer, want) in [
        (2.0, 1.0, 3.0),
        (4.0, 1.0, 2.0),
        (4.0, 2.0, 1.0),
        (12.0, 1.0, 0.67),
    ] {
        let weight = LineWeight {
            outer,
            ..LineWeight::EVEN
        };
        let found = most(&small.outlined(Outlines {
            width,
            weight,
            ..boiling(3.0, 0.0)
        }));
        assert!(found <= want + 0.05, "{width}, {outer}: {found}");
        assert!(found > 0.4 * want, "{width}, {outer}: {found}");
    }
}

/// A drawing stays for as long as the rate says, then comes another one; at rate 0 nothing
/// ever moves.
#[test]
fn drawings_change_at_their_rate() {
    let mut small = edge();
    let mut drawings = |rate: f32| {
        small.outlined(boiling(2.0, rate));
        runs(&small.film(13)).len()
    };
    assert_eq!(drawings(0.0), 1);
    let [many, few] = [60.0, 6.0].map(drawings);
    assert!(many > few && few > 1, "{many}, {few}");
}
