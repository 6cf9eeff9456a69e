//! The pipelines that draw the ids of objects.

use bevy::{
    asset::load_embedded_asset,
    material::{MaterialProperties, key::ErasedMaterialPipelineKey},
    mesh::MeshVertexBufferLayoutRef,
    pbr::{
        PrepassFragmentShader, PrepassPipeline, PrepassPipelineSpecializer, PrepassVertexShader,
    },
    platform::sync::Arc,
    prelude::*,
    render::{
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntries, CompareFunction, DownlevelFlags,
            FragmentState, RenderPipelineDescriptor, ShaderStages, SpecializedMeshPipeline,
            SpecializedMeshPipelineError, TextureFormat,
            binding_types::{storage_buffer_read_only, uniform_buffer},
        },
        renderer::RenderAdapter,
    },
    shader::ShaderDefVal,
};

use super::{ID_FORMAT, Pressure, WIDTH_FORMAT};
use crate::gpu::{UNFILTERABLE, definitions, sampled};

/// What all pipelines of this pass have in common.
#[derive(Resource, Deref, Clone)]
pub(super) struct ObjectIdPipeline(Arc<IdParts>);

pub(super) struct IdParts {
    prepass: PrepassPipeline,
    pub layout: BindGroupLayoutDescriptor,
    /// The layout if the widths of lines are drawn too.
    pub with_widths: BindGroupLayoutDescriptor,
    /// Without and with sections.
    shaders: [Handle<Shader>; 2],
    shades_samples: bool,
}

/// Whether the shaders of an adapter can run for each sample of a pixel: then `SAMPLE_SHADING` is
/// defined where a shader asks for the number of its sample. Vulkan drivers need not have it; where
/// it is missing, the first sample of a pixel stands for all.
pub(super) fn has_sample_shading(adapter: &RenderAdapter) -> bool {
    let flags = adapter.get_downlevel_capabilities().flags;
    flags.contains(DownlevelFlags::MULTISAMPLED_SHADING)
}

pub(super) fn init_object_id_pipeline(
    mut commands: Commands,
    prepass: Res<PrepassPipeline>,
    assets: Res<AssetServer>,
    adapter: Res<RenderAdapter>,
) {
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::FRAGMENT,
        (
            storage_buffer_read_only::<Vec<UVec4>>(false),
            storage_buffer_read_only::<Vec<u32>>(false),
            uniform_buffer::<Pressure>(false),
        ),
    );
    commands.insert_resource(ObjectIdPipeline(Arc::new(IdParts {
        shades_samples: has_sample_shading(&adapter),
        prepass: prepass.clone(),
        layout: BindGroupLayoutDescriptor::new("comics_objects", &entries[..2]),
        with_widths: BindGroupLayoutDescriptor::new("comics_objects_with_widths", &entries),
        shaders: [
            load_embedded_asset!(assets.as_ref(), "ids.wgsl"),
            load_embedded_asset!(assets.as_ref(), "sections.wgsl"),
        ],
    })));
}

pub(super) fn reads_material(properties: &MaterialProperties) -> bool {
    properties.get_shader(PrepassVertexShader).is_some()
        || properties.get_shader(PrepassFragmentShader).is_some()
}

/// Whether the depth prepass draws meshes of this material.
pub(super) fn in_prepass(properties: &MaterialProperties) -> bool {
    properties.prepass_enabled
        && !properties.reads_view_transmission_texture
        && matches!(
            properties.alpha_mode,
            AlphaMode::Opaque | AlphaMode::AlphaToCoverage | AlphaMode::Mask(_)
        )
}

/// Whether only parts of the triangles of meshes of this material are seen.
pub(super) fn is_masked(properties: &MaterialProperties) -> bool {
    matches!(
        properties.alpha_mode,
        AlphaMode::Mask(_) | AlphaMode::AlphaToCoverage
    )
}

/// A layout of the pass of ids, with the depth of the prepass.
pub(super) fn with_prepass_depth(
    layout: &BindGroupLayoutDescriptor,
    multisampled: bool,
) -> BindGroupLayoutDescriptor {
    let depth = sampled(multisampled, UNFILTERABLE);
    let mut layout = layout.clone();
    layout.entries.push(depth.build(3, ShaderStages::FRAGMENT));
    layout
}

/// What is drawn of a mesh besides its id.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct IdVariant {
    /// The mesh is divided into sections.
    pub sections: bool,
    /// The widths of lines are drawn too.
    pub widths: bool,
    /// They are those of the mesh's vertices.
    pub vertex_widths: bool,
    /// Depth is compared with a tolerance.
    pub tolerant: bool,
    /// The mesh is drawn into the layer of highlighted objects, as if nothing else was there.
    pub highlighted: bool,
}

impl IdVariant {
    fn defs(self) -> impl Iterator<Item = ShaderDefVal> {
        definitions([
            (self.widths, "LINE_WIDTHS"),
            (self.vertex_widths, "VERTEX_WIDTHS"),
            (self.tolerant, "TOLERANT"),
        ])
    }
}

impl ObjectIdPipeline {
    pub fn specializer(&self, properties: &Arc<MaterialProperties>) -> ObjectIdSpecializer {
        ObjectIdSpecializer {
            ids: self.clone(),
            properties: properties.clone(),
        }
    }
}

impl IdParts {
    /// The engine's pipeline of the prepass.
    pub fn prepass_of(&self, properties: &Arc<MaterialProperties>) -> PrepassPipelineSpecializer {
        PrepassPipelineSpecializer {
            pipeline: self.prepass.clone(),
            properties: properties.clone(),
        }
    }
}

/// Made for every mesh, so it shares what only a new pipeline needs.
pub(super) struct ObjectIdSpecializer {
    ids: ObjectIdPipeline,
    properties: Arc<MaterialProperties>,
}

impl SpecializedMeshPipeline for ObjectIdSpecializer {
    type Key = (ErasedMaterialPipelineKey, IdVariant);

    fn specialize(
        &self,
        (key, variant): Self::Key,
        layout: &MeshVertexBufferLayoutRef,
    ) -> Result<RenderPipelineDescriptor, SpecializedMeshPipelineError> {
        let bindings = if variant.widths {
            &self.ids.with_widths
        } else {
            &self.ids.layout
        };
        let mut descriptor = (self.ids.prepass_of(&self.properties)).specialize(key, layout)?;
        let label = if variant.highlighted {
            "comics_highlighted_objects"
        } else {
            "comics_object_ids"
        };
        descriptor.label = Some(label.into());
        let multisampled = descriptor.multisample.count > 1;
        descriptor.layout[1] = if variant.tolerant {
            with_prepass_depth(bindings, multisampled)
        } else {
            bindings.clone()
        };
        let formats: &[TextureFormat] = if variant.widths {
            &[ID_FORMAT, WIDTH_FORMAT]
        } else {
            &[ID_FORMAT]
        };
        // The engine's modules of meshes and views depend on the definitions.
        let engine = variant
            .widths
            .then(|| descriptor.vertex.shader_defs.clone());
        let mut shader_defs: Vec<_> = engine.into_iter().flatten().chain(variant.defs()).collect();
        if variant.tolerant && multisampled {
            shader_defs.push("TOLERANT_MULTISAMPLED".into());
            if self.ids.shades_samples {
                shader_defs.push("SAMPLE_SHADING".into());
            }
        }
        descriptor.fragment = Some(FragmentState {
            shader: self.ids.shaders[usize::from(variant.sections)].clone(),
            shader_defs,
            entry_point: Some("object_id".into()),
            targets: (formats.iter())
                .map(|format| Some((*format).into()))
                .collect(),
        });
        if let Some(depth) = &mut descriptor.depth_stencil {
            let has_own_depth = variant.tolerant || variant.highlighted;
            depth.depth_write_enabled = Some(has_own_depth);
            depth.depth_compare = Some(if has_own_depth {
                CompareFunction::GreaterEqual
            } else {
                CompareFunction::Equal
            });
        }
        Ok(descriptor)
    }
}
