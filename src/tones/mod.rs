//! The service of tones: brings the tones of a view's unstyled picture into a range. The reduction
//! of the depth range counts them, and its smoothing follows their percentiles from frame to frame.
//! The fused pass reads these, and `tones.wgsl` says how tones change by them.

mod measure;
pub(crate) mod prepare;
mod settings;

use std::num::NonZeroU64;

use bevy::{
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup,
        render_resource::{
            BindGroupLayoutEntry, ShaderStages, binding_types::uniform_buffer_sized,
        },
    },
    shader::load_shader_library,
};

use self::prepare::{ToneUniforms, ViewTones, prepare_view_tones};
use crate::{depth::view::RANGE_SIZE, schedule::PrepareComics};

pub(crate) use measure::measure_tones;
pub use settings::ToneRange;

/// On a view in the render world: a request to measure its tones, written in every frame by
/// [`PrepareComics::Choose`].
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct TonesRequest {
    pub camera: Entity,
    pub range: ToneRange,
    /// How the picture is stored.
    pub space: CompositingSpace,
    /// x, y, width, height in physical pixels.
    pub viewport: UVec4,
    /// The view is styled after FXAA and SMAA.
    pub after_anti_aliasing: bool,
    /// Real time since the last frame, in seconds.
    pub seconds: f32,
    /// Number of cuts of the camera so far.
    pub cuts: u32,
}

/// The binding of the percentiles in the fused pass, see `tones.wgsl`.
pub(crate) const TONES_BINDING: u32 = 34;

/// The layout entry of the percentiles in the fused pass.
pub(crate) fn tones_entry() -> BindGroupLayoutEntry {
    let size = NonZeroU64::new(RANGE_SIZE);
    uniform_buffer_sized(false, size).build(TONES_BINDING, ShaderStages::FRAGMENT)
}

/// Loads the WGSL of tones, and prepares the views that request percentiles. The fused pass orders
/// the measuring before itself.
pub(crate) fn build_render(app: &mut App) {
    load_shader_library!(app, "tones.wgsl");
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<ToneUniforms>()
        .add_systems(RenderStartup, forget_tones)
        .add_systems(Render, prepare_view_tones.in_set(PrepareComics::Services));
}

/// The buffers of a lost device are no longer valid.
fn forget_tones(mut commands: Commands, views: Query<Entity, With<ViewTones>>) {
    for view in &views {
        commands.entity(view).remove::<ViewTones>();
    }
}
