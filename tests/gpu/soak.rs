//! A short soak: nothing grows from cycle to cycle. `report --only soak` runs the long one.

use bevy_comics_testkit::soak::Soak;

/// The file of a style breaks and is mended in every cycle, and the camera wears what was last
/// readable.
#[test]
fn nothing_is_left_after_a_cycle_of_changes() {
    let folder = std::env::temp_dir().join(format!("bevy_comics_soak_{}", std::process::id()));
    let mut soak = Soak::new(&folder).expect("a folder for a file");
    // Four kinds of views: with and without samples and HDR colours.
    let first: Vec<_> = (0..4).map(|_| soak.cycle().expect("a file")).collect();
    assert_eq!(soak.width_of_file(), Some(4.0));
    let second: Vec<_> = (0..2).map(|_| soak.cycle().expect("a file")).collect();
    assert_eq!(soak.width_of_file(), Some(2.0));
    std::fs::remove_dir_all(&folder).expect("the folder");
    for sample in first.iter().chain(&second) {
        println!("{sample:?}");
        assert_eq!(sample.errors, 0);
        assert!(sample.resources[0].1 > 0, "the report counts nothing");
    }
    // Pipelines stay: all have been compiled in the first four cycles. Of the rest there is as much as
    // with the same kind of view before.
    for (before, after) in first.iter().zip(&second) {
        let counts = before.resources.iter().zip(&after.resources);
        for ((before, after), all) in counts.zip(&first[3].resources) {
            let is_pipeline = after.0.ends_with("pipelines");
            let most = if is_pipeline { all } else { before };
            assert!(after.1 <= most.1, "{most:?} grew to {after:?}");
        }
    }
}
