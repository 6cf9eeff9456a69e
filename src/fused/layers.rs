//! The passes of a view before the last one, and the textures that they draw: pictures for
//! effects that read the picture at other places, and means over boxes or numbers beside them.

use bevy::{
    ecs::{
        component::Component,
        entity::Entity,
        query::With,
        system::{Commands, Query, Res, ResMut},
    },
    math::UVec2,
    render::{
        render_resource::{
            LoadOp, PipelineCache, RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline,
            TextureDescriptor, TextureFormat, TextureUsages, TextureView,
        },
        renderer::{RenderContext, RenderDevice},
        texture::{CachedTexture, TextureCache},
    },
};

use super::{
    inputs::{Before, Inputs},
    key::StylizeKey,
    prepare::{FusedRequest, Layer, LayerPass},
    words::{Drawn, LAYER_FORMAT, WORDS_FORMAT},
};
use crate::gpu::{attachment, texture};

/// On a view in the render world: what its passes but the last one draw to.
#[derive(Component)]
pub(super) struct ViewLayers {
    /// A pass cannot read what it draws to, so more than one pass draw to two in turns.
    pictures: Vec<CachedTexture>,
    /// The same of pictures with numbers.
    numbered: Vec<CachedTexture>,
    /// Means of rows and of boxes, or nothing.
    means: Vec<CachedTexture>,
}

impl ViewLayers {
    /// The texture that a pass draws to, and the next one reads.
    fn picture(&self, pass: usize, key: &StylizeKey) -> Option<&TextureView> {
        let textures = match key.draws {
            Drawn::WithScalar(_) => &self.numbered,
            _ => &self.pictures,
        };
        let at = pass % textures.len().max(1);
        Some(&textures.get(at)?.default_view)
    }

    fn means(&self, step: usize) -> Option<&TextureView> {
        Some(&self.means.get(step)?.default_view)
    }
}

pub(super) fn prepare_layers(
    mut commands: Commands,
    views: Query<(Entity, &FusedRequest)>,
    layered: Query<Entity, With<ViewLayers>>,
    (mut textures, device): (ResMut<TextureCache>, Res<RenderDevice>),
) {
    for (view, request) in &views {
        let mut get = |format, count| {
            let layer = || descriptor(request, format);
            (0..count)
                .map(|_| textures.get(&device, layer()))
                .collect::<Vec<_>>()
        };
        let layers = || request.layers.iter();
        // In turns by the number of the pass: two, even if only one of the passes draws to them.
        let both = |draws: bool| if draws { layers().len().min(2) } else { 0 };
        let is_numbered = |layer: &Layer| matches!(layer.picture.key.draws, Drawn::WithScalar(_));
        let pictures = get(LAYER_FORMAT, both(!layers().all(is_numbered)));
        let numbered = get(WORDS_FORMAT, both(layers().any(is_numbered)));
        let has_means = layers().any(|layer| layer.means.is_some());
        let means = get(WORDS_FORMAT, if has_means { 2 } else { 0 });
        if !request.layers.is_empty() {
            let layers = ViewLayers {
                pictures,
                numbered,
                means,
            };
            commands.entity(view).insert(layers);
        } else if layered.contains(view) {
            commands.entity(view).remove::<ViewLayers>();
        }
    }
    for view in &layered {
        if !views.contains(view) {
            commands.entity(view).remove::<ViewLayers>();
        }
    }
}

/// A texture of the viewport's size.
fn descriptor(request: &FusedRequest, format: TextureFormat) -> TextureDescriptor<'static> {
    let [_, _, width, height] = request.facts.viewport.to_array();
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
    texture(
        "comics_layer",
        (UVec2::new(width, height), 1),
        format,
        usage,
    )
}

pub(super) fn described<'a>(
    attachments: &'a [Option<RenderPassColorAttachment<'a>>],
) -> RenderPassDescriptor<'a> {
    RenderPassDescriptor {
        label: Some("comics_stylize"),
        color_attachments: attachments,
        ..Default::default()
    }
}

/// The passes before the last one.
pub(super) struct Layers<'a>(Vec<LayerDraw<'a>>);

struct LayerDraw<'a> {
    picture: Draw<'a>,
    means: Option<[Draw<'a>; 2]>,
}

/// A full-screen pass that draws a texture for a later one.
struct Draw<'a> {
    key: &'a StylizeKey,
    pipeline: &'a RenderPipeline,
    texture: &'a TextureView,
}

impl<'a> Draw<'a> {
    fn new(
        cache: &'a PipelineCache,
        pass: &'a LayerPass,
        texture: Option<&'a TextureView>,
    ) -> Option<Self> {
        Some(Self {
            key: &pass.key,
            pipeline: cache.get_render_pipeline(pass.pipeline)?,
            texture: texture?,
        })
    }

    /// Returns what it has drawn.
    fn record(&self, ctx: &mut RenderContext, inputs: &Inputs, before: &Before) -> &'a TextureView {
        let bind_group = inputs.bind_group(self.key, before);
        let attachments = [Some(attachment(self.texture, LoadOp::default()))];
        let encoder = ctx.command_encoder();
        let mut pass = encoder.begin_render_pass(&described(&attachments));
        pass.set_bind_group(0, &bind_group, &[]);
        pass.set_pipeline(self.pipeline);
        pass.draw(0..3, 0..1);
        self.texture
    }
}

impl<'a> Layers<'a> {
    /// `None` if a pipeline or a texture is not ready in this frame.
    pub fn new(
        cache: &'a PipelineCache,
        request: &'a FusedRequest,
        textures: Option<&'a ViewLayers>,
    ) -> Option<Self> {
        let draws = request.layers.iter().enumerate().map(|(i, layer)| {
            let textures = textures?;
            let means = match &layer.means {
                Some([across, down]) => Some([
                    Draw::new(cache, across, textures.means(0))?,
                    Draw::new(cache, down, textures.means(1))?,
                ]),
                None => None,
            };
            let texture = textures.picture(i, &layer.picture.key);
            let picture = Draw::new(cache, &layer.picture, texture)?;
            Some(LayerDraw { picture, means })
        });
        draws.collect::<Option<_>>().map(Self)
    }

    /// Returns what they have drawn for the last pass.
    pub fn record(&self, ctx: &mut RenderContext, inputs: &Inputs) -> Before<'a> {
        let mut before = Before::default();
        for layer in &self.0 {
            let drawn = Some(layer.picture.record(ctx, inputs, &before));
            before = match layer.picture.key.draws {
                Drawn::WithScalar(_) => Before {
                    picture: None,
                    words: drawn,
                },
                _ => Before {
                    picture: drawn,
                    words: None,
                },
            };
            for draw in layer.means.iter().flatten() {
                before.words = Some(draw.record(ctx, inputs, &before));
            }
        }
        before
    }
}
