//! What lines find and cost.

use bevy_comics_testkit::scenes::BuiltIn;

use crate::{
    Run,
    rig::{self, Rig},
    scores::{detectors, score},
};

pub fn measure(run: &Run) -> Result<(), String> {
    score(run)?;
    let mut rig = Rig::new(Some(BuiltIn::Teapot), run.size([320, 180], [1280, 720]));
    rig.unlight();
    let variants = rig::styles(run.some(2, detectors()));
    let mut times = rig::times();
    rig::record(run, &mut times, "lines", "teapot", &mut rig, &variants);
    run.save("line_times", &times)
}
