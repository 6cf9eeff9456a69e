//! The depth test of object ids. They are drawn where depth is *equal* to that of the depth
//! prepass. WGSL does not promise that two pipelines compute the same position, and the
//! engine's vertex shaders have no `@invariant`: on a device where the positions differ, ids
//! would be missing. So missing ids are counted (`count.rs`), and where a trial shows that a
//! tolerance brings them back (`watch.rs`), ids are drawn with one (`bindings.rs`).

mod count;
mod watch;

use std::sync::{
    PoisonError,
    atomic::{AtomicU32, Ordering},
};

use bevy::{
    asset::embedded_asset,
    prelude::*,
    render::{
        Extract, GpuResourceAppExt, Render, RenderStartup, RenderSystems,
        render_resource::SpecializedComputePipelines,
    },
    shader::load_shader_library,
};

use self::{
    count::{CountPipeline, Readings, init_count_pipeline, map_counts, prepare_counts},
    watch::Watch,
};
use crate::schedule::PrepareComics;

pub(super) use count::{IdCount, count_ids};

/// How the pass of object ids compares depth with the depth prepass. A resource of the main
/// world; a change takes effect in the next frame.
///
/// Object ids are drawn by a second pass over the meshes of the depth prepass. On a device that
/// computes slightly different positions in that pass, the test for equal depth fails at some
/// pixels, which then have no id: lines between objects, and effects that follow objects, break up
/// there.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Resource, Default, Clone, PartialEq)]
#[non_exhaustive]
pub enum ObjectIdDepthTest {
    /// `Equal`, until pixels without an id are found, and a trial of a few frames shows that
    /// `Tolerant` gives them one. Then `Tolerant` for as long as the app runs; the log says so
    /// once. On devices without compute shaders it is always `Equal`. The default.
    #[default]
    Auto,
    /// Depth is equal to that of the prepass.
    Equal,
    /// Depth differs from that of the prepass by 2^-12 of itself (0.024 % of the distance, in
    /// perspective) plus 2^-22, and a sixteenth of its change over a pixel, at most; in
    /// multisampled views three quarters of that change. The nearest such mesh counts. Costs a
    /// depth texture and a texture load per pixel and mesh.
    Tolerant,
}

/// The name of the tolerant test in the diagnostics.
pub(super) const TOLERANT: &str = "tolerant depth";

/// The depth test of this frame. It changes during extraction only.
#[derive(Resource, Default)]
pub(super) struct DepthTest {
    setting: ObjectIdDepthTest,
    watch: Watch,
    /// The counts that have arrived from the GPU.
    readings: Readings,
    /// Tolerant pipelines that were asked for ahead of their use in the last frame, and those
    /// of them that were compiled.
    asked: AtomicU32,
    compiled: AtomicU32,
}

impl DepthTest {
    /// Whether ids are drawn with a tolerance in this frame.
    pub fn tolerant(&self) -> bool {
        match self.setting {
            ObjectIdDepthTest::Auto => self.watch.tolerant(),
            ObjectIdDepthTest::Equal => false,
            ObjectIdDepthTest::Tolerant => true,
        }
    }

    fn is_auto(&self) -> bool {
        self.setting == ObjectIdDepthTest::Auto
    }

    /// Whether missing ids may be counted in some later frame.
    fn watches(&self) -> bool {
        self.is_auto() && self.watch.watches()
    }

    /// Whether missing ids are counted in this frame.
    fn counts(&self) -> bool {
        self.is_auto() && self.watch.counts()
    }

    /// Whether tolerant pipelines compile ahead of their use. Without that, all ids would be
    /// missing in the first frames of a trial.
    pub fn compiles_ahead(&self) -> bool {
        self.is_auto() && self.watch.compiles()
    }

    /// Notes a pipeline that was asked for ahead of its use.
    pub fn note_ahead(&self, compiled: bool) {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.compiled
            .fetch_add(u32::from(compiled), Ordering::Relaxed);
    }
}

/// Begins the frame: takes the setting of the game, and the counts that have arrived.
fn advance_depth_test(main: Extract<Option<Res<ObjectIdDepthTest>>>, mut test: ResMut<DepthTest>) {
    let test = &mut *test;
    test.setting = main.as_ref().map(|setting| **setting).unwrap_or_default();
    let readings = std::mem::take(
        &mut *test
            .readings
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner),
    );
    let [asked, compiled] =
        [&test.asked, &test.compiled].map(|count| count.swap(0, Ordering::Relaxed));
    if !test.is_auto() {
        return;
    }
    let ready = asked > 0 && asked == compiled;
    if let Some(fraction) = test.watch.advance(readings, ready) {
        warn!(
            "`ObjectIdDepthTest`: this device does not draw object ids at the depths of the \
             prepass ({:.0} % of the pixels had none). They are drawn with a tolerance from now \
             on, which costs more",
            100.0 * fraction
        );
    }
}

/// The part in the main world.
pub(super) fn build(app: &mut App) {
    app.register_type::<ObjectIdDepthTest>()
        .init_resource::<ObjectIdDepthTest>();
}

/// The shaders. Needs the engine's assets.
pub(super) fn build_shaders(app: &mut App) {
    load_shader_library!(app, "tolerance.wgsl");
    embedded_asset!(app, "count.wgsl");
}

/// The part in the render world.
pub(super) fn build_render(render_app: &mut SubApp) {
    render_app
        .init_resource::<DepthTest>()
        .init_gpu_resource::<SpecializedComputePipelines<CountPipeline>>()
        .add_systems(RenderStartup, init_count_pipeline)
        .add_systems(ExtractSchedule, advance_depth_test)
        .add_systems(
            Render,
            (
                prepare_counts.in_set(PrepareComics::Services),
                map_counts.in_set(RenderSystems::Cleanup),
            ),
        );
}
