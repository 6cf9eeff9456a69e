//! The pipelines and phase items that draw transparent meshes into a view's own depth.

use bevy::{
    asset::load_embedded_asset,
    core_pipeline::prepass::NORMAL_PREPASS_FORMAT,
    ecs::system::SystemParam,
    material::{MaterialProperties, key::ErasedMaterialPipelineKey},
    mesh::MeshVertexBufferLayoutRef,
    pbr::{MeshPipelineKey, PrepassFragmentShader},
    platform::sync::Arc,
    prelude::*,
    render::{
        render_resource::{
            CompareFunction, FragmentState, PipelineCache, RenderPipelineDescriptor,
            SpecializedMeshPipeline, SpecializedMeshPipelineError, SpecializedMeshPipelines,
            TextureFormat,
        },
        sync_world::MainEntity,
    },
    shader::ShaderRef,
};

use crate::objects::{
    DepthWrites, ID_FORMAT, QueuedDepth,
    items::{DrawnMeshes, Missing, may_move_vertices},
    phase::{Bin, Layer},
    pipeline::{ObjectIdPipeline, in_prepass, reads_material},
};

/// The shaders of this pass.
#[derive(Resource)]
pub(in crate::objects) struct TransparentPipeline {
    shader: Handle<Shader>,
    /// The prepass shader of the engine's standard material: a material that has it has the
    /// bindings of the standard material.
    standard: Option<Handle<Shader>>,
}

pub(super) fn init_transparent_pipeline(mut commands: Commands, assets: Res<AssetServer>) {
    commands.insert_resource(TransparentPipeline {
        shader: load_embedded_asset!(assets.as_ref(), "transparent.wgsl"),
        standard: match <StandardMaterial as Material>::prepass_fragment_shader() {
            ShaderRef::Default => None,
            ShaderRef::Handle(handle) => Some(handle),
            ShaderRef::Path(path) => Some(assets.load(path)),
        },
    });
}

/// Selects the variant of the pass.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(in crate::objects) struct TransparentKey {
    material: ErasedMaterialPipelineKey,
    targets: QueuedDepth,
    /// Pixels below an alpha are left out.
    cutoff: bool,
}

pub(in crate::objects) struct TransparentSpecializer {
    ids: ObjectIdPipeline,
    properties: Arc<MaterialProperties>,
    shader: Handle<Shader>,
}

impl SpecializedMeshPipeline for TransparentSpecializer {
    type Key = TransparentKey;

    fn specialize(
        &self,
        key: Self::Key,
        layout: &MeshVertexBufferLayoutRef,
    ) -> Result<RenderPipelineDescriptor, SpecializedMeshPipelineError> {
        let prepass = self.ids.prepass_of(&self.properties);
        let mut descriptor = prepass.specialize(key.material, layout)?;
        descriptor.label = Some("comics_transparent_depth".into());
        descriptor.layout[1] = self.ids.layout.clone();
        // The material adds its own to those of the fragment shader.
        let defs = descriptor.fragment.take().map(|state| state.shader_defs);
        let mut shader_defs = defs.unwrap_or_else(|| descriptor.vertex.shader_defs.clone());
        if key.cutoff {
            shader_defs.push("ALPHA_CUTOFF".into());
        }
        descriptor.fragment = Some(FragmentState {
            shader: self.shader.clone(),
            shader_defs,
            entry_point: Some("surface".into()),
            targets: formats(key.targets)
                .map(|format| format.map(Into::into))
                .to_vec(),
        });
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.depth_write_enabled = Some(true);
            depth.depth_compare = Some(CompareFunction::GreaterEqual);
        }
        Ok(descriptor)
    }
}

/// Formats of the color targets; `None`: it is not written.
fn formats(targets: QueuedDepth) -> [Option<TextureFormat>; 2] {
    [
        targets.ids.then_some(ID_FORMAT),
        targets.normals.then_some(NORMAL_PREPASS_FORMAT),
    ]
}

/// Finds the bins of transparent meshes.
#[derive(SystemParam)]
pub(in crate::objects) struct TransparentItems<'w> {
    writes: Res<'w, DepthWrites>,
    drawn: DrawnMeshes<'w>,
    shared: Res<'w, ObjectIdPipeline>,
    own: Res<'w, TransparentPipeline>,
    pipelines: ResMut<'w, SpecializedMeshPipelines<TransparentSpecializer>>,
    cache: Res<'w, PipelineCache>,
}

impl TransparentItems<'_> {
    /// The bin of a mesh, and where the engine has uploaded it; it is not drawn if it does not ask
    /// for it, or if the depth prepass draws it.
    pub fn bin(
        &mut self,
        entity: MainEntity,
        view_key: MeshPipelineKey,
        targets: QueuedDepth,
    ) -> Result<(Bin, u32), Missing> {
        if !self.writes.0.contains(entity.id()) {
            return Err(Missing::NotDrawn);
        }
        let drawn = self.drawn.get(entity)?;
        let properties = drawn.properties;
        if in_prepass(properties) {
            return Err(Missing::NotDrawn);
        }
        let cutoff = self.own.has_cutoff(entity, properties);
        let cutoff = cutoff.ok_or(Missing::NotDrawn)?;
        if may_move_vertices(properties) {
            warn_once!(
                "the material of {entity:?} has `DepthWrite` and a vertex shader, but none for the \
                 prepass: if it moves vertices, lines are where the mesh would be without that; \
                 implement `prepass_vertex_shader`"
            );
        }
        self.bin_of(entity, view_key, targets, cutoff)
    }

    /// The same for a mesh of the prepass that fades.
    pub fn fading_bin(
        &mut self,
        entity: MainEntity,
        view_key: MeshPipelineKey,
        targets: QueuedDepth,
    ) -> Result<(Bin, u32), Missing> {
        let drawn = self.drawn.get(entity)?;
        if !in_prepass(drawn.properties) {
            return Err(Missing::NotDrawn);
        }
        let is_masked = matches!(drawn.properties.alpha_mode, AlphaMode::Mask(_));
        let cutoff = is_masked && self.own.has_cutoff(entity, drawn.properties) == Some(true);
        self.bin_of(entity, view_key, targets, cutoff)
    }

    /// The alpha below which the material of a mesh leaves pixels out.
    pub fn alpha_mask(&self, entity: MainEntity) -> Option<f32> {
        match self.drawn.get(entity).ok()?.properties.alpha_mode {
            AlphaMode::Mask(threshold) => Some(threshold),
            _ => None,
        }
    }

    fn bin_of(
        &mut self,
        entity: MainEntity,
        view_key: MeshPipelineKey,
        targets: QueuedDepth,
        cutoff: bool,
    ) -> Result<(Bin, u32), Missing> {
        let drawn = self.drawn.get(entity)?;
        let properties = drawn.properties;
        let uses_material = cutoff || reads_material(properties);
        let mut mesh_key = drawn.mesh_key(view_key, uses_material);
        mesh_key.set(MeshPipelineKey::NORMAL_PREPASS, targets.normals);
        mesh_key.set(MeshPipelineKey::MAY_DISCARD, cutoff);
        let key = TransparentKey {
            material: drawn.material_key(mesh_key),
            targets,
            cutoff,
        };
        let specializer = self.own.specializer(&self.shared, properties);
        let pipeline = (self.pipelines)
            .specialize(&self.cache, &specializer, key, &drawn.mesh.layout)
            .inspect_err(|error| error_once!("no depth of {entity:?}: {error}"))
            .map_err(|_| Missing::NotDrawn)?;
        let layer = (Layer::OwnDepth, uses_material);
        Ok(self.drawn.bin(entity, &drawn, pipeline, layer))
    }
}

impl TransparentPipeline {
    /// Whether the alpha of a material is known, because its bindings begin with those of the
    /// standard material; `None` if the material has no prepass.
    fn has_cutoff(&self, mesh: MainEntity, properties: &MaterialProperties) -> Option<bool> {
        if !properties.prepass_enabled {
            warn_once!("{mesh:?} writes no depth: its material has no prepass");
            return None;
        }
        let shader = properties.get_shader(PrepassFragmentShader);
        let known = shader.is_some() && shader == self.standard;
        if !known {
            warn_once!("all of {mesh:?} writes depth: the alpha of its material is unknown");
        }
        Some(known)
    }

    fn specializer(
        &self,
        ids: &ObjectIdPipeline,
        properties: &Arc<MaterialProperties>,
    ) -> TransparentSpecializer {
        TransparentSpecializer {
            ids: ids.clone(),
            properties: properties.clone(),
            shader: self.shader.clone(),
        }
    }
}
