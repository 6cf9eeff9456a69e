//! The system sets of the crate.

use bevy::ecs::schedule::SystemSet;

/// The systems of this crate: order your own against them. Those of the render
/// world are in the `Core3d` schedule of a camera.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ComicsSystems {
    /// In the main world's schedule [`Last`](bevy::app::Last): what cameras draw is
    /// planned from their components, and prepasses are asked for or released.
    Plan,
    /// The depth range is found: after `Core3dSystems::Prepass`, before
    /// `Core3dSystems::MainPass`.
    DepthRange,
    /// The outlines are found: after the depth range, before
    /// `Core3dSystems::MainPass`.
    Outlines,
    /// The picture is stylized: in `Core3dSystems::PostProcess`, after
    /// tonemapping and before FXAA and SMAA, which then smooth the ink.
    Stylize,
}

/// The order in which this crate prepares a frame, in
/// `RenderSystems::PrepareBindGroups`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum PrepareComics {
    /// Chooses what every view draws, and writes the services' requests.
    Choose,
    /// The services prepare what was requested.
    Services,
    /// The fused pass is prepared.
    Fused,
}
