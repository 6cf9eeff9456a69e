//! The material of the ribbons.

use bevy::{
    mesh::MeshVertexBufferLayoutRef,
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::render_resource::{
        AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
    },
    shader::ShaderRef,
};

/// Ink: unlit, in no prepass, without shadows. The vertex shader makes ribbons of paths.
#[derive(Asset, AsBindGroup, TypePath, Clone, Debug, PartialEq)]
pub(super) struct MotionInk {
    #[uniform(0)]
    pub color: LinearRgba,
    /// Half of the widest width, in physical pixels.
    #[uniform(0)]
    pub half_width: f32,
}

const SHADER: &str = "embedded://bevy_comics/motion_lines/ink.wgsl";

impl Material for MotionInk {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::Blend
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        // A ribbon that turns back shows its other side.
        descriptor.primitive.cull_mode = None;
        Ok(())
    }
}
