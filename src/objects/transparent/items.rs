//! The pipelines and phase items that draw transparent meshes into a view's own depth.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::prepass::NORMAL_PREPASS_FORMAT,
    ecs::{
        entity::Entity,
        resource::Resource,
        system::{Commands, Res, ResMut, SystemParam},
    },
    log::{error_once, warn_once},
    material::{
        MaterialProperties,
        key::{ErasedMaterialPipelineKey, ErasedMeshPipelineKey},
    },
    mesh::MeshVertexBufferLayoutRef,
    pbr::{
        Material, MeshPipelineKey, PreparedMaterial, PrepassFragmentShader,
        PrepassPipelineSpecializer, RenderMaterialInstances, RenderMeshInstances, StandardMaterial,
    },
    platform::sync::Arc,
    render::{
        erased_render_asset::ErasedRenderAssets,
        mesh::RenderMesh,
        render_asset::RenderAssets,
        render_phase::DrawFunctions,
        render_resource::{
            BindGroupLayoutDescriptor, CompareFunction, FragmentState, PipelineCache,
            RenderPipelineDescriptor, SpecializedMeshPipeline, SpecializedMeshPipelineError,
            SpecializedMeshPipelines, TextureFormat,
        },
        sync_world::MainEntity,
    },
    shader::{Shader, ShaderRef},
};

use crate::objects::{
    ID_FORMAT, QueuedDepth,
    items::draw_function,
    lightmaps::MeshLightmaps,
    phase::{Layer, ObjectIdItem},
    pipeline::{ObjectIdPipeline, in_prepass, reads_material},
    table::DepthWrites,
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
    prepass: PrepassPipelineSpecializer,
    /// The pipeline of object ids, for its layout.
    layout: BindGroupLayoutDescriptor,
    shader: Handle<Shader>,
}

impl SpecializedMeshPipeline for TransparentSpecializer {
    type Key = TransparentKey;

    fn specialize(
        &self,
        key: Self::Key,
        layout: &MeshVertexBufferLayoutRef,
    ) -> Result<RenderPipelineDescriptor, SpecializedMeshPipelineError> {
        let mut descriptor = self.prepass.specialize(key.material, layout)?;
        descriptor.label = Some("comics_transparent_depth".into());
        descriptor.layout[1] = self.layout.clone();
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

/// Formats of the colour targets; `None`: it is not written.
fn formats(targets: QueuedDepth) -> [Option<TextureFormat>; 2] {
    [
        targets.ids.then_some(ID_FORMAT),
        targets.normals.then_some(NORMAL_PREPASS_FORMAT),
    ]
}

/// Makes the phase items of transparent meshes.
#[derive(SystemParam)]
pub(in crate::objects) struct TransparentItems<'w> {
    writes: Res<'w, DepthWrites>,
    draw_functions: Res<'w, DrawFunctions<ObjectIdItem>>,
    shared: Res<'w, ObjectIdPipeline>,
    own: Res<'w, TransparentPipeline>,
    pipelines: ResMut<'w, SpecializedMeshPipelines<TransparentSpecializer>>,
    cache: Res<'w, PipelineCache>,
    meshes: Res<'w, RenderAssets<RenderMesh>>,
    instances: Res<'w, RenderMeshInstances>,
    lightmaps: MeshLightmaps<'w>,
    materials: Res<'w, ErasedRenderAssets<PreparedMaterial>>,
    material_instances: Res<'w, RenderMaterialInstances>,
}

impl TransparentItems<'_> {
    /// The phase item of a mesh; `None` if it does not ask for it, or if the depth prepass
    /// draws it.
    pub fn item(
        &mut self,
        object: (Entity, MainEntity),
        view_key: MeshPipelineKey,
        targets: QueuedDepth,
    ) -> Option<ObjectIdItem> {
        if !self.writes.cutoffs.contains_key(&object.1.id()) {
            return None;
        }
        let instance = self.instances.render_mesh_queue_data(object.1)?;
        let mesh = self.meshes.get(instance.mesh_asset_id())?;
        let asset = self.material_instances.instances.get(&object.1)?.asset_id;
        let properties = &self.materials.get(asset)?.properties;
        if in_prepass(properties) {
            return None;
        }
        let cutoff = self.own.has_cutoff(object.1, properties)?;
        let mut mesh_key = view_key | MeshPipelineKey::from_bits_retain(mesh.key_bits.bits());
        mesh_key.set(MeshPipelineKey::NORMAL_PREPASS, targets.normals);
        mesh_key.set(MeshPipelineKey::LIGHTMAPPED, self.lightmaps.has(object.1));
        let uses_material = cutoff || reads_material(properties);
        mesh_key.set(MeshPipelineKey::PREPASS_READS_MATERIAL, uses_material);
        mesh_key.set(MeshPipelineKey::MAY_DISCARD, cutoff);
        let key = TransparentKey {
            material: ErasedMaterialPipelineKey {
                type_id: asset.type_id(),
                mesh_key: ErasedMeshPipelineKey::new(mesh_key),
                material_key: properties.material_key.clone(),
            },
            targets,
            cutoff,
        };
        let specializer = self.own.specializer(&self.shared, properties);
        let pipeline = (self.pipelines)
            .specialize(&self.cache, &specializer, key, &mesh.layout)
            .inspect_err(|error| error_once!("no depth of {:?}: {error}", object.1))
            .ok()?;
        let draw_function = draw_function(&self.draw_functions, uses_material);
        let drawn = (mesh.indexed(), Layer::OwnDepth);
        Some(ObjectIdItem::new(object, pipeline, draw_function, drawn))
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
            prepass: PrepassPipelineSpecializer {
                pipeline: ids.prepass.clone(),
                properties: properties.clone(),
            },
            layout: ids.layout.clone(),
            shader: self.shader.clone(),
        }
    }
}
