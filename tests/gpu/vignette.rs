//! The vignette against geometry.

use crate::prelude::*;

/// Truth: a hard vignette is an ellipse of the viewport's shape. Its area is
/// pi r^2 / 2 of the picture where it touches no side, and the picture inside is
/// as it was, to the bit.
#[test]
fn a_hard_vignette_is_an_ellipse_of_its_area() {
    let mut small = Small::new(UVec2::new(192, 128), Msaa::Off);
    small.clear();
    let bare = small.settle().picture();
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
        let part = |count: usize| count as f64 / pixels;
        let black = part(inked.pixels().filter(|p| p.0[..3] == [0; 3]).count());
        let pairs = inked.pixels().zip(bare.pixels());
        let kept = part(pairs.filter(|(a, b)| a == b).count());
        // The distance is 1 at a corner, so the ellipse has half axes of radius *
        // sqrt(2) times half the sides: pi / 4 * 2 r^2 of the rectangle.
        let inside = std::f64::consts::FRAC_PI_2 * f64::from(radius).powi(2);
        // Pixels that the edge runs through: about the ellipse's circumference.
        let slack = 700.0 / pixels;
        assert!((kept - inside).abs() < slack, "{radius}: {kept}");
        assert!((black + inside - 1.0).abs() < slack, "{radius}: {black}");
    }
}
