//! Prepares the buffers and uniforms of the views whose range is requested.

use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use bevy::{
    ecs::entity::EntityHashMap,
    prelude::*,
    render::{
        render_resource::{Buffer, BufferUsages, DynamicUniformBuffer},
        renderer::{RenderDevice, RenderQueue},
        texture::{CachedTexture, TextureCache},
    },
};

use super::{
    follow::{SmoothingUniform, ViewSmoothing},
    frame::DepthProjection,
    passes::{RangePasses, Reduction},
    ping_pong::chain_textures,
    range::RangeView,
    range_of::{ConversionUniform, TakenRange},
    readback::{RangeReadback, RangeReadings},
    request::RangeRequest,
    view::RANGE_SIZE,
};
use crate::gpu::buffer;

/// Bytes of `BorderState` in `borders.wgsl`.
const BORDERS_SIZE: u64 = 16;

/// On a view in the render world: its visible range. It stays on the view, with the
/// state of its smoothing, as long as a range is requested.
#[derive(Component)]
pub(crate) struct ViewDepthRange {
    pub request: RangeRequest,
    pub passes: RangePasses,
    /// Offset in bytes of this view's entry in [`RangeUniforms::views`].
    pub view_offset: u32,
    /// Keys of the nearest and farthest depth of this frame.
    pub keys: Buffer,
    /// Textures of the ping-pong chain; empty if another reduction runs.
    pub chain: Vec<CachedTexture>,
    pub smoothing: Option<ViewSmoothing>,
    /// The state of the borders of depth layers.
    pub borders: Option<Buffer>,
    /// The range of another view, which this one draws with.
    pub taken: Option<TakenRange>,
    /// Whether the passes of this frame were recorded.
    pub found: AtomicBool,
    pub readback: Mutex<RangeReadback>,
}

impl ViewDepthRange {
    fn new(device: &RenderDevice, request: &RangeRequest, passes: RangePasses) -> Self {
        Self {
            request: request.clone(),
            passes,
            view_offset: 0,
            keys: keys_buffer(device),
            chain: Vec::new(),
            smoothing: None,
            borders: None,
            taken: None,
            found: AtomicBool::new(false),
            readback: Mutex::default(),
        }
    }

    /// The buffer in which the reduction counts depths, if it does.
    pub fn histogram(&self) -> Option<&Buffer> {
        self.smoothing.as_ref()?.histogram.as_ref()
    }

    /// Keys of the range that the depth map spans, after smoothing; `None` unless the
    /// passes of this frame were recorded.
    pub fn drawn(&self) -> Option<&Buffer> {
        let keys = match &self.taken {
            Some(taken) => &taken.drawn,
            None => self.own(),
        };
        self.found.load(Ordering::Relaxed).then_some(keys)
    }

    /// Keys of this view's own range, after smoothing.
    fn own(&self) -> &Buffer {
        (self.smoothing.as_ref()).map_or(&self.keys, |smoothing| &smoothing.drawn)
    }

    /// Prepares to take the range of another view, if this one is to: `own` and the projection of the
    /// other one.
    fn take(
        &mut self,
        leaders: &EntityHashMap<(Buffer, DepthProjection)>,
        uniforms: &mut RangeUniforms,
        device: &RenderDevice,
    ) {
        let takes = self.passes.conversion.is_some();
        let Some(leader) = self.request.leader.filter(|_| takes) else {
            self.taken = None;
            return;
        };
        // If the other one has no range any more, this view has the last one until it has its own.
        if let Some((keys, projection)) = leaders.get(&leader) {
            let taken = (self.taken.take()).filter(|taken| taken.from.id() == keys.id());
            let mut taken = taken.unwrap_or_else(|| TakenRange::new(device, keys.clone()));
            taken.conversion = ConversionUniform::new(projection, &self.request.projection);
            self.taken = Some(taken);
        }
        if let Some(taken) = &mut self.taken {
            taken.offset = uniforms.conversions.push(&taken.conversion);
        }
    }
}

#[derive(Resource)]
pub(crate) struct RangeUniforms {
    pub views: DynamicUniformBuffer<RangeView>,
    pub smoothings: DynamicUniformBuffer<SmoothingUniform>,
    pub conversions: DynamicUniformBuffer<ConversionUniform>,
}

impl Default for RangeUniforms {
    fn default() -> Self {
        let mut views = DynamicUniformBuffer::default();
        views.set_label(Some("comics_range_views"));
        let mut smoothings = DynamicUniformBuffer::default();
        smoothings.set_label(Some("comics_range_smoothings"));
        let mut conversions = DynamicUniformBuffer::default();
        conversions.set_label(Some("comics_range_conversions"));
        Self {
            views,
            smoothings,
            conversions,
        }
    }
}

pub(crate) fn prepare_view_ranges(
    mut commands: Commands,
    mut views: Query<(
        Entity,
        &RangeRequest,
        &RangePasses,
        Option<&mut ViewDepthRange>,
    )>,
    stale: Query<Entity, (With<ViewDepthRange>, Without<RangeRequest>)>,
    mut uniforms: ResMut<RangeUniforms>,
    mut textures: ResMut<TextureCache>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    uniforms.views.clear();
    uniforms.smoothings.clear();
    uniforms.conversions.clear();
    let mut new = Vec::new();
    let mut leaders = EntityHashMap::default();
    let mut lend = |range: &ViewDepthRange| {
        let lent = (range.own().clone(), range.request.projection);
        leaders.insert(range.request.camera, lent);
    };
    for (entity, request, passes, range) in &mut views {
        let tools = (&*device, &mut *textures);
        match range {
            Some(mut range) => {
                range.prepare(request, *passes, &mut uniforms, tools);
                lend(&range);
            }
            None => {
                let mut range = ViewDepthRange::new(&device, request, *passes);
                range.prepare(request, *passes, &mut uniforms, tools);
                lend(&range);
                new.push((entity, range));
            }
        }
    }
    for (.., range) in &mut views {
        if let Some(mut range) = range {
            range.take(&leaders, &mut uniforms, &device);
        }
    }
    for (entity, mut range) in new {
        range.take(&leaders, &mut uniforms, &device);
        commands.entity(entity).insert(range);
    }
    for entity in &stale {
        commands.entity(entity).remove::<ViewDepthRange>();
    }
    uniforms.views.write_buffer(&device, &queue);
    uniforms.smoothings.write_buffer(&device, &queue);
    uniforms.conversions.write_buffer(&device, &queue);
}

impl ViewDepthRange {
    /// Prepares this frame; buffers that still fit are kept.
    fn prepare(
        &mut self,
        request: &RangeRequest,
        passes: RangePasses,
        uniforms: &mut RangeUniforms,
        (device, textures): (&RenderDevice, &mut TextureCache),
    ) {
        if passes.smoothing.is_some() {
            let followed = request.followed();
            let smoothing = self
                .smoothing
                .get_or_insert_with(|| ViewSmoothing::new(device, &followed));
            smoothing.keep_histogram(device, passes.counts);
            let begin = self.passes.middle.is_none();
            let uniform = smoothing.uniform(&followed, begin);
            smoothing.uniform_offset = uniforms.smoothings.push(&uniform);
        } else {
            self.smoothing = None;
        }
        self.borders = passes.borders.map(|_| {
            let known = self.borders.take();
            known.unwrap_or_else(|| {
                let label = "comics_depth_borders";
                buffer(device, label, BORDERS_SIZE, BufferUsages::STORAGE)
            })
        });
        self.chain = match passes.reduction {
            Some(Reduction::PingPong { .. }) => chain_textures(textures, device, request.rect.zw()),
            Some(Reduction::Compute { .. }) | None => Vec::new(),
        };
        self.view_offset = uniforms.views.push(&RangeView {
            rect: request.rect,
            raw: request.raw,
        });
        if !request.readback && !request.histogram {
            self.readback = Mutex::default();
        }
        self.found = AtomicBool::new(false);
        self.passes = passes;
        self.request.clone_from(request);
    }
}

pub(crate) fn keys_buffer(device: &RenderDevice) -> Buffer {
    let copied = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
    let usage = BufferUsages::STORAGE | BufferUsages::UNIFORM | copied;
    buffer(device, "comics_depth_range", RANGE_SIZE, usage)
}

/// Maps the copies of this frame. Runs after they were submitted.
pub(crate) fn map_readbacks(mut ranges: Query<&mut ViewDepthRange>, readings: Res<RangeReadings>) {
    for mut range in &mut ranges {
        let camera = range.request.camera;
        let readback = range
            .readback
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        readback.map(camera, &readings);
    }
}
