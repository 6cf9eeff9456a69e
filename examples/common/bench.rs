//! Times what one camera's schedule does, part by part: on a CPU adapter the
//! wall time of a submit that holds only that part, waited for; on a GPU, the
//! adapter's own timestamps around it.

use std::time::Instant;

use bevy::{
    core_pipeline::{
        blit::{BlitPipeline, BlitPipelineKey},
        schedule::{Core3d, Core3dSystems},
    },
    ecs::schedule::ApplyDeferred,
    platform::collections::HashMap,
    prelude::*,
    render::{
        RenderApp,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
        render_resource::{
            CachedRenderPipelineId, Operations, PipelineCache, RenderPassColorAttachment,
            RenderPassDescriptor, SpecializedRenderPipeline, TextureFormat, WgpuFeatures,
        },
        renderer::{
            PendingCommandBuffers, RenderAdapterInfo, RenderContext, RenderDevice, RenderQueue,
            ViewQuery,
        },
        view::ViewTarget,
    },
};
use bevy_comics::ComicsSystems;

use super::headless::Headless;

/// The parts of a camera's frame, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lap {
    /// The engine's depth and normal prepass.
    Prepass,
    /// The depth range.
    Range,
    /// Ids, edges and floods of the outlines.
    Lines,
    /// The engine's main pass.
    Main,
    /// Everything after it, up to the last picture.
    Post,
}

pub const LAPS: usize = 5;

/// Milliseconds of each lap.
pub type Laps = [f64; LAPS];

/// The laps of the frames since it was last emptied; several cameras add up.
#[derive(Resource, Default)]
pub struct Stopwatch {
    frame: Laps,
    pub frames: Vec<Laps>,
    timestamps: Option<Timestamps>,
}

struct Timestamps {
    queries: wgpu::QuerySet,
    used: Vec<Option<Lap>>,
}

const QUERIES: u32 = 64;

/// Whether the adapter's own timestamps are used.
fn has_timestamps(info: &RenderAdapterInfo, device: &RenderDevice) -> bool {
    let wanted = WgpuFeatures::TIMESTAMP_QUERY | WgpuFeatures::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    info.device_type != wgpu::DeviceType::Cpu && device.features().contains(wanted)
}

/// How times are taken on this adapter, in words.
pub fn method(headless: &Headless) -> &'static str {
    let world = headless.app.sub_app(RenderApp).world();
    let info = world.resource::<RenderAdapterInfo>();
    if has_timestamps(info, world.resource::<RenderDevice>()) {
        "timestamps of the adapter"
    } else {
        "wall time of a submit that holds only the passes, waited for"
    }
}

/// Ends a lap; `None` ends what is not measured.
fn mark(lap: Option<Lap>) -> impl FnMut(&mut World) {
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
            assert!(at < QUERIES, "too many cameras for the stopwatch");
            let mut encoder = device.create_command_encoder(&Default::default());
            encoder.write_timestamp(&stamps.queries, at);
            stamps.used.push(lap);
            let mut pending = world.resource_mut::<PendingCommandBuffers>();
            pending.push(buffers);
            pending.push([encoder.finish()]);
            return;
        }
        let start = Instant::now();
        queue.submit(buffers);
        wait(&device);
        let elapsed = start.elapsed().as_secs_f64() * 1e3;
        if let Some(lap) = lap {
            world.resource_mut::<Stopwatch>().frame[lap as usize] += elapsed;
        }
    }
}

fn wait(device: &RenderDevice) {
    device
        .wgpu_device()
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
}

fn end_frame(mut watch: ResMut<Stopwatch>, device: Res<RenderDevice>, queue: Res<RenderQueue>) {
    if let Some(stamps) = watch.timestamps.take_if(|stamps| !stamps.used.is_empty()) {
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
        staging
            .slice(..)
            .map_async(wgpu::MapMode::Read, |result| result.expect("mapped"));
        wait(&device);
        let period = f64::from(queue.get_timestamp_period()) * 1e-6;
        let times: Vec<u64> = staging
            .slice(..)
            .get_mapped_range()
            .chunks_exact(8)
            .map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]))
            .collect();
        for (i, lap) in stamps.used.iter().enumerate() {
            if let Some(lap) = lap {
                let ticks = times[i].saturating_sub(times[i - 1]);
                watch.frame[*lap as usize] += ticks as f64 * period;
            }
        }
    }
    let frame = std::mem::take(&mut watch.frame);
    watch.frames.push(frame);
}

/// A post-process pass that only copies: what every ratio is to.
#[derive(Component, ExtractComponent, Clone, Copy, Default)]
pub struct Blit;

fn blit(
    view: ViewQuery<(&ViewTarget, &Blit)>,
    pipeline: Res<BlitPipeline>,
    cache: Res<PipelineCache>,
    mut pipelines: Local<HashMap<TextureFormat, CachedRenderPipelineId>>,
    mut ctx: RenderContext,
) {
    let (target, _) = view.into_inner();
    let id = pipelines
        .entry(target.main_texture_format())
        .or_insert_with_key(|format| {
            cache.queue_render_pipeline(pipeline.specialize(BlitPipelineKey {
                target_format: *format,
                blend_state: None,
                samples: 1,
                source_space: None,
            }))
        });
    let Some(ready) = cache.get_render_pipeline(*id) else {
        return;
    };
    let post = target.post_process_write();
    let group = pipeline.create_bind_group(ctx.render_device(), post.source, &cache);
    let mut pass = ctx
        .command_encoder()
        .begin_render_pass(&RenderPassDescriptor {
            label: Some("blit"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: post.destination,
                depth_slice: None,
                resolve_target: None,
                ops: Operations::default(),
            })],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
    pass.set_pipeline(ready);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
}

/// Adds the stopwatch and the blit. Frames take longer: every lap is waited for.
pub struct BenchPlugin;

impl Plugin for BenchPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractComponentPlugin::<Blit>::default());
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        let lap = |lap| (ApplyDeferred, mark(lap)).chain();
        render_app
            .init_resource::<Stopwatch>()
            .add_systems(
                Core3d,
                (
                    lap(None).before(Core3dSystems::Prepass),
                    lap(Some(Lap::Prepass))
                        .after(Core3dSystems::Prepass)
                        .before(ComicsSystems::DepthRange),
                    lap(Some(Lap::Range))
                        .after(ComicsSystems::DepthRange)
                        .before(ComicsSystems::Outlines),
                    lap(Some(Lap::Lines))
                        .after(ComicsSystems::Outlines)
                        .before(Core3dSystems::MainPass),
                    lap(Some(Lap::Main))
                        .after(Core3dSystems::MainPass)
                        .before(Core3dSystems::EarlyPostProcess),
                    lap(Some(Lap::Post))
                        .after(Core3dSystems::PostProcess)
                        .before(bevy::core_pipeline::upscaling::upscaling),
                    blit.in_set(Core3dSystems::PostProcess)
                        .before(ComicsSystems::Stylize),
                ),
            )
            .add_systems(
                bevy::render::Render,
                end_frame.in_set(bevy::render::RenderSystems::Cleanup),
            );
    }
}

/// Renders `frames` frames and gives their laps.
pub fn laps(headless: &mut Headless, frames: usize) -> Vec<Laps> {
    let empty = |headless: &mut Headless| {
        let world = headless.app.sub_app_mut(RenderApp).world_mut();
        std::mem::take(&mut world.resource_mut::<Stopwatch>().frames)
    };
    empty(headless);
    headless.step(frames);
    empty(headless)
}

/// Milliseconds of a whole frame, waited for, whatever the adapter.
pub fn whole_frame(headless: &mut Headless) -> f64 {
    let start = Instant::now();
    headless.step(1);
    let world = headless.app.sub_app(RenderApp).world();
    wait(world.resource::<RenderDevice>());
    start.elapsed().as_secs_f64() * 1e3
}
