//! Failures that post-processing plugins are known for, one test for each.

mod devices;
mod effects;
mod inputs;
mod lifetimes;
pub mod prepasses;
mod recovery;
mod views;

use bevy::light::cluster::GlobalClusterSettings;

use crate::{prelude::*, small::camera};

fn full_style() -> ComicStyle {
    ComicStyle::default()
        .with(Desaturation::default())
        .with(Colorization::default())
        .with(Contours {
            threshold: 0.05,
            ..default()
        })
}

/// Where the number of pixels does not matter.
fn tiny() -> UVec2 {
    UVec2::new(48, 32)
}

fn styled(msaa: Msaa) -> Small {
    let mut small = Small::new(size(), msaa);
    small.style(&full_style()).settle();
    small
}

/// Has the engine divide lights among clusters on the CPU.
fn cluster_on_cpu(small: &mut Small) {
    let mut clusters = small.world().resource_mut::<GlobalClusterSettings>();
    clusters.gpu_clustering = None;
}

fn outcome(small: &Small, camera: Entity, stage: ComicsStage) -> Option<StageOutcome> {
    small
        .headless
        .app
        .world()
        .resource::<ComicsDiagnostics>()
        .cameras
        .get(&camera)?
        .outcome(stage)
}
