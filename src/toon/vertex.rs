//! The vertex shader of materials that need more outputs than the engine's.

use bevy::{
    asset::{Handle, uuid_handle},
    mesh::{Mesh, MeshVertexBufferLayoutRef},
    render::render_resource::{SpecializedMeshPipelineError, VertexState},
    shader::{Shader, ShaderDefVal},
};

use super::{smooth::SMOOTHED_NORMAL, uniform::ToonKey};

/// `vertex.wgsl`.
pub(super) const VERTEX: Handle<Shader> = uuid_handle!("0d7b0a5c-31b5-4c6e-9a47-5f0b6d1f3c82");

/// The shader location of the smoothed normal. The engine uses those before it.
const SMOOTHED_LOCATION: u32 = 8;

/// Whether definitions are those of a prepass or a shadow map.
fn is_prepass(definitions: &[ShaderDefVal]) -> bool {
    definitions.contains(&"PREPASS_PIPELINE".into())
}

/// Whether a mesh has smoothed normals.
pub(super) fn is_smoothed(layout: &MeshVertexBufferLayoutRef) -> bool {
    layout.0.contains(SMOOTHED_NORMAL) && layout.0.contains(Mesh::ATTRIBUTE_NORMAL)
}

/// Takes the place of the engine's vertex shader in the main pass, if the material needs that.
pub(super) fn specialize(
    vertex: &mut VertexState,
    layout: &MeshVertexBufferLayoutRef,
    key: ToonKey,
) -> Result<(), SpecializedMeshPipelineError> {
    // Prepasses and shadow maps have shaders of their own.
    if is_prepass(&vertex.shader_defs) {
        return Ok(());
    }
    let smoothed = is_smoothed(layout) && key.reads_smoothed();
    let definitions = key.vertex_definitions(&vertex.shader_defs, smoothed);
    if definitions.is_empty() {
        return Ok(());
    }
    if smoothed {
        let attribute = SMOOTHED_NORMAL.at_shader_location(SMOOTHED_LOCATION);
        let more = layout.0.get_layout(&[attribute])?;
        for buffer in vertex.buffers.iter_mut().take(1) {
            buffer.attributes.extend(&more.attributes);
        }
    }
    vertex.shader = VERTEX;
    vertex.shader_defs.extend(definitions);
    Ok(())
}
