//! The pipelines and draw commands that draw the ids of objects.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::{
        entity::Entity,
        resource::Resource,
        system::{Commands, Res, ResMut, SystemParam, SystemParamItem, lifetimeless::SRes},
    },
    log::error_once,
    material::{
        AlphaMode, MaterialProperties,
        key::{ErasedMaterialPipelineKey, ErasedMeshPipelineKey},
    },
    math::UVec4,
    mesh::MeshVertexBufferLayoutRef,
    pbr::{
        DrawMesh, MeshPipelineKey, PreparedMaterial, PrepassFragmentShader, PrepassPipeline,
        PrepassPipelineSpecializer, PrepassVertexShader, RenderMaterialInstances,
        RenderMeshInstances, SetMaterialBindGroup, SetMeshBindGroup,
        SetPrepassEmptyMaterialBindGroup, SetPrepassViewBindGroup,
    },
    platform::sync::Arc,
    render::{
        erased_render_asset::ErasedRenderAssets,
        mesh::RenderMesh,
        render_asset::RenderAssets,
        render_phase::{
            DrawFunctions, PhaseItem, PhaseItemExtraIndex, RenderCommand, RenderCommandResult,
            SetItemPipeline, TrackedRenderPass,
        },
        render_resource::{
            BindGroup, BindGroupLayoutDescriptor, BindGroupLayoutEntries, ColorTargetState,
            ColorWrites, CompareFunction, FragmentState, PipelineCache, RenderPipelineDescriptor,
            ShaderStages, SpecializedMeshPipeline, SpecializedMeshPipelineError,
            SpecializedMeshPipelines, StorageBuffer, binding_types::storage_buffer_read_only,
        },
        sync_world::MainEntity,
    },
    shader::Shader,
};

use super::{
    ID_FORMAT,
    layer::MarkSpecializer,
    phase::{Layer, ObjectIdItem},
    sections::{SectionBuffer, SectionTables},
};

/// The parts that all pipelines of this pass have in common.
#[derive(Resource)]
pub(super) struct ObjectIdPipeline {
    pub prepass: PrepassPipeline,
    pub layout: BindGroupLayoutDescriptor,
    /// Without and with sections.
    shaders: [Handle<Shader>; 2],
}

pub(super) fn init_object_id_pipeline(
    mut commands: Commands,
    prepass: Res<PrepassPipeline>,
    assets: Res<AssetServer>,
) {
    commands.insert_resource(ObjectIdPipeline {
        prepass: prepass.clone(),
        layout: BindGroupLayoutDescriptor::new(
            "comics_objects",
            &BindGroupLayoutEntries::sequential(
                ShaderStages::FRAGMENT,
                (
                    storage_buffer_read_only::<Vec<UVec4>>(false),
                    storage_buffer_read_only::<Vec<u32>>(false),
                ),
            ),
        ),
        shaders: [
            load_embedded_asset!(assets.as_ref(), "ids.wgsl"),
            load_embedded_asset!(assets.as_ref(), "sections.wgsl"),
        ],
    });
}

impl ObjectIdPipeline {
    fn specializer<const SECTIONS: bool>(
        &self,
        properties: &Arc<MaterialProperties>,
    ) -> ObjectIdSpecializer<SECTIONS> {
        ObjectIdSpecializer {
            prepass: PrepassPipelineSpecializer {
                pipeline: self.prepass.clone(),
                properties: properties.clone(),
            },
            layout: self.layout.clone(),
            shader: self.shaders[usize::from(SECTIONS)].clone(),
        }
    }
}

/// `SECTIONS`: for meshes that are divided into sections.
pub(super) struct ObjectIdSpecializer<const SECTIONS: bool> {
    prepass: PrepassPipelineSpecializer,
    layout: BindGroupLayoutDescriptor,
    shader: Handle<Shader>,
}

impl<const SECTIONS: bool> SpecializedMeshPipeline for ObjectIdSpecializer<SECTIONS> {
    type Key = ErasedMaterialPipelineKey;

    fn specialize(
        &self,
        key: Self::Key,
        layout: &MeshVertexBufferLayoutRef,
    ) -> Result<RenderPipelineDescriptor, SpecializedMeshPipelineError> {
        let mut descriptor = self.prepass.specialize(key, layout)?;
        descriptor.label = Some("comics_object_ids".into());
        descriptor.layout[1] = self.layout.clone();
        descriptor.fragment = Some(FragmentState {
            shader: self.shader.clone(),
            entry_point: Some("object_id".into()),
            targets: vec![Some(ColorTargetState {
                format: ID_FORMAT,
                blend: None,
                write_mask: ColorWrites::ALL,
            })],
            ..Default::default()
        });
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.depth_write_enabled = Some(false);
            depth.depth_compare = Some(CompareFunction::Equal);
        }
        Ok(descriptor)
    }
}

/// Id, style slot, first word of the sections and bits of the least alpha of each object,
/// indexed by the instance index of its phase item.
#[derive(Resource, Default)]
pub(super) struct ObjectTable {
    pub objects: StorageBuffer<Vec<UVec4>>,
    pub bind_group: Option<BindGroup>,
}

pub(super) struct SetObjectTable<const I: usize>;

impl<P: PhaseItem, const I: usize> RenderCommand<P> for SetObjectTable<I> {
    type Param = SRes<ObjectTable>;
    type ViewQuery = ();
    type ItemQuery = ();

    fn render<'w>(
        _item: &P,
        _view: (),
        _entity: Option<()>,
        table: SystemParamItem<'w, '_, Self::Param>,
        pass: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        let Some(bind_group) = &table.into_inner().bind_group else {
            return RenderCommandResult::Skip;
        };
        pass.set_bind_group(I, bind_group, &[]);
        RenderCommandResult::Success
    }
}

/// Draws the id of an object whose material has no prepass shader.
pub(super) type DrawId = (
    SetItemPipeline,
    SetPrepassViewBindGroup<0>,
    SetObjectTable<1>,
    SetMeshBindGroup<2>,
    SetPrepassEmptyMaterialBindGroup<3>,
    DrawMesh,
);

/// As [`DrawId`], for materials with a prepass shader, which may read the material's
/// bindings.
pub(super) type DrawIdWithMaterial = (
    SetItemPipeline,
    SetPrepassViewBindGroup<0>,
    SetObjectTable<1>,
    SetMeshBindGroup<2>,
    SetMaterialBindGroup<3>,
    DrawMesh,
);

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

/// Makes the phase items of objects.
#[derive(SystemParam)]
pub(super) struct IdItems<'w> {
    draw_functions: Res<'w, DrawFunctions<ObjectIdItem>>,
    shared: Res<'w, ObjectIdPipeline>,
    pipelines: ResMut<'w, SpecializedMeshPipelines<ObjectIdSpecializer<false>>>,
    marked: ResMut<'w, SpecializedMeshPipelines<MarkSpecializer>>,
    with_sections: ResMut<'w, SpecializedMeshPipelines<ObjectIdSpecializer<true>>>,
    sections: (Res<'w, SectionBuffer>, Res<'w, SectionTables>),
    cache: Res<'w, PipelineCache>,
    meshes: Res<'w, RenderAssets<RenderMesh>>,
    instances: Res<'w, RenderMeshInstances>,
    materials: Res<'w, ErasedRenderAssets<PreparedMaterial>>,
    material_instances: Res<'w, RenderMaterialInstances>,
}

impl IdItems<'_> {
    /// The phase item of an object; `None` if the depth prepass does not draw it. `marked`: in
    /// the layer of marked objects.
    pub fn item(
        &mut self,
        object: (Entity, MainEntity),
        view_key: MeshPipelineKey,
        marked: bool,
    ) -> Option<ObjectIdItem> {
        let instance = self.instances.render_mesh_queue_data(object.1)?;
        let mesh = self.meshes.get(instance.mesh_asset_id())?;
        let material_instance = self.material_instances.instances.get(&object.1)?;
        let material = self.materials.get(material_instance.asset_id)?;
        if !in_prepass(&material.properties) {
            return None;
        }
        let mut mesh_key = view_key | MeshPipelineKey::from_bits_retain(mesh.key_bits.bits());
        if instance.lightmap_slab_index().is_some() {
            mesh_key |= MeshPipelineKey::LIGHTMAPPED;
        }
        let uses_material = reads_material(&material.properties);
        if uses_material {
            mesh_key |= MeshPipelineKey::PREPASS_READS_MATERIAL;
        }
        let key = ErasedMaterialPipelineKey {
            type_id: material_instance.asset_id.type_id(),
            mesh_key: ErasedMeshPipelineKey::new(mesh_key),
            material_key: material.properties.material_key.clone(),
        };
        let (buffer, tables) = &self.sections;
        let cache = &self.cache;
        let pipeline = if marked {
            let specializer = MarkSpecializer(self.shared.specializer(&material.properties));
            let pipelines = &mut self.marked;
            pipelines.specialize(cache, &specializer, key, &mesh.layout)
        } else if buffer.start(tables, object.1.id()).is_some() {
            let specializer = self.shared.specializer(&material.properties);
            let pipelines = &mut self.with_sections;
            pipelines.specialize(cache, &specializer, key, &mesh.layout)
        } else {
            let specializer = self.shared.specializer(&material.properties);
            let pipelines = &mut self.pipelines;
            pipelines.specialize(cache, &specializer, key, &mesh.layout)
        };
        let pipeline = pipeline
            .inspect_err(|error| error_once!("no object id for {:?}: {error}", object.1))
            .ok()?;
        let functions = self.draw_functions.read();
        Some(ObjectIdItem {
            entity: object,
            pipeline,
            draw_function: if uses_material {
                functions.id::<DrawIdWithMaterial>()
            } else {
                functions.id::<DrawId>()
            },
            batch_range: 0..1,
            extra_index: PhaseItemExtraIndex::None,
            indexed: mesh.indexed(),
            layer: if marked {
                Layer::Marked
            } else {
                Layer::Prepass
            },
        })
    }
}
