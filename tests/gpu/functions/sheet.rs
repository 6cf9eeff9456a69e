//! The sheet: its height, and ink on it. Pictures on paper equal the reference that is measured
//! here.

use bevy_comics_testkit::reference::sheet::{Sheet, height};

/// Truth: heights are as often above 0 as below, so that what is added to a tone is 0 in
/// the mean; and they vary.
#[test]
fn the_sheet_is_level() {
    for sheet in 0..6 {
        let heights: Vec<f64> = (0..90_000)
            .map(|n| {
                let at = [n % 300, n / 300].map(|v| f64::from(v) + 0.5);
                height(at, sheet)
            })
            .collect();
        let count = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / count;
        let square = heights.iter().map(|h| h * h).sum::<f64>() / count;
        // 625 grains of the coarsest octave, with a deviation of 0.2.
        assert!(mean.abs() < 0.03, "{sheet}: {mean}");
        assert!((0.3..0.7).contains(&square.sqrt()), "{sheet}: {square}");
    }
}

/// Truth: streaks run along the line. They are eight times as long as wide; from pixel to pixel,
/// ink changes at least 2.5 times as fast across the line as along it, because a streak is hardly
/// wider than a pixel.
#[test]
fn streaks_run_along_the_line() {
    let sheet = Sheet {
        dry_brush: 0.5,
        ..Sheet::SMOOTH
    };
    for degrees in [0.0f64, 11.25, 37.0, 90.0, 133.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let ink = |place| sheet.under(place).dry_ink([cos, sin], 5.0);
        // Mean of the squared change over a pixel along and across.
        let change = |[dx, dy]: [f64; 2]| {
            let places = (0..40_000).map(|n| [f64::from(n % 200) + 0.5, f64::from(n / 200) + 0.5]);
            let changes = places.map(|[x, y]| (ink([x + dx, y + dy]) - ink([x, y])).powi(2));
            changes.sum::<f64>() / 40_000.0
        };
        let (along, across) = (change([cos, sin]), change([-sin, cos]));
        let ratio = (across / along).sqrt();
        println!("{degrees} degrees: {ratio:.1} times as fast across");
        assert!(ratio > 2.5, "{degrees}: {ratio}");
    }
}
