//! The instances of the draw calls of object ids, and what the pass reads of each.
//!
//! With the engine's indirect drawing, the order of its instances is known to the GPU alone, so a
//! fragment could not tell which mesh it belongs to. The bins of this pass are therefore expanded
//! by the engine's pipeline for direct drawing, which writes each mesh to the place that its work
//! item names.

use std::any::TypeId;

use bevy::{
    ecs::system::{Res, ResMut, StaticSystemParam, SystemParam, SystemParamItem},
    pbr::{MeshInputUniform, MeshPipeline, MeshUniform, PreprocessPipelines, RenderMeshInstances},
    platform::time::Instant,
    render::{
        batching::{
            GetBatchData, GetFullBatchData, gpu_preprocessing::BatchedInstanceBuffers,
            no_gpu_preprocessing::BatchedInstanceBuffer,
        },
        render_resource::{BindGroup, Buffer, PipelineCache},
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        view::{ExtractedView, ViewUniformOffset, ViewUniforms},
    },
};

use super::{
    phase::{Instance, InstanceBuffers, ObjectIdItem, ObjectIdPhase, ObjectIdPhases},
    pipeline::ObjectIdPipeline,
    sections::SectionBuffer,
};
use crate::{
    bind_groups::Binder,
    gpu::{compute_pass, entry},
};

/// The engine's buffers of mesh instances: one of them exists, depending on who expands meshes.
#[derive(SystemParam)]
pub(super) struct EngineBuffers<'w> {
    gpu: Option<ResMut<'w, BatchedInstanceBuffers<MeshUniform, MeshInputUniform>>>,
    cpu: Option<ResMut<'w, BatchedInstanceBuffer<MeshUniform>>>,
    instances: Res<'w, RenderMeshInstances>,
}

/// Makes the draw calls of this frame, and uploads what they read.
pub(super) fn place_instances(
    mut phases: ResMut<ObjectIdPhases>,
    mut engine: EngineBuffers,
    param: StaticSystemParam<<MeshPipeline as GetBatchData>::Param>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    let started = Instant::now();
    place(&mut phases, &mut engine, &param, (&device, &queue));
    phases.elapsed += started.elapsed();
}

fn place(
    phases: &mut ObjectIdPhases,
    engine: &mut EngineBuffers,
    param: &SystemParamItem<<MeshPipeline as GetBatchData>::Param>,
    (device, queue): (&RenderDevice, &RenderQueue),
) {
    let key = TypeId::of::<ObjectIdItem>();
    if let RenderMeshInstances::CpuBuilding(_) = *engine.instances {
        if let Some(buffer) = &mut engine.cpu {
            for phase in phases.views.values_mut() {
                phase.build_on_cpu(buffer, param);
                phase.upload(device, queue);
            }
        }
        return;
    }
    let Some(buffers) = &mut engine.gpu else {
        return;
    };
    let mut most = 0;
    for phase in phases.views.values_mut() {
        if std::mem::take(&mut phase.changed) {
            phase.build();
            phase.upload(device, queue);
        }
        most = most.max(phase.buffers.work.len());
    }
    // Views are expanded one after another, each right before it is drawn.
    if most > 0 {
        let phase = buffers.phase_instance_buffers.entry(key).or_default();
        phase.data_buffer.add_multiple(most);
    } else {
        buffers.phase_instance_buffers.swap_remove(&key);
    }
}

impl ObjectIdPhase {
    /// Makes the draw calls, and what the GPU expands.
    fn build(&mut self) {
        let mut items = std::mem::take(&mut self.items);
        let mut buffers = std::mem::take(&mut self.buffers);
        items.clear();
        let mut end = 0;
        for (bin, meshes) in self.bins() {
            let first = end as u32;
            for Instance { input, record, .. } in meshes {
                buffers.work.set(end, [*input, end as u32]);
                buffers.records.set(end, *record);
                end += 1;
            }
            let range = first..end as u32;
            items.extend((meshes.first()).map(|i| Self::draw_call(bin, i.mesh, range)));
        }
        buffers.work.truncate(end);
        buffers.records.truncate(end);
        (self.items, self.buffers) = (items, buffers);
    }

    /// Makes the draw calls, and adds the instances to those that the CPU expands.
    fn build_on_cpu(
        &mut self,
        buffer: &mut BatchedInstanceBuffer<MeshUniform>,
        param: &SystemParamItem<<MeshPipeline as GetBatchData>::Param>,
    ) {
        let mut items = std::mem::take(&mut self.items);
        let mut buffers = std::mem::take(&mut self.buffers);
        items.clear();
        let mut next = 0;
        for (bin, meshes) in self.bins() {
            let mut drawn = None;
            for Instance { mesh, record, .. } in meshes {
                let Some(uniform) = MeshPipeline::get_binned_batch_data(param, *mesh) else {
                    continue;
                };
                let at = buffer.push(uniform).index;
                for unused in next..at as usize {
                    buffers.records.set(unused, [0; 4]);
                }
                next = at as usize + 1;
                buffers.records.set(next - 1, *record);
                drawn = Some((drawn.map_or((*mesh, at), |(first, _)| first), at + 1));
            }
            items.extend(drawn.map(|((mesh, first), end)| Self::draw_call(bin, mesh, first..end)));
        }
        buffers.records.truncate(next);
        self.changed = false;
        (self.items, self.buffers) = (items, buffers);
    }

    /// The records of the instances, and the sections that they name; `None` without a mesh.
    pub fn bound<'a>(&'a self, sections: &'a SectionBuffer) -> Option<[&'a Buffer; 2]> {
        if self.items.is_empty() {
            return None;
        }
        Some([self.buffers.records.buffer()?, sections.buffer()?])
    }

    fn upload(&mut self, device: &RenderDevice, queue: &RenderQueue) {
        self.buffers.work.write(device, queue);
        self.buffers.records.write(device, queue);
    }
}

/// The engine's side of the bindings.
#[derive(SystemParam)]
pub(super) struct Expanding<'w> {
    buffers: Option<Res<'w, BatchedInstanceBuffers<MeshUniform, MeshInputUniform>>>,
    pipelines: Option<Res<'w, PreprocessPipelines>>,
    views: Res<'w, ViewUniforms>,
}

impl Expanding<'_> {
    /// `None` if nothing is expanded on the GPU, or if the engine has no buffers.
    fn expansion(&self, view: &InstanceBuffers, binder: &Binder) -> Option<BindGroup> {
        let engine = self.buffers.as_ref()?;
        let output = engine
            .phase_instance_buffers
            .get(&TypeId::of::<ObjectIdItem>())?;
        let current = engine.current_input_buffer.buffer().buffer()?;
        let previous = engine.previous_input_buffer.buffer()?;
        let pipeline = &self.pipelines.as_ref()?.direct_preprocess;
        Some(binder.group(
            "comics_object_instances",
            &pipeline.bind_group_layout,
            &[
                entry(0, self.views.uniforms.binding()?),
                entry(3, current.as_entire_binding()),
                entry(4, previous.as_entire_binding()),
                entry(5, view.work.binding()?),
                entry(6, output.data_buffer.buffer()?.as_entire_binding()),
            ],
        ))
    }
}

/// Binds the buffers of this frame.
pub(super) fn bind_instances(
    mut phases: ResMut<ObjectIdPhases>,
    expanding: Expanding,
    sections: Res<SectionBuffer>,
    shared: Res<ObjectIdPipeline>,
    binder: Binder,
) {
    let started = Instant::now();
    for phase in phases.views.values_mut() {
        phase.buffers.expansion = expanding.expansion(&phase.buffers, &binder);
        phase.buffers.bound = phase.bound(&sections).map(|[objects, sections]| {
            let entries = [
                entry(0, objects.as_entire_binding()),
                entry(1, sections.as_entire_binding()),
            ];
            binder.group("comics_objects", &shared.layout, &entries)
        });
    }
    phases.elapsed += started.elapsed();
}

/// Expands the instances of a view.
pub(super) fn expand_instances(
    view: ViewQuery<(&ExtractedView, &ViewUniformOffset)>,
    phases: Res<ObjectIdPhases>,
    pipelines: Option<Res<PreprocessPipelines>>,
    cache: Res<PipelineCache>,
    mut ctx: RenderContext,
) {
    let (view, offset) = view.into_inner();
    let Some(phase) = phases.views.get(&view.retained_view_entity) else {
        return;
    };
    let pipeline = pipelines
        .and_then(|pipelines| pipelines.direct_preprocess.pipeline_id)
        .and_then(|id| cache.get_compute_pipeline(id));
    let (Some(expansion), Some(pipeline)) = (&phase.buffers.expansion, pipeline) else {
        return;
    };
    let bound = (pipeline, expansion);
    let encoder = ctx.command_encoder();
    let mut pass = compute_pass(encoder, "comics_object_instances", bound, &[offset.offset]);
    pass.dispatch_workgroups((phase.buffers.work.len() as u32).div_ceil(64), 1, 1);
}
