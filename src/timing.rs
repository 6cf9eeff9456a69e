//! Times what one camera's schedule does, part by part: on a CPU adapter the
//! wall time of a submit that holds only that part, waited for (its own
//! timestamps are not to be trusted); on a GPU, the adapter's timestamps.
//!
//! Nothing here runs unless it is asked for. Frames that are timed take longer
//! on a CPU adapter: every part is waited for.

use std::{
    collections::VecDeque,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use bevy::{
    anti_alias::{fxaa::fxaa, smaa::smaa},
    app::{App, Plugin},
    core_pipeline::{
        schedule::{Core3d, Core3dSystems},
        tonemapping::tonemapping,
        upscaling::upscaling,
    },
    ecs::{
        resource::Resource,
        schedule::{ApplyDeferred, IntoScheduleConfigs, ScheduleConfigs},
        system::{Res, ResMut, ScheduleSystem},
        world::World,
    },
    render::{
        Extract, ExtractSchedule, Render, RenderApp, RenderSystems,
        render_resource::WgpuFeatures,
        renderer::{PendingCommandBuffers, RenderAdapterInfo, RenderDevice, RenderQueue},
    },
};

use crate::schedule::ComicsSystems;

/// Milliseconds of the laps of one frame, by lap; several cameras add up.
pub type Laps = Vec<f64>;

/// Takes the times. Laps are numbers that the one who marks them knows.
#[derive(Resource)]
pub struct Stopwatch {
    /// Whether it runs; where it does not, nothing is submitted or waited for.
    pub running: bool,
    /// The frames since it was last emptied, oldest first.
    pub frames: VecDeque<Laps>,
    frame: Laps,
    timestamps: Option<Timestamps>,
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self {
            running: true,
            frames: VecDeque::new(),
            frame: Laps::new(),
            timestamps: None,
        }
    }
}

impl Stopwatch {
    fn add(&mut self, lap: usize, milliseconds: f64) {
        if self.frame.len() <= lap {
            self.frame.resize(lap + 1, 0.0);
        }
        self.frame[lap] += milliseconds;
    }
}

struct Timestamps {
    queries: wgpu::QuerySet,
    used: Vec<Option<usize>>,
}

const QUERIES: u32 = 64;

fn has_timestamps(info: &RenderAdapterInfo, device: &RenderDevice) -> bool {
    let wanted = WgpuFeatures::TIMESTAMP_QUERY | WgpuFeatures::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    info.device_type != wgpu::DeviceType::Cpu && device.features().contains(wanted)
}

/// How times are taken on the adapter of this render world, in words.
pub fn method(render_world: &World) -> &'static str {
    method_of(
        render_world.resource::<RenderAdapterInfo>(),
        render_world.resource::<RenderDevice>(),
    )
}

fn method_of(info: &RenderAdapterInfo, device: &RenderDevice) -> &'static str {
    if has_timestamps(info, device) {
        "timestamps of the adapter"
    } else {
        "wall time of a submit that holds only the passes, waited for"
    }
}

/// Whether the render world has a [`Stopwatch`] that runs.
fn is_running(watch: Res<Stopwatch>) -> bool {
    watch.running
}

/// Systems of the `Core3d` schedule that end a lap; `None` ends what is not
/// measured.
pub fn lap(lap: Option<usize>) -> ScheduleConfigs<ScheduleSystem> {
    (ApplyDeferred, mark(lap)).chain().run_if(is_running)
}

fn mark(lap: Option<usize>) -> impl FnMut(&mut World) {
    move |world| {
        let buffers = world.resource_mut::<PendingCommandBuffers>().take();
        let device = world.resource::<RenderDevice>().clone();
        let queue = world.resource::<RenderQueue>().clone();
        let info = world.resource::<RenderAdapterInfo>();
        if has_timestamps(info, &device) {
            let mut watch = world.resource_mut::<Stopwatch>();
            let stamps = watch.timestamps.get_or_insert_with(|| Timestamps {
                queries: device
                    .wgpu_device()
                    .create_query_set(&wgpu::QuerySetDescriptor {
                        label: None,
                        ty: wgpu::QueryType::Timestamp,
                        count: QUERIES,
                    }),
                used: Vec::new(),
            });
            let at = stamps.used.len() as u32;
            let mut stamped = None;
            // Beyond so many cameras there are no times, and no harm.
            if at < QUERIES {
                let mut encoder = device.create_command_encoder(&Default::default());
                encoder.write_timestamp(&stamps.queries, at);
                stamps.used.push(lap);
                stamped = Some(encoder.finish());
            }
            let mut pending = world.resource_mut::<PendingCommandBuffers>();
            pending.push(buffers);
            pending.push(stamped);
            return;
        }
        let start = Instant::now();
        queue.submit(buffers);
        wait(&device);
        let elapsed = start.elapsed().as_secs_f64() * 1e3;
        if let Some(lap) = lap {
            world.resource_mut::<Stopwatch>().add(lap, elapsed);
        }
    }
}

/// Waits for the device; one that is lost is not waited for.
pub fn wait(device: &RenderDevice) {
    let _ = device
        .wgpu_device()
        .poll(wgpu::PollType::wait_indefinitely());
}

/// The system of [`RenderSystems::Cleanup`] that ends the frame of a
/// [`Stopwatch`].
pub fn end_frame(mut watch: ResMut<Stopwatch>, device: Res<RenderDevice>, queue: Res<RenderQueue>) {
    if !watch.running {
        return;
    }
    if let Some(stamps) = watch.timestamps.take_if(|stamps| !stamps.used.is_empty()) {
        let times = resolve(&stamps, &device, &queue);
        let period = f64::from(queue.get_timestamp_period()) * 1e-6;
        for (i, lap) in stamps.used.iter().enumerate().skip(1) {
            if let Some(lap) = lap {
                let ticks = times[i].saturating_sub(times[i - 1]);
                watch.add(*lap, ticks as f64 * period);
            }
        }
    }
    let frame = std::mem::take(&mut watch.frame);
    watch.frames.push_back(frame);
}

fn resolve(stamps: &Timestamps, device: &RenderDevice, queue: &RenderQueue) -> Vec<u64> {
    let count = stamps.used.len() as u32;
    let new_buffer = |usage| {
        device.wgpu_device().create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(QUERIES) * 8,
            usage,
            mapped_at_creation: false,
        })
    };
    let resolved = new_buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
    let staging = new_buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.resolve_query_set(&stamps.queries, 0..count, &resolved, 0);
    encoder.copy_buffer_to_buffer(&resolved, 0, &staging, 0, u64::from(QUERIES) * 8);
    queue.submit([encoder.finish()]);
    let mapped = Arc::new(AtomicBool::new(false));
    let answer = mapped.clone();
    staging
        .slice(..)
        .map_async(wgpu::MapMode::Read, move |result| {
            answer.store(result.is_ok(), Ordering::Release);
        });
    wait(device);
    if !mapped.load(Ordering::Acquire) {
        return vec![0; stamps.used.len()];
    }
    staging
        .slice(..)
        .get_mapped_range()
        .chunks_exact(8)
        .map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]))
        .collect()
}

/// What a camera's frame is made of, in order: the laps of [`PassTimesPlugin`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pass {
    /// The engine's depth and normal prepass.
    Prepass,
    /// The depth range: reduction and smoothing.
    DepthRange,
    /// Ids, edges and floods of the outlines.
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
    pub const ALL: [Self; 7] = [
        Self::Prepass,
        Self::DepthRange,
        Self::Outlines,
        Self::Main,
        Self::Tonemapping,
        Self::Stylize,
        Self::After,
    ];

    /// What a chart calls it.
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

/// The times of every [`Pass`], for the game: what [`PassTimesPlugin`] takes
/// while it runs. It starts stopped.
#[derive(Resource, Default)]
pub struct PassTimes(Mutex<Times>);

#[derive(Default)]
struct Times {
    running: bool,
    frames: VecDeque<Laps>,
    method: Option<&'static str>,
}

/// So many frames are kept.
const KEPT: usize = 240;

impl PassTimes {
    fn lock(&self) -> MutexGuard<'_, Times> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts or stops taking times; a start forgets what was before.
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

/// Carries the switch to the render world, and the times back.
fn exchange(
    times: Extract<Res<PassTimes>>,
    mut watch: ResMut<Stopwatch>,
    info: Res<RenderAdapterInfo>,
    device: Res<RenderDevice>,
) {
    let mut times = times.lock();
    watch.running = times.running;
    if times.running {
        times.method = Some(method_of(&info, &device));
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
            .insert_resource(Stopwatch {
                running: false,
                ..Stopwatch::default()
            })
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
