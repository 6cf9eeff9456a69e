//! Times what one camera's schedule does, part by part: on a CPU adapter the
//! wall time of a submit that holds only that part, waited for (its own
//! timestamps are not to be trusted); on a GPU, the adapter's timestamps.
//!
//! Nothing here runs unless it is asked for. Frames that are timed take longer
//! on a CPU adapter: every part is waited for.

use std::{
    collections::VecDeque,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use bevy::{
    ecs::{schedule::ScheduleConfigs, system::ScheduleSystem},
    prelude::*,
    render::{
        render_resource::WgpuFeatures,
        renderer::{PendingCommandBuffers, RenderAdapterInfo, RenderDevice, RenderQueue},
    },
};

/// Milliseconds of the laps of one frame, by lap; several cameras add up.
pub type Laps = Vec<f64>;

/// Collects times by lap. The caller chooses what each lap index means.
#[derive(Resource)]
pub struct Stopwatch {
    /// While false, nothing is submitted or waited for.
    pub running: bool,
    /// Frames since the caller last emptied this, oldest first.
    pub frames: VecDeque<Laps>,
    frame: Laps,
    timestamps: Option<Timestamps>,
}

impl Stopwatch {
    pub fn new(running: bool) -> Self {
        Self {
            running,
            frames: VecDeque::new(),
            frame: Laps::new(),
            timestamps: None,
        }
    }

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

/// How times are taken on this adapter, in words.
pub fn method(info: &RenderAdapterInfo, device: &RenderDevice) -> &'static str {
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

/// Systems of the `Core3d` schedule that end a lap. `None` discards the time
/// since the last mark.
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
            // Marks beyond the number of queries are not timed.
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

/// Waits until the device is idle; returns at once if the device is lost.
pub fn wait(device: &RenderDevice) {
    let _ = device
        .wgpu_device()
        .poll(wgpu::PollType::wait_indefinitely());
}

/// Ends the frame of a [`Stopwatch`]; runs in `RenderSystems::Cleanup`.
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
