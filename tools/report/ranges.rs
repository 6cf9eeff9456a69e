//! What finding the visible range takes: the crate's reductions, and smoothing.

use bevy_comics::{
    Colorization, ComicStyle, DepthMap,
    depth::{RangeSmoothing, ReductionMethod},
};

use bevy_comics_testkit::{scenes::BuiltIn, studio::with_map};

use crate::{
    Run,
    rig::{self, Drawn, Rig},
};

pub fn measure(run: &Run) -> Result<(), String> {
    let mut rig = Rig::new(Some(BuiltIn::Teapot), run.size([320, 180], [1920, 1080]));
    rig.unlight();
    let reductions = [
        ReductionMethod::BarrierFree,
        ReductionMethod::Subgroup,
        ReductionMethod::SharedMemory,
        ReductionMethod::PingPong,
    ];
    let reductions = reductions.map(|reduction| {
        let map = DepthMap {
            reduction,
            smoothing: None,
            ..DepthMap::default()
        };
        (format!("{reduction:?}"), map)
    });
    let smoothed = [
        ("smoothing without percentiles", 0.0),
        ("percentiles", 0.005),
    ];
    let smoothed = smoothed.map(|(name, outliers)| {
        let smoothing = Some(RangeSmoothing {
            outliers,
            ..RangeSmoothing::default()
        });
        let map = DepthMap {
            smoothing,
            ..DepthMap::default()
        };
        (name.to_owned(), map)
    });
    let tinted = |(name, map)| {
        let tint = ComicStyle::new().with(Colorization::default());
        (name, Drawn::style(with_map(tint, map)))
    };
    let variants: Vec<_> = reductions.into_iter().chain(smoothed).map(tinted).collect();
    let mut times = rig::times();
    rig::record(run, &mut times, "ranges", "teapot", &mut rig, &variants);
    run.save("range_times", &times)
}
