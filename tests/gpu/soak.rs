//! A short run in which everything changes. The long one is `report --only soak`, which looks at
//! the memory of the process too: here looks change, and the driver keeps memory for each.

use bevy_comics_testkit::soak::{Changes, Pace, Sample, Soak};

/// Draws cycles of changes: as many as there are kinds of cameras, then twice the same, after which
/// the GPU must hold the same.
fn assert_nothing_is_left(changes: Changes, pace: Pace) {
    let name = format!("bevy_comics_soak_{}_{}", changes.looks, std::process::id());
    let folder = std::env::temp_dir().join(name);
    let mut soak = Soak::with_pace(&folder, changes, pace).expect("a temporary folder");
    let mut round = || -> Vec<Sample> {
        let kinds = pace.kinds.iter();
        kinds.map(|_| soak.cycle().expect("a file")).collect()
    };
    let warm_up = round();
    let rounds = [round(), round()];
    std::fs::remove_dir_all(&folder).expect("removed");
    let samples = || warm_up.iter().chain(rounds.iter().flatten());
    assert!(samples().all(|sample| sample.styled), "no look is drawn");
    assert!(samples().all(|sample| sample.errors == 0), "errors");
    let [before, after] = &rounds;
    for (before, after) in before.iter().zip(after) {
        assert!(!before.resources.is_empty(), "resources are not counted");
        assert_eq!(
            before.resources, after.resources,
            "frames {} and {}",
            before.frame, after.frame
        );
    }
}

/// Nothing on the GPU is left of cameras, objects and sizes.
#[test]
fn a_short_run_leaves_nothing_behind() {
    let changes = Changes {
        looks: 1,
        materials: false,
        files: false,
        ..Changes::default()
    };
    assert_nothing_is_left(changes, Pace::SHORTEST);
}

/// Nor of materials, looks and broken files.
///
/// The looks here are the first ones, which have lines between objects: other looks would have the
/// buffers of object ids made anew, which takes up to 64 frames.
#[ignore = "long: a thousand frames"]
#[test]
fn a_thousand_frames_leave_nothing_behind() {
    let changes = Changes {
        looks: 3,
        ..Changes::default()
    };
    assert_nothing_is_left(changes, Pace::SHORT);
}
