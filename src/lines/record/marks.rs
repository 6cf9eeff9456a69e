//! Draws the lines of highlighted objects over the picture: see `marks.wgsl`.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    camera::CompositingSpace,
    core_pipeline::FullscreenShader,
    ecs::{
        component::Component,
        entity::Entity,
        resource::Resource,
        system::{Query, Res},
    },
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
    shader::{Shader, ShaderDefVal},
};

use crate::{
    bind_groups::Binder,
    gpu::{UNFILTERABLE, attachment, entry},
    lines::{
        passes::LinePasses,
        prepare::ViewLines,
        request::{LinePassUniform, LineRequest},
        tiles::{TileList, tile_shader, vertices},
    },
    objects::{MarkStyleBuffer, object_styles_entry},
};

/// On a view in the render world: the entity that has the requests for the lines of its marked
/// objects, and the pipeline that draws them.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct ViewMarks {
    pub layer: Entity,
    pub pipeline: CachedRenderPipelineId,
    pub key: MarkKey,
    /// The view is styled after anti-aliasing.
    pub late: bool,
}

/// Selects the variant of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MarkKey {
    pub format: TextureFormat,
    pub space: CompositingSpace,
    /// Only the tiles with ink are drawn.
    pub tiled: bool,
}

impl MarkKey {
    fn layout() -> BindGroupLayoutDescriptor {
        let stages = ShaderStages::FRAGMENT;
        let float = texture_2d(UNFILTERABLE);
        let entries = [
            uniform_buffer::<LinePassUniform>(false).build(1, stages),
            float.build(4, stages),
            object_styles_entry(),
        ];
        BindGroupLayoutDescriptor::new("comics_draw_marks", &entries)
    }

    fn defs(self) -> Vec<ShaderDefVal> {
        let space = match self.space {
            CompositingSpace::Linear => None,
            CompositingSpace::Srgb => Some("STORED_SRGB".into()),
            CompositingSpace::Oklab => Some("STORED_OKLAB".into()),
        };
        let styles = ["OBJECT_STYLES".into()];
        styles.into_iter().chain(space).collect()
    }
}

#[derive(Resource)]
pub(crate) struct MarkPipeline {
    fullscreen: FullscreenShader,
    tile: Handle<Shader>,
    shader: Handle<Shader>,
}

impl MarkPipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            tile: tile_shader(assets),
            shader: load_embedded_asset!(assets, "marks.wgsl"),
        }
    }
}

impl SpecializedRenderPipeline for MarkPipeline {
    type Key = MarkKey;

    fn specialize(&self, key: MarkKey) -> RenderPipelineDescriptor {
        let (vertex, primitive) = vertices(key.tiled, &self.fullscreen, &self.tile);
        RenderPipelineDescriptor {
            label: Some("comics_draw_marks".into()),
            layout: vec![MarkKey::layout()],
            vertex,
            primitive,
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: key.defs(),
                entry_point: Some("draw_marks".into()),
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
    styles: &'a MarkStyleBuffer,
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
pub(crate) fn draw_marks<const LATE: bool>(
    view: ViewQuery<(&ViewTarget, &ViewMarks)>,
    layers: Query<(&LineRequest, &LinePasses, &ViewLines)>,
    styles: Res<MarkStyleBuffer>,
    binder: Binder,
    mut ctx: RenderContext,
) {
    let (target, marks) = view.into_inner();
    if marks.late != LATE {
        return;
    }
    let Ok((request, passes, lines)) = layers.get(marks.layer) else {
        return;
    };
    let pipeline = binder.cache.get_render_pipeline(marks.pipeline);
    let entries = bindings(lines, &styles);
    let (Some(pipeline), Some(entries)) = (pipeline, entries) else {
        return;
    };
    if target.main_texture_format() != marks.key.format {
        return;
    }
    let group = binder.group("comics_draw_marks", &MarkKey::layout(), &entries);
    let tiles = if marks.key.tiled { lines.tiles() } else { None };
    if marks.key.tiled != tiles.is_some() || marks.key.tiled != passes.are_tiles_complete() {
        return;
    }
    let mut pass = ctx
        .command_encoder()
        .begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_draw_marks"),
            color_attachments: &[Some(attachment(target.main_texture_view(), LoadOp::Load))],
            ..Default::default()
        });
    let [x, y, width, height] = request.view.viewport.as_vec4().to_array();
    pass.set_viewport(x, y, width, height, 0.0, 1.0);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    match tiles {
        Some(tiles) => tiles.draw(&mut pass, TileList::Inked),
        None => pass.draw(0..3, 0..1),
    }
}
