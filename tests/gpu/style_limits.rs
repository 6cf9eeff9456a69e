//! Looks keep the limits that the page of looks states.

use bevy_comics::style::Preset;
use bevy_comics_testkit::style_work::LookBench;

use crate::prelude::*;

/// Strokes, in the scene that is drawn soonest.
#[test]
fn a_look_keeps_its_limits() {
    keep_their_limits(BuiltIn::Teapot, &[presets::ENGRAVING]);
}

#[test]
#[ignore = "long: every look"]
fn every_look_keeps_its_limits() {
    keep_their_limits(BuiltIn::Figure, presets::STYLES);
}

/// One scene, smaller and with fewer frames than the page; `pictures gallery` measures three
/// scenes, and the distances of looks. It alone counts fragments: their limit is of the mean over
/// the scenes, and looks with broken lines have more on one of them.
fn keep_their_limits(scene: BuiltIn, looks: &[Preset]) {
    let mut bench = LookBench::new(scene, UVec2::new(160, 90), 3);
    bench.count_fragments = false;
    let (_, unstyled) = bench.measure(None);
    let mut failed = Vec::new();
    for look in looks {
        let (_, measures) = bench.measure(Some(&look.style()));
        println!("{look}: {measures:?}, unstyled {unstyled:?}");
        let found = measures.failures(*look, &unstyled);
        failed.extend(found.into_iter().map(|text| format!("{look}: {text}")));
    }
    assert!(failed.is_empty(), "{failed:#?}");
}
