//! What a view does not need does not run: passes, prepasses, range, effects.

use crate::prelude::*;

fn small() -> Small {
    Small::new(size(), Msaa::Off)
}

/// The stages that ran, and the reason for each that did not.
fn stages(small: &Small) -> (Vec<ComicsStage>, Vec<(ComicsStage, SkipReason)>) {
    let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
    let camera = diagnostics.cameras.get(&small.camera).expect("listed");
    let (mut ran, mut left) = (Vec::new(), Vec::new());
    for (stage, outcome) in &camera.stages {
        match outcome {
            StageOutcome::Skipped(reason) => left.push((*stage, *reason)),
            _ => ran.push(*stage),
        }
    }
    (ran, left)
}

fn remove<C: Component>(small: &mut Small) {
    small.camera_mut().remove::<C>();
    small.settle();
}

/// A `DepthMap` alone requests nothing either.
#[test]
fn a_camera_without_styles_costs_nothing() {
    let mut small = small();
    for has_map in [false, true] {
        if has_map {
            small.insert(DepthMap::default());
        }
        small.settle();
        let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
        assert!(diagnostics.cameras.is_empty());
        assert!(!small.has::<DepthPrepass>() && small.depth().is_none());
    }
}

#[test]
fn one_atmosphere_for_all_reads_no_depth() {
    let mut small = small();
    small.insert(Colorization::SEPIA).settle();
    let (ran, left) = stages(&small);
    assert_eq!(
        ran,
        [ComicsStage::of::<Colorization>(), ComicsStage::Stylize]
    );
    for skipped in [
        (ComicsStage::DepthPrepass, SkipReason::NoDepthStyle),
        (ComicsStage::DepthRange, SkipReason::NoDepthStyle),
        (ComicsStage::of::<Contours>(), SkipReason::NotRequested),
    ] {
        assert!(left.contains(&skipped), "{skipped:?}");
    }
    // Nor do flats of one threshold.
    for (depth_weight, reads_depth) in [(0.0, false), (0.5, true)] {
        let flats = BlackFlats {
            depth_weight,
            ..default()
        };
        assert_eq!(
            small.insert(flats).settle().has::<DepthPrepass>(),
            reads_depth
        );
    }
}

#[test]
fn a_fixed_range_has_no_reduction() {
    let mut small = small();
    for mapping in [
        DepthMapping::Linear,
        DepthMapping::Logarithmic,
        DepthMapping::Fixed {
            from: 2.0,
            to: 12.0,
        },
        DepthMapping::FixedLogarithmic {
            from: 2.0,
            to: 12.0,
        },
    ] {
        let map = DepthMap {
            mapping,
            ..default()
        };
        small.insert((map, Contours::default())).settle();
        let (ran, left) = stages(&small);
        assert_eq!(
            ran,
            [
                ComicsStage::DepthPrepass,
                ComicsStage::SearchTiles,
                ComicsStage::of::<Contours>(),
                ComicsStage::Stylize
            ]
        );
        let skipped = (ComicsStage::DepthRange, SkipReason::FixedRange);
        assert!(left.contains(&skipped), "{mapping:?}");
    }
    small.insert(DepthMap::default()).settle();
    assert!(small.ran(ComicsStage::DepthRange));
}

#[test]
fn what_changes_nothing_is_left_out() {
    let mut small = small();
    let original = small.settle().picture();
    small
        .insert((
            Desaturation {
                amount: 0.0,
                ..default()
            },
            Colorization {
                mode: ColorizationMode::KeepHue,
                ..default()
            },
            BlackFlats {
                value: None,
                ..default()
            },
            Contours {
                opacity: -3.0,
                ..default()
            },
        ))
        .settle();
    let (ran, left) = stages(&small);
    assert_eq!(ran, []);
    for stage in [
        ComicsStage::of::<Desaturation>(),
        ComicsStage::of::<Colorization>(),
        ComicsStage::of::<BlackFlats>(),
        ComicsStage::of::<Contours>(),
    ] {
        assert!(left.contains(&(stage, SkipReason::Negligible)), "{stage:?}");
    }
    assert!(left.contains(&(ComicsStage::Stylize, SkipReason::NothingToDraw)));
    assert!(!small.has::<DepthPrepass>());
    assert_eq!(small.picture(), original);
}

/// Outlines request only what they draw: no range without a fade, no normals
/// without creases, no ids without object edges.
#[test]
fn outlines_run_what_they_need_and_no_more() {
    let mut small = small();
    small.insert(Outlines::SILHOUETTES).settle();
    let (ran, left) = stages(&small);
    assert_eq!(
        ran,
        [
            ComicsStage::DepthPrepass,
            ComicsStage::SearchTiles,
            ComicsStage::FindLines,
            ComicsStage::DrawLines,
            ComicsStage::of::<Outlines>(),
            ComicsStage::Stylize,
        ]
    );
    for skipped in [
        (ComicsStage::DepthRange, SkipReason::NoMapStyle),
        (ComicsStage::NormalPrepass, SkipReason::NoSuchLines),
        (ComicsStage::ObjectIds, SkipReason::NoSuchLines),
    ] {
        assert!(left.contains(&skipped), "{skipped:?}");
    }
    small
        .insert(Outlines {
            width: 9.0,
            opacity_fade: 0.5,
            ..default()
        })
        .settle();
    for stage in [
        ComicsStage::NormalPrepass,
        ComicsStage::ObjectIds,
        ComicsStage::DepthRange,
    ] {
        assert!(small.ran(stage), "{stage:?}");
    }
    remove::<Outlines>(&mut small);
    assert!(!small.has::<DepthPrepass>());
    // Tone bands alone read no depth.
    small.insert(ToneBands::default()).settle();
    let (ran, _) = stages(&small);
    assert_eq!(ran, [ComicsStage::of::<ToneBands>(), ComicsStage::Stylize]);
    // A sketch with invisible lines leaves the picture unchanged.
    remove::<ToneBands>(&mut small);
    let original = small.picture();
    let invisible = Outlines {
        silhouettes: None,
        creases: None,
        objects: None,
        ..default()
    };
    small.insert((Sketch::default(), invisible)).settle();
    assert_eq!(stages(&small).0, []);
    assert_eq!(small.picture(), original);
}

/// A sketch replaces the outlines and draws their lines; without `Outlines` on
/// the camera it uses default lines.
#[test]
fn a_sketch_draws_in_place_of_the_outlines() {
    let mut small = small();
    small.insert(Sketch::default()).settle();
    for reason in [SkipReason::NotRequested, SkipReason::Replaced] {
        let (ran, left) = stages(&small);
        for stage in [ComicsStage::DrawLines, ComicsStage::of::<Sketch>()] {
            assert!(ran.contains(&stage), "{stage:?}, {reason:?}");
        }
        let skipped = (ComicsStage::of::<Outlines>(), reason);
        assert!(left.contains(&skipped), "{left:?}");
        small.insert(Outlines::default()).settle();
    }
}

#[test]
fn the_game_can_ask_for_the_range_alone() {
    let mut small = small();
    let original = small.settle().picture();
    small.insert(VisibleDepthRange::default()).settle();
    let (ran, _) = stages(&small);
    assert_eq!(
        ran,
        [
            ComicsStage::DepthPrepass,
            ComicsStage::DepthRange,
            ComicsStage::RangeReadback
        ]
    );
    assert_eq!(small.picture(), original);
    let range = small.range().and_then(VisibleDepthRange::distances);
    let (near, far) = range.expect("a range");
    // The camera is 6.6 units from the center of a ground of 9 by 9.
    assert!(
        1.0 < near && near < 5.0 && 8.0 < far && far < 14.0,
        "{near} to {far}"
    );
}

#[test]
fn both_passes_have_time_spans_in_the_engines_diagnostics() {
    use bevy::{diagnostic::DiagnosticsStore, render::diagnostic::RenderDiagnosticsPlugin};
    let mut small = Small::with_plugins(options(size()), Msaa::Off, RenderDiagnosticsPlugin);
    small.insert(Contours::default());
    small.headless.step(20);
    let store = small.headless.app.world().resource::<DiagnosticsStore>();
    for pass in ["comics_depth_range", "comics_stylize"] {
        let measured = store.iter().any(|d| d.path().as_str().contains(pass));
        assert!(measured, "{pass} is not among the diagnostics");
    }
}
