//! Counts covered pixels without an id, on the GPU. The CPU never waits for the counts, so they
//! arrive a few frames late.

use std::sync::{
    Arc, Mutex, PoisonError,
    atomic::{AtomicBool, AtomicU8, Ordering},
};

use bevy::{
    asset::load_embedded_asset,
    camera::{MainPassResolutionOverride, Viewport},
    core_pipeline::prepass::ViewPrepassTextures,
    prelude::*,
    render::{
        camera::ExtractedCamera,
        render_resource::{
            BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, Buffer,
            BufferUsages, CachedComputePipelineId, ComputePipelineDescriptor, PipelineCache,
            ShaderStages, SpecializedComputePipeline, SpecializedComputePipelines,
            TextureSampleType, TextureView,
            binding_types::{storage_buffer_sized, uniform_buffer_sized},
        },
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        view::{ExtractedView, ViewDepthTexture},
    },
};

use super::{DepthTest, watch::Reading};
use crate::{
    gpu::{UNFILTERABLE, buffer, compute_pass, definitions, sampled},
    objects::{
        IdRequest, ViewObjectIds,
        bindings::IdBindings,
        phase::{Layer, ObjectIdPhases},
    },
    readback::map_words,
};

/// `STEP` and `STRIP` of `count.wgsl`.
const STEP: u32 = 4;
const STRIP: u32 = 16;
/// Invocations of a workgroup in x, and in y.
const WORKGROUP: u32 = 8;
/// Bytes of the counts.
const COUNTS_SIZE: u64 = 8;

/// The counts that have arrived.
#[derive(Clone, Default)]
pub(super) struct Readings(pub Arc<Mutex<Vec<Reading>>>);

/// States of [`IdCount`].
const FREE: u8 = 0;
const RECORDED: u8 = 1;
const MAPPED: u8 = 2;

/// On a view whose missing ids are counted.
#[derive(Component)]
pub(in crate::objects) struct IdCount {
    camera: Entity,
    multisampled: bool,
    pipeline: CachedComputePipelineId,
    /// The viewport, the counts, and their copy for the CPU.
    viewport: Buffer,
    counts: Buffer,
    copy: Buffer,
    /// From the recording of a count until it was read, no other is recorded.
    state: Arc<AtomicU8>,
    /// Whether the ids of the recorded count were drawn with a tolerance.
    tolerant: AtomicBool,
}

impl IdCount {
    fn new(device: &RenderDevice, request: &IdRequest, pipeline: CachedComputePipelineId) -> Self {
        let buffer =
            |label, size, usage| buffer(device, label, size, usage | BufferUsages::COPY_DST);
        let counted = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        Self {
            camera: request.camera,
            multisampled: request.samples > 1,
            pipeline,
            viewport: buffer("comics_count_ids_viewport", 16, BufferUsages::UNIFORM),
            counts: buffer("comics_count_ids", COUNTS_SIZE, counted),
            copy: buffer("comics_count_ids_copy", COUNTS_SIZE, BufferUsages::MAP_READ),
            state: Arc::default(),
            tolerant: AtomicBool::new(false),
        }
    }

    /// Records a count, unless the pipeline is compiling.
    fn record(
        &self,
        ctx: &mut RenderContext,
        (cache, queue): (&PipelineCache, &RenderQueue),
        (depth, ids): (&TextureView, &TextureView),
        viewport: UVec4,
    ) {
        let Some(pipeline) = cache.get_compute_pipeline(self.pipeline) else {
            return;
        };
        let bytes: Vec<u8> = viewport.to_array().map(u32::to_le_bytes).concat();
        queue.write_buffer(&self.viewport, 0, &bytes);
        let layout = cache.get_bind_group_layout(&count_layout(self.multisampled));
        let group = ctx.render_device().create_bind_group(
            "comics_count_ids",
            &layout,
            &BindGroupEntries::sequential((
                depth,
                ids,
                self.viewport.as_entire_binding(),
                self.counts.as_entire_binding(),
            )),
        );
        let encoder = ctx.command_encoder();
        encoder.clear_buffer(&self.counts, 0, None);
        {
            let mut pass = compute_pass(encoder, "comics_count_ids", (pipeline, &group), &[]);
            let across = viewport.z.div_ceil(STEP * STRIP * WORKGROUP);
            pass.dispatch_workgroups(across, viewport.w.div_ceil(STEP * WORKGROUP), 1);
        }
        encoder.copy_buffer_to_buffer(&self.counts, 0, &self.copy, 0, COUNTS_SIZE);
        self.state.store(RECORDED, Ordering::Release);
    }

    /// Maps the count of this frame. Call it after it was submitted.
    fn map(&self, readings: &Readings) {
        if self.state.load(Ordering::Acquire) != RECORDED {
            return;
        }
        self.state.store(MAPPED, Ordering::Release);
        let (camera, state) = (self.camera, self.state.clone());
        let readings = readings.clone();
        let tolerant = self.tolerant.load(Ordering::Relaxed);
        map_words(&self.copy, move |words| {
            if let Some(words) = words {
                let mut readings = readings.0.lock().unwrap_or_else(PoisonError::into_inner);
                readings.push(Reading {
                    camera,
                    covered: words[0],
                    missing: words[1],
                    tolerant,
                });
            }
            state.store(FREE, Ordering::Release);
        });
    }
}

/// Counts missing ids. Its key: whether the view is multisampled.
#[derive(Resource)]
pub(super) struct CountPipeline(Handle<Shader>);

pub(super) fn init_count_pipeline(mut commands: Commands, assets: Res<AssetServer>) {
    let shader = load_embedded_asset!(assets.as_ref(), "count.wgsl");
    commands.insert_resource(CountPipeline(shader));
}

fn count_layout(multisampled: bool) -> BindGroupLayoutDescriptor {
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (
            sampled(multisampled, UNFILTERABLE),
            sampled(multisampled, TextureSampleType::Uint),
            uniform_buffer_sized(false, None),
            storage_buffer_sized(false, None),
        ),
    );
    BindGroupLayoutDescriptor::new("comics_count_ids", &entries)
}

impl SpecializedComputePipeline for CountPipeline {
    type Key = bool;

    fn specialize(&self, multisampled: bool) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_count_ids".into()),
            layout: vec![count_layout(multisampled)],
            shader: self.0.clone(),
            shader_defs: definitions([(multisampled, "MULTISAMPLED")]).collect(),
            entry_point: Some("count".into()),
            ..Default::default()
        }
    }
}

/// Gives the views whose ids are drawn what counting needs, on devices with compute shaders.
pub(super) fn prepare_counts(
    mut commands: Commands,
    views: Query<(Entity, &IdRequest, Option<&IdCount>)>,
    counted: Query<(Entity, Option<&IdRequest>), With<IdCount>>,
    test: Res<DepthTest>,
    (pipeline, cache, device): (Res<CountPipeline>, Res<PipelineCache>, Res<RenderDevice>),
    mut pipelines: ResMut<SpecializedComputePipelines<CountPipeline>>,
) {
    for (view, request) in &counted {
        if request.is_none() || !test.watches() {
            commands.entity(view).remove::<IdCount>();
        }
    }
    if !test.counts() || device.limits().max_compute_workgroup_size_x == 0 {
        return;
    }
    for (view, request, known) in &views {
        let multisampled = request.samples > 1;
        if known.is_none_or(|known| known.multisampled != multisampled) {
            let id = pipelines.specialize(&cache, &pipeline, multisampled);
            let count = IdCount::new(&device, request, id);
            commands.entity(view).insert(count);
        }
    }
}

/// The view whose ids are counted.
type Counted = (
    (
        &'static ExtractedCamera,
        &'static ExtractedView,
        Option<&'static MainPassResolutionOverride>,
    ),
    (&'static ViewDepthTexture, &'static ViewPrepassTextures),
    (
        &'static IdRequest,
        &'static ViewObjectIds,
        Option<&'static IdBindings>,
        &'static IdCount,
    ),
);

/// Counts the missing ids of a view, after they were drawn, in some of the frames.
pub(in crate::objects) fn count_ids(
    view: ViewQuery<Counted>,
    phases: Res<ObjectIdPhases>,
    test: Res<DepthTest>,
    (cache, queue): (Res<PipelineCache>, Res<RenderQueue>),
    mut ctx: RenderContext,
) {
    let ((camera, extracted, resolution), (depth, prepass), ids) = view.into_inner();
    let (request, ids, bindings, count) = ids;
    let has_own_depth = bindings.is_some_and(|bindings| bindings.depth.is_some());
    let is_tolerant = test.tolerant();
    let free = count.state.load(Ordering::Acquire) == FREE;
    if !test.counts() || !free || is_tolerant != has_own_depth {
        return;
    }
    let Some(covered) = prepass.depth.as_ref().map(|depth| &depth.texture) else {
        return;
    };
    let samples = [&depth.texture, &covered.texture, &ids.texture].map(|t| t.sample_count());
    if samples != [request.samples; 3] || count.multisampled != (request.samples > 1) {
        return;
    }
    // Meshes whose pipelines compile have no ids yet. Without a mesh, the depth may be old.
    let phase = phases.views.get(&extracted.retained_view_entity);
    let items = phase.into_iter().flat_map(|phase| &phase.items);
    let mut bins = items
        .map(|item| item.bin)
        .filter(|bin| bin.layer == Layer::Prepass)
        .peekable();
    let is_ready = |pipeline| cache.get_render_pipeline(pipeline).is_some();
    if bins.peek().is_none() || !bins.all(|bin| is_ready(bin.pipeline)) {
        return;
    }
    // What is beside the viewport is depth of other cameras.
    let own = Viewport::from_viewport_and_override(camera.viewport.as_ref(), resolution);
    let viewport = own.map_or(UVec4::new(0, 0, request.size.x, request.size.y), |own| {
        let (at, size) = (own.physical_position, own.physical_size);
        UVec4::new(at.x, at.y, size.x, size.y)
    });
    count.tolerant.store(is_tolerant, Ordering::Relaxed);
    let views = (&covered.default_view, &ids.view);
    count.record(&mut ctx, (&cache, &queue), views, viewport);
}

/// Maps the counts of this frame. Runs after they were submitted.
pub(super) fn map_counts(counts: Query<&IdCount>, test: Res<DepthTest>) {
    for count in &counts {
        count.map(&test.readings);
    }
}
