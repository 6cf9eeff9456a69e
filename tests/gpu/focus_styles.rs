//! Focus by dots and by lines.

use crate::{
    focus::{at, figure},
    prelude::*,
};

const SIZE: UVec2 = UVec2::new(96, 96);
/// Size of the pictures with lines.
const LINED: UVec2 = UVec2::new(64, 64);

/// Truth: what is out of focus is printed with its mean light, in dots that grow with the distance
/// from the focus; what is in focus is as it was.
#[test]
fn dots_keep_the_mean_light() {
    let mut small = Small::new(SIZE, Msaa::Off);
    small.clear();
    small.insert((Transform::IDENTITY, Projection::default()));
    let wall = Transform::from_xyz(0.0, 0.0, -20.0);
    let color = Color::linear_rgb(0.55, 0.3, 0.12);
    small.put(Rectangle::new(100.0, 100.0), unlit(color), wall);
    let plain = small.shot(&ComicStyle::new());
    let count = f64::from(SIZE.x * SIZE.y);
    let mut spreads = Vec::new();
    for focus_at in [20.0, 12.0, 8.0, 2.0] {
        let style = ComicStyle::new().with(at(focus_at, FocusStyle::Dots));
        let picture = small.shot(&style);
        if focus_at == 20.0 {
            assert_eq!(picture, plain);
        }
        let mut spread = 0.0;
        for channel in 0..3 {
            let all = || {
                picture
                    .enumerate_pixels()
                    .map(|(x, y, _)| linear(&picture, x, y)[channel])
            };
            let want = linear(&plain, 0, 0)[channel];
            let mean = all().sum::<f64>() / count;
            assert!(
                (mean - want).abs() < 0.01,
                "{focus_at}, {channel}: {mean}, {want}"
            );
            spread += all().map(|v| (v - want).powi(2)).sum::<f64>() / count;
        }
        spreads.push(spread);
    }
    assert!(spreads.is_sorted_by(|a, b| a < b), "{spreads:?}");
}

/// Ink of a black outline around a red figure before stripes of blue and green: 1 for a pixel
/// without light.
fn ink(picture: &image::RgbaImage) -> f64 {
    let light = |(x, y, _)| linear(picture, x, y).into_iter().fold(0.0, f64::max);
    picture
        .enumerate_pixels()
        .map(light)
        .map(|light| 1.0 - light)
        .sum()
}

/// Truth: lines in focus are those without the effect; the farther they are from it, the less ink
/// they have, down to none; and the colors stay.
#[test]
fn lines_fade_out_of_focus() {
    let mut small = Small::new(LINED, Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        figure(&mut small, 5.0, 60.0);
        let bare = small.shot(&ComicStyle::new());
        let lines = ComicStyle::new().with(Outlines {
            width: 3.0,
            silhouettes: Some(Silhouettes::default()),
            creases: None,
            objects: None,
            ..default()
        });
        let whole = small.shot(&lines);
        let mut inked = Vec::new();
        for focus_at in [5.0, 7.5, 10.0, 12.0, 60.0] {
            let style = lines.clone().with(at(focus_at, FocusStyle::Lines));
            let picture = small.shot(&style);
            if focus_at == 5.0 {
                assert_eq!(picture, whole);
            }
            if focus_at == 60.0 {
                assert_eq!(picture, bare);
            }
            inked.push(ink(&picture) - ink(&bare));
        }
        assert!(inked.is_sorted_by(|a, b| a > b), "{inked:?}");
        assert!(inked[0] > 100.0, "{inked:?}");
    }
}

/// A line that is half as strong is half as wide too: its ink is about a quarter.
#[test]
fn lines_become_thinner_and_fainter() {
    let mut small = Small::new(LINED, Msaa::Off);
    figure(&mut small, 5.0, 60.0);
    let bare = small.shot(&ComicStyle::new());
    let lines = ComicStyle::new().with(Outlines {
        width: 8.0,
        silhouettes: Some(Silhouettes::default()),
        creases: None,
        objects: None,
        ..default()
    });
    let mut of = |style: &ComicStyle| ink(&small.shot(style)) - ink(&bare);
    let whole = of(&lines);
    // Half of the ramp from 0.15 to 1.15.
    let half = of(&lines
        .clone()
        .with(at(5.0 * 0.65f32.exp(), FocusStyle::Lines)));
    // Half the width, and half of the light, in display codes or not, of what is left.
    assert!((0.15..0.4).contains(&(half / whole)), "{half}, {whole}");
}
