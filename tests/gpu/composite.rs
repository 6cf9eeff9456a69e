//! `StyleWeight`, `SplitView`, debug views and the histogram, in pictures.

use bevy_comics::depth::DepthBin;
use bevy_comics_testkit::reference::color;
use image::RgbaImage;

use crate::prelude::*;

fn styled() -> Small {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert((Desaturation::default(), Contours::default()));
    small
}

#[test]
fn a_weight_mixes_and_none_costs_nothing() {
    let mut small = styled();
    let full = small.settle().picture();
    small.insert(StyleWeight(1.0));
    assert_eq!(
        small.settle().picture(),
        full,
        "all of it is as without the component"
    );
    small.insert(StyleWeight(f32::NAN));
    assert_eq!(
        small.settle().picture(),
        full,
        "what is no number counts as 1"
    );
    small.insert(StyleWeight(0.0));
    let none = small.settle().picture();
    assert!(!small.ran(ComicsStage::Stylize) && !small.ran(ComicsStage::DepthRange));
    small.insert(StyleWeight(-3.0));
    assert_eq!(small.settle().picture(), none, "a weight is clamped");
    small.insert(StyleWeight(0.5));
    let half = small.settle().picture();
    let mut changed = 0;
    for (x, y, pixel) in half.enumerate_pixels() {
        let (a, b) = (linear(&none, x, y), linear(&full, x, y));
        let want = color::srgb_encode(std::array::from_fn(|i| 0.5 * (a[i] + b[i])));
        // Both ends and the mix are rounded to 8-bit codes.
        let is_right = |i: usize| (f64::from(pixel[i]) - want[i] * 255.0).abs() <= 2.0;
        assert!((0..3).all(is_right), "{x}, {y}: {pixel:?}, {want:?}");
        changed += u32::from(none.get_pixel(x, y) != pixel);
    }
    assert!(changed > 500, "the style does something: {changed}");

    let mut camera = small.camera_mut();
    camera.remove::<(Desaturation, Contours, StyleWeight)>();
    assert_eq!(small.settle().picture(), none, "none is the original");
}

#[test]
fn a_split_shows_both_pictures_to_the_bit() {
    let mut small = styled();
    let full = small.settle().picture();
    small.insert(StyleWeight(0.0));
    let none = small.settle().picture();
    small.insert((StyleWeight(1.0), SplitView { at: 0.25 }));
    let both = small.settle().picture();
    let line = size().x / 4;
    for (x, y, pixel) in both.enumerate_pixels() {
        let want = if x < line { &none } else { &full };
        assert_eq!(pixel, want.get_pixel(x, y), "{x}, {y}");
    }
    small.insert(SplitView { at: 7.0 });
    assert_eq!(small.settle().picture(), none);
    small.insert(SplitView { at: f32::NAN }).settle();
}

fn is_gray(picture: &RgbaImage) -> bool {
    picture.pixels().all(|p| p[0] == p[1] && p[1] == p[2])
}

fn codes(picture: &RgbaImage) -> BTreeSet<[u8; 3]> {
    picture.pixels().map(|p| [p[0], p[1], p[2]]).collect()
}

/// The picture of a debug view, which is not the original.
fn show(small: &mut Small, view: DebugView, original: &RgbaImage) -> RgbaImage {
    small.insert(view);
    let picture = small.settle().picture();
    assert_ne!(picture, *original, "{view:?}");
    picture
}

#[test]
fn every_view_shows_what_it_says() {
    assert_views_of_the_scene(Msaa::Off);
}

#[test]
fn every_view_of_effects_shows_what_it_says() {
    assert_views_of_effects(Msaa::Off);
}

#[test]
#[ignore = "long: shaders of their own; `debug_views_show_it` draws most of them"]
fn every_multisampled_view_shows_what_it_says() {
    assert_views_of_the_scene(Msaa::Sample4);
    assert_views_of_effects(Msaa::Sample4);
}

fn assert_views_of_the_scene(msaa: Msaa) {
    let mut small = Small::new(size(), msaa);
    let original = small.settle().picture();
    let show = |small: &mut Small, view| show(small, view, &original);
    // No effect on the camera: a debug view requests what it needs.
    let map = show(&mut small, DebugView::DepthMap);
    assert!(is_gray(&map) && small.ran(ComicsStage::DepthRange));
    let shades = codes(&map);
    assert!(shades.contains(&[255; 3]), "the sky is far");
    assert!(shades.iter().any(|s| s[0] < 12), "something is near");
    assert!(shades.len() > 20, "and much in between");
    let raw = show(&mut small, DebugView::RawRange);
    assert!(is_gray(&raw));
    // In the one picture near is brighter, in the other far.
    for (a, b) in map.pixels().zip(raw.pixels()) {
        if a[0] < 8 {
            assert!(b[0] > 200, "{a:?} {b:?}");
        }
        if a[0] == 255 {
            assert!(b[0] < 40, "{a:?} {b:?}");
        }
    }
    for view in [DebugView::Silhouettes, DebugView::Creases] {
        let lines = show(&mut small, view);
        let dark = lines.pixels().filter(|p| p[0] < 128).count();
        assert!(is_gray(&lines) && dark > 20, "{view:?}: {dark} dark pixels");
        assert!(
            dark < (size().x * size().y / 3) as usize,
            "{view:?} is mostly paper"
        );
    }
    let ids = show(&mut small, DebugView::ObjectIds);
    assert!(small.ran(ComicsStage::ObjectIds));
    assert!(codes(&ids).len() >= 4, "objects have colors of their own");
    assert!(codes(&ids).contains(&[0; 3]), "the sky is no object");
}

fn assert_views_of_effects(msaa: Msaa) {
    let mut small = Small::new(size(), msaa);
    let original = small.settle().picture();
    let show = |small: &mut Small, view| show(small, view, &original);
    let map = show(&mut small, DebugView::DepthMap);
    let bands = show(&mut small, DebugView::Effect("tone_bands"));
    assert!(is_gray(&bands) && codes(&bands).len() < 40);
    let kept = show(&mut small, DebugView::Saturation);
    assert_eq!(codes(&kept).len(), 1, "no style takes color away");
    let same = show(&mut small, DebugView::Difference);
    assert_eq!(codes(&same), [[0; 3]].into(), "no style is no difference");

    small.insert((Desaturation::default(), ToneBands::default()));
    let kept = show(&mut small, DebugView::Saturation);
    assert!(is_gray(&kept) && codes(&kept).len() > 20);
    let apart = show(&mut small, DebugView::Difference);
    assert!(codes(&apart).len() > 20);
    // A weight does not hide a debug view; a split applies to it.
    small.insert((StyleWeight(0.0), SplitView { at: 0.5 }));
    let split = show(&mut small, DebugView::DepthMap);
    for (x, y, pixel) in split.enumerate_pixels() {
        let want = if x < size().x / 2 { &original } else { &map };
        assert_eq!(pixel, want.get_pixel(x, y), "{x}, {y}");
    }
}

fn histogram(small: &mut Small) -> DepthHistogram {
    small.settle();
    let histogram = small.camera_mut().get::<DepthHistogram>().cloned();
    histogram.expect("asked for")
}

#[test]
fn the_histogram_counts_every_depth_once() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert((
        DepthHistogram::default(),
        VisibleDepthRange::default(),
        DebugView::DepthMap,
    ));
    let map = small.settle().picture();
    let found = histogram(&mut small);
    let range = small.range().and_then(VisibleDepthRange::distances);
    let (near, far) = range.expect("geometry");
    let count = |found: &DepthHistogram| found.bins.iter().map(|bin| bin.count).sum::<u32>();
    let counted = count(&found);
    let sky = map.pixels().filter(|p| p[0] == 255).count() as u32;
    let all = size().x * size().y;
    // The sky and the farthest geometry are white.
    assert!(
        counted >= all - sky && counted < all,
        "{counted} of {all}, {sky} white"
    );
    for (bin, end) in [(found.bins.first(), near), (found.bins.last(), far)] {
        let bin = bin.expect("bins");
        assert!(bin.near <= end && end <= bin.far, "{bin:?}, {end}");
    }
    let gapless = |pair: &[DepthBin]| pair[0].far == pair[1].near;
    assert!(found.bins.windows(2).all(gapless), "{found:?}");
    let drawn = found.drawn.expect("a range is drawn with");
    assert!(
        (drawn.0 - near).abs() < 1e-3 * near && (drawn.1 - far).abs() < 1e-3 * far,
        "{drawn:?}"
    );

    // Also without smoothing, and in an empty view.
    small.insert(DepthMap {
        smoothing: None,
        ..default()
    });
    assert_eq!(count(&histogram(&mut small)), counted);
    small.clear();
    let empty = histogram(&mut small);
    assert!(empty.bins.is_empty() && empty.drawn.is_none(), "{empty:?}");
}

/// A sketch with a small weight changes the picture little, with and without
/// outlines on the camera.
#[test]
fn a_sketch_fades_in() {
    let mut small = Small::new(UVec2::new(160, 96), Msaa::Off);
    let sketch = |amount| Sketch {
        amount,
        rate: 0.0,
        ..default()
    };
    let outlines = Outlines {
        objects: None,
        ..default()
    };
    for lines in [None, Some(outlines)] {
        let lined = with_option(ComicStyle::default(), lines);
        let style = |sketch| with_option(lined.clone(), sketch);
        let before = small.shot(&style(None));
        assert_eq!(
            small.shot(&style(Some(sketch(0.0)))),
            before,
            "no amount is no sketch"
        );
        assert!(!small.ran(ComicsStage::of::<Sketch>()));
        let begun = small.shot(&style(Some(sketch(0.004))));
        let apart = before
            .pixels()
            .zip(begun.pixels())
            .map(|(a, b)| u32::from(a[0].abs_diff(b[0])))
            .sum::<u32>() as f64
            / f64::from(160 * 96);
        assert!(apart < 2.0, "with lines {}: {apart} codes", lines.is_some());
        let whole = small.shot(&style(Some(sketch(1.0))));
        let nearly = small.shot(&style(Some(sketch(0.9999))));
        for (a, b) in whole.pixels().zip(nearly.pixels()) {
            assert!((0..3).all(|i| a[i].abs_diff(b[i]) <= 1), "{a:?} {b:?}");
        }
    }
}
