//! The fused full-screen pass: every style of a camera in one read and one
//! write of its picture.

mod modes;

use std::sync::atomic::Ordering;

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    camera::CompositingSpace,
    core_pipeline::{FullscreenShader, prepass::ViewPrepassTextures},
    ecs::{resource::Resource, system::Res},
    math::{IVec4, Vec2},
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutEntries, ColorTargetState,
            ColorWrites, FragmentState, IntoBinding, Operations, PipelineCache,
            RenderPassColorAttachment, RenderPassDescriptor, RenderPipelineDescriptor,
            ShaderStages, ShaderType, SpecializedRenderPipeline, TextureFormat, TextureSampleType,
            binding_types::{texture_2d, texture_2d_multisampled, uniform_buffer},
        },
        renderer::{RenderContext, ViewQuery},
        view::ViewTarget,
    },
    shader::{Shader, ShaderDefVal},
};

use crate::{
    depth::{DepthFrame, RawDepth, prepare::ViewRange},
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    finish::{DebugView, FinishUniform},
    objects::ObjectStyleBuffer,
    outlining::{edges_entry, ids_entry, object_styles_entry, range_entry},
    passes::ViewPasses,
    styles::{
        black_flats::BlackFlatsUniform, colorization::ColorizationUniform,
        contours::ContoursUniform, desaturation::DesaturationUniform, outlines::OutlinesUniform,
        sketch::SketchUniform, tone_bands::ToneBandsUniform,
    },
    view::Plan,
};
use modes::Modes;

/// `Comics` of `bindings.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct ComicsUniform {
    pub viewport: IVec4,
    pub depth_scale: Vec2,
    pub flip: u32,
    pub raw: RawDepth,
    pub depth: DepthFrame,
    pub desaturation: DesaturationUniform,
    pub colorization: ColorizationUniform,
    pub contours: ContoursUniform,
    pub black_flats: BlackFlatsUniform,
    pub tone_bands: ToneBandsUniform,
    pub outlines: OutlinesUniform,
    pub sketch: SketchUniform,
    pub finish: FinishUniform,
}

/// What is compiled in: the presence of styles and their modes, never their
/// other numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct StylizeKey {
    format: TextureFormat,
    space: CompositingSpace,
    pub depth: bool,
    pub visible_range: bool,
    pub samples: u32,
    oblique: bool,
    desaturation: bool,
    colorization: bool,
    black_flats: bool,
    steep_flats: bool,
    contours: bool,
    tone_bands: bool,
    edges: bool,
    flood: bool,
    object_styles: bool,
    sketch: bool,
    pub view: Option<DebugView>,
    modes: Modes,
}

impl Default for StylizeKey {
    fn default() -> Self {
        Self::new(&Plan::default(), TextureFormat::Rgba8UnormSrgb, None)
    }
}

impl StylizeKey {
    pub fn new(plan: &Plan, format: TextureFormat, space: Option<CompositingSpace>) -> Self {
        Self {
            format,
            space: space.unwrap_or(CompositingSpace::Linear),
            depth: plan.draws_with_depth(),
            visible_range: plan.draws_with_range(),
            samples: 1,
            oblique: false,
            desaturation: plan.desaturation.is_some(),
            colorization: plan.colorization.is_some(),
            black_flats: plan.black_flats.is_some(),
            steep_flats: plan.black_flats.is_some_and(|b| b.slope.is_some()),
            contours: plan.contours.is_some(),
            tone_bands: plan.tone_bands.is_some(),
            edges: plan.outlines.is_some(),
            flood: false,
            object_styles: plan.object_styles && plan.outlines.is_some(),
            sketch: plan.sketch.is_some(),
            view: plan.view,
            modes: Modes::default(),
        }
    }

    /// The modes that this uniform holds.
    pub fn with_modes(self, uniform: &ComicsUniform) -> Self {
        Self {
            modes: Modes::of(uniform),
            ..self
        }
    }

    /// Whether lines come from a flood.
    pub fn with_flood(self, flood: bool) -> Self {
        Self { flood, ..self }
    }

    /// What is compiled in depends on the depth only where depth is read.
    pub fn with_depth(self, samples: u32, oblique: bool) -> Self {
        if self.depth {
            Self {
                samples,
                oblique,
                ..self
            }
        } else {
            self
        }
    }

    fn shader_defs(&self) -> Vec<ShaderDefVal> {
        let space = match self.space {
            CompositingSpace::Linear => None,
            CompositingSpace::Srgb => Some("STORED_SRGB"),
            CompositingSpace::Oklab => Some("STORED_OKLAB"),
        };
        [
            (self.depth, "DEPTH"),
            (self.visible_range, "VISIBLE_RANGE"),
            (self.samples > 1, "MULTISAMPLED"),
            (self.oblique, "OBLIQUE"),
            (self.desaturation, "DESATURATION"),
            (self.colorization, "COLORIZATION"),
            (self.black_flats, "BLACK_FLATS"),
            (self.steep_flats, "STEEP_FLATS"),
            (self.contours, "CONTOURS"),
            (self.tone_bands, "TONE_BANDS"),
            (self.edges, "EDGES"),
            (self.flood, "FLOOD"),
            (self.object_styles, "OBJECT_STYLES"),
            (self.sketch, "SKETCH"),
        ]
        .into_iter()
        .filter_map(|(on, name)| on.then_some(name))
        .chain(space)
        .chain(self.view.map(DebugView::shader_def))
        .chain(self.shows_ids().then_some("OBJECT_IDS"))
        .map(ShaderDefVal::from)
        .chain(self.modes.shader_defs())
        .collect()
    }

    fn shows_ids(&self) -> bool {
        self.view.is_some_and(DebugView::reads_ids)
    }

    fn layout(&self) -> BindGroupLayoutDescriptor {
        let unfilterable = TextureSampleType::Float { filterable: false };
        let mut entries = BindGroupLayoutEntries::sequential(
            ShaderStages::FRAGMENT,
            (
                texture_2d(unfilterable),
                uniform_buffer::<ComicsUniform>(true),
            ),
        )
        .to_vec();
        if self.depth {
            let depth = if self.samples > 1 {
                texture_2d_multisampled(unfilterable)
            } else {
                texture_2d(unfilterable)
            };
            entries.push(depth.build(2, ShaderStages::FRAGMENT));
        }
        if self.visible_range {
            entries.push(range_entry());
        }
        if self.edges {
            entries.push(edges_entry(4));
        }
        if self.flood {
            entries.push(edges_entry(5));
        }
        if self.object_styles {
            entries.push(object_styles_entry());
        }
        if self.shows_ids() {
            entries.push(ids_entry(self.samples > 1));
        }
        BindGroupLayoutDescriptor::new("comics_stylize", &entries)
    }
}

#[derive(Resource)]
pub(crate) struct StylizePipeline {
    fullscreen: FullscreenShader,
    shader: Handle<Shader>,
}

impl StylizePipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            shader: load_embedded_asset!(assets, "stylize.wgsl"),
        }
    }
}

impl SpecializedRenderPipeline for StylizePipeline {
    type Key = StylizeKey;

    fn specialize(&self, key: Self::Key) -> RenderPipelineDescriptor {
        RenderPipelineDescriptor {
            label: Some("comics_stylize".into()),
            layout: vec![key.layout()],
            vertex: self.fullscreen.to_vertex_state(),
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: key.shader_defs(),
                entry_point: Some("stylize".into()),
                targets: vec![Some(ColorTargetState {
                    format: key.format,
                    blend: None,
                    write_mask: ColorWrites::ALL,
                })],
            }),
            ..Default::default()
        }
    }
}

/// Draws the styles of the view. The picture is taken from the view only when
/// everything is there to give it back.
pub(crate) fn stylize(
    view: ViewQuery<(&ViewTarget, Option<&ViewPrepassTextures>)>,
    passes: Res<ViewPasses>,
    object_styles: Res<ObjectStyleBuffer>,
    ledger: Res<StageLedger>,
    cache: Res<PipelineCache>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (target, prepass) = view.into_inner();
    let Some(pass) = passes.views.get(&entity) else {
        return;
    };
    let (Some(id), Some(uniforms)) = (pass.stylize, passes.uniforms.binding()) else {
        return;
    };
    let key = &pass.key;
    let pass_through = |reason| {
        ledger.set(
            pass.camera,
            ComicsStage::Stylize,
            StageOutcome::LeftOut(reason),
        );
    };
    let Some(pipeline) = cache.get_render_pipeline(id) else {
        return pass_through(LeftOut::PipelineNotReady);
    };
    let depth = prepass.and_then(|textures| textures.depth.as_ref());
    if key.depth && depth.is_none_or(|d| d.texture.texture.sample_count() != key.samples) {
        return pass_through(LeftOut::SampleCountMismatch);
    }
    // A range that was not found this frame is not drawn with.
    let keys = pass.range.as_ref().and_then(ViewRange::drawn);
    if key.visible_range && keys.is_none() {
        return pass_through(LeftOut::PipelineNotReady);
    }
    if target.main_texture_format() != key.format {
        return pass_through(LeftOut::PipelineNotReady);
    }

    let outline = pass.outline.as_ref();
    let lines_found = pass.outlines_found.load(Ordering::Relaxed);
    if key.edges && (outline.is_none() || !lines_found) {
        return pass_through(LeftOut::PipelineNotReady);
    }
    let style_table = object_styles.buffer();
    if key.object_styles && style_table.is_none() {
        return pass_through(LeftOut::PipelineNotReady);
    }

    let ids = pass.ids.as_ref();
    if key.shows_ids() && ids.is_none() {
        return pass_through(LeftOut::PipelineNotReady);
    }

    let layout = cache.get_bind_group_layout(&key.layout());
    let post = target.post_process_write();
    let entry = |binding, resource| BindGroupEntry { binding, resource };
    let mut entries = vec![entry(0, post.source.into_binding()), entry(1, uniforms)];
    if let Some(depth) = depth.filter(|_| key.depth) {
        entries.push(entry(2, (&depth.texture.default_view).into_binding()));
    }
    if let Some(keys) = keys.filter(|_| key.visible_range) {
        entries.push(entry(3, keys.as_entire_binding()));
    }
    if let Some(outline) = outline.filter(|_| key.edges) {
        entries.push(entry(4, (&outline.edges.view).into_binding()));
        if let Some(flood) = outline.flood.as_ref().filter(|_| key.flood) {
            entries.push(entry(5, (&flood.result().view).into_binding()));
        }
    }
    if let Some(styles) = style_table.filter(|_| key.object_styles) {
        entries.push(entry(6, styles.as_entire_binding()));
    }
    if let Some(ids) = ids.filter(|_| key.shows_ids()) {
        entries.push(entry(8, (&ids.view).into_binding()));
    }
    let device = ctx.render_device();
    let bind_group = device.create_bind_group("comics_stylize", &layout, &entries);

    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let encoder = ctx.command_encoder();
    let span = diagnostics.time_span(encoder, "comics_stylize");
    {
        let mut render_pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_stylize"),
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
        render_pass.set_pipeline(pipeline);
        render_pass.set_bind_group(0, &bind_group, &[pass.uniform_offset]);
        render_pass.draw(0..3, 0..1);
    }
    span.end(encoder);

    for (stage, ran) in [
        (ComicsStage::ToneBands, pass.plan.tone_bands.is_some()),
        (ComicsStage::Desaturation, pass.plan.desaturation.is_some()),
        (ComicsStage::Colorization, pass.plan.colorization.is_some()),
        (ComicsStage::BlackFlats, pass.plan.black_flats.is_some()),
        (ComicsStage::Contours, pass.plan.contours.is_some()),
        (ComicsStage::Outlines, pass.plan.outlines.is_some()),
        (ComicsStage::Sketch, pass.plan.sketch.is_some()),
        (ComicsStage::Stylize, true),
    ] {
        if ran {
            ledger.set(pass.camera, stage, StageOutcome::Ran);
        }
    }
}
