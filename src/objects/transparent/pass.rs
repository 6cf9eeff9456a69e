//! Copies the prepass textures of a view and draws its transparent meshes into the copies.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    asset::load_embedded_asset,
    camera::{MainPassResolutionOverride, Viewport},
    core_pipeline::{
        FullscreenShader,
        core_3d::CORE_3D_DEPTH_FORMAT,
        prepass::{NORMAL_PREPASS_FORMAT, ViewPrepassTextures},
    },
    prelude::*,
    render::{
        camera::ExtractedCamera,
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries,
            FragmentState, LoadOp, MultisampleState, PipelineCache, RenderPassDescriptor,
            RenderPipeline, RenderPipelineDescriptor, ShaderStages, SpecializedRenderPipeline,
            SpecializedRenderPipelines, StoreOp, TextureFormat, TextureUsages, TextureView,
        },
        renderer::{RenderAdapter, RenderContext, RenderDevice, ViewQuery},
        texture::{CachedTexture, TextureCache},
        view::{ExtractedView, ViewDepthTexture},
    },
};

use crate::{
    bind_groups::Binder,
    depth::surfaces::{OwnNormals, OwnSurfaces},
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    gpu::{self, UNFILTERABLE, depth_attachment, sampled},
    objects::{
        DepthWanted, QueuedDepth, ViewObjectIds,
        phase::{Layer, ObjectIdPhase, ObjectIdPhases},
        pipeline::has_sample_shading,
    },
};

/// Copies the normal prepass. Its key is the number of samples per pixel.
#[derive(Resource)]
pub(super) struct NormalCopyPipeline {
    fullscreen: FullscreenShader,
    shader: Handle<Shader>,
    shades_samples: bool,
}

pub(super) fn init_normal_copy(
    mut commands: Commands,
    fullscreen: Res<FullscreenShader>,
    assets: Res<AssetServer>,
    adapter: Res<RenderAdapter>,
) {
    commands.insert_resource(NormalCopyPipeline {
        shades_samples: has_sample_shading(&adapter),
        fullscreen: fullscreen.clone(),
        shader: load_embedded_asset!(assets.as_ref(), "copy_normals.wgsl"),
    });
}

fn copy_layout(samples: u32) -> BindGroupLayoutDescriptor {
    let texture = sampled(samples > 1, UNFILTERABLE);
    let entries = BindGroupLayoutEntries::single(ShaderStages::FRAGMENT, texture);
    BindGroupLayoutDescriptor::new("comics_copy_normals", &entries)
}

impl SpecializedRenderPipeline for NormalCopyPipeline {
    type Key = u32;

    fn specialize(&self, samples: u32) -> RenderPipelineDescriptor {
        let multisampled = samples > 1;
        let shader_defs = gpu::definitions([
            (multisampled, "MULTISAMPLED"),
            (multisampled && self.shades_samples, "SAMPLE_SHADING"),
        ]);
        RenderPipelineDescriptor {
            label: Some("comics_copy_normals".into()),
            layout: vec![copy_layout(samples)],
            vertex: self.fullscreen.to_vertex_state(),
            multisample: MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: shader_defs.collect(),
                entry_point: Some("copy_normal".into()),
                targets: vec![Some(NORMAL_PREPASS_FORMAT.into())],
            }),
            ..Default::default()
        }
    }
}

/// Gets the textures of this frame from the engine's texture cache.
pub(super) fn prepare_own_surfaces(
    mut commands: Commands,
    views: Query<(Entity, &QueuedDepth, Option<&ViewPrepassTextures>)>,
    stale: Query<Entity, (With<OwnSurfaces>, Without<QueuedDepth>)>,
    (mut textures, device): (ResMut<TextureCache>, Res<RenderDevice>),
    (copy, cache): (Res<NormalCopyPipeline>, Res<PipelineCache>),
    mut copies: ResMut<SpecializedRenderPipelines<NormalCopyPipeline>>,
) {
    for (view, queued, prepass) in &views {
        let Some(depth) = prepass.and_then(|prepass| prepass.depth.as_ref()) else {
            commands.entity(view).remove::<OwnSurfaces>();
            continue;
        };
        let like = &depth.texture.texture;
        let mut texture = |label, format: TextureFormat, usage: TextureUsages| {
            let usage = usage | TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
            let size = (UVec2::new(like.width(), like.height()), like.sample_count());
            textures.get(&device, gpu::texture(label, size, format, usage))
        };
        let copied = TextureUsages::COPY_DST;
        let depth = texture("comics_own_depth", CORE_3D_DEPTH_FORMAT, copied);
        let drawn = TextureUsages::empty();
        let normal = queued.normals.then(|| OwnNormals {
            texture: texture("comics_own_normals", NORMAL_PREPASS_FORMAT, drawn),
            copy: copies.specialize(&cache, &copy, like.sample_count()),
        });
        commands.entity(view).insert(OwnSurfaces {
            depth,
            normal,
            drawn: AtomicBool::new(false),
        });
    }
    for view in &stale {
        commands.entity(view).remove::<OwnSurfaces>();
    }
}

/// The components of a view that the pass reads.
type Parts<'a> = (
    (&'a ViewDepthTexture, &'a ViewPrepassTextures),
    (&'a QueuedDepth, &'a OwnSurfaces, Option<&'a ViewObjectIds>),
);

/// Draws the transparent meshes of a view into its own depth, normals and object ids.
pub(in crate::objects) fn draw_transparent_depth(
    world: &World,
    view: ViewQuery<(
        (
            &ExtractedCamera,
            &ExtractedView,
            Option<&MainPassResolutionOverride>,
            &DepthWanted,
        ),
        (&ViewDepthTexture, &ViewPrepassTextures),
        (&QueuedDepth, &OwnSurfaces, Option<&ViewObjectIds>),
    )>,
    phases: Res<ObjectIdPhases>,
    (ledger, binder): (Res<StageLedger>, Binder),
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let ((camera, extracted, resolution, wanted), textures, own) = view.into_inner();
    let phase = phases.views.get(&extracted.retained_view_entity);
    let recorded = Targets::new((textures, own), &binder).and_then(|targets| {
        let phase = phase.ok_or(SkipReason::PipelineNotReady)?;
        let viewport = Viewport::from_viewport_and_override(camera.viewport.as_ref(), resolution);
        targets.record(&mut ctx, (world, entity, phase), viewport)
    });
    let outcome = match recorded {
        Ok(()) => {
            own.1.drawn.store(true, Ordering::Relaxed);
            StageOutcome::Ran
        }
        Err(reason) => StageOutcome::Skipped(reason),
    };
    ledger.set(wanted.camera, ComicsStage::TransparentDepth, outcome);
}

/// The textures of the pass.
struct Targets<'a> {
    /// The engine's depth, and the copy.
    depth: (&'a ViewDepthTexture, &'a CachedTexture),
    ids: Option<&'a TextureView>,
    normal: Option<(&'a TextureView, &'a RenderPipeline, BindGroup)>,
}

impl<'a> Targets<'a> {
    /// An error if one of them is missing in this frame, or has another number of samples.
    fn new(
        ((depth, prepass), (queued, own, ids)): Parts<'a>,
        binder: &'a Binder,
    ) -> Result<Self, SkipReason> {
        let not_ready = SkipReason::PipelineNotReady;
        let samples = own.depth.texture.sample_count();
        let same = depth.texture.sample_count() == samples
            && depth.texture.size() == own.depth.texture.size();
        if !same {
            return Err(SkipReason::SampleCountMismatch);
        }
        let ids = match (queued.ids, ids) {
            (true, Some(ids)) if ids.texture.sample_count() == samples => Some(&ids.view),
            (true, Some(_)) => return Err(SkipReason::SampleCountMismatch),
            (true, None) => return Err(not_ready),
            (false, _) => None,
        };
        let normal = match (&own.normal, &prepass.normal) {
            (Some(own), Some(prepass)) => {
                let source = BindGroupEntries::single(&prepass.texture.default_view);
                let group = binder.group("comics_copy_normals", &copy_layout(samples), &source);
                let pipeline = (binder.cache)
                    .get_render_pipeline(own.copy)
                    .ok_or(not_ready)?;
                Some((&own.texture.default_view, pipeline, group))
            }
            (Some(_), None) => return Err(SkipReason::NoNormalPrepass),
            (None, _) => None,
        };
        Ok(Self {
            depth: (depth, &own.depth),
            ids,
            normal,
        })
    }

    fn record<'w>(
        &self,
        ctx: &mut RenderContext,
        (world, view, phase): (&'w World, Entity, &ObjectIdPhase),
        viewport: Option<Viewport>,
    ) -> Result<(), SkipReason> {
        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let span = diagnostics.time_span(ctx.command_encoder(), "comics_transparent_depth");
        self.copy(ctx);
        let drawn = self.draw(ctx, (world, view, phase), viewport);
        span.end(ctx.command_encoder());
        drawn
    }

    /// Copies the depth and the normals of the prepass.
    fn copy(&self, ctx: &mut RenderContext) {
        let encoder = ctx.command_encoder();
        let (engine, own) = self.depth;
        encoder.copy_texture_to_texture(
            engine.texture.as_image_copy(),
            own.texture.as_image_copy(),
            own.texture.size(),
        );
        let Some((target, pipeline, group)) = &self.normal else {
            return;
        };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_copy_normals"),
            color_attachments: &[Some(gpu::attachment(target, LoadOp::default()))],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn draw<'w>(
        &self,
        ctx: &mut RenderContext,
        (world, view, phase): (&'w World, Entity, &ObjectIdPhase),
        viewport: Option<Viewport>,
    ) -> Result<(), SkipReason> {
        let mut pass = ctx.begin_tracked_render_pass(RenderPassDescriptor {
            label: Some("comics_transparent_depth"),
            color_attachments: &[
                self.ids.map(|ids| gpu::attachment(ids, LoadOp::Load)),
                (self.normal.as_ref()).map(|(normal, ..)| gpu::attachment(normal, LoadOp::Load)),
            ],
            depth_stencil_attachment: Some(depth_attachment(
                &self.depth.1.default_view,
                LoadOp::Load,
                StoreOp::Store,
            )),
            ..Default::default()
        });
        if let Some(viewport) = viewport {
            pass.set_camera_viewport(&viewport);
        }
        phase
            .render(&mut pass, (world, view), Layer::OwnDepth)
            .map_err(|error| {
                error_once!("transparent meshes wrote no depth: {error:?}");
                SkipReason::PipelineNotReady
            })
    }
}
