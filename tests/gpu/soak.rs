//! A short run in which everything changes. The long one is `report --only soak`, which looks at the memory
//! of the process too: here looks change, and the driver keeps memory for each.

use bevy_comics_testkit::soak::{Changes, Pace, Sample, Soak};

/// Looks that follow each other. The first ones have lines between objects: other looks would have the
/// buffers of object ids made anew, which takes up to 64 frames.
const LOOKS: usize = 3;

/// Nothing on the GPU is left of cameras, objects, sizes, looks and broken files.
#[test]
fn a_short_run_leaves_nothing_behind() {
    let name = format!("bevy_comics_short_soak_{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    let changes = Changes {
        looks: LOOKS,
        ..Changes::default()
    };
    let mut soak = Soak::with_pace(&folder, changes, Pace::SHORT).expect("a temporary folder");
    let mut round = || -> Vec<Sample> {
        let kinds = Pace::SHORT.kinds.iter();
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
