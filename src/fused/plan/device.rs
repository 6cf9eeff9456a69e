//! What a device lacks of what effects use.

use bevy::{
    log::warn_once,
    render::{
        renderer::{RenderAdapterInfo, RenderDevice},
        settings::WgpuFeatures,
    },
};

use crate::depth::surfaces::prepass_is_empty;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DeviceLacks {
    pub compute_shaders: bool,
    /// Storage buffers in vertex and fragment shaders, which object ids need.
    pub object_ids: bool,
    /// The index of a triangle in fragment shaders, which sections of meshes need.
    pub primitive_index: bool,
    /// Copies of depth textures: see [`prepass_is_empty`].
    pub depth_copies: bool,
}

impl DeviceLacks {
    /// Most storage buffers of a stage of the pipelines that draw or read object ids, the engine's
    /// included.
    const ID_BUFFERS: u32 = 4;

    pub fn new(device: &RenderDevice, adapter: &RenderAdapterInfo) -> Self {
        let limits = device.limits();
        Self {
            compute_shaders: limits.max_compute_workgroup_size_x == 0,
            object_ids: limits.max_storage_buffers_per_shader_stage < Self::ID_BUFFERS,
            primitive_index: !device.features().contains(WgpuFeatures::PRIMITIVE_INDEX),
            depth_copies: prepass_is_empty(adapter),
        }
    }

    /// Warns once about each, with what is not drawn.
    pub fn warn(self) {
        if self.compute_shaders {
            warn_once!(
                "this device has no compute shaders: visible ranges are not smoothed, locked, \
                 trimmed or taken from other cameras (`RangeOf`), the focus of the middle is not smoothed, borders of depth layers are not found, tones are not brought into a range (`ToneRange`), and lines are drawn without \
                 hysteresis, closed gaps, ink budget, held frames, weights, styles of convex and concave edges, and fog"
            );
        }
        if self.object_ids && cfg!(feature = "objects") {
            warn_once!(
                "this device has too few storage buffers for object ids: edges between objects, line \
                 styles of objects, sections, selection and x-ray outlines, screens that follow objects and depth of \
                 transparent meshes are not drawn"
            );
        }
    }
}
