//! Smooths the visible range over time, so that the picture does not flicker:
//! settings, event, compute pass. \[CS\] leaves this as future work.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    camera::Camera,
    ecs::{
        component::Component,
        entity::Entity,
        event::EntityEvent,
        observer::On,
        query::With,
        resource::Resource,
        system::{Commands, Query},
    },
    math::UVec2,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::{
        render_resource::{
            BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutEntries, BindingResource,
            Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePassDescriptor,
            ComputePipeline, ComputePipelineDescriptor, PipelineCache, ShaderStages, ShaderType,
            SpecializedComputePipeline,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer},
        },
        renderer::RenderDevice,
    },
    shader::Shader,
};
use serde::{Deserialize, Serialize};

use super::{DepthMap, ProjectionKind, frame::DepthProjection, request::RangeRequest};
use crate::settings::{FieldRange, bounded};

/// Smooths the visible range of a [`DepthMap`] over time, so that it does not flicker
/// when something small or short-lived enters or leaves the view.
///
/// There are four stages, in this order: percentiles, the median of three frames,
/// hysteresis, and an exponential approach. A setting of 0 (or `false`) leaves its
/// stage out. While the range lags behind the scene, distances outside of it map to
/// 0 or 1.
///
/// The state is one per camera and stays on the GPU. It starts with the first frame
/// that shows geometry, and anew after a [`CameraCut`], when the size of the view
/// changes, and when the near or far plane changes. Without compute shaders there
/// is no smoothing.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RangeSmoothing {
    /// Fraction of the visible geometry, in pixels, that may be outside of the
    /// range at each end, so that a few pixels do not stretch the range.
    /// Range 0 to 0.2, default 0; 0.005 is a good first value.
    ///
    /// Where geometry that covers about this fraction comes and goes, the range
    /// flickers more than with 0 (measured in `docs/report`). Has no effect with
    /// `ReductionMethod::PingPong`.
    #[reflect(@FieldRange::linear(0.0, 0.2))]
    pub outliers: f32,
    /// Takes the median of the last three frames, so that geometry that is visible
    /// for one frame changes nothing. Delays the range by one frame.
    /// Default: `true`.
    pub despike: bool,
    /// Change of distance, in octaves, that an end of the range ignores. An end that
    /// has begun to move follows the scene until it is within a quarter of this, then
    /// comes to rest. Under an orthographic projection the unit is the length of the
    /// range. Range 0 to 4, default 0.07 (5 % of a distance).
    #[reflect(@FieldRange::linear(0.0, 4.0).unit("oct"))]
    pub hysteresis: f32,
    /// Time constant with which the range grows, in seconds of real time: 63 % of a
    /// change is made up after this time, 95 % after three times this time, at any
    /// frame rate. Range 0 to 60, default 0.1.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("s"))]
    pub expand: f32,
    /// Time constant with which the range shrinks, in seconds of real time.
    /// Range 0 to 60, default 1.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("s"))]
    pub shrink: f32,
}

impl Default for RangeSmoothing {
    fn default() -> Self {
        Self {
            outliers: 0.0,
            despike: true,
            hysteresis: 0.07,
            expand: 0.1,
            shrink: 1.0,
        }
    }
}

impl RangeSmoothing {
    /// No smoothing: the range of each single frame.
    pub const OFF: Self = Self {
        outliers: 0.0,
        despike: false,
        hysteresis: 0.0,
        expand: 0.0,
        shrink: 0.0,
    };

    /// The settings that are used: every number in its documented range, what
    /// is not finite replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            outliers: bounded(self.outliers, default.outliers, 0.0, 0.2),
            despike: self.despike,
            hysteresis: bounded(self.hysteresis, default.hysteresis, 0.0, 4.0),
            expand: bounded(self.expand, default.expand, 0.0, 60.0),
            shrink: bounded(self.shrink, default.shrink, 0.0, 60.0),
        }
    }

    /// Whether it changes nothing.
    pub fn is_negligible(&self) -> bool {
        *self == Self::OFF
    }
}

/// Tells a camera that its next frame does not continue the last one, after a cut or
/// a teleport. Its smoothed range starts anew.
///
/// ```
/// # use bevy::ecs::prelude::*;
/// # use bevy_comics::CameraCut;
/// fn cut(mut commands: Commands, camera: Entity) {
///     commands.trigger(CameraCut { entity: camera });
/// }
/// ```
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
pub struct CameraCut {
    /// The camera that was cut.
    pub entity: Entity,
}

/// Number of cuts of a camera so far.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct CameraCuts(pub u32);

pub(crate) fn count_cut(
    cut: On<CameraCut>,
    mut cameras: Query<Option<&mut CameraCuts>, With<Camera>>,
    mut commands: Commands,
) {
    match cameras.get_mut(cut.entity) {
        Ok(Some(mut cuts)) => cuts.0 = cuts.0.wrapping_add(1),
        Ok(None) => {
            commands.entity(cut.entity).insert(CameraCuts(1));
        }
        Err(_) => bevy::log::warn_once!("CameraCut: {} is not a camera", cut.entity),
    }
}

/// Bits of [`SmoothingUniform::flags`], as in `smoothing.wgsl`.
const ORTHOGRAPHIC: u32 = 1;
const SNAP: u32 = 2;
const HOLD: u32 = 4;
const DESPIKE: u32 = 8;
const RESET: u32 = 16;

/// `Smoothing` of `smoothing.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SmoothingUniform {
    pub offset: f32,
    pub outliers: f32,
    pub hysteresis: f32,
    pub expand: f32,
    pub shrink: f32,
    pub flags: u32,
}

/// Fraction of the difference to a goal that is made up in `seconds`, for a time
/// constant in seconds.
fn approach(seconds: f32, constant: f32) -> f32 {
    if constant > 0.0 {
        -(-f64::from(seconds) / f64::from(constant)).exp_m1() as f32
    } else {
        1.0
    }
}

impl SmoothingUniform {
    pub fn new(
        map: &DepthMap,
        projection: &DepthProjection,
        seconds: f32,
        [snap, reset]: [bool; 2],
    ) -> Self {
        let smoothing = map.smoothing.unwrap_or(RangeSmoothing::OFF);
        let orthographic = projection.kind() == ProjectionKind::Orthographic;
        let flag = |on: bool, flag: u32| if on { flag } else { 0 };
        Self {
            offset: projection.offset(),
            outliers: smoothing.outliers,
            hysteresis: smoothing.hysteresis,
            expand: approach(seconds, smoothing.expand),
            shrink: approach(seconds, smoothing.shrink),
            flags: flag(orthographic, ORTHOGRAPHIC)
                | flag(snap, SNAP)
                | flag(reset, RESET)
                | flag(map.locked, HOLD)
                | flag(smoothing.despike, DESPIKE),
        }
    }
}

/// Bytes of the buffer of `RangeState`, which needs 52.
const STATE_SIZE: u64 = 64;
/// Bytes of the buffer of `Histogram`, which needs 1028.
const HISTOGRAM_SIZE: u64 = 1040;

/// A view's smoothed range: its buffers, and what they were last computed for.
pub(crate) struct ViewSmoothing {
    state: Buffer,
    /// Keys of the range that the depth map spans.
    pub drawn: Buffer,
    /// Counts of the reduction, if it counts.
    pub histogram: Option<Buffer>,
    /// Number of cuts and size of the view in depth pixels. If one changes, smoothing
    /// starts anew, or waits for that while the range is locked.
    origin: (u32, UVec2),
    /// If it changes, raw depth has another meaning, and smoothing starts anew even if
    /// the range is locked.
    projection: DepthProjection,
    /// Whether smoothing is to start anew, for a change of `origin` (snap) or of
    /// `projection` (reset). Cleared when a frame that does so was recorded.
    snap: AtomicBool,
    reset: AtomicBool,
    locked: bool,
    pub uniform_offset: u32,
}

impl ViewSmoothing {
    pub fn new(device: &RenderDevice, request: &RangeRequest, size: UVec2) -> Self {
        let buffer = |label, size, usage| {
            device.create_buffer(&BufferDescriptor {
                label: Some(label),
                size,
                usage: BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        };
        Self {
            state: buffer("comics_range_state", STATE_SIZE, BufferUsages::empty()),
            drawn: buffer(
                "comics_smoothed_range",
                16,
                BufferUsages::UNIFORM | BufferUsages::COPY_SRC,
            ),
            histogram: None,
            origin: (request.cuts, size),
            projection: request.projection,
            snap: AtomicBool::new(false),
            reset: AtomicBool::new(false),
            locked: false,
            uniform_offset: 0,
        }
    }

    /// The uniform of this frame. Compares the request with that of the last frame.
    pub fn uniform(&mut self, request: &RangeRequest, size: UVec2) -> SmoothingUniform {
        if self.origin != (request.cuts, size) {
            self.origin = (request.cuts, size);
            self.snap = AtomicBool::new(true);
        }
        if self.projection != request.projection {
            self.projection = request.projection;
            self.reset = AtomicBool::new(true);
        }
        self.locked = request.map.locked;
        let starts = [&self.snap, &self.reset].map(|flag| flag.load(Ordering::Relaxed));
        SmoothingUniform::new(&request.map, &request.projection, request.seconds, starts)
    }

    /// Creates or drops the buffer of the histogram.
    pub fn keep_histogram(&mut self, device: &RenderDevice, wanted: bool) {
        if !wanted {
            self.histogram = None;
        } else if self.histogram.is_none() {
            self.histogram = Some(device.create_buffer(&BufferDescriptor {
                label: Some("comics_depth_histogram"),
                size: HISTOGRAM_SIZE,
                usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }));
        }
    }

    /// Records the smoothing of this frame. `found` holds the keys of the reduction.
    pub fn record(
        &self,
        device: &RenderDevice,
        encoder: &mut CommandEncoder,
        cache: &PipelineCache,
        pipeline: &ComputePipeline,
        (uniforms, found): (BindingResource, &Buffer),
    ) {
        let entry = |binding, resource| BindGroupEntry { binding, resource };
        let mut entries = vec![
            entry(0, uniforms),
            entry(1, found.as_entire_binding()),
            entry(2, self.state.as_entire_binding()),
            entry(3, self.drawn.as_entire_binding()),
        ];
        if let Some(histogram) = &self.histogram {
            entries.push(entry(4, histogram.as_entire_binding()));
        }
        let layout = SmoothingPipeline::layout(self.histogram.is_some());
        let bind_group = device.create_bind_group(
            "comics_range_smoothing",
            &cache.get_bind_group_layout(&layout),
            &entries,
        );
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("comics_range_smoothing"),
            timestamp_writes: None,
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &bind_group, &[self.uniform_offset]);
        pass.dispatch_workgroups(1, 1, 1);
        drop(pass);
        // A locked range ignores a cut; smoothing starts anew when it is unlocked.
        if !self.locked {
            self.snap.store(false, Ordering::Relaxed);
        }
        self.reset.store(false, Ordering::Relaxed);
    }
}

#[derive(Resource)]
pub(crate) struct SmoothingPipeline {
    shader: Handle<Shader>,
}

impl SmoothingPipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "smoothing.wgsl"),
        }
    }

    fn layout(histogram: bool) -> BindGroupLayoutDescriptor {
        let mut entries = BindGroupLayoutEntries::sequential(
            ShaderStages::COMPUTE,
            (
                uniform_buffer::<SmoothingUniform>(true),
                storage_buffer_read_only_sized(false, None),
                storage_buffer_sized(false, None),
                storage_buffer_sized(false, None),
            ),
        )
        .to_vec();
        if histogram {
            entries
                .push(storage_buffer_read_only_sized(false, None).build(4, ShaderStages::COMPUTE));
        }
        BindGroupLayoutDescriptor::new("comics_range_smoothing", &entries)
    }
}

impl SpecializedComputePipeline for SmoothingPipeline {
    /// Whether the reduction counts a histogram.
    type Key = bool;

    fn specialize(&self, histogram: Self::Key) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_range_smoothing".into()),
            layout: vec![Self::layout(histogram)],
            shader: self.shader.clone(),
            shader_defs: if histogram {
                vec!["HISTOGRAM".into()]
            } else {
                Vec::new()
            },
            entry_point: Some("follow".into()),
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_short_steps_are_one_long_step() {
        for constant in [0.05, 0.1, 1.0, 30.0] {
            let once = f64::from(approach(0.1, constant));
            let left = 1.0 - f64::from(approach(0.01, constant));
            assert!((1.0 - left.powi(10) - once).abs() < 1e-6, "{constant}");
        }
        assert_eq!(approach(0.016, 0.0), 1.0);
        assert_eq!(approach(0.0, 1.0), 0.0);
    }
}
