//! The draw commands of object ids, and the draw calls that meshes are part of.

use bevy::{
    asset::UntypedAssetId,
    ecs::system::{
        SystemParam, SystemParamItem,
        lifetimeless::{Read, SRes},
    },
    material::{
        MaterialProperties,
        key::{ErasedMaterialPipelineKey, ErasedMeshPipelineKey},
    },
    mesh::BaseMeshPipelineKey,
    pbr::{
        DrawMesh, MaterialVertexShader, MeshPipelineKey, PreparedMaterial, PrepassVertexShader,
        RenderMaterialInstances, RenderMeshInstances, RenderMeshQueueData, SetMaterialBindGroup,
        SetMeshBindGroup, SetPrepassEmptyMaterialBindGroup, SetPrepassViewBindGroup, SkinUniforms,
    },
    platform::sync::Arc,
    prelude::*,
    render::{
        erased_render_asset::ErasedRenderAssets,
        mesh::RenderMesh,
        render_asset::RenderAssets,
        render_phase::{
            DrawFunctionId, DrawFunctions, RenderCommand, RenderCommandResult, SetItemPipeline,
            TrackedRenderPass,
        },
        render_resource::{CachedRenderPipelineId, PipelineCache, SpecializedMeshPipelines},
        sync_world::MainEntity,
        view::ExtractedView,
    },
};

use super::{
    backdrop::Backdrops,
    bindings::IdBindings,
    depth_test::DepthTest,
    lightmaps::MeshLightmaps,
    line_widths::WideMeshes,
    phase::{Bin, Layer, ObjectIdItem, ObjectIdPhase, ObjectIdPhases},
    pipeline::{
        IdVariant, ObjectIdPipeline, ObjectIdSpecializer, in_prepass, is_masked, reads_material,
    },
    sections::SectionStarts,
};

pub(super) struct SetObjectTable<const I: usize>;

impl<const I: usize> RenderCommand<ObjectIdItem> for SetObjectTable<I> {
    type Param = SRes<ObjectIdPhases>;
    type ViewQuery = (Read<ExtractedView>, Option<Read<IdBindings>>);
    type ItemQuery = ();

    fn render<'w>(
        item: &ObjectIdItem,
        (view, own): (&'w ExtractedView, Option<&'w IdBindings>),
        _entity: Option<()>,
        phases: SystemParamItem<'w, '_, Self::Param>,
        pass: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        // Only the pipelines of ids draw widths, and compare depth with a tolerance.
        let own = own.filter(|_| item.bin.layer == Layer::Prepass);
        let bind_group = match own {
            Some(own) => own.group.as_ref(),
            None => {
                let phase = phases.into_inner().views.get(&view.retained_view_entity);
                phase.and_then(|phase| phase.buffers.bound.as_ref())
            }
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

/// What is drawn of an object.
#[derive(Clone, Copy, Debug)]
pub(super) enum Drawn {
    /// Its id, and perhaps the widths of its lines.
    Ids { widths: bool },
    /// Its depth and id in the layer of highlighted objects.
    Highlighted,
}

/// Why a mesh is in no bin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Missing {
    /// It is not drawn into this layer.
    NotDrawn,
    /// It may be drawn when its assets have loaded.
    NotLoaded,
}

/// A mesh with what its draw call depends on.
pub(super) struct DrawnMesh<'a> {
    pub instance: RenderMeshQueueData<'a>,
    pub mesh: &'a RenderMesh,
    pub material: UntypedAssetId,
    pub properties: &'a Arc<MaterialProperties>,
    /// The group of bindings that the material is in. The mesh's own note of it may be older.
    group: u32,
    lightmapped: bool,
}

impl DrawnMesh<'_> {
    /// The key of its pipeline. `uses_material`: whether that reads the material.
    pub fn mesh_key(&self, view: MeshPipelineKey, uses_material: bool) -> MeshPipelineKey {
        let mut key = view | MeshPipelineKey::from_bits_retain(self.mesh.key_bits.bits());
        key.set(MeshPipelineKey::LIGHTMAPPED, self.lightmapped);
        key.set(MeshPipelineKey::PREPASS_READS_MATERIAL, uses_material);
        key
    }

    pub fn material_key(&self, mesh_key: MeshPipelineKey) -> ErasedMaterialPipelineKey {
        ErasedMaterialPipelineKey {
            type_id: self.material.type_id(),
            mesh_key: ErasedMeshPipelineKey::new(mesh_key),
            material_key: self.properties.material_key.clone(),
        }
    }
}

/// The meshes and materials of the engine.
#[derive(SystemParam)]
pub(super) struct DrawnMeshes<'w> {
    draw_functions: Res<'w, DrawFunctions<ObjectIdItem>>,
    meshes: Res<'w, RenderAssets<RenderMesh>>,
    instances: Res<'w, RenderMeshInstances>,
    lightmaps: MeshLightmaps<'w>,
    skins: Res<'w, SkinUniforms>,
    materials: Res<'w, ErasedRenderAssets<PreparedMaterial>>,
    material_instances: Res<'w, RenderMaterialInstances>,
}

impl DrawnMeshes<'_> {
    pub fn get(&self, entity: MainEntity) -> Result<DrawnMesh<'_>, Missing> {
        let found = || {
            let instance = self.instances.render_mesh_queue_data(entity)?;
            let material = self.material_instances.instances.get(&entity)?.asset_id;
            let prepared = self.materials.get(material)?;
            Some(DrawnMesh {
                group: prepared.binding.group.0,
                properties: &prepared.properties,
                mesh: self.meshes.get(instance.mesh_asset_id())?,
                instance,
                material,
                lightmapped: self.lightmaps.has(entity),
            })
        };
        found().ok_or(Missing::NotLoaded)
    }

    /// The bin of a mesh, and where the engine has uploaded it.
    pub fn bin(
        &self,
        entity: MainEntity,
        drawn: &DrawnMesh,
        pipeline: CachedRenderPipelineId,
        (layer, uses_material): (Layer, bool),
    ) -> (Bin, u32) {
        // With the CPU's instances, morph targets may be bound for each mesh.
        let on_cpu = matches!(*self.instances, RenderMeshInstances::CpuBuilding(_));
        let morphed = drawn
            .mesh
            .key_bits
            .contains(BaseMeshPipelineKey::MORPH_TARGETS);
        let alone = !drawn.instance.should_batch() || drawn.lightmapped || (on_cpu && morphed);
        let bin = Bin {
            layer,
            pipeline,
            draw_function: draw_function(&self.draw_functions, uses_material),
            material: uses_material.then_some(drawn.group),
            mesh: drawn.instance.mesh_asset_id(),
            skinned: self.skins.skin_byte_offset(entity).is_some(),
            alone: alone.then_some(entity),
            ahead: None,
        };
        (bin, *drawn.instance.current_uniform_index)
    }
}

/// Whether a material may move vertices in the main pass alone.
pub(super) fn may_move_vertices(properties: &MaterialProperties) -> bool {
    properties.get_shader(MaterialVertexShader).is_some()
        && properties.get_shader(PrepassVertexShader).is_none()
}

/// Finds the bins of objects.
#[derive(SystemParam)]
pub(super) struct IdItems<'w> {
    drawn: DrawnMeshes<'w>,
    shared: Res<'w, ObjectIdPipeline>,
    pipelines: ResMut<'w, SpecializedMeshPipelines<ObjectIdSpecializer>>,
    wide: Res<'w, WideMeshes>,
    test: Res<'w, DepthTest>,
    backdrops: Res<'w, Backdrops>,
    sections: Res<'w, SectionStarts>,
    pub cache: Res<'w, PipelineCache>,
}

impl IdItems<'_> {
    fn variant(&self, entity: Entity, drawn: &DrawnMesh, widths: bool) -> IdVariant {
        let wanted = widths && self.wide.0.contains(entity);
        let has_colors = drawn.mesh.layout.0.contains(Mesh::ATTRIBUTE_COLOR);
        if wanted && !has_colors {
            warn_once!("`LineWidths` does nothing on {entity}: its mesh has no vertex colors");
        }
        IdVariant {
            sections: self.sections.draws(entity, is_masked(drawn.properties)),
            widths,
            vertex_widths: wanted && has_colors,
            tolerant: self.test.tolerant(),
            highlighted: false,
        }
    }

    pub fn is_backdrop(&self, mesh: MainEntity) -> bool {
        self.backdrops.0.contains(mesh.id())
    }

    /// The bin of an object, and where the engine has uploaded it.
    pub fn bin(
        &mut self,
        entity: MainEntity,
        view_key: MeshPipelineKey,
        what: Drawn,
    ) -> Result<(Bin, u32), Missing> {
        let drawn = self.drawn.get(entity)?;
        if !in_prepass(drawn.properties) || self.is_backdrop(entity) {
            return Err(Missing::NotDrawn);
        }
        if may_move_vertices(drawn.properties) {
            warn_once!(
                "the material of {entity:?} has a vertex shader, but none for the prepass: if it moves \
                 vertices, pixels are lost; implement `prepass_vertex_shader`, or return false from \
                 `enable_prepass`"
            );
        }
        let uses_material = reads_material(drawn.properties);
        let key = drawn.material_key(drawn.mesh_key(view_key, uses_material));
        let (cache, layout) = (&self.cache, &drawn.mesh.layout);
        let specializer = self.shared.specializer(drawn.properties);
        let (layer, variant) = match what {
            Drawn::Highlighted => {
                let variant = IdVariant {
                    highlighted: true,
                    ..Default::default()
                };
                (Layer::Highlighted, variant)
            }
            Drawn::Ids { widths } => {
                let variant = self.variant(entity.id(), &drawn, widths);
                (Layer::Prepass, variant)
            }
        };
        let mut specialize = |variant| {
            let key = (key.clone(), variant);
            self.pipelines.specialize(cache, &specializer, key, layout)
        };
        let mut ahead = None;
        if layer == Layer::Prepass && self.test.compiles_ahead() {
            let tolerant = IdVariant {
                tolerant: true,
                ..variant
            };
            ahead = specialize(tolerant).ok();
        }
        let pipeline = specialize(variant)
            .inspect_err(|error| error_once!("no object id for {entity:?}: {error}"))
            .map_err(|_| Missing::NotDrawn)?;
        let (bin, input) = self
            .drawn
            .bin(entity, &drawn, pipeline, (layer, uses_material));
        Ok((Bin { ahead, ..bin }, input))
    }
}

impl ObjectIdPhase {
    /// Notes which of the pipelines that compile ahead of their use are ready.
    pub fn note_ahead(&self, test: &DepthTest, items: &IdItems) {
        for ahead in self.bins().filter_map(|(bin, _)| bin.ahead) {
            test.note_ahead(items.cache.get_render_pipeline(ahead).is_some());
        }
    }
}
