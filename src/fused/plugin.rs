//! Adds the fused pass to an app.

use bevy::{
    anti_alias::{contrast_adaptive_sharpening::cas, fxaa::fxaa, smaa::smaa},
    core_pipeline::{
        FullscreenShader,
        schedule::{Core3d, Core3dSystems},
        tonemapping::tonemapping,
    },
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup, RenderSystems,
        render_resource::SpecializedRenderPipelines, renderer::RenderDevice,
    },
};

use super::{
    pass::{
        StylizePipeline,
        blue_noise::BlueNoise,
        earlier_passes::prepare_pass_textures,
        errors::{ShaderErrors, file_path},
        inputs::PassSampler,
        prepare::{ViewFused, prepare_fused_pass},
        stylize,
    },
    requests::choose::choose_plans,
};
use crate::{
    effect::{EffectRegistry, EffectTarget, EffectType, load_shaders},
    lines::draw_highlights,
    schedule::{ComicsSystems, PrepareComics},
    tones::measure_tones,
};

/// Chooses the plan of every view, and draws its effects in one pass.
pub(crate) struct FusedPlugin;

/// The shader modules of the effects. Keeps their assets alive.
#[derive(Resource)]
struct EffectModules {
    _modules: Vec<Handle<Shader>>,
}

#[derive(Resource)]
struct FusedShader(Handle<Shader>);

impl Plugin for FusedPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<EffectRegistry>()
            .register_type::<EffectTarget>();
    }

    /// Composes the shader here, when the plugins of all effects are built.
    fn finish(&self, app: &mut App) {
        let registry = app.world().resource::<EffectRegistry>().clone();
        registry.seal();
        let Some(mut shaders) = app.world_mut().get_resource_mut::<Assets<Shader>>() else {
            return;
        };
        let module = |effect: &&EffectType| {
            shaders.add(Shader::from_wgsl(effect.shader.source, file_path(effect)))
        };
        let modules = registry.types().iter().map(module).collect();
        let fused = Shader::from_wgsl(registry.shader(), "bevy_comics/fused/fused.wgsl");
        let fused = shaders.add(fused);
        app.insert_resource(EffectModules { _modules: modules });
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app
                .insert_resource(registry)
                .insert_resource(FusedShader(fused));
        }
    }
}

impl FusedPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shaders(app);
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .init_gpu_resource::<SpecializedRenderPipelines<StylizePipeline>>()
            .init_resource::<ShaderErrors>()
            .configure_sets(
                Render,
                (
                    PrepareComics::Choose,
                    PrepareComics::Services,
                    PrepareComics::Fused,
                )
                    .chain()
                    .in_set(RenderSystems::PrepareBindGroups),
            )
            .add_systems(RenderStartup, init_pipeline)
            .add_systems(
                Render,
                (
                    choose_plans.in_set(PrepareComics::Choose),
                    (prepare_fused_pass, prepare_pass_textures).in_set(PrepareComics::Fused),
                ),
            )
            .add_systems(
                Core3d,
                (
                    (
                        measure_tones::<false>,
                        stylize::<false>,
                        draw_highlights::<false>,
                    )
                        .chain()
                        .in_set(ComicsSystems::Stylize)
                        .after(tonemapping)
                        .before(fxaa)
                        .before(smaa),
                    (
                        measure_tones::<true>,
                        stylize::<true>,
                        draw_highlights::<true>,
                    )
                        .chain()
                        .in_set(ComicsSystems::Print)
                        .after(ComicsSystems::Stylize)
                        .after(fxaa)
                        .after(smaa)
                        .after(cas),
                )
                    .in_set(Core3dSystems::PostProcess),
            );
    }
}

fn init_pipeline(
    mut commands: Commands,
    fullscreen: Res<FullscreenShader>,
    (shader, assets): (Res<FusedShader>, Res<AssetServer>),
    device: Res<RenderDevice>,
    fused: Query<Entity, With<ViewFused>>,
) {
    // Runs again after the device was lost: the old device's buffers are invalid.
    for view in &fused {
        commands.entity(view).remove::<ViewFused>();
    }
    commands.insert_resource(BlueNoise::default());
    commands.insert_resource(PassSampler::new(&device));
    commands.insert_resource(StylizePipeline::new(&fullscreen, shader.0.clone(), &assets));
}
