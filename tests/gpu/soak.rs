//! A short soak: nothing grows from cycle to cycle. `report --only soak` runs the long one.

use bevy_comics_testkit::soak::{Changes, Soak};

/// Sizes, objects and a file that breaks and is mended. The camera wears what was last readable. Looks are
/// not changed: lavapipe compiles shaders again for each, and keeps the memory.
#[test]
fn nothing_is_left_after_a_cycle_of_changes() {
    let folder = std::env::temp_dir().join(format!("bevy_comics_soak_{}", std::process::id()));
    let mut soak = Soak::new(&folder, Changes::of("sizes,objects,files")).expect("a file");
    let mut samples = Vec::new();
    for width in [1.0, 2.0, 3.0, 4.0, 1.0, 2.0] {
        samples.push(soak.cycle().expect("a file"));
        assert_eq!(soak.width_of_file(), Some(width));
    }
    std::fs::remove_dir_all(&folder).expect("the folder");
    for sample in &samples {
        println!("{sample:?}");
        assert_eq!(sample.errors, 0);
        assert!(sample.resources[0].1 > 0, "the report counts nothing");
    }
    // All widths have been drawn after four cycles.
    for (k, (kind, after)) in samples[5].resources.iter().enumerate() {
        let before = samples[3].resources[k].1.max(samples[4].resources[k].1);
        assert!(*after <= before, "{before} {kind} grew to {after}");
    }
    if let (Some(before), Some(after)) = (samples[3].resident, samples[5].resident) {
        assert!(after < before + before / 50, "{before} KiB grew to {after}");
    }
}
