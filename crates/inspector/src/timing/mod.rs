//! Times of the passes of all cameras.

mod stopwatch;

use std::{
    collections::VecDeque,
    sync::{Mutex, MutexGuard, PoisonError},
};

use bevy::{
    anti_alias::{fxaa::fxaa, smaa::smaa},
    core_pipeline::{
        schedule::{Core3d, Core3dSystems},
        tonemapping::tonemapping,
        upscaling::upscaling,
    },
    prelude::*,
    render::{
        Extract, Render, RenderApp, RenderSystems,
        renderer::{RenderAdapterInfo, RenderDevice},
    },
};

use bevy_comics::ComicsSystems;
use stopwatch::{Laps, Stopwatch, end_frame, lap};

/// Parts of a camera's frame, in order: the laps of [`PassTimesPlugin`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pass {
    /// The engine's depth and normal prepass.
    Prepass,
    /// The depth range: reduction and smoothing.
    DepthRange,
    /// The ids of objects, and finding and drawing lines.
    Outlines,
    /// The engine's main pass.
    Main,
    /// The engine's post-processing before the styles, tonemapping included.
    Tonemapping,
    /// The fused pass of the styles.
    Stylize,
    /// The engine's post-processing after the styles.
    After,
}

impl Pass {
    /// All of them, in order.
    pub const ALL: &[Self] = &[
        Self::Prepass,
        Self::DepthRange,
        Self::Outlines,
        Self::Main,
        Self::Tonemapping,
        Self::Stylize,
        Self::After,
    ];

    /// The name in charts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Prepass => "prepass",
            Self::DepthRange => "depth range",
            Self::Outlines => "outlines",
            Self::Main => "main pass",
            Self::Tonemapping => "to tonemapping",
            Self::Stylize => "stylize",
            Self::After => "after",
        }
    }

    /// Whether the pass is this crate's own.
    pub fn is_comics(self) -> bool {
        matches!(self, Self::DepthRange | Self::Outlines | Self::Stylize)
    }
}

/// The times of every [`Pass`], in the main world. [`PassTimesPlugin`] fills it
/// while it runs; it starts stopped.
#[derive(Resource, Default)]
pub struct PassTimes(Mutex<Times>);

#[derive(Default)]
struct Times {
    running: bool,
    frames: VecDeque<Laps>,
    method: Option<&'static str>,
}

/// Number of frames kept.
const KEPT: usize = 240;

impl PassTimes {
    fn lock(&self) -> MutexGuard<'_, Times> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts or stops taking times. A start discards earlier frames.
    pub fn run(&self, running: bool) {
        let mut times = self.lock();
        if running && !times.running {
            times.frames.clear();
        }
        times.running = running;
    }

    /// Milliseconds by [`Pass`], of the last 240 timed frames, oldest first.
    pub fn frames(&self) -> Vec<[f64; Pass::ALL.len()]> {
        let padded =
            |frame: &Laps| std::array::from_fn(|lap| frame.get(lap).copied().unwrap_or(0.0));
        self.lock().frames.iter().map(padded).collect()
    }

    /// How times are taken on this adapter, in words; `None` before the first.
    pub fn method(&self) -> Option<&'static str> {
        self.lock().method
    }
}

/// Adds [`PassTimes`], which times every [`Pass`] of all cameras together.
#[derive(Default)]
pub struct PassTimesPlugin;

/// Copies the switch to the render world, and the times back.
fn exchange(
    times: Extract<Res<PassTimes>>,
    mut watch: ResMut<Stopwatch>,
    info: Res<RenderAdapterInfo>,
    device: Res<RenderDevice>,
) {
    let mut times = times.lock();
    watch.running = times.running;
    if times.running {
        times.method = Some(stopwatch::method(&info, &device));
        times.frames.extend(watch.frames.drain(..));
        let old = times.frames.len().saturating_sub(KEPT);
        times.frames.drain(..old);
    } else {
        watch.frames.clear();
    }
}

impl Plugin for PassTimesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<PassTimes>();
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .insert_resource(Stopwatch::new(false))
            .add_systems(ExtractSchedule, exchange)
            .add_systems(
                Core3d,
                (
                    lap(None).before(Core3dSystems::Prepass),
                    lap(Some(Pass::Prepass as usize))
                        .after(Core3dSystems::Prepass)
                        .before(ComicsSystems::DepthRange),
                    lap(Some(Pass::DepthRange as usize))
                        .after(ComicsSystems::DepthRange)
                        .before(ComicsSystems::Outlines),
                    lap(Some(Pass::Outlines as usize))
                        .after(ComicsSystems::Outlines)
                        .before(Core3dSystems::MainPass),
                    lap(Some(Pass::Main as usize))
                        .after(Core3dSystems::MainPass)
                        .before(Core3dSystems::EarlyPostProcess),
                    lap(Some(Pass::Tonemapping as usize))
                        .after(tonemapping)
                        .before(ComicsSystems::Stylize),
                    lap(Some(Pass::Stylize as usize))
                        .after(ComicsSystems::Stylize)
                        .before(fxaa)
                        .before(smaa),
                    lap(Some(Pass::After as usize))
                        .after(Core3dSystems::PostProcess)
                        .before(upscaling),
                ),
            )
            .add_systems(Render, end_frame.in_set(RenderSystems::Cleanup));
    }
}
