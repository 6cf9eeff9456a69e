use super::*;

fn camera(index: u32) -> Entity {
    Entity::from_raw_u32(index).expect("an index")
}

/// Runs frames in which the first camera has `missing(tolerant)` of 1000 covered pixels without
/// an id, with counts that arrive in the next frame and pipelines that take ten frames. Returns
/// the frames in which ids were drawn with a tolerance.
fn run(watch: &mut Watch, frames: u32, missing: impl Fn(bool) -> u32) -> Vec<u32> {
    let mut compiling = 0;
    let mut tolerant = Vec::new();
    let mut reading = Vec::new();
    for frame in 0..frames {
        watch.advance(std::mem::take(&mut reading), compiling >= 10);
        compiling = if watch.compiles() { compiling + 1 } else { 0 };
        if watch.tolerant() {
            tolerant.push(frame);
        }
        if watch.counts() {
            reading.push(Reading {
                camera: camera(1),
                covered: 1000,
                missing: missing(watch.tolerant()),
                tolerant: watch.tolerant(),
            });
        }
    }
    tolerant
}

#[test]
fn complete_ids_are_never_drawn_with_a_tolerance() {
    let mut watch = Watch::default();
    assert!(run(&mut watch, 5000, |_| 0).is_empty());
    // Half a percent, too: no triangle of the picture is that small as a whole.
    assert!(run(&mut watch, 5000, |_| 5).is_empty());
    assert!(watch.watches());
}

/// Ids that a tolerance brings back are found in the first frames, and at any later time; then
/// nothing is counted any more.
#[test]
fn lost_ids_switch_the_tolerance_on_for_good() {
    for before in [0, 1, 500] {
        let mut watch = Watch::default();
        assert!(run(&mut watch, before, |_| 0).is_empty());
        let lost = |tolerant: bool| if tolerant { 0 } else { 300 };
        let on = run(&mut watch, 200, lost);
        let first = on[0];
        assert_eq!(on, (first..200).collect::<Vec<_>>(), "{before}");
        assert!(first < if before < 64 { 25 } else { 90 }, "{first}");
        assert!(!watch.watches() && !watch.counts());
        assert_eq!(run(&mut watch, 200, |_| 0).len(), 200);
    }
}

/// Some pixels may rightly have no id, among others that lost theirs.
#[test]
fn a_tolerance_need_not_bring_all_ids_back() {
    let mut watch = Watch::default();
    run(&mut watch, 200, |tolerant| if tolerant { 300 } else { 500 });
    assert!(!watch.watches());
}

/// What a tolerance does not change, is tried a few times in an app, for a few frames.
#[test]
fn what_rightly_has_no_id_is_tried_a_few_times_at_most() {
    let mut watch = Watch::default();
    let tried = run(&mut watch, 20_000, |_| 400);
    assert!((3..8).contains(&tried.len()), "{tried:?}");
    assert!(watch.watches());
    // The fraction grows by and by, to all pixels.
    let mut watch = Watch::default();
    let mut trials = 0;
    for missing in 0..1000 {
        let tried = run(&mut watch, 400, |_| missing);
        trials += usize::from(!tried.is_empty());
    }
    assert!((2..8).contains(&trials), "{trials}");
}

/// A suspicion about a camera that is gone does not last; other cameras do not end it.
#[test]
fn a_camera_that_is_gone_leaves_no_trial_behind() {
    let mut watch = Watch::default();
    let reading = |index, missing| Reading {
        camera: camera(index),
        covered: 1000,
        missing,
        tolerant: false,
    };
    for _ in 0..3 {
        watch.advance(vec![reading(1, 0), reading(2, 500), reading(3, 0)], false);
    }
    assert!(watch.compiles());
    watch.advance(Vec::new(), true);
    assert!(watch.tolerant());
    for _ in 0..=TRIAL {
        watch.advance(vec![reading(1, 0)], false);
    }
    assert!(!watch.tolerant() && watch.watches() && !watch.compiles());
}
