//! Times the parts of one camera's frame. On a CPU adapter, a time is the wall time of
//! a submit that holds only that part, until it is done. On a GPU, it is the difference
//! of the adapter's timestamps before and after the part.

use std::time::Instant;

use bevy::{
    core_pipeline::{
        blit::{BlitPipeline, BlitPipelineKey},
        schedule::{Core3d, Core3dSystems},
    },
    platform::collections::HashMap,
    prelude::*,
    render::{
        RenderApp,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
        render_resource::{
            CachedRenderPipelineId, Operations, PipelineCache, RenderPassColorAttachment,
            RenderPassDescriptor, SpecializedRenderPipeline, TextureFormat,
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        view::ViewTarget,
    },
};
use bevy_comics::ComicsSystems;

use crate::{
    headless::{Headless, HeadlessOptions},
    stopwatch::{self, Stopwatch},
};

/// The parts of a camera's frame, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lap {
    /// The engine's depth and normal prepass.
    Prepass,
    /// The depth range.
    Range,
    /// The ids of objects, and finding and drawing lines.
    Lines,
    /// The engine's main pass.
    Main,
    /// All post-processing, up to the engine's upscaling pass.
    Post,
}

pub const LAPS: usize = 5;

/// Milliseconds of a frame, by [`Lap`].
pub type Laps = [f64; LAPS];

/// Of an app that is timed: its systems run as in a game.
pub fn options(size: UVec2) -> HeadlessOptions {
    HeadlessOptions {
        size,
        parallel_systems: true,
        ..default()
    }
}

/// How times are measured on this adapter, in words.
pub fn method(headless: &Headless) -> &'static str {
    let world = headless.app.sub_app(RenderApp).world();
    stopwatch::method(world.resource(), world.resource())
}

/// On a camera: a post-process pass that only copies. Its time is the unit of all
/// ratios.
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
    let encoder = ctx.command_encoder();
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("blit"),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: post.destination,
            depth_slice: None,
            resolve_target: None,
            ops: Operations::default(),
        })],
        ..default()
    });
    pass.set_pipeline(ready);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
}

/// Adds the stopwatch and the blit. On a CPU adapter frames take longer, since the end
/// of every lap is waited for.
pub struct BenchPlugin;

impl Plugin for BenchPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractComponentPlugin::<Blit>::default());
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        let lap = |lap: Option<Lap>| stopwatch::lap(lap.map(|lap| lap as usize));
        render_app
            .insert_resource(Stopwatch::new(true))
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
                stopwatch::end_frame.in_set(bevy::render::RenderSystems::Cleanup),
            );
    }
}

/// Renders `frames` frames and returns their laps.
pub fn laps(headless: &mut Headless, frames: usize) -> Vec<Laps> {
    let empty = |headless: &mut Headless| -> Vec<Laps> {
        let world = headless.app.sub_app_mut(RenderApp).world_mut();
        let frames = std::mem::take(&mut world.resource_mut::<Stopwatch>().frames);
        let padded =
            |frame: Vec<f64>| std::array::from_fn(|lap| frame.get(lap).copied().unwrap_or(0.0));
        frames.into_iter().map(padded).collect()
    };
    empty(headless);
    headless.step(frames);
    empty(headless)
}

/// Milliseconds of wall time of a whole frame, until the device is done.
pub fn whole_frame(headless: &mut Headless) -> f64 {
    let start = Instant::now();
    headless.step(1);
    let world = headless.app.sub_app(RenderApp).world();
    stopwatch::wait(world.resource::<RenderDevice>());
    start.elapsed().as_secs_f64() * 1e3
}
