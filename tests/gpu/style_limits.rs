//! Styles keep the limits that the gallery states.

use bevy_comics::style::Preset;
use bevy_comics_testkit::style_work::StyleBench;

use crate::prelude::*;

/// Strokes, in the scene that is drawn soonest.
#[test]
fn a_style_keeps_its_limits() {
    keep_their_limits(BuiltIn::Teapot, &[presets::ENGRAVING]);
}

#[test]
#[ignore = "long: every style"]
fn every_style_keeps_its_limits() {
    keep_their_limits(BuiltIn::Figure, presets::STYLES);
}

/// One scene, smaller and with fewer frames than the page; `pictures gallery` measures three
/// scenes, and the distances of styles. It alone counts fragments: their limit is of the mean over
/// the scenes, and styles with broken lines have more on one of them.
fn keep_their_limits(scene: BuiltIn, presets: &[Preset]) {
    let mut bench = StyleBench::new(scene, UVec2::new(160, 90), 3);
    bench.count_fragments = false;
    let (_, unstyled) = bench.measure(None);
    let mut failed = Vec::new();
    for preset in presets {
        let (_, measures) = bench.measure(Some(&preset.style()));
        println!("{preset}: {measures:?}, unstyled {unstyled:?}");
        let found = measures.failures(*preset, &unstyled);
        failed.extend(found.into_iter().map(|text| format!("{preset}: {text}")));
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
