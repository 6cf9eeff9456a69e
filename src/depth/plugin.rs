//! Adds the depth service to an app.

use bevy::{
    asset::embedded_asset,
    core_pipeline::{
        FullscreenShader,
        schedule::{Core3d, Core3dSystems},
    },
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup, RenderSystems,
        render_resource::{SpecializedComputePipelines, SpecializedRenderPipelines},
        renderer::RenderDevice,
    },
    shader::load_shader_library,
};

use super::{
    CameraCut, DepthHistogram, DepthMap, MaterialsReadRange, VisibleDepthRange,
    ping_pong::PingPongPipeline,
    prepare::{RangeUniforms, ViewDepthRange, map_readbacks, prepare_view_ranges},
    range::RangePipeline,
    readback::{RangeReadings, receive_ranges},
    reduce::reduce_depth_range,
    smoothing::count_cut,
    surfaces::use_drawn_depth,
    view_pass::ViewPassPipeline,
};
use crate::schedule::{ComicsSystems, PrepareComics};

/// Computes, smooths and reads back the visible range of the views that request it,
/// and loads the WGSL of the depth map.
pub(crate) struct DepthPlugin;

impl Plugin for DepthPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<DepthMap>()
            .register_type::<VisibleDepthRange>()
            .register_type::<DepthHistogram>()
            .register_type::<CameraCut>()
            .init_resource::<MaterialsReadRange>()
            .add_observer(count_cut);
    }
}

impl DepthPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "map.wgsl");
        load_shader_library!(app, "raw.wgsl");
        load_shader_library!(app, "view.wgsl");
        load_shader_library!(app, "window.wgsl");
        load_shader_library!(app, "normal.wgsl");
        load_shader_library!(app, "histogram.wgsl");
        load_shader_library!(app, "level.wgsl");
        embedded_asset!(app, "smoothing.wgsl");
        embedded_asset!(app, "borders.wgsl");
        embedded_asset!(app, "middle.wgsl");
        embedded_asset!(app, "range.wgsl");
        embedded_asset!(app, "range_of.wgsl");
        embedded_asset!(app, "ping_pong.wgsl");

        let readings = RangeReadings::default();
        app.insert_resource(readings.clone())
            .add_systems(PreUpdate, receive_ranges);
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .insert_resource(readings)
            .init_gpu_resource::<SpecializedComputePipelines<RangePipeline>>()
            .init_gpu_resource::<SpecializedRenderPipelines<PingPongPipeline>>()
            .init_gpu_resource::<SpecializedComputePipelines<ViewPassPipeline>>()
            .init_gpu_resource::<RangeUniforms>()
            .add_systems(RenderStartup, init_pipelines)
            .add_systems(
                Render,
                (
                    (prepare_view_ranges, use_drawn_depth).in_set(PrepareComics::Services),
                    map_readbacks.in_set(RenderSystems::Cleanup),
                ),
            )
            .add_systems(
                Core3d,
                reduce_depth_range
                    .in_set(ComicsSystems::DepthRange)
                    .after(Core3dSystems::Prepass)
                    .before(Core3dSystems::MainPass),
            );
    }
}

fn init_pipelines(
    mut commands: Commands,
    device: Res<RenderDevice>,
    fullscreen: Res<FullscreenShader>,
    assets: Res<AssetServer>,
    ranges: Query<Entity, With<ViewDepthRange>>,
) {
    // This runs again after a lost device, whose buffers are no longer valid.
    for view in &ranges {
        commands.entity(view).remove::<ViewDepthRange>();
    }
    commands.insert_resource(RangePipeline::new(&device, &assets));
    commands.insert_resource(PingPongPipeline::new(&fullscreen, &assets));
    commands.insert_resource(ViewPassPipeline::new(&assets));
}
