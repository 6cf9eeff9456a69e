//! The plugin: one frame, top to bottom.

use bevy::{
    anti_alias::{fxaa::fxaa, smaa::smaa},
    app::{App, Plugin, PostUpdate, PreUpdate, Update},
    asset::{AssetApp, AssetServer, embedded_asset},
    core_pipeline::{
        schedule::{Core3d, Core3dSystems},
        tonemapping::tonemapping,
    },
    ecs::schedule::{IntoScheduleConfigs, SystemSet},
    render::{
        ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderStartup, RenderSystems,
        render_resource::{SpecializedComputePipelines, SpecializedRenderPipelines},
    },
    shader::load_shader_library,
};

#[cfg(feature = "objects")]
use crate::objects::{ContourStyle, NoContours, assign_object_styles};
use crate::{
    depth::{
        CameraCut, DepthHistogram, DepthMap, VisibleDepthRange,
        ping_pong::PingPongPipeline,
        range::{RangePipeline, reduce_depth_range},
        readback::{RangeReadings, receive_ranges},
        smoothing::{SmoothingPipeline, count_cut},
    },
    diagnostics::{ComicsDiagnostics, StageLedger, publish_ledger, read_ledger},
    finish::{DebugView, SplitView, StyleWeight},
    objects::{ObjectStyleBuffer, ObjectStyles},
    outlining::{FloodPipeline, OutlinePipeline, find_outlines},
    passes::{ViewPasses, init_pipelines, map_readbacks, prepare_view_passes},
    prepasses::{request_prepasses, warn_unsupported},
    styles::{
        BlackFlats, Colorization, ComicStyle, ComicStyleHandle, Contours, Desaturation, Outlines,
        Sketch, StyleLoader, StyleTransition, ToneBands, apply_styles, run_transitions,
    },
    stylize::{StylizePipeline, stylize},
    view::extract_views,
};

/// Adds comics stylization: every [`Camera3d`](bevy::camera::Camera3d) with a
/// style component is drawn as a comic.
///
/// In an app without a renderer the plugin registers its types and does
/// nothing else.
#[derive(Default)]
pub struct ComicsPlugin;

/// The render-world systems of this crate, in the `Core3d` schedule of a camera:
/// order your own passes against them.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ComicsSystems {
    /// The depth range is found: after `Core3dSystems::Prepass`, before
    /// `Core3dSystems::MainPass`.
    DepthRange,
    /// The outlines are found: after the depth range, before
    /// `Core3dSystems::MainPass`.
    Outlines,
    /// The picture is stylized: in `Core3dSystems::PostProcess`, after
    /// tonemapping and before FXAA and SMAA, which then smooth the ink.
    Stylize,
}

impl Plugin for ComicsPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<DepthMap>()
            .register_type::<VisibleDepthRange>()
            .register_type::<DepthHistogram>()
            .register_type::<CameraCut>()
            .register_type::<StyleWeight>()
            .register_type::<SplitView>()
            .register_type::<DebugView>()
            .register_type::<StyleTransition>()
            .register_type::<Desaturation>()
            .register_type::<Colorization>()
            .register_type::<BlackFlats>()
            .register_type::<Contours>()
            .register_type::<ToneBands>()
            .register_type::<Outlines>()
            .register_type::<Sketch>()
            .register_type::<ComicStyleHandle>()
            .register_type::<ComicsDiagnostics>()
            .init_resource::<ComicsDiagnostics>()
            .init_resource::<ObjectStyles>()
            .add_observer(count_cut)
            .add_systems(PostUpdate, (request_prepasses, warn_unsupported));
        #[cfg(feature = "objects")]
        app.register_type::<ContourStyle>()
            .register_type::<NoContours>()
            .add_systems(PostUpdate, assign_object_styles);
        if app.world().contains_resource::<AssetServer>() {
            app.init_asset::<ComicStyle>()
                .register_asset_reflect::<ComicStyle>()
                .init_asset_loader::<StyleLoader>()
                .add_systems(Update, (apply_styles, run_transitions).chain());
        }
        #[cfg(feature = "cartoon")]
        crate::cartoon::build(app);
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }

        load_shader_library!(app, "styles/color.wgsl");
        load_shader_library!(app, "styles/desaturation.wgsl");
        load_shader_library!(app, "styles/colorization.wgsl");
        load_shader_library!(app, "styles/black_flats.wgsl");
        load_shader_library!(app, "styles/contours/contours.wgsl");
        load_shader_library!(app, "styles/outlines/outlines.wgsl");
        load_shader_library!(app, "styles/tone_bands.wgsl");
        load_shader_library!(app, "styles/sketch.wgsl");
        load_shader_library!(app, "finish/finish.wgsl");
        load_shader_library!(app, "depth/map.wgsl");
        load_shader_library!(app, "depth/raw.wgsl");
        load_shader_library!(app, "stylize/bindings.wgsl");
        load_shader_library!(app, "stylize/taps.wgsl");
        load_shader_library!(app, "stylize/lines.wgsl");
        embedded_asset!(app, "outlining/detect.wgsl");
        embedded_asset!(app, "outlining/flood.wgsl");
        #[cfg(feature = "objects")]
        embedded_asset!(app, "objects/ids.wgsl");
        #[cfg(feature = "cartoon")]
        load_shader_library!(app, "cartoon/light.wgsl");
        embedded_asset!(app, "stylize/stylize.wgsl");
        // Both an entry point and a library: the reduction counts in its bins.
        load_shader_library!(app, "depth/smoothing.wgsl");
        embedded_asset!(app, "depth/range.wgsl");
        embedded_asset!(app, "depth/ping_pong.wgsl");

        let ledger = StageLedger::default();
        let readings = RangeReadings::default();
        app.insert_resource(ledger.reader())
            .insert_resource(readings.clone())
            .add_systems(PreUpdate, (read_ledger, receive_ranges));

        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .insert_resource(ledger)
            .insert_resource(readings)
            .init_gpu_resource::<SpecializedRenderPipelines<StylizePipeline>>()
            .init_gpu_resource::<SpecializedComputePipelines<RangePipeline>>()
            .init_gpu_resource::<SpecializedRenderPipelines<PingPongPipeline>>()
            .init_gpu_resource::<SpecializedComputePipelines<SmoothingPipeline>>()
            .init_gpu_resource::<SpecializedRenderPipelines<OutlinePipeline>>()
            .init_gpu_resource::<SpecializedRenderPipelines<FloodPipeline>>()
            .init_gpu_resource::<ObjectStyleBuffer>()
            .init_gpu_resource::<ViewPasses>()
            .init_resource::<ObjectStyles>()
            .add_systems(RenderStartup, init_pipelines)
            .add_systems(ExtractSchedule, extract_views)
            .add_systems(
                Render,
                (
                    prepare_view_passes.in_set(RenderSystems::PrepareBindGroups),
                    (map_readbacks, publish_ledger).in_set(RenderSystems::Cleanup),
                ),
            )
            .add_systems(
                Core3d,
                (
                    reduce_depth_range
                        .in_set(ComicsSystems::DepthRange)
                        .after(Core3dSystems::Prepass)
                        .before(Core3dSystems::MainPass),
                    find_outlines
                        .in_set(ComicsSystems::Outlines)
                        .after(ComicsSystems::DepthRange)
                        .after(Core3dSystems::Prepass)
                        .before(Core3dSystems::MainPass),
                    stylize
                        .in_set(ComicsSystems::Stylize)
                        .in_set(Core3dSystems::PostProcess)
                        .after(tonemapping)
                        .before(fxaa)
                        .before(smaa),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        #[cfg(feature = "cartoon")]
        crate::cartoon::finish(app);
        // Ids are drawn with the engine's own mesh pipelines.
        #[cfg(feature = "objects")]
        if app.is_plugin_added::<bevy::pbr::PbrPlugin>() {
            crate::objects::ids::build(app);
            if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
                render_app.add_systems(
                    Core3d,
                    crate::objects::ids::draw_object_ids
                        .after(Core3dSystems::Prepass)
                        .after(ComicsSystems::DepthRange)
                        .before(ComicsSystems::Outlines)
                        .before(Core3dSystems::MainPass),
                );
            }
        }
        #[cfg(not(feature = "objects"))]
        let _ = app;
    }
}
