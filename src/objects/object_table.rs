//! The table that the pass of object ids reads.

use bevy::{
    ecs::{
        resource::Resource,
        system::{Res, ResMut},
    },
    math::UVec4,
    render::{
        render_phase::{PhaseItem, ViewSortedRenderPhases},
        render_resource::{BindGroup, BindGroupEntries, PipelineCache, StorageBuffer},
        renderer::{RenderDevice, RenderQueue},
    },
};

use super::{
    DepthWrites, ObjectStyles,
    groups::ObjectGroups,
    marks::Marks,
    object_id::object_id,
    phase::{Layer, ObjectIdItem},
    pipeline::ObjectIdPipeline,
    sections::{SectionBuffer, SectionTables},
};

/// Id, style slot, first word of the sections and bits of the least alpha of each object,
/// indexed by the instance index of its phase item.
#[derive(Resource, Default)]
pub(super) struct ObjectTable {
    pub objects: StorageBuffer<Vec<UVec4>>,
    pub bind_group: Option<BindGroup>,
}

/// What is known of objects by their entities.
type Tables<'w> = (
    Res<'w, ObjectStyles>,
    Res<'w, ObjectGroups>,
    Res<'w, Marks>,
    Res<'w, DepthWrites>,
);

pub(super) fn prepare_object_table(
    phases: Res<ViewSortedRenderPhases<ObjectIdItem>>,
    (styles, groups, marks, writes): Tables,
    (sections, section_tables): (Res<SectionBuffer>, Res<SectionTables>),
    (shared, cache): (Res<ObjectIdPipeline>, Res<PipelineCache>),
    mut table: ResMut<ObjectTable>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    let table = &mut *table;
    let objects = table.objects.get_mut();
    objects.clear();
    for item in phases.values().flat_map(|phase| phase.items.values()) {
        let at = item.batch_range.start as usize;
        if objects.len() <= at {
            objects.resize(at + 1, UVec4::ZERO);
        }
        let mesh = item.main_entity().id();
        if let Some((root, slot)) = marks.of(mesh).filter(|_| item.layer == Layer::Marked) {
            objects[at] = UVec4::new(u32::from(object_id(root)), u32::from(slot), 0, 0);
            continue;
        }
        let slot = styles.slots.get(&mesh).copied();
        let id = object_id(groups.object(mesh));
        let start = sections.start(&section_tables, mesh).unwrap_or(0);
        let cutoff = writes
            .cutoffs
            .get(&mesh)
            .map_or(0, |cutoff| cutoff.to_bits());
        objects[at] = UVec4::new(u32::from(id), u32::from(slot.unwrap_or(0)), start, cutoff);
    }
    table.bind_group = None;
    if objects.is_empty() {
        return;
    }
    table.objects.write_buffer(&device, &queue);
    if let (Some(objects), Some(sections)) = (table.objects.binding(), sections.buffer()) {
        table.bind_group = Some(device.create_bind_group(
            "comics_objects",
            &cache.get_bind_group_layout(&shared.layout),
            &BindGroupEntries::sequential((objects, sections.as_entire_binding())),
        ));
    }
}
