//! The fused full-screen pass: reads the picture of a camera once, applies every
//! effect, and writes the picture once.

pub(super) mod blue_noise;
pub(super) mod earlier_passes;
pub(super) mod errors;
pub(super) mod inputs;
pub(super) mod prepare;

use bevy::{
    core_pipeline::FullscreenShader,
    prelude::*,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BlendState, ColorTargetState, ColorWrites, FragmentState, IntoBinding,
            LoadOp, PipelineCache, RenderPipeline, RenderPipelineDescriptor,
            SpecializedRenderPipeline, TextureView,
        },
        renderer::{RenderContext, ViewQuery},
        view::ViewTarget,
    },
};

use self::{
    blue_noise::BlueNoise,
    earlier_passes::{EarlierPasses, PassTextures, described},
    errors::ShaderErrors,
    inputs::{Inputs, PassSampler, ViewInputs, entries},
    prepare::{FusedRequest, ViewFused},
};
use super::key::StylizeKey;
use crate::{
    bind_groups::Binder,
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    gpu::{attachment, entry},
    lines::{TileList, TileLists, ViewLines, tile_shader, vertices},
    objects::ObjectStyleBuffer,
};

#[derive(Resource)]
pub(crate) struct StylizePipeline {
    fullscreen: FullscreenShader,
    shader: Handle<Shader>,
    tile: Handle<Shader>,
}

impl StylizePipeline {
    pub fn new(
        fullscreen: &FullscreenShader,
        shader: Handle<Shader>,
        assets: &AssetServer,
    ) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            shader,
            tile: tile_shader(assets),
        }
    }
}

impl SpecializedRenderPipeline for StylizePipeline {
    type Key = StylizeKey;

    fn specialize(&self, key: Self::Key) -> RenderPipelineDescriptor {
        let (vertex, primitive) = vertices(key.area.is_tiled(), &self.fullscreen, &self.tile);
        let overlay = key.area.is_overlay();
        RenderPipelineDescriptor {
            label: Some("comics_stylize".into()),
            layout: vec![key.layout()],
            vertex,
            primitive,
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: key.shader_defs(),
                entry_point: Some(key.draws.entry_point().into()),
                targets: vec![Some(ColorTargetState {
                    format: key.format,
                    blend: overlay.then_some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: ColorWrites::ALL,
                })],
            }),
            ..Default::default()
        }
    }
}

/// Draws the effects of the view. Calls `post_process_write`, which swaps the
/// view's textures, only when all inputs are there: a swap without a draw would
/// lose the picture.
///
/// `PRINTS`: draws the views whose colors are printed, the others otherwise.
pub(super) fn stylize<const PRINTS: bool>(
    view: ViewQuery<(
        (
            &ViewTarget,
            &FusedRequest,
            &ViewFused,
            Option<&PassTextures>,
        ),
        ViewInputs<'_>,
    )>,
    (object_styles, sampler): (Res<ObjectStyleBuffer>, Res<PassSampler>),
    blue_noise: Res<BlueNoise>,
    (ledger, errors): (Res<StageLedger>, Res<ShaderErrors>),
    binder: Binder,
    mut ctx: RenderContext,
) {
    let ((target, request, fused, textures), found) = view.into_inner();
    if request.plan.runs_after_anti_aliasing() != PRINTS {
        return;
    }
    let (_, _, lines, ..) = found;
    let cache = &*binder.cache;
    let earlier = EarlierPasses::new(cache, request, textures);
    let (Some(draws), Some(earlier)) = (Draws::new(cache, request, lines), earlier) else {
        errors.report(cache, request, &ledger);
        return pass_through(request, &ledger, SkipReason::PipelineNotReady);
    };
    let found = if target.main_texture_format() == request.key.format {
        entries(&request.key, found, &object_styles, &blue_noise)
    } else {
        Err(SkipReason::PipelineNotReady)
    };
    let mut entries = match found {
        Ok(entries) => entries,
        Err(reason) => return pass_through(request, &ledger, reason),
    };
    entries.push(entry(1, fused.uniform.as_entire_binding()));
    let destination = if request.key.area.is_overlay() {
        target.main_texture_view()
    } else {
        let post = target.post_process_write();
        entries.push(entry(0, post.source.into_binding()));
        post.destination
    };
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let span = diagnostics.time_span(ctx.command_encoder(), "comics_stylize");
    let inputs = Inputs {
        entries,
        sampler: &sampler,
        binder: &binder,
    };
    let before = earlier.record(&mut ctx, &inputs);
    let group = inputs.bind_group(&request.key, &before);
    draws.record(&mut ctx, destination, &group, request);
    span.end(ctx.command_encoder());
    ran(request, &ledger);
}

struct Draws<'a> {
    base: Option<&'a RenderPipeline>,
    pipeline: &'a RenderPipeline,
    /// The tiles that `pipeline` draws, if it does not draw all pixels.
    tiles: Option<&'a TileLists>,
}

impl<'a> Draws<'a> {
    /// `None` if a pipeline or the tiles are not ready in this frame.
    fn new(
        cache: &'a PipelineCache,
        request: &FusedRequest,
        lines: Option<&'a ViewLines>,
    ) -> Option<Self> {
        let pipeline = cache.get_render_pipeline(request.pipeline)?;
        let base = match request.base {
            Some(base) => Some(cache.get_render_pipeline(base)?),
            None => None,
        };
        let tiles = if request.key.area.is_tiled() {
            Some(lines?.tiles()?)
        } else {
            None
        };
        Some(Self {
            base,
            pipeline,
            tiles,
        })
    }

    fn record(
        &self,
        ctx: &mut RenderContext,
        destination: &TextureView,
        bind_group: &BindGroup,
        request: &FusedRequest,
    ) {
        // All pixels are drawn, except in an overlay.
        let load = if request.key.area.is_overlay() {
            LoadOp::Load
        } else {
            LoadOp::default()
        };
        let encoder = ctx.command_encoder();
        let attachments = [Some(attachment(destination, load))];
        let mut pass = encoder.begin_render_pass(&described(&attachments));
        pass.set_bind_group(0, bind_group, &[]);
        if let Some(base) = self.base {
            pass.set_pipeline(base);
            pass.draw(0..3, 0..1);
        }
        pass.set_pipeline(self.pipeline);
        match self.tiles {
            Some(tiles) => {
                let [x, y, width, height] = request.context.viewport.as_vec4().to_array();
                pass.set_viewport(x, y, width, height, 0.0, 1.0);
                tiles.draw(&mut pass, TileList::Inked);
            }
            None => pass.draw(0..3, 0..1),
        }
    }
}

/// Reports that the pass and its effects ran.
fn ran(request: &FusedRequest, ledger: &StageLedger) {
    for effect in request.plan.drawn() {
        let stage = ComicsStage::Effect(effect.name());
        ledger.set(request.camera, stage, StageOutcome::Ran);
    }
    ledger.set(request.camera, ComicsStage::Stylize, StageOutcome::Ran);
}

/// Reports why the pass did not run. The picture stays as it is.
fn pass_through(request: &FusedRequest, ledger: &StageLedger, reason: SkipReason) {
    let outcome = StageOutcome::Skipped(reason);
    ledger.set(request.camera, ComicsStage::Stylize, outcome);
}
