//! Plans of views that lack a prepass, and of devices that lack what effects use.

use crate::effect::Needs;
use bevy::{
    log::warn_once,
    render::{renderer::RenderAdapterInfo, settings::WgpuLimits},
};

use super::{Plan, plan::Planned};
use crate::{composite::DebugView, depth::surfaces::prepass_is_empty, diagnostics::SkipReason};

/// Inputs that a view may lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Input {
    DepthPrepass,
    NormalPrepass,
    ObjectIds,
}

/// What a device lacks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DeviceLacks {
    pub compute_shaders: bool,
    /// Storage buffers in vertex and fragment shaders, which object ids need.
    pub object_ids: bool,
    /// Copies of depth textures: see [`prepass_is_empty`].
    pub depth_copies: bool,
}

impl DeviceLacks {
    /// Most storage buffers of a stage of the pipelines that draw or read object ids, the engine's
    /// included.
    const ID_BUFFERS: u32 = 4;

    pub fn new(limits: &WgpuLimits, adapter: &RenderAdapterInfo) -> Self {
        Self {
            compute_shaders: limits.max_compute_workgroup_size_x == 0,
            object_ids: limits.max_storage_buffers_per_shader_stage < Self::ID_BUFFERS,
            depth_copies: prepass_is_empty(adapter),
        }
    }

    /// Warns once about each, with what is not drawn.
    pub fn warn(self) {
        if self.compute_shaders {
            warn_once!(
                "this device has no compute shaders: visible ranges are not smoothed, locked or \
                 trimmed, borders of depth layers are not found, and lines are drawn without \
                 hysteresis, closed gaps, ink budget, held frames, weights and fog"
            );
        }
        if self.object_ids && cfg!(feature = "objects") {
            warn_once!(
                "this device has too few storage buffers for object ids: edges between objects, line \
                 styles of objects, sections, marks, screens that follow objects and depth of \
                 transparent meshes are not drawn"
            );
        }
    }
}

impl Plan {
    /// The plan on a device.
    #[must_use]
    pub fn on_device(mut self, lacks: DeviceLacks) -> Self {
        self.lacks = lacks;
        if lacks.object_ids {
            self.without(Input::ObjectIds)
        } else {
            self
        }
    }

    /// The plan for a view that does not have this input, or does not have it yet.
    #[must_use]
    pub fn without(&self, missing: Input) -> Self {
        let mut plan = self.clone();
        let (needs, reason) = match missing {
            Input::DepthPrepass => (
                Needs::all().difference(Needs::WITHOUT_PREPASSES),
                SkipReason::NoDepthPrepass,
            ),
            Input::NormalPrepass => (Needs::NORMALS, SkipReason::NoNormalPrepass),
            Input::ObjectIds => (Needs::IDS, SkipReason::NoStorageBuffers),
        };
        for planned in std::mem::take(&mut plan.effects) {
            let name = planned.effect.effect_type().name;
            match planned.effect.any_without(needs) {
                Some(effect)
                    if effect.any_strength() > 0.0 && !effect.any_needs().intersects(needs) =>
                {
                    plan.effects.push(Planned { effect, ..planned });
                }
                _ => plan.left_out.push((name, reason)),
            }
        }
        match missing {
            Input::DepthPrepass => {
                plan.view = plan.view.filter(|v| !v.needs_depth());
                plan.histogram = false;
                plan.readback = false;
                plan.unstyled = false;
            }
            Input::NormalPrepass => {
                plan.view = plan.view.filter(|v| *v != DebugView::Creases);
            }
            Input::ObjectIds => {
                plan.view = plan.view.filter(|v| !v.reads_ids());
                plan.lacks.object_ids = true;
                plan.object_styles = false;
                plan.sections = false;
                plan.vertex_widths = false;
                plan.unstyled = false;
                plan.anchored = false;
                plan.marks = false;
            }
        }
        plan.resolve();
        plan
    }
}
