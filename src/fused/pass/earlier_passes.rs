//! The passes of a view before the last one, and the textures that they draw: pictures for
//! effects that read the picture at other places, and means over boxes or numbers beside them.

use bevy::{
    prelude::*,
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
    inputs::{Inputs, PreviousPass},
    prepare::{EarlierPassRequest, FusedRequest, TexturePass},
};
use crate::{
    fused::key::{
        StylizeKey,
        intermediate::{Drawn, PACKED_FORMAT, PASS_FORMAT},
    },
    gpu::{attachment, texture},
};

/// On a view in the render world: what its passes but the last one draw to.
#[derive(Component)]
pub(crate) struct PassTextures {
    /// A pass cannot read what it draws to, so more than one pass draw to two in turns.
    pictures: Vec<CachedTexture>,
    /// The same of pictures with numbers.
    with_scalar: Vec<CachedTexture>,
    /// Means of rows and of boxes, or nothing.
    means: Vec<CachedTexture>,
}

impl PassTextures {
    /// The texture that a pass draws to, and the next one reads.
    fn picture(&self, pass: usize, key: &StylizeKey) -> Option<&TextureView> {
        let textures = match key.draws {
            Drawn::WithScalar(_) => &self.with_scalar,
            _ => &self.pictures,
        };
        let at = pass % textures.len().max(1);
        Some(&textures.get(at)?.default_view)
    }

    fn means(&self, step: usize) -> Option<&TextureView> {
        Some(&self.means.get(step)?.default_view)
    }
}

pub(crate) fn prepare_pass_textures(
    mut commands: Commands,
    views: Query<(Entity, &FusedRequest)>,
    prepared: Query<Entity, With<PassTextures>>,
    (mut textures, device): (ResMut<TextureCache>, Res<RenderDevice>),
) {
    for (view, request) in &views {
        let mut get = |format, count| {
            (0..count)
                .map(|_| textures.get(&device, descriptor(request, format)))
                .collect::<Vec<_>>()
        };
        let passes = || request.earlier.iter();
        // In turns by the number of the pass: two, even if only one of the passes draws to them.
        let both = |draws: bool| if draws { passes().len().min(2) } else { 0 };
        let has_scalar =
            |pass: &EarlierPassRequest| matches!(pass.picture.key.draws, Drawn::WithScalar(_));
        let pictures = get(PASS_FORMAT, both(!passes().all(has_scalar)));
        let with_scalar = get(PACKED_FORMAT, both(passes().any(has_scalar)));
        let has_means = passes().any(|pass| pass.means.is_some());
        let means = get(PACKED_FORMAT, if has_means { 2 } else { 0 });
        if !request.earlier.is_empty() {
            commands.entity(view).insert(PassTextures {
                pictures,
                with_scalar,
                means,
            });
        } else if prepared.contains(view) {
            commands.entity(view).remove::<PassTextures>();
        }
    }
    for view in &prepared {
        if !views.contains(view) {
            commands.entity(view).remove::<PassTextures>();
        }
    }
}

/// A texture of the viewport's size.
fn descriptor(request: &FusedRequest, format: TextureFormat) -> TextureDescriptor<'static> {
    let [_, _, width, height] = request.context.viewport.to_array();
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
    texture("comics_pass", (UVec2::new(width, height), 1), format, usage)
}

pub(crate) fn described<'a>(
    attachments: &'a [Option<RenderPassColorAttachment<'a>>],
) -> RenderPassDescriptor<'a> {
    RenderPassDescriptor {
        label: Some("comics_stylize"),
        color_attachments: attachments,
        ..Default::default()
    }
}

pub(crate) struct EarlierPasses<'a>(Vec<EarlierPass<'a>>);

struct EarlierPass<'a> {
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
        pass: &'a TexturePass,
        texture: Option<&'a TextureView>,
    ) -> Option<Self> {
        Some(Self {
            key: &pass.key,
            pipeline: cache.get_render_pipeline(pass.pipeline)?,
            texture: texture?,
        })
    }

    /// Returns what it has drawn.
    fn record(
        &self,
        ctx: &mut RenderContext,
        inputs: &Inputs,
        before: &PreviousPass,
    ) -> &'a TextureView {
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

impl<'a> EarlierPasses<'a> {
    /// `None` if a pipeline or a texture is not ready in this frame.
    pub fn new(
        cache: &'a PipelineCache,
        request: &'a FusedRequest,
        textures: Option<&'a PassTextures>,
    ) -> Option<Self> {
        let draws = request.earlier.iter().enumerate().map(|(i, pass)| {
            let textures = textures?;
            let means = match &pass.means {
                Some([across, down]) => Some([
                    Draw::new(cache, across, textures.means(0))?,
                    Draw::new(cache, down, textures.means(1))?,
                ]),
                None => None,
            };
            let texture = textures.picture(i, &pass.picture.key);
            let picture = Draw::new(cache, &pass.picture, texture)?;
            Some(EarlierPass { picture, means })
        });
        draws.collect::<Option<_>>().map(Self)
    }

    /// Returns what they have drawn for the last pass.
    pub fn record(&self, ctx: &mut RenderContext, inputs: &Inputs) -> PreviousPass<'a> {
        let mut before = PreviousPass::default();
        for pass in &self.0 {
            let drawn = Some(pass.picture.record(ctx, inputs, &before));
            before = match pass.picture.key.draws {
                Drawn::WithScalar(_) => PreviousPass {
                    picture: None,
                    packed: drawn,
                },
                _ => PreviousPass {
                    picture: drawn,
                    packed: None,
                },
            };
            for draw in pass.means.iter().flatten() {
                before.packed = Some(draw.record(ctx, inputs, &before));
            }
        }
        before
    }
}
