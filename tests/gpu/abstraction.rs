//! The dial of abstraction in whole views.

use bevy::{prelude::*, render::view::Msaa};
use bevy_comics::{
    Abstraction, ComicStyle, DepthMap, DepthMapping, Outlines, Silhouettes, ToneBands,
};
use bevy_comics_testkit::{studio::with_map, work::along_cracks};

use crate::small::Small;

/// Depth from 1 to 101 units.
fn hundred(flip: bool) -> DepthMap {
    DepthMap {
        mapping: DepthMapping::Fixed {
            near: 1.0,
            far: 101.0,
        },
        flip,
        ..default()
    }
}

/// A card over the left half of the view with a shade of its own, and one over the right half, with
/// another card in front of each by this fraction of the distance.
fn cards(small: &mut Small, distances: [f32; 2], step: f32) {
    small.clear();
    small.insert(Transform::IDENTITY);
    for (side, distance) in [-1.0, 1.0].into_iter().zip(distances) {
        for (height, away) in [(0.6, distance * (1.0 + step)), (0.2, distance)] {
            let at = Transform::from_xyz(side * 0.22 * away, 0.0, -away);
            let material = StandardMaterial {
                base_color: Color::srgb(0.9, 0.5, 0.3),
                unlit: true,
                ..default()
            };
            small.put(Rectangle::new(0.2 * away, height * away), material, at);
        }
    }
}

/// Codes at the middles of both cards.
fn seen(small: &mut Small) -> [[u8; 3]; 2] {
    let picture = small.settle().picture();
    let (w, h) = picture.dimensions();
    let tan = 0.414_213_57;
    [-0.22, 0.22].map(|x: f32| {
        let column = (w as f32 * 0.5 + x / (2.0 * tan) * h as f32) as u32;
        let [r, g, b, _] = picture.get_pixel(column, h / 2).0;
        [r, g, b]
    })
}

fn spread([r, g, b]: [u8; 3]) -> u8 {
    r.max(g).max(b) - r.min(g).min(b)
}

/// Near things have their colours and many bands; far ones are grey and have few.
#[test]
fn far_things_are_paler_and_have_fewer_tones() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let mut small = Small::new(UVec2::new(96, 64), msaa);
        cards(&mut small, [1.001, 100.9], 0.0001);
        let plain = seen(&mut small);
        assert_eq!(plain[0], plain[1]);
        let abstraction = Abstraction {
            saturation: 0.0,
            band_splits: 0.0,
            ..default()
        };
        for flip in [false, true] {
            let style = ComicStyle::new().with(abstraction);
            small.style(&with_map(style, hundred(flip)));
            let mut found = seen(&mut small);
            if flip {
                found.reverse();
            }
            let apart = spread(found[0]).abs_diff(spread(plain[0]));
            assert!(apart <= 1, "{msaa:?}, {flip}: {found:?} of {plain:?}");
            assert!(spread(found[1]) <= 1, "{msaa:?}, {flip}: {found:?}");
        }
        // Two bands far away, and sixteen near by: as with so many levels alone.
        let bands = |levels| ToneBands {
            levels,
            ..default()
        };
        let split = Abstraction {
            saturation: 1.0,
            band_splits: 2.0,
            ..default()
        };
        let style = ComicStyle::new().with(bands(2)).with(split);
        small.style(&with_map(style, hundred(false)));
        let found = seen(&mut small);
        for (card, levels) in [8, 2].into_iter().enumerate() {
            small.style(&ComicStyle::new().with(bands(levels)));
            let wanted = seen(&mut small)[card];
            let apart = (0..3).map(|i| found[card][i].abs_diff(wanted[i]));
            assert!(
                apart.max() <= Some(1),
                "{levels} bands: {found:?}, {wanted:?}"
            );
        }
        assert_eq!(small.errors(), 0);
    }
}

/// Dark pixels in the middle columns of the left and the right cards in front, near their horizontal
/// edges.
fn ink(small: &mut Small) -> [usize; 2] {
    let picture = small.settle().picture();
    let mut count = [0; 2];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let middle = picture.height() / 2;
        let side = usize::from(x > picture.width() / 2);
        // 0.22 of the distance from the middle of the view.
        let centre = [31, 65][side];
        let is_near_edge = y.abs_diff(middle) < picture.height() / 4;
        if is_near_edge && x.abs_diff(centre) < 5 && pixel.0[0] < 60 {
            count[side] += 1;
        }
    }
    count
}

/// A step that is a line near by is none far away, and a large step is one at every distance.
#[test]
fn far_edges_must_be_stronger() {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    small.insert(Camera {
        clear_color: Color::WHITE.into(),
        ..default()
    });
    let outlines = Outlines {
        creases: None,
        objects: None,
        silhouettes: Some(Silhouettes {
            softness: 0.0,
            ..default()
        }),
        continuity: 0.0,
        ..along_cracks()
    };
    // At the threshold of 0.02 the response is 1, and above, the square of the ratio.
    for (step, stays) in [(0.03, false), (0.3, true)] {
        cards(&mut small, [1.2, 75.0], step);
        let style = ComicStyle::new().with(outlines);
        small.style(&with_map(style.clone(), hundred(false)));
        let without = ink(&mut small);
        assert!(without[0] > 15 && without[1] > 15, "{step}: {without:?}");
        let abstraction = Abstraction {
            line_threshold: 8.0,
            ..default()
        };
        small.style(&with_map(style.with(abstraction), hundred(false)));
        let with = ink(&mut small);
        assert_eq!(with[0], without[0], "{step}: near by");
        if stays {
            assert_eq!(with[1], without[1], "{step}: far away");
        } else {
            assert!(with[1] < without[1] / 2, "{step}: {with:?} of {without:?}");
        }
    }
    assert_eq!(small.errors(), 0);
}
