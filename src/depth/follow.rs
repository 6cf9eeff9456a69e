//! What the pass reads and keeps that smooths the visible range.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    math::UVec2,
    render::{
        render_resource::{BindingResource, Buffer, BufferUsages, CommandEncoder, ShaderType},
        renderer::RenderDevice,
    },
};

use super::{ProjectionKind, RangeSmoothing, frame::DepthProjection, view::RANGE_SIZE};
use crate::gpu::buffer;

/// Bits of [`SmoothingUniform::flags`], as in `level.wgsl`.
const ORTHOGRAPHIC: u32 = 1;
const SNAP: u32 = 2;
const HOLD: u32 = 4;
const DESPIKE: u32 = 8;
const RESET: u32 = 16;
const BEGIN: u32 = 32;

/// `Smoothing` of `level.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SmoothingUniform {
    pub offset: f32,
    pub outliers: f32,
    pub hysteresis: f32,
    pub expand: f32,
    pub shrink: f32,
    pub settle: f32,
    pub seconds: f32,
    pub flags: u32,
}

/// Time constant in seconds with which an end settles that rests beside what is visible
/// (`WATCH` in `smoothing.wgsl` is the time before that).
const SETTLE: f32 = 2.0;

/// A longer frame, in seconds, counts as one of this length when an end is watched:
/// a game that was stopped did not show a view that stood still.
const LONGEST_WATCHED: f32 = 0.1;

/// Fraction of the difference to a goal that is made up in `seconds`, for a time
/// constant in seconds.
fn approach(seconds: f32, constant: f32) -> f32 {
    if constant > 0.0 {
        -(-f64::from(seconds) / f64::from(constant)).exp_m1() as f32
    } else {
        1.0
    }
}

/// How a range is smoothed in a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Followed {
    pub smoothing: RangeSmoothing,
    /// The range stays as it is.
    pub locked: bool,
    pub projection: DepthProjection,
    /// Number of cuts of the camera so far, and size of the viewport in physical pixels.
    pub origin: (u32, UVec2),
    /// Real time since the last frame, in seconds.
    pub seconds: f32,
}

impl SmoothingUniform {
    fn new(followed: &Followed, [snap, reset, begin]: [bool; 3]) -> Self {
        let Followed {
            smoothing,
            locked,
            projection,
            seconds,
            ..
        } = *followed;
        let orthographic = projection.kind() == ProjectionKind::Orthographic;
        let flag = |on: bool, flag: u32| if on { flag } else { 0 };
        Self {
            offset: projection.offset(),
            outliers: smoothing.outliers,
            hysteresis: smoothing.hysteresis,
            expand: approach(seconds, smoothing.expand),
            shrink: approach(seconds, smoothing.shrink),
            settle: approach(seconds, SETTLE),
            seconds: seconds.min(LONGEST_WATCHED),
            flags: flag(orthographic, ORTHOGRAPHIC)
                | flag(snap, SNAP)
                | flag(reset, RESET)
                | flag(begin, BEGIN)
                | flag(locked, HOLD)
                | flag(smoothing.despike, DESPIKE),
        }
    }
}

/// Bytes of the buffer of `RangeState`, which needs 88.
const STATE_SIZE: u64 = 96;
/// Offset in bytes of `RangeState::window`.
const WINDOW_OFFSET: u64 = 80;
const WINDOW_SIZE: u64 = 8;
/// Bytes of the buffer of `Histogram`, which needs 1036.
const HISTOGRAM_SIZE: u64 = 1040;
/// Offset in bytes of `Histogram::window_near`.
const HISTOGRAM_WINDOW: u64 = 1028;

/// A view's smoothed range: its buffers, and what they were last computed for.
pub(crate) struct ViewSmoothing {
    state: Buffer,
    /// Keys of the range that the depth map spans.
    pub drawn: Buffer,
    /// Counts of the reduction, if it counts.
    pub histogram: Option<Buffer>,
    /// Number of cuts and size of the viewport. If one changes, smoothing starts anew, or waits for
    /// that while the range is locked. The resolution of the main pass does not count: games change
    /// it all the time.
    origin: (u32, UVec2),
    /// If raw depth gets another meaning, smoothing starts anew even if the range is
    /// locked.
    projection: DepthProjection,
    /// Whether smoothing is to start anew, for a change of `origin` (snap) or of
    /// `projection` (reset). Cleared when a frame that does so was recorded.
    snap: AtomicBool,
    reset: AtomicBool,
    locked: bool,
    pub uniform_offset: u32,
}

impl ViewSmoothing {
    pub fn new(device: &RenderDevice, followed: &Followed) -> Self {
        let buffer =
            |label, size, usage| buffer(device, label, size, BufferUsages::STORAGE | usage);
        Self {
            state: buffer("comics_range_state", STATE_SIZE, BufferUsages::COPY_SRC),
            drawn: buffer(
                "comics_smoothed_range",
                RANGE_SIZE,
                BufferUsages::UNIFORM | BufferUsages::COPY_SRC,
            ),
            histogram: None,
            origin: followed.origin,
            projection: followed.projection,
            snap: AtomicBool::new(false),
            reset: AtomicBool::new(false),
            locked: false,
            uniform_offset: 0,
        }
    }

    /// The uniform of this frame. Compares the frame with the last one. `begin`: the middle was not
    /// found in that one.
    pub fn uniform(&mut self, followed: &Followed, begin: bool) -> SmoothingUniform {
        let is_other = self.origin != followed.origin;
        if is_other {
            self.origin = followed.origin;
            self.snap = AtomicBool::new(true);
        }
        if !self.projection.same_raw_depth(&followed.projection) {
            self.reset = AtomicBool::new(true);
        }
        self.projection = followed.projection;
        self.locked = followed.locked;
        let [snap, reset] = [&self.snap, &self.reset].map(|flag| flag.load(Ordering::Relaxed));
        SmoothingUniform::new(followed, [snap, reset, begin || is_other])
    }

    /// Creates or drops the buffer of the histogram.
    pub fn keep_histogram(&mut self, device: &RenderDevice, wanted: bool) {
        if !wanted {
            self.histogram = None;
        } else if self.histogram.is_none() {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
            let histogram = buffer(device, "comics_depth_histogram", HISTOGRAM_SIZE, usage);
            self.histogram = Some(histogram);
        }
    }

    /// Records that the histogram is cleared, and that it counts in bins of the visible
    /// range of the last frame.
    pub fn clear_histogram(&self, encoder: &mut CommandEncoder) {
        let Some(histogram) = &self.histogram else {
            return;
        };
        encoder.clear_buffer(histogram, 0, None);
        encoder.copy_buffer_to_buffer(
            &self.state,
            WINDOW_OFFSET,
            histogram,
            HISTOGRAM_WINDOW,
            WINDOW_SIZE,
        );
    }

    /// What the pass binds. `found` holds the keys of the reduction.
    pub fn bound<'a>(
        &'a self,
        uniforms: BindingResource<'a>,
        found: &'a Buffer,
    ) -> Vec<BindingResource<'a>> {
        let buffers = [found, &self.state, &self.drawn];
        let buffers = buffers.into_iter().chain(&self.histogram);
        let buffers = buffers.map(|buffer| buffer.as_entire_binding());
        [uniforms].into_iter().chain(buffers).collect()
    }

    /// Notes that the pass of this frame was recorded.
    pub fn recorded(&self) {
        // A locked range ignores a cut; smoothing starts anew when it is unlocked.
        if !self.locked {
            self.snap.store(false, Ordering::Relaxed);
        }
        self.reset.store(false, Ordering::Relaxed);
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
