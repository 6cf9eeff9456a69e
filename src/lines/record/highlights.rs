//! Draws the lines of highlighted objects over the picture: see `highlights.wgsl`.

use bevy::{
    asset::load_embedded_asset,
    core_pipeline::FullscreenShader,
    prelude::*,
    render::{
        render_resource::{
            BindGroupEntry, BindGroupLayoutDescriptor, BlendState, CachedRenderPipelineId,
            ColorTargetState, ColorWrites, FragmentState, IntoBinding, LoadOp,
            RenderPassDescriptor, RenderPipelineDescriptor, ShaderStages,
            SpecializedRenderPipeline, TextureFormat,
            binding_types::{texture_2d, uniform_buffer},
        },
        renderer::{RenderContext, ViewQuery},
        view::ViewTarget,
    },
    shader::ShaderDefVal,
};

use crate::{
    bind_groups::Binder,
    gpu::{UNFILTERABLE, attachment, entry, stored},
    lines::{
        passes::LinePasses,
        prepare::ViewLines,
        request::{LinePassUniform, LineRequest},
        tiles::{TileList, draw_tiles, tile_shader, vertices},
    },
    objects::{HighlightStyleBuffer, object_styles_entry},
};

/// On a view in the render world: the entity that has the requests for the lines of its highlighted
/// objects, and the pipeline that draws them.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct ViewHighlights {
    pub layer: Entity,
    pub pipeline: CachedRenderPipelineId,
    pub key: HighlightKey,
    /// The view is styled after anti-aliasing.
    pub late: bool,
}

/// Selects the variant of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct HighlightKey {
    pub format: TextureFormat,
    pub space: CompositingSpace,
    /// Only the tiles with ink are drawn.
    pub tiled: bool,
}

impl HighlightKey {
    fn layout() -> BindGroupLayoutDescriptor {
        let stages = ShaderStages::FRAGMENT;
        let float = texture_2d(UNFILTERABLE);
        let entries = [
            uniform_buffer::<LinePassUniform>(false).build(1, stages),
            float.build(4, stages),
            object_styles_entry(),
        ];
        BindGroupLayoutDescriptor::new("comics_draw_highlights", &entries)
    }

    fn defs(self) -> Vec<ShaderDefVal> {
        let styles = ["OBJECT_STYLES".into()];
        styles.into_iter().chain(stored(self.space)).collect()
    }
}

#[derive(Resource)]
pub(crate) struct HighlightPipeline {
    fullscreen: FullscreenShader,
    tile: Handle<Shader>,
    shader: Handle<Shader>,
}

impl HighlightPipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            tile: tile_shader(assets),
            shader: load_embedded_asset!(assets, "highlights.wgsl"),
        }
    }
}

impl SpecializedRenderPipeline for HighlightPipeline {
    type Key = HighlightKey;

    fn specialize(&self, key: HighlightKey) -> RenderPipelineDescriptor {
        let (vertex, primitive) = vertices(key.tiled, &self.fullscreen, &self.tile);
        RenderPipelineDescriptor {
            label: Some("comics_draw_highlights".into()),
            layout: vec![HighlightKey::layout()],
            vertex,
            primitive,
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: key.defs(),
                entry_point: Some("draw_highlights".into()),
                targets: vec![Some(ColorTargetState {
                    format: key.format,
                    blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: ColorWrites::ALL,
                })],
            }),
            ..Default::default()
        }
    }
}

/// What the pass binds; `None` if something is not ready in this frame.
fn bindings<'a>(
    lines: &'a ViewLines,
    styles: &'a HighlightStyleBuffer,
) -> Option<[BindGroupEntry<'a>; 3]> {
    let resources = [
        (1, lines.uniform.binding()?),
        (4, (&lines.found()?.default_view).into_binding()),
        (6, styles.0.buffer()?.as_entire_binding()),
    ];
    Some(resources.map(|(binding, resource)| entry(binding, resource)))
}

/// Draws the lines of the highlighted objects of the view over its picture. `LATE`: of the views
/// that are styled after anti-aliasing, of the others otherwise.
pub(crate) fn draw_highlights<const LATE: bool>(
    view: ViewQuery<(&ViewTarget, &ViewHighlights)>,
    layers: Query<(&LineRequest, &LinePasses, &ViewLines)>,
    styles: Res<HighlightStyleBuffer>,
    binder: Binder,
    mut ctx: RenderContext,
) {
    let (target, highlights) = view.into_inner();
    if highlights.late != LATE {
        return;
    }
    let Ok((request, passes, lines)) = layers.get(highlights.layer) else {
        return;
    };
    let pipeline = binder.cache.get_render_pipeline(highlights.pipeline);
    let entries = bindings(lines, &styles);
    let (Some(pipeline), Some(entries)) = (pipeline, entries) else {
        return;
    };
    if target.main_texture_format() != highlights.key.format {
        return;
    }
    let group = binder.group("comics_draw_highlights", &HighlightKey::layout(), &entries);
    let tiled = highlights.key.tiled;
    let tiles = lines.tiles().filter(|_| tiled);
    if tiled != tiles.is_some() || tiled != passes.are_tiles_complete() {
        return;
    }
    let mut pass = ctx
        .command_encoder()
        .begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_draw_highlights"),
            color_attachments: &[Some(attachment(target.main_texture_view(), LoadOp::Load))],
            ..Default::default()
        });
    let [x, y, width, height] = request.view.viewport.as_vec4().to_array();
    pass.set_viewport(x, y, width, height, 0.0, 1.0);
    let tiles = tiles.map(|tiles| (tiles, TileList::Inked));
    draw_tiles(&mut pass, (pipeline, &group), tiles);
}
