//! Visible ranges that are taken from other views.

use bevy::render::{
    render_resource::{Buffer, BufferUsages, CommandEncoder, ShaderType},
    renderer::RenderDevice,
};

use super::{frame::DepthProjection, view::RANGE_SIZE};
use crate::gpu::buffer;

/// `Conversion` of `range_of.wgsl`: raw depth of a view from that of another one at the same
/// distance.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ConversionUniform {
    pub factor: f32,
    pub summand: f32,
    pub pole: f32,
    pub is_reciprocal: u32,
}

impl ConversionUniform {
    pub fn new(from: &DepthProjection, to: &DepthProjection) -> Self {
        let (factor, summand, pole) = from.conversion(to);
        Self {
            factor: factor as f32,
            summand: summand as f32,
            pole: pole.unwrap_or(0.0) as f32,
            is_reciprocal: pole.is_some().into(),
        }
    }
}

/// The range that a view takes from another one.
pub(crate) struct TakenRange {
    /// Keys of the other view's range.
    pub from: Buffer,
    pub conversion: ConversionUniform,
    /// The same in raw depth of this view.
    pub drawn: Buffer,
    /// Offset of `conversion` in bytes.
    pub offset: u32,
}

impl TakenRange {
    pub fn new(device: &RenderDevice, from: Buffer) -> Self {
        let copied = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let usage = BufferUsages::STORAGE | BufferUsages::UNIFORM | copied;
        Self {
            from,
            conversion: ConversionUniform::default(),
            drawn: buffer(device, "comics_range_of", RANGE_SIZE, usage),
            offset: 0,
        }
    }

    /// Takes the borders and the middle from the view's own range.
    pub fn keep_own(&self, encoder: &mut CommandEncoder, own: &Buffer) {
        let after_keys = 8;
        let size = RANGE_SIZE - after_keys;
        encoder.copy_buffer_to_buffer(own, after_keys, &self.drawn, after_keys, size);
    }
}
