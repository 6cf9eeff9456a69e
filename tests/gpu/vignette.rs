//! The vignette: its function against its reference, and the rule against geometry.

use bevy_comics_testkit::reference::vignette;

use crate::prelude::*;

const INK: Color = Color::srgb(0.8, 0.1, 0.3);

/// Every pixel of the fused pass equals its reference, in the camera's viewport.
#[test]
fn every_pixel_matches_the_reference() {
    let mut small = Small::new(size(), Msaa::Off);
    for settings in [
        Vignette::default(),
        Vignette {
            amount: 1.0,
            radius: 0.4,
            softness: 0.0,
            color: INK,
        },
        Vignette {
            amount: 0.35,
            radius: 1.0,
            softness: 1.0,
            color: INK,
        },
    ] {
        small.insert(settings).settle();
        assert!(small.ran(ComicsStage::of::<Vignette>()));
        let (picture, shown) = small.pass();
        let extent = [size().x, size().y].map(f64::from);
        let mut far = 0;
        for y in 0..size().y {
            for x in 0..size().x {
                let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                let i = (y * size().x + x) as usize;
                let source = picture.pixels[i].map(f64::from);
                let want = vignette::vignette(&settings, source, at, extent);
                // One code of the display: the target has eight bits.
                let codes = |light: f64| {
                    bevy_comics_testkit::reference::color::srgb_encode([light; 3])[0] * 255.0
                };
                let apart = (0..3)
                    .map(|c| (codes(f64::from(shown.pixels[i][c])) - codes(want[c])).abs())
                    .fold(0.0, f64::max);
                // Pixels on a hard edge are decided by rounding.
                far += usize::from(apart > 1.0);
            }
        }
        let edge = if settings.softness == 0.0 { 4 } else { 0 };
        assert!(far <= edge, "{settings:?}: {far} pixels");
    }
}

/// The rule: a hard vignette is an ellipse of the viewport's shape. Its area is
/// pi r^2 / 2 of the picture where it touches no side, and the picture inside is
/// as it was, to the bit.
#[test]
fn a_hard_vignette_is_an_ellipse_of_its_area() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Off);
    small.clear();
    small.settle();
    let bare = small.picture();
    for radius in [0.2f32, 0.45, 0.7] {
        small
            .insert(Vignette {
                amount: 1.0,
                radius,
                softness: 0.0,
                color: Color::BLACK,
            })
            .settle();
        let inked = small.picture();
        let pixels = f64::from(inked.width() * inked.height());
        let black = inked.pixels().filter(|p| p.0[..3] == [0; 3]).count() as f64;
        let kept = inked
            .pixels()
            .zip(bare.pixels())
            .filter(|(a, b)| a == b)
            .count() as f64;
        // The distance is 1 at a corner, so the ellipse has half axes of radius *
        // sqrt(2) times half the sides: pi / 4 * 2 r^2 of the rectangle.
        let inside = std::f64::consts::FRAC_PI_2 * f64::from(radius).powi(2);
        // Pixels that the edge runs through: about the ellipse's circumference.
        let slack = 700.0 / pixels;
        assert!(
            (kept / pixels - inside).abs() < slack,
            "{radius}: {}",
            kept / pixels
        );
        assert!(
            (black / pixels - (1.0 - inside)).abs() < slack,
            "{radius}: {}",
            black / pixels
        );
    }
}
