//! Draws the ids of the objects: every mesh of the depth prepass once more, at
//! exactly the depth that the prepass found, so that each pixel knows its
//! object. Skins, morph targets, materials with vertex shaders of their own and
//! alpha masks come out right, since the vertex shader is the prepass's and what
//! it discarded fails the test for equal depth.

use super::{ID_FORMAT, ObjectStyles, phase::ObjectIdItem};
use crate::{
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    passes::ViewPasses,
    view::ComicsView,
};
use bevy::{
    app::App,
    asset::{AssetServer, Handle, load_embedded_asset},
    camera::{MainPassResolutionOverride, Viewport},
    ecs::{
        component::Component,
        entity::Entity,
        resource::Resource,
        schedule::IntoScheduleConfigs,
        system::{Commands, Query, Res, ResMut, SystemParamItem, lifetimeless::SRes},
        world::World,
    },
    log::error_once,
    material::{
        AlphaMode, MaterialProperties,
        key::{ErasedMaterialPipelineKey, ErasedMeshPipelineKey},
    },
    math::UVec2,
    mesh::{Mesh3d, MeshVertexBufferLayoutRef},
    pbr::{
        DrawMesh, MeshPipeline, MeshPipelineKey, PreparedMaterial, PrepassFragmentShader,
        PrepassPipeline, PrepassPipelineSpecializer, PrepassVertexShader, RenderMaterialInstances,
        RenderMeshInstances, SetMaterialBindGroup, SetMeshBindGroup,
        SetPrepassEmptyMaterialBindGroup, SetPrepassViewBindGroup,
    },
    platform::collections::HashSet,
    render::{
        ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderDebugFlags, RenderStartup,
        RenderSystems,
        camera::ExtractedCamera,
        erased_render_asset::ErasedRenderAssets,
        mesh::RenderMesh,
        render_asset::RenderAssets,
        render_phase::{
            AddRenderCommand, DrawFunctions, PhaseItem, PhaseItemExtraIndex, RenderCommand,
            RenderCommandResult, SetItemPipeline, SortedRenderPhasePlugin, TrackedRenderPass,
            ViewSortedRenderPhases, sort_phase_system,
        },
        render_resource::{
            BindGroup, BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries,
            ColorTargetState, ColorWrites, CompareFunction, FragmentState, LoadOp, Operations,
            PipelineCache, RenderPassColorAttachment, RenderPassDescriptor,
            RenderPipelineDescriptor, ShaderStages, SpecializedMeshPipeline,
            SpecializedMeshPipelineError, SpecializedMeshPipelines, StorageBuffer, StoreOp,
            Texture, binding_types::storage_buffer_read_only,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        view::{ExtractedView, Msaa, RenderVisibleEntities, RetainedViewEntity, ViewDepthTexture},
    },
    shader::Shader,
};

/// The id that an entity has in [`ViewObjectIds`], 1 to 65535. Entities whose
/// indices differ by a multiple of 65535 share one, and have no
/// [object edge](crate::ObjectEdges) between them.
pub fn object_id(entity: Entity) -> u16 {
    (entity.index_u32() % 65535 + 1) as u16
}

/// In the render world, on a view whose object ids are drawn: which object is
/// seen at each pixel. As large as the depth texture, with as many samples.
#[derive(Component, Clone, Debug)]
pub struct ViewObjectIds {
    /// `Rg16Uint`: the [`object_id`] (0: none) and the slot of its contour style
    /// (0: none of its own).
    pub texture: Texture,
}

/// Publishes the textures of the views.
fn publish_object_ids(
    mut commands: Commands,
    passes: Res<ViewPasses>,
    published: Query<(Entity, &ViewObjectIds)>,
) {
    for (view, ids) in &published {
        let texture = passes.views.get(&view).and_then(|pass| pass.ids.as_ref());
        if texture.is_none_or(|own| own.texture.id() != ids.texture.id()) {
            commands.entity(view).remove::<ViewObjectIds>();
        }
    }
    for (view, pass) in &passes.views {
        if let Some(ids) = &pass.ids
            && !published
                .get(*view)
                .is_ok_and(|(_, known)| known.texture.id() == ids.texture.id())
        {
            commands.entity(*view).insert(ViewObjectIds {
                texture: ids.texture.clone(),
            });
        }
    }
}

/// What all pipelines of this pass have in common.
#[derive(Resource)]
struct ObjectIdPipeline {
    prepass: PrepassPipeline,
    layout: BindGroupLayoutDescriptor,
    shader: Handle<Shader>,
}

fn init_object_id_pipeline(
    mut commands: Commands,
    prepass: Res<PrepassPipeline>,
    assets: Res<AssetServer>,
) {
    commands.insert_resource(ObjectIdPipeline {
        prepass: prepass.clone(),
        layout: BindGroupLayoutDescriptor::new(
            "comics_objects",
            &BindGroupLayoutEntries::single(
                ShaderStages::FRAGMENT,
                storage_buffer_read_only::<Vec<UVec2>>(false),
            ),
        ),
        shader: load_embedded_asset!(assets.as_ref(), "ids.wgsl"),
    });
}

struct ObjectIdSpecializer {
    prepass: PrepassPipelineSpecializer,
    layout: BindGroupLayoutDescriptor,
    shader: Handle<Shader>,
}

impl SpecializedMeshPipeline for ObjectIdSpecializer {
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

/// By output index of the phase's instances: (id, style slot).
#[derive(Resource, Default)]
struct ObjectTable {
    objects: StorageBuffer<Vec<UVec2>>,
    bind_group: Option<BindGroup>,
}

struct SetObjectTable<const I: usize>;

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

type DrawId = (
    SetItemPipeline,
    SetPrepassViewBindGroup<0>,
    SetObjectTable<1>,
    SetMeshBindGroup<2>,
    SetPrepassEmptyMaterialBindGroup<3>,
    DrawMesh,
);

/// For materials whose vertex shader may read their bindings.
type DrawIdWithMaterial = (
    SetItemPipeline,
    SetPrepassViewBindGroup<0>,
    SetObjectTable<1>,
    SetMeshBindGroup<2>,
    SetMaterialBindGroup<3>,
    DrawMesh,
);

fn reads_material(properties: &MaterialProperties) -> bool {
    properties.get_shader(PrepassVertexShader).is_some()
        || properties.get_shader(PrepassFragmentShader).is_some()
}

/// Whether a material is drawn in the prepass.
fn in_prepass(properties: &MaterialProperties) -> bool {
    properties.prepass_enabled
        && !properties.reads_view_transmission_texture
        && matches!(
            properties.alpha_mode,
            AlphaMode::Opaque | AlphaMode::AlphaToCoverage | AlphaMode::Mask(_)
        )
}

fn queue_object_ids(
    views: Query<(&ExtractedView, &RenderVisibleEntities, &ComicsView, &Msaa)>,
    draw_functions: Res<DrawFunctions<ObjectIdItem>>,
    shared: Res<ObjectIdPipeline>,
    mut pipelines: ResMut<SpecializedMeshPipelines<ObjectIdSpecializer>>,
    cache: Res<PipelineCache>,
    (meshes, instances): (Res<RenderAssets<RenderMesh>>, Res<RenderMeshInstances>),
    (materials, material_instances): (
        Res<ErasedRenderAssets<PreparedMaterial>>,
        Res<RenderMaterialInstances>,
    ),
    mut phases: ResMut<ViewSortedRenderPhases<ObjectIdItem>>,
) {
    let mut live: HashSet<RetainedViewEntity> = HashSet::default();
    let functions = draw_functions.read();
    let (plain, with_material) = (
        functions.id::<DrawId>(),
        functions.id::<DrawIdWithMaterial>(),
    );
    for (view, visible, comics, msaa) in &views {
        if !comics.plan.draws_ids() {
            continue;
        }
        live.insert(view.retained_view_entity);
        phases.prepare_for_new_frame(view.retained_view_entity);
        let Some(phase) = phases.get_mut(&view.retained_view_entity) else {
            continue;
        };
        let Some(class) = visible.get::<Mesh3d>() else {
            continue;
        };
        for (render_entity, main_entity) in class.iter_visible() {
            let Some(instance) = instances.render_mesh_queue_data(*main_entity) else {
                continue;
            };
            let Some(mesh) = meshes.get(instance.mesh_asset_id()) else {
                continue;
            };
            let Some(material) = material_instances
                .instances
                .get(main_entity)
                .and_then(|instance| materials.get(instance.asset_id).zip(Some(instance)))
            else {
                continue;
            };
            let (material, material_instance) = material;
            if !in_prepass(&material.properties) {
                continue;
            }
            let mut mesh_key = MeshPipelineKey::from_msaa_samples(msaa.samples())
                | MeshPipelineKey::DEPTH_PREPASS
                | MeshPipelineKey::from_bits_retain(mesh.key_bits.bits());
            if instance.lightmap_slab_index().is_some() {
                mesh_key |= MeshPipelineKey::LIGHTMAPPED;
            }
            let uses_material = reads_material(&material.properties);
            if uses_material {
                mesh_key |= MeshPipelineKey::PREPASS_READS_MATERIAL;
            }
            let specializer = ObjectIdSpecializer {
                prepass: PrepassPipelineSpecializer {
                    pipeline: shared.prepass.clone(),
                    properties: material.properties.clone(),
                },
                layout: shared.layout.clone(),
                shader: shared.shader.clone(),
            };
            let key = ErasedMaterialPipelineKey {
                type_id: material_instance.asset_id.type_id(),
                mesh_key: ErasedMeshPipelineKey::new(mesh_key),
                material_key: material.properties.material_key.clone(),
            };
            match pipelines.specialize(&cache, &specializer, key, &mesh.layout) {
                Ok(pipeline) => phase.add_transient(ObjectIdItem {
                    entity: (*render_entity, *main_entity),
                    pipeline,
                    draw_function: if uses_material { with_material } else { plain },
                    batch_range: 0..1,
                    extra_index: PhaseItemExtraIndex::None,
                    indexed: mesh.indexed(),
                }),
                Err(error) => error_once!("{main_entity:?} has no object id: {error}"),
            }
        }
    }
    phases.retain(|view, _| live.contains(view));
}

fn prepare_object_table(
    phases: Res<ViewSortedRenderPhases<ObjectIdItem>>,
    styles: Res<ObjectStyles>,
    shared: Res<ObjectIdPipeline>,
    cache: Res<PipelineCache>,
    mut table: ResMut<ObjectTable>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    let table = &mut *table;
    let objects = table.objects.get_mut();
    objects.clear();
    for item in phases.values().flat_map(|phase| phase.items.values()) {
        let at = item.batch_range.start as usize;
        if objects.len() <= at {
            objects.resize(at + 1, UVec2::ZERO);
        }
        let slot = styles.slots.get(&item.main_entity().id()).copied();
        let id = object_id(item.main_entity().id());
        objects[at] = UVec2::new(u32::from(id), u32::from(slot.unwrap_or(0)));
    }
    table.bind_group = None;
    if objects.is_empty() {
        return;
    }
    table.objects.write_buffer(&device, &queue);
    if let Some(binding) = table.objects.binding() {
        table.bind_group = Some(device.create_bind_group(
            "comics_objects",
            &cache.get_bind_group_layout(&shared.layout),
            &BindGroupEntries::single(binding),
        ));
    }
}

/// Draws the ids of a view.
pub(crate) fn draw_object_ids(
    world: &World,
    view: ViewQuery<(
        &ExtractedCamera,
        &ExtractedView,
        &ViewDepthTexture,
        Option<&MainPassResolutionOverride>,
    )>,
    passes: Res<ViewPasses>,
    phases: Option<Res<ViewSortedRenderPhases<ObjectIdItem>>>,
    ledger: Res<StageLedger>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (camera, extracted, depth, resolution) = view.into_inner();
    let Some((pass, target)) = passes
        .views
        .get(&entity)
        .and_then(|pass| pass.ids.as_ref().map(|ids| (pass, ids)))
    else {
        return;
    };
    let Some(phase) = phases
        .as_ref()
        .and_then(|phases| phases.get(&extracted.retained_view_entity))
    else {
        return;
    };
    if depth.texture.sample_count() != target.texture.sample_count() {
        ledger.set(
            pass.camera,
            ComicsStage::ObjectIds,
            StageOutcome::LeftOut(LeftOut::SampleCountMismatch),
        );
        return;
    }
    let mut render_pass = ctx.begin_tracked_render_pass(RenderPassDescriptor {
        label: Some("comics_object_ids"),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: &target.view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations {
                load: LoadOp::Clear(Default::default()),
                store: StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    if let Some(viewport) =
        Viewport::from_viewport_and_override(camera.viewport.as_ref(), resolution)
    {
        render_pass.set_camera_viewport(&viewport);
    }
    if let Err(error) = phase.render(&mut render_pass, world, entity) {
        error_once!("the object ids were not drawn: {error:?}");
        return;
    }
    ledger.set(pass.camera, ComicsStage::ObjectIds, StageOutcome::Ran);
}

/// Adds the pass, in an app that draws meshes.
pub(crate) fn build(app: &mut App) {
    app.add_plugins(SortedRenderPhasePlugin::<ObjectIdItem, MeshPipeline>::new(
        RenderDebugFlags::default(),
    ));
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<SpecializedMeshPipelines<ObjectIdSpecializer>>()
        .init_gpu_resource::<ObjectTable>()
        .init_resource::<DrawFunctions<ObjectIdItem>>()
        .add_render_command::<ObjectIdItem, DrawId>()
        .add_render_command::<ObjectIdItem, DrawIdWithMaterial>()
        .add_systems(
            RenderStartup,
            init_object_id_pipeline.after(bevy::pbr::init_prepass_pipeline),
        )
        .add_systems(ExtractSchedule, super::table::extract_object_styles)
        .add_systems(
            Render,
            (
                queue_object_ids.in_set(RenderSystems::QueueMeshes),
                sort_phase_system::<ObjectIdItem>.in_set(RenderSystems::PhaseSort),
                prepare_object_table.in_set(RenderSystems::PrepareBindGroups),
                publish_object_ids.in_set(RenderSystems::Cleanup),
            ),
        );
}
