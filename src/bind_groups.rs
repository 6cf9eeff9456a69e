//! Bind groups that are kept while what they bind is the same.

use std::{
    hash::{BuildHasher, Hash},
    sync::{Mutex, PoisonError},
};

use bevy::{
    ecs::system::SystemParam,
    platform::{collections::HashTable, hash::FixedHasher},
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderSystems,
        render_resource::{
            BindGroup, BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutId,
            BindingResource, PipelineCache,
        },
        renderer::RenderDevice,
    },
};

pub(crate) fn build_render(app: &mut App) {
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app
            .init_gpu_resource::<BindGroups>()
            .add_systems(Render, forget_unused.in_set(RenderSystems::Cleanup));
    }
}

/// The bind groups of the last frames. A new device has none.
#[derive(Resource, Default)]
pub(crate) struct BindGroups(Mutex<Groups>);

#[derive(Default)]
struct Groups {
    kept: HashTable<Kept>,
    /// How many were made so far.
    made: usize,
}

impl BindGroups {
    /// How many were made so far.
    #[cfg(feature = "objects")]
    pub fn made(&self) -> usize {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).made
    }
}

struct Kept {
    hash: u64,
    layout: BindGroupLayoutId,
    entries: Vec<(u32, Bound)>,
    group: BindGroup,
    /// Frames since it was used.
    unused: u8,
}

/// Frames after which an unused bind group is dropped: as the engine does with textures.
const UNUSED: u8 = 3;

/// What an entry binds, as far as it is used here.
#[derive(PartialEq, Eq, Hash)]
enum Bound {
    Buffer(wgpu::Buffer, u64, Option<wgpu::BufferSize>),
    Texture(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Bound {
    /// `None` for a kind of resource that no pass binds: such groups are not kept.
    fn new(resource: &BindingResource) -> Option<Self> {
        Some(match resource {
            BindingResource::Buffer(b) => Self::Buffer(b.buffer.clone(), b.offset, b.size),
            BindingResource::TextureView(view) => Self::Texture((*view).clone()),
            BindingResource::Sampler(sampler) => Self::Sampler((*sampler).clone()),
            _ => return None,
        })
    }
}

#[derive(SystemParam)]
pub(crate) struct Binder<'w> {
    pub cache: Res<'w, PipelineCache>,
    pub device: Res<'w, RenderDevice>,
    groups: Res<'w, BindGroups>,
}

impl Binder<'_> {
    /// The bind group of these entries: that of an earlier frame if it is still the same.
    pub fn group(
        &self,
        label: &'static str,
        layout: &BindGroupLayoutDescriptor,
        entries: &[BindGroupEntry],
    ) -> BindGroup {
        let layout = self.cache.get_bind_group_layout(layout);
        let make = || self.device.create_bind_group(label, &layout, entries);
        let bound = |entry: &BindGroupEntry| Some((entry.binding, Bound::new(&entry.resource)?));
        let Some(bound) = entries.iter().map(bound).collect::<Option<Vec<_>>>() else {
            return make();
        };
        let id = layout.id();
        let hash = FixedHasher.hash_one((id, &bound));
        let mut groups = self.groups.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |kept: &Kept| kept.layout == id && kept.entries == bound;
        if let Some(kept) = groups.kept.find_mut(hash, is_same) {
            kept.unused = 0;
            return kept.group.clone();
        }
        let group = make();
        groups.made += 1;
        let kept = Kept {
            hash,
            layout: id,
            entries: bound,
            group: group.clone(),
            unused: 0,
        };
        groups.kept.insert_unique(hash, kept, |kept| kept.hash);
        group
    }
}

/// Drops the bind groups that were not used for some frames.
fn forget_unused(groups: Res<BindGroups>) {
    let mut groups = groups.0.lock().unwrap_or_else(PoisonError::into_inner);
    groups.kept.retain(|kept| {
        kept.unused += 1;
        kept.unused <= UNUSED
    });
}
