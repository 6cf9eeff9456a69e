//! The system sets of the crate.

use bevy::ecs::schedule::SystemSet;

/// The systems of this crate, for ordering your own systems against them.
///
/// All sets but [`Plan`](Self::Plan) are in the render world, in the `Core3d`
/// schedule that runs for each camera.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ComicsSystems {
    /// Plans what each camera draws from its components, and adds or removes
    /// prepasses: in the main world's schedule [`Last`](bevy::app::Last).
    Plan,
    /// Finds the visible depth range: after `Core3dSystems::Prepass`, before
    /// `Core3dSystems::MainPass`.
    DepthRange,
    /// Finds the outlines: after [`DepthRange`](Self::DepthRange), before
    /// `Core3dSystems::MainPass`.
    Outlines,
    /// Applies the effects to the picture: in `Core3dSystems::PostProcess`, after
    /// tonemapping and before FXAA and SMAA, which then smooth the ink.
    Stylize,
    /// The same for cameras with an effect that [prints](crate::Effect::runs_after_anti_aliasing):
    /// after FXAA, SMAA and contrast-adaptive sharpening, which would change dots and grain.
    Print,
}

/// The steps that prepare a frame, in this order, in
/// `RenderSystems::PrepareBindGroups`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum PrepareComics {
    /// Chooses what every view draws, and writes a request for each service.
    Choose,
    /// Each service prepares what was requested of it.
    Services,
    /// Prepares the fused pass.
    Fused,
}

/// The systems that put the effects of impacts on cameras, before cameras are planned.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RunImpacts;

/// The system that divides meshes into sections, after it is known whether a camera asks for them.
#[cfg(feature = "objects")]
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DivideMeshes;
