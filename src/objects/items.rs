//! The pipelines and draw commands that draw the ids of objects.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::{
        entity::Entity,
        resource::Resource,
        system::{
            Commands, Res, ResMut, SystemParam, SystemParamItem,
            lifetimeless::{Read, SRes},
        },
    },
    log::{error_once, warn_once},
    material::{
        AlphaMode, MaterialProperties,
        key::{ErasedMaterialPipelineKey, ErasedMeshPipelineKey},
    },
    math::UVec4,
    mesh::{Mesh, MeshVertexBufferLayoutRef},
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
            DrawFunctionId, DrawFunctions, RenderCommand, RenderCommandResult, SetItemPipeline,
            TrackedRenderPass,
        },
        render_resource::{
            BindGroup, BindGroupLayoutDescriptor, BindGroupLayoutEntries, ColorTargetState,
            ColorWrites, CompareFunction, FragmentState, PipelineCache, RenderPipelineDescriptor,
            ShaderStages, SpecializedMeshPipeline, SpecializedMeshPipelineError,
            SpecializedMeshPipelines, StorageBuffer, TextureFormat,
            binding_types::{storage_buffer_read_only, uniform_buffer},
        },
        renderer::RenderAdapter,
        sync_world::MainEntity,
    },
    shader::{Shader, ShaderDefVal},
};

use super::{
    ID_FORMAT, Pressure, WIDTH_FORMAT,
    depth_test::{DepthTest, TolerantIds, with_prepass_depth},
    layer::MarkSpecializer,
    lightmaps::MeshLightmaps,
    line_widths::{WideMeshes, WidthBindings},
    phase::{Layer, ObjectIdItem},
    sections::{SectionBuffer, SectionTables},
    shading::has_sample_shading,
};

/// The parts that all pipelines of this pass have in common.
#[derive(Resource)]
pub(super) struct ObjectIdPipeline {
    pub prepass: PrepassPipeline,
    pub layout: BindGroupLayoutDescriptor,
    /// The layout if the widths of lines are drawn too.
    pub with_widths: BindGroupLayoutDescriptor,
    /// Without and with sections.
    shaders: [Handle<Shader>; 2],
    shades_samples: bool,
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
    commands.insert_resource(ObjectIdPipeline {
        shades_samples: has_sample_shading(&adapter),
        prepass: prepass.clone(),
        layout: BindGroupLayoutDescriptor::new("comics_objects", &entries[..2]),
        with_widths: BindGroupLayoutDescriptor::new("comics_objects_with_widths", &entries),
        shaders: [
            load_embedded_asset!(assets.as_ref(), "ids.wgsl"),
            load_embedded_asset!(assets.as_ref(), "sections.wgsl"),
        ],
    });
}

/// What is drawn of a mesh besides its id.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct IdVariant {
    /// The mesh is divided into sections.
    sections: bool,
    /// The widths of lines are drawn too.
    widths: bool,
    /// They are those of the mesh's vertices.
    vertex_widths: bool,
    /// Depth is compared with a tolerance.
    tolerant: bool,
}

impl IdVariant {
    fn defs(self) -> impl Iterator<Item = ShaderDefVal> {
        [
            (self.widths, "LINE_WIDTHS"),
            (self.vertex_widths, "VERTEX_WIDTHS"),
            (self.tolerant, "TOLERANT"),
        ]
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, name)| name.into())
    }
}

impl ObjectIdPipeline {
    fn specializer(
        &self,
        properties: &Arc<MaterialProperties>,
        variant: IdVariant,
    ) -> ObjectIdSpecializer {
        let layout = if variant.widths {
            &self.with_widths
        } else {
            &self.layout
        };
        ObjectIdSpecializer {
            prepass: PrepassPipelineSpecializer {
                pipeline: self.prepass.clone(),
                properties: properties.clone(),
            },
            layout: layout.clone(),
            shader: self.shaders[usize::from(variant.sections)].clone(),
            shades_samples: self.shades_samples,
        }
    }
}

pub(super) struct ObjectIdSpecializer {
    prepass: PrepassPipelineSpecializer,
    layout: BindGroupLayoutDescriptor,
    shader: Handle<Shader>,
    shades_samples: bool,
}

impl SpecializedMeshPipeline for ObjectIdSpecializer {
    type Key = (ErasedMaterialPipelineKey, IdVariant);

    fn specialize(
        &self,
        (key, variant): Self::Key,
        layout: &MeshVertexBufferLayoutRef,
    ) -> Result<RenderPipelineDescriptor, SpecializedMeshPipelineError> {
        let mut descriptor = self.prepass.specialize(key, layout)?;
        descriptor.label = Some("comics_object_ids".into());
        let multisampled = descriptor.multisample.count > 1;
        descriptor.layout[1] = if variant.tolerant {
            with_prepass_depth(&self.layout, multisampled)
        } else {
            self.layout.clone()
        };
        let target = |format| {
            Some(ColorTargetState {
                format,
                blend: None,
                write_mask: ColorWrites::ALL,
            })
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
            if self.shades_samples {
                shader_defs.push("SAMPLE_SHADING".into());
            }
        }
        descriptor.fragment = Some(FragmentState {
            shader: self.shader.clone(),
            shader_defs,
            entry_point: Some("object_id".into()),
            targets: formats.iter().copied().map(target).collect(),
        });
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.depth_write_enabled = Some(variant.tolerant);
            depth.depth_compare = Some(if variant.tolerant {
                CompareFunction::GreaterEqual
            } else {
                CompareFunction::Equal
            });
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

impl<const I: usize> RenderCommand<ObjectIdItem> for SetObjectTable<I> {
    type Param = SRes<ObjectTable>;
    type ViewQuery = (Option<Read<WidthBindings>>, Option<Read<TolerantIds>>);
    type ItemQuery = ();

    fn render<'w>(
        item: &ObjectIdItem,
        (widths, tolerant): (Option<&'w WidthBindings>, Option<&'w TolerantIds>),
        _entity: Option<()>,
        table: SystemParamItem<'w, '_, Self::Param>,
        pass: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        // Only the pipelines of ids draw widths, and compare depth with a tolerance.
        let own = tolerant.map(|tolerant| &tolerant.bind_group);
        let own = own.or(widths.map(|widths| &widths.0));
        let bind_group = match own.filter(|_| item.layer == Layer::Prepass) {
            Some(own) => own,
            None => &table.into_inner().bind_group,
        };
        let Some(bind_group) = bind_group else {
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

/// The draw command of an object; `uses_material`: one that binds the material.
pub(super) fn draw_function(
    functions: &DrawFunctions<ObjectIdItem>,
    uses_material: bool,
) -> DrawFunctionId {
    let functions = functions.read();
    if uses_material {
        functions.id::<DrawIdWithMaterial>()
    } else {
        functions.id::<DrawId>()
    }
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

/// What is drawn of an object.
#[derive(Clone, Copy, Debug)]
pub(super) enum Drawn {
    /// Its id, and perhaps the widths of its lines.
    Ids { widths: bool },
    /// Its depth and id in the layer of marked objects.
    Marked,
}

/// Makes the phase items of objects.
#[derive(SystemParam)]
pub(super) struct IdItems<'w> {
    draw_functions: Res<'w, DrawFunctions<ObjectIdItem>>,
    shared: Res<'w, ObjectIdPipeline>,
    pipelines: ResMut<'w, SpecializedMeshPipelines<ObjectIdSpecializer>>,
    marked: ResMut<'w, SpecializedMeshPipelines<MarkSpecializer>>,
    wide: Res<'w, WideMeshes>,
    test: Res<'w, DepthTest>,
    sections: (Res<'w, SectionBuffer>, Res<'w, SectionTables>),
    cache: Res<'w, PipelineCache>,
    meshes: Res<'w, RenderAssets<RenderMesh>>,
    instances: Res<'w, RenderMeshInstances>,
    lightmaps: MeshLightmaps<'w>,
    materials: Res<'w, ErasedRenderAssets<PreparedMaterial>>,
    material_instances: Res<'w, RenderMaterialInstances>,
}

impl IdItems<'_> {
    fn variant(&self, entity: Entity, mesh: &RenderMesh, widths: bool) -> IdVariant {
        let (buffer, tables) = &self.sections;
        let wanted = widths && self.wide.contains(entity);
        let has_colors = mesh.layout.0.contains(Mesh::ATTRIBUTE_COLOR);
        if wanted && !has_colors {
            warn_once!("`LineWidths` does nothing on {entity}: its mesh has no vertex colours");
        }
        IdVariant {
            sections: buffer.start(tables, entity).is_some(),
            widths,
            vertex_widths: wanted && has_colors,
            tolerant: self.test.tolerant(),
        }
    }

    /// The phase item of an object; `None` if the depth prepass does not draw it.
    pub fn item(
        &mut self,
        object: (Entity, MainEntity),
        view_key: MeshPipelineKey,
        drawn: Drawn,
    ) -> Option<ObjectIdItem> {
        let instance = self.instances.render_mesh_queue_data(object.1)?;
        let mesh = self.meshes.get(instance.mesh_asset_id())?;
        let material_instance = self.material_instances.instances.get(&object.1)?;
        let material = self.materials.get(material_instance.asset_id)?;
        if !in_prepass(&material.properties) {
            return None;
        }
        let mut mesh_key = view_key | MeshPipelineKey::from_bits_retain(mesh.key_bits.bits());
        mesh_key.set(MeshPipelineKey::LIGHTMAPPED, self.lightmaps.has(object.1));
        let uses_material = reads_material(&material.properties);
        mesh_key.set(MeshPipelineKey::PREPASS_READS_MATERIAL, uses_material);
        let key = ErasedMaterialPipelineKey {
            type_id: material_instance.asset_id.type_id(),
            mesh_key: ErasedMeshPipelineKey::new(mesh_key),
            material_key: material.properties.material_key.clone(),
        };
        let (variant, layer) = match drawn {
            Drawn::Marked => (IdVariant::default(), Layer::Marked),
            Drawn::Ids { widths } => {
                let variant = self.variant(object.1.id(), mesh, widths);
                (variant, Layer::Prepass)
            }
        };
        let specializer = self.shared.specializer(&material.properties, variant);
        let (cache, layout) = (&self.cache, &mesh.layout);
        if layer == Layer::Prepass && self.test.compiles_ahead() {
            let tolerant = IdVariant {
                tolerant: true,
                ..variant
            };
            let key = (key.clone(), tolerant);
            let pipeline = self.pipelines.specialize(cache, &specializer, key, layout);
            let compiled = pipeline.is_ok_and(|id| cache.get_render_pipeline(id).is_some());
            self.test.note_ahead(compiled);
        }
        let key = (key, variant);
        let pipeline = match layer {
            Layer::Marked => {
                let specializer = MarkSpecializer(specializer);
                self.marked.specialize(cache, &specializer, key, layout)
            }
            _ => self.pipelines.specialize(cache, &specializer, key, layout),
        };
        let pipeline = pipeline
            .inspect_err(|error| error_once!("no object id for {:?}: {error}", object.1))
            .ok()?;
        let draw_function = draw_function(&self.draw_functions, uses_material);
        let drawn = (mesh.indexed(), layer);
        Some(ObjectIdItem::new(object, pipeline, draw_function, drawn))
    }
}
