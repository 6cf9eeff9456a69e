//! Abstraction in whole views.

use bevy_comics::objects::ObjectSimplification;
use bevy_comics_testkit::work::along_cracks;

use crate::prelude::*;

/// Depth from 1 to 101 units.
fn hundred(flip: bool) -> DepthMap {
    DepthMap {
        mapping: DepthMapping::Fixed {
            from: 1.0,
            to: 101.0,
        },
        flip,
        ..default()
    }
}

/// Before a white background.
fn before_white(mut small: Small) -> Small {
    small.camera_settings().clear_color = Color::WHITE.into();
    small
}

/// Draws with a style over the depth from 1 to 101 units.
fn set_style(small: &mut Small, style: ComicStyle) {
    small.style(&with_map(style, hundred(false)));
}

/// A card over the left half of the view with a shade of its own, and one over the right half, with
/// another card in front of each by this fraction of the distance: those are returned.
fn cards(small: &mut Small, distances: [f32; 2], step: f32) -> [Entity; 2] {
    small.clear();
    small.insert(Transform::IDENTITY);
    [0, 1].map(|card| {
        let (side, distance) = ([-1.0, 1.0][card], distances[card]);
        let [_, front] = [(0.6, distance * (1.0 + step)), (0.2, distance)].map(|(height, away)| {
            let at = Transform::from_xyz(side * 0.22 * away, 0.0, -away);
            let shape = Rectangle::new(0.2 * away, height * away);
            small.put(shape, unlit(Color::srgb(0.9, 0.5, 0.3)), at)
        });
        front
    })
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

/// Near things have their colors and many bands; far ones are gray and have few.
#[test]
fn far_things_are_paler_and_have_fewer_tones() {
    assert_far_things_are_paler(&[Msaa::Off, Msaa::Sample4], &[Msaa::Off]);
}

#[test]
#[ignore = "long: every check with several samples"]
fn far_things_of_several_samples_are_paler_and_have_fewer_tones() {
    assert_far_things_are_paler(&[Msaa::Sample4], &[Msaa::Sample4]);
}

/// `in_full`: with the exponent and with bands.
fn assert_far_things_are_paler(views: &[Msaa], in_full: &[Msaa]) {
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for &msaa in views {
        small.restart(msaa);
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
        if !in_full.contains(&msaa) {
            continue;
        }
        // What is at half of the depth is by the exponent as abstract as at a quarter.
        cards(&mut small, [51.0, 26.0], 0.0001);
        let [half, quarter] = [2.0, 1.0].map(|exponent| {
            let style = ComicStyle::new().with(Abstraction {
                exponent,
                ..abstraction
            });
            set_style(&mut small, style);
            seen(&mut small)
        });
        let apart = (0..3).map(|i| half[0][i].abs_diff(quarter[1][i]));
        assert!(apart.max() <= Some(1), "{half:?}, {quarter:?}");
        assert!(
            spread(half[0]) > spread(quarter[0]) + 9,
            "{half:?}, {quarter:?}"
        );
        cards(&mut small, [1.001, 100.9], 0.0001);
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
        set_style(&mut small, style);
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
    }
}

/// Dark pixels in the middle columns of the left and the right cards in front, near their
/// horizontal edges.
fn ink(small: &mut Small) -> [usize; 2] {
    let picture = small.settle().picture();
    let mut count = [0; 2];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let middle = picture.height() / 2;
        let side = usize::from(x > picture.width() / 2);
        // 0.22 of the distance from the middle of the view.
        let center = [31, 65][side];
        let is_near_edge = y.abs_diff(middle) < picture.height() / 4;
        if is_near_edge && x.abs_diff(center) < 5 && pixel.0[0] < 60 {
            count[side] += 1;
        }
    }
    count
}

/// Silhouettes that are lines or not, without a transition.
fn sharp() -> Outlines {
    Outlines {
        creases: None,
        objects: None,
        silhouettes: Some(Silhouettes {
            softness: 0.0,
            ..default()
        }),
        hysteresis: 0.0,
        ..along_cracks()
    }
}

/// The ink of a near card and a far one with a step of this fraction, without abstraction and with
/// that of their places, by this exponent, or of levels of their own.
fn inks(small: &mut Small, step: f32, exponent: f32, levels: Option<[f32; 2]>) -> [[usize; 2]; 2] {
    let fronts = cards(small, [1.2, 75.0], step);
    let style = ComicStyle::new().with(sharp());
    set_style(small, style.clone());
    let without = ink(small);
    for (front, level) in fronts.into_iter().zip(levels.into_iter().flatten()) {
        let own = ObjectSimplification::fixed(level);
        small.world().entity_mut(front).insert(own);
    }
    let abstraction = Abstraction {
        line_threshold: 8.0,
        exponent,
        ..default()
    };
    set_style(small, style.with(abstraction));
    [without, ink(small)]
}

/// A step that is a line near by is none far away, and a large step is one at every distance. The
/// lines of an object with a level of its own follow that, not its place.
#[test]
fn far_edges_must_be_stronger() {
    let mut small = before_white(Small::new(UVec2::new(96, 64), Msaa::Off));
    // At the threshold of 0.02 the response is 1, and above, the square of the ratio. That of a
    // step of 0.03 is 2.1, which is above the limit of 0.5 up to an abstraction of 0.46. The
    // abstraction at 75 units is 0.74, or its fourth power.
    for (step, exponent, levels, kept) in [
        (0.03, 1.0, None, [true, false]),
        (0.3, 1.0, None, [true, true]),
        (0.03, 4.0, None, [true, true]),
        (0.03, 1.0, Some([1.0, 0.0]), [false, true]),
    ] {
        let [without, with] = inks(&mut small, step, exponent, levels);
        for card in 0..2 {
            let what = format!("{step}, {exponent}, {levels:?}, {card}: {with:?} of {without:?}");
            assert!(without[card] > 15, "{what}");
            if kept[card] {
                assert_eq!(with[card], without[card], "{what}");
            } else {
                assert!(with[card] < without[card] / 2, "{what}");
            }
        }
    }
}

/// Objects with an abstraction of their own have its colors, at every distance.
#[test]
fn objects_have_colors_of_their_own_level() {
    let offset = |offset| ObjectSimplification {
        offset,
        ..default()
    };
    let mut small = Small::new(UVec2::new(96, 64), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        let abstraction = Abstraction {
            saturation: 0.0,
            band_splits: 0.0,
            ..default()
        };
        let fronts = cards(&mut small, [1.001, 100.9], 0.0001);
        let plain = spread(seen(&mut small)[0]);
        let levels = |small: &mut Small, [near, far]: [ObjectSimplification; 2]| {
            small.world().entity_mut(fronts[0]).insert(near);
            small.world().entity_mut(fronts[1]).insert(far);
            seen(small).map(spread)
        };
        let style = |granularity| {
            ComicStyle::new().with(Abstraction {
                granularity,
                ..abstraction
            })
        };
        set_style(&mut small, style(Granularity::Object));
        let fixed = ObjectSimplification::fixed;
        for reversed in [[fixed(1.0), fixed(0.0)], [offset(1.0), offset(-1.0)]] {
            let found = levels(&mut small, reversed);
            let right = found[0] <= 1 && found[1].abs_diff(plain) <= 1;
            assert!(right, "{msaa:?}: {found:?} of {plain}");
        }
        let found = levels(&mut small, [fixed(0.5), offset(-0.5)]);
        let half = found.map(|found| f32::from(found) / f32::from(plain));
        assert!(
            half.iter().all(|part| (0.3..0.75).contains(part)),
            "{half:?}"
        );
        // Inherited from a parent, except for those with their own.
        for front in fronts {
            let mut front = small.world().entity_mut(front);
            front.remove::<ObjectSimplification>();
        }
        let parent = (fixed(1.0), Transform::IDENTITY, Visibility::default());
        let parent = small.world().spawn(parent).id();
        small.world().entity_mut(parent).add_children(&fronts);
        small.world().entity_mut(fronts[1]).insert(fixed(0.0));
        let found = seen(&mut small).map(spread);
        assert!(found[0] <= 1 && found[1].abs_diff(plain) <= 1, "{found:?}");
        // Where every pixel is on its own, there are no objects.
        set_style(&mut small, style(Granularity::Pixel));
        let found = seen(&mut small).map(spread);
        assert!(found[1] <= 1 && found[0].abs_diff(plain) <= 1, "{found:?}");
    }
}

/// One figure has one level: the lines of an object that extends in depth appear at the same step,
/// between those at which they appear in its two halves.
#[test]
fn lines_of_an_object_follow_its_center() {
    // With the same ids of objects each time: the thresholds of a whole are equal to a step at some
    // ids only.
    let mut small = before_white(Small::alone(options(UVec2::new(96, 64)), Msaa::Off));
    let abstraction = Abstraction {
        line_threshold: 8.0,
        ..default()
    };
    let style = ComicStyle::new().with(sharp()).with(abstraction);
    set_style(&mut small, style);
    let mut have_lines = |step: u32, whole: bool| {
        let fronts = cards(&mut small, [30.0, 50.0], 0.002 * step as f32);
        if whole {
            let group = (OutlineGroup, Transform::IDENTITY, Visibility::default());
            let group = small.world().spawn(group).id();
            small.world().entity_mut(group).add_children(&fronts);
        }
        ink(&mut small).map(|ink| ink > 15)
    };
    // The least step that has lines, which both cards have or none.
    let (mut none, mut some) = (5, 40);
    for whole in [false, true] {
        assert_eq!(have_lines(none, whole), [false; 2]);
        assert_eq!(have_lines(some, whole), [true; 2]);
    }
    while some - none > 1 {
        let middle = (none + some) / 2;
        let found = have_lines(middle, true);
        assert_eq!(found[0], found[1], "at {middle}");
        if found[0] {
            some = middle;
        } else {
            none = middle;
        }
    }
    println!("the least step as a whole: {some}");
    // Alone, the near card has a line before that, and the far one later.
    assert!(have_lines(some - 1, false)[0], "near, {some}");
    assert!(!have_lines(some, false)[1], "far, {some}");
}

/// Lightness as `color.wgsl` has it: the square root of the luminance.
fn lightness(code: u8) -> f32 {
    Color::srgb_u8(code, code, code).to_linear().red.sqrt()
}

/// Truth: while the camera moves, tones split and never pop. A wall with a gradient keeps its size
/// on the screen, so that only the abstraction changes it.
#[test]
fn tones_split_without_popping() {
    const STEPS: usize = 150;
    const LEVELS: u32 = 2;
    const SPLITS: f32 = 3.0;
    let mut small = Small::new(UVec2::new(96, 24), Msaa::Off);
    small.clear();
    small.insert(Transform::IDENTITY);
    let colors: Vec<_> = [1.0, 0.02, 0.02, 1.0].map(|y: f32| [y, y, y, 1.0]).to_vec();
    let mesh =
        Mesh::from(Rectangle::new(4.0, 2.0)).with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    let wall = small.put(mesh, unlit(Color::WHITE), Transform::IDENTITY);
    let bands = ToneBands {
        levels: LEVELS,
        ..default()
    };
    let abstraction = Abstraction {
        band_splits: SPLITS,
        saturation: 1.0,
        ..default()
    };
    let style = ComicStyle::new().with(bands).with(abstraction);
    set_style(&mut small, style);
    let seen_at = |small: &mut Small, d: f32| {
        let away = 1.0 + 100.0 * d;
        let at = Transform::from_xyz(0.0, 0.0, -away).with_scale(Vec3::splat(away));
        small.world().entity_mut(wall).insert(at);
        small.headless.step(1);
        let picture = small.picture();
        let codes = picture.pixels().map(|p| lightness(p.0[0]));
        codes.collect::<Vec<f32>>()
    };
    seen_at(&mut small, 1.0);
    small.settle();
    let first = seen_at(&mut small, 1.0);
    let mut before = first.clone();
    let mut worst = (0.0f32, 0.0f32);
    // Around the places where bands are halved, each 1 / SPLITS of the depth, and at the ends.
    for part in [130..150, 90..110, 40..60, 0..20] {
        let from = part.end as f32 / STEPS as f32;
        seen_at(&mut small, from);
        before = seen_at(&mut small, from);
        for step in part.rev() {
            let d = step as f32 / STEPS as f32;
            let now = seen_at(&mut small, d);
            // The middles of a band and of its halves differ by a quarter of the band; smoothstep
            // has a slope of 1.5; and the place of an object near the eye follows it by up to 15 %
            // more.
            let coarse = 1.0 / (LEVELS as f32 * (SPLITS * (1.0 - d)).floor().exp2());
            let bound = 1.15 * 1.5 * SPLITS / STEPS as f32 * 0.25 * coarse.max(1.0 / 8.0) * 2.0;
            for (a, b) in before.iter().zip(&now) {
                let code = 1.2 / 255.0 / a.min(*b).max(0.05);
                let moved = (a - b).abs();
                worst.0 = worst.0.max(moved);
                worst.1 = worst.1.max((moved - code) / bound);
            }
            before = now;
        }
    }
    let changed = first.iter().zip(&before).map(|(a, b)| (a - b).abs());
    let changed = changed.fold(0.0, f32::max);
    println!("a step changes up to {worst:?} of {changed}");
    assert!(worst.1 <= 1.0, "{worst:?}");
    assert!(changed > 0.1, "{changed}");
}
