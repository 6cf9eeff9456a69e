//! The draw commands and phase items of object ids.

use bevy::{
    ecs::{
        entity::Entity,
        system::{
            Res, ResMut, SystemParam, SystemParamItem,
            lifetimeless::{Read, SRes},
        },
    },
    log::{error_once, warn_once},
    material::key::{ErasedMaterialPipelineKey, ErasedMeshPipelineKey},
    mesh::Mesh,
    pbr::{
        DrawMesh, MeshPipelineKey, PreparedMaterial, RenderMaterialInstances, RenderMeshInstances,
        SetMaterialBindGroup, SetMeshBindGroup, SetPrepassEmptyMaterialBindGroup,
        SetPrepassViewBindGroup,
    },
    render::{
        erased_render_asset::ErasedRenderAssets,
        mesh::RenderMesh,
        render_asset::RenderAssets,
        render_phase::{
            DrawFunctionId, DrawFunctions, RenderCommand, RenderCommandResult, SetItemPipeline,
            TrackedRenderPass,
        },
        render_resource::{PipelineCache, SpecializedMeshPipelines},
        sync_world::MainEntity,
    },
};

use super::{
    depth_test::{DepthTest, TolerantIds},
    lightmaps::MeshLightmaps,
    line_widths::{WideMeshes, WidthBindings},
    object_table::ObjectTable,
    phase::{Layer, ObjectIdItem},
    pipeline::{
        IdVariant, MarkSpecializer, ObjectIdPipeline, ObjectIdSpecializer, in_prepass,
        reads_material,
    },
    sections::{SectionBuffer, SectionTables},
};

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
