//! What tests and benchmarks read of the work that objects cause.

use std::time::Duration;

use bevy::ecs::world::World;

use crate::bind_groups::BindGroups;

use super::{depths::ObjectBounds, phase::ObjectIdPhases, sections::SectionBuffer};

/// What the passes of object ids do in all views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ObjectWork {
    /// Draw calls of a frame.
    pub draw_calls: usize,
    /// Meshes in these draw calls.
    pub instances: usize,
    /// Meshes that were added to them, in all frames so far.
    pub queued: usize,
    /// Bytes of instances, sections and boxes that were uploaded, in all frames so far.
    pub uploaded: usize,
    /// Bind groups that the plugin's passes have made, in all frames so far.
    pub bind_groups: usize,
}

impl ObjectWork {
    /// How long the CPU took in the last frame to queue, batch and bind object ids.
    pub fn elapsed(render_world: &World) -> Duration {
        let phases = render_world.get_resource::<ObjectIdPhases>();
        phases.map_or(Duration::ZERO, |phases| phases.elapsed)
    }

    /// Reads it from the render world.
    pub fn of(render_world: &World) -> Self {
        let phases = render_world.get_resource::<ObjectIdPhases>();
        let phases = phases.into_iter().flat_map(|phases| phases.views.values());
        let sections = render_world.get_resource::<SectionBuffer>();
        let boxes = render_world.get_resource::<ObjectBounds>();
        let sections = sections.map_or(0, |sections| sections.words.written);
        let shared = Self {
            uploaded: sections + boxes.map_or(0, |boxes| boxes.table.written),
            bind_groups: render_world
                .get_resource::<BindGroups>()
                .map_or(0, BindGroups::made),
            ..Self::default()
        };
        phases.fold(shared, |sum, phase| Self {
            draw_calls: sum.draw_calls + phase.items.len(),
            instances: sum.instances + phase.items.iter().map(|i| i.instances.len()).sum::<usize>(),
            queued: sum.queued + phase.added,
            bind_groups: sum.bind_groups,
            uploaded: sum.uploaded + phase.buffers.work.written + phase.buffers.records.written,
        })
    }
}
