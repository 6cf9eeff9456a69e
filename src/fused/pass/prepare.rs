//! Writes the uniform of the fused pass for every view.

use crate::effect::{EffectContext, Needs, encode};
use std::sync::Arc;

use bevy::{
    prelude::*,
    render::{
        render_resource::{Buffer, BufferUsages, CachedRenderPipelineId},
        renderer::{RenderDevice, RenderQueue},
    },
};

use super::blue_noise::BlueNoise;
use crate::{
    depth::view::ViewUniform,
    fused::{Plan, key::StylizeKey},
    gpu::buffer,
    lines::{LineLayersUniform, LinesUniform},
};

/// On a view in the render world: draw its effects in this frame.
#[derive(Component, Clone, Debug)]
pub(crate) struct FusedRequest {
    pub camera: Entity,
    pub plan: Arc<Plan>,
    /// The passes before the last one.
    pub earlier: Vec<EarlierPassRequest>,
    pub key: StylizeKey,
    pub pipeline: CachedRenderPipelineId,
    /// Draws all pixels before the tiles of `pipeline`, see [`DrawnArea::Base`].
    ///
    /// [`DrawnArea::Base`]: crate::fused::key::drawn_area::DrawnArea::Base
    pub base: Option<CachedRenderPipelineId>,
    pub context: EffectContext,
    pub view: ViewUniform,
    pub lines: Option<LinesUniform>,
    pub line_layers: Option<LineLayersUniform>,
}

/// A pass that draws a picture for the next one, with numbers if that one reads them, and the
/// passes that draw means over boxes of this picture: of rows, then of boxes.
#[derive(Clone, Debug)]
pub(crate) struct EarlierPassRequest {
    pub picture: TexturePass,
    pub means: Option<[TexturePass; 2]>,
}

/// A pass that draws a texture for a later one.
#[derive(Clone, Debug)]
pub(crate) struct TexturePass {
    pub key: StylizeKey,
    pub pipeline: CachedRenderPipelineId,
}

/// Bytes after the uniform. A shader whose WGSL struct is larger than
/// [`Effect::Uniform`](crate::effect::Effect::Uniform) reads them. Without them the buffer
/// would be too small for the shader: a validation error, which ends the app.
const SLACK: u64 = 1024;

impl FusedRequest {
    /// The pipelines of all passes.
    pub fn pipelines(&self) -> impl Iterator<Item = CachedRenderPipelineId> {
        let passes = |earlier: &EarlierPassRequest| {
            let means = earlier.means.iter().flatten();
            let passes = [&earlier.picture].into_iter().chain(means);
            passes.map(|pass| pass.pipeline).collect::<Vec<_>>()
        };
        let earlier = self.earlier.iter().flat_map(passes);
        earlier.chain(self.base).chain([self.pipeline])
    }

    /// The bytes of `Comics` in `fused.wgsl`: only the parts that the key compiles
    /// in, each at a multiple of 16 bytes, with 16 bytes before all but the first two.
    fn uniform_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let pad = |bytes: &mut Vec<u8>| bytes.resize(bytes.len().next_multiple_of(16), 0);
        for part in [
            encode(&self.view),
            encode(&self.plan.composite.uniform(self.context.viewport.z)),
        ] {
            bytes.extend(part);
            pad(&mut bytes);
        }
        let mut push = |part: Vec<u8>| {
            bytes.extend([0; 16]);
            bytes.extend(part);
            pad(&mut bytes);
        };
        if let Some(lines) = self.lines.filter(|_| self.key.lines) {
            push(encode(&lines));
        }
        if let Some(layers) = self.line_layers.filter(|_| self.key.layer_ink) {
            push(encode(&layers));
        }
        if let Some(tones) = self.plan.tones().filter(|_| self.key.tones) {
            push(encode(&tones.packed()));
        }
        for effect in self.plan.drawn() {
            if effect.effect_type().shader.settings.is_some() {
                push(effect.uniform_bytes(&self.context));
            }
        }
        bytes
    }
}

/// On a view in the render world: the uniform buffer of its fused pass.
#[derive(Component)]
pub(crate) struct ViewFused {
    pub uniform: Buffer,
}

pub(crate) fn prepare_fused_pass(
    mut commands: Commands,
    views: Query<(Entity, &FusedRequest, Option<&ViewFused>)>,
    stale: Query<Entity, (With<ViewFused>, Without<FusedRequest>)>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
    mut blue_noise: ResMut<BlueNoise>,
) {
    let needs = |request: &FusedRequest| request.key.needs.contains(Needs::BLUE_NOISE);
    if views.iter().any(|(_, request, _)| needs(request)) {
        blue_noise.prepare(&device, &queue);
    }
    for (entity, request, fused) in &views {
        let bytes = request.uniform_bytes();
        let fits = fused.filter(|fused| fused.uniform.size() >= bytes.len() as u64 + SLACK);
        match fits {
            Some(fused) => queue.write_buffer(&fused.uniform, 0, &bytes),
            None => {
                let size = bytes.len() as u64 + SLACK;
                let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
                let uniform = buffer(&device, "comics_uniform", size, usage);
                queue.write_buffer(&uniform, 0, &bytes);
                commands.entity(entity).insert(ViewFused { uniform });
            }
        }
    }
    for entity in &stale {
        commands.entity(entity).remove::<ViewFused>();
    }
}
