//! Prepares the buffers and uniforms of the views whose tones are measured.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    prelude::*,
    render::{
        render_resource::{Buffer, DynamicUniformBuffer},
        renderer::{RenderDevice, RenderQueue},
    },
};

use super::TonesRequest;
use crate::depth::{
    RawDepth,
    follow::{Followed, SmoothingUniform, ViewSmoothing},
    frame::DepthProjection,
    passes::TonePasses,
    prepare::keys_buffer,
    range::RangeView,
};

/// On a view in the render world: the percentiles of its tones. It stays on the view, with the
/// state of the smoothing, as long as they are requested.
#[derive(Component)]
pub(crate) struct ViewTones {
    pub request: TonesRequest,
    pub passes: TonePasses,
    /// Offset in bytes of this view's entry in [`ToneUniforms::views`].
    pub view_offset: u32,
    /// Keys of the lightest and the darkest tone of this frame.
    pub keys: Buffer,
    pub smoothing: ViewSmoothing,
    /// Whether the passes of this frame were recorded.
    pub found: AtomicBool,
}

impl TonesRequest {
    fn followed(&self) -> Followed {
        Followed {
            smoothing: self.range.followed(),
            locked: false,
            projection: DepthProjection::NONE,
            origin: (self.cuts, self.viewport.zw()),
            seconds: self.seconds,
        }
    }
}

impl ViewTones {
    fn new(device: &RenderDevice, request: TonesRequest, passes: TonePasses) -> Self {
        Self {
            request,
            passes,
            view_offset: 0,
            keys: keys_buffer(device),
            smoothing: ViewSmoothing::new(device, &request.followed()),
            found: AtomicBool::new(false),
        }
    }

    /// The percentiles as keys; `None` unless the passes of this frame were recorded.
    pub fn drawn(&self) -> Option<&Buffer> {
        let found = self.found.load(Ordering::Relaxed);
        found.then_some(&self.smoothing.drawn)
    }

    /// Prepares this frame.
    fn prepare(
        &mut self,
        request: TonesRequest,
        passes: TonePasses,
        uniforms: &mut ToneUniforms,
        device: &RenderDevice,
    ) {
        self.smoothing.keep_histogram(device, true);
        let uniform = self.smoothing.uniform(&request.followed(), false);
        self.smoothing.uniform_offset = uniforms.smoothings.push(&uniform);
        self.view_offset = uniforms.views.push(&RangeView {
            rect: request.viewport,
            raw: RawDepth::default(),
        });
        self.found = AtomicBool::new(false);
        self.passes = passes;
        self.request = request;
    }
}

#[derive(Resource)]
pub(crate) struct ToneUniforms {
    pub views: DynamicUniformBuffer<RangeView>,
    pub smoothings: DynamicUniformBuffer<SmoothingUniform>,
}

impl Default for ToneUniforms {
    fn default() -> Self {
        let mut views = DynamicUniformBuffer::default();
        views.set_label(Some("comics_tone_views"));
        let mut smoothings = DynamicUniformBuffer::default();
        smoothings.set_label(Some("comics_tone_smoothings"));
        Self { views, smoothings }
    }
}

pub(super) fn prepare_view_tones(
    mut commands: Commands,
    mut views: Query<(Entity, &TonesRequest, &TonePasses, Option<&mut ViewTones>)>,
    stale: Query<Entity, (With<ViewTones>, Without<TonesRequest>)>,
    mut uniforms: ResMut<ToneUniforms>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    uniforms.views.clear();
    uniforms.smoothings.clear();
    for (view, request, passes, tones) in &mut views {
        match tones {
            Some(mut tones) => tones.prepare(*request, *passes, &mut uniforms, &device),
            None => {
                let mut tones = ViewTones::new(&device, *request, *passes);
                tones.prepare(*request, *passes, &mut uniforms, &device);
                commands.entity(view).insert(tones);
            }
        }
    }
    for view in &stale {
        commands.entity(view).remove::<ViewTones>();
    }
    let ToneUniforms { views, smoothings } = &mut *uniforms;
    views.write_buffer(&device, &queue);
    smoothings.write_buffer(&device, &queue);
}
