//! Diagnostics: what ran for each camera, what was left out, and why.

mod ledger;

use std::{borrow::Cow, fmt};

use bevy::{ecs::entity::EntityHashMap, prelude::*};

pub use crate::composite::DebugView;
pub(crate) use ledger::{StageLedger, publish_ledger, read_ledger};

/// The stages in the frame of a camera with effects, in order.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ComicsStage {
    /// The engine's depth prepass, requested by this crate or by the game.
    DepthPrepass,
    /// The engine's normal prepass, requested by this crate or by the game.
    NormalPrepass,
    /// The pass that draws the ids of objects.
    ObjectIds,
    /// The pass that draws transparent meshes into the depth that effects read
    /// (`DepthWrite`).
    TransparentDepth,
    /// The reduction that finds the nearest and farthest visible depth.
    DepthRange,
    /// The smoothing or locking of that range over time
    /// (`RangeSmoothing`, [`DepthMap::locked`](crate::DepthMap::locked)).
    RangeSmoothing,
    /// The copy of the range, or of the histogram, to the game
    /// (`VisibleDepthRange`, `DepthHistogram`).
    RangeReadback,
    /// The pass that picks one sample of every pixel of a multisampled view, for the
    /// lines.
    ResolveSamples,
    /// The passes that list the tiles of the picture that may have ink.
    SearchTiles,
    /// The pass that finds the cracks between pixels that lines run along.
    FindLines,
    /// The pass that draws the ink of the lines.
    DrawLines,
    /// The passes that draw the outlines of highlighted objects
    /// ([`SelectionOutline`](crate::SelectionOutline), [`XRayOutline`](crate::XRayOutline)).
    HighlightedObjects,
    /// The passes that find the range of the picture's tones
    /// ([`ToneRange`](crate::ToneRange)).
    Tones,
    /// An effect in the fused pass, by its name
    /// ([`Effect::NAME`](crate::Effect::NAME)); see also [`ComicsStage::of`].
    Effect(&'static str),
    /// The fused full-screen pass.
    Stylize,
}

impl ComicsStage {
    /// The stages before the fused pass, in order.
    pub const SERVICES: &'static [Self] = &[
        Self::DepthPrepass,
        Self::NormalPrepass,
        Self::ObjectIds,
        Self::TransparentDepth,
        Self::DepthRange,
        Self::RangeSmoothing,
        Self::RangeReadback,
        Self::ResolveSamples,
        Self::SearchTiles,
        Self::FindLines,
        Self::DrawLines,
        Self::HighlightedObjects,
        Self::Tones,
    ];

    /// The stage's name in reports and files: lower case, with spaces.
    pub fn name(self) -> Cow<'static, str> {
        Cow::Borrowed(match self {
            Self::DepthPrepass => "depth prepass",
            Self::NormalPrepass => "normal prepass",
            Self::ObjectIds => "object ids",
            Self::TransparentDepth => "transparent depth",
            Self::DepthRange => "depth range",
            Self::RangeSmoothing => "range smoothing",
            Self::RangeReadback => "range readback",
            Self::ResolveSamples => "resolve samples",
            Self::SearchTiles => "search tiles",
            Self::FindLines => "find lines",
            Self::DrawLines => "draw lines",
            Self::HighlightedObjects => "highlighted objects",
            Self::Tones => "tones",
            Self::Effect(name) => return Cow::Owned(name.replace('_', " ")),
            Self::Stylize => "stylize",
        })
    }
}

/// The outcome of a stage in a camera's last frame.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StageOutcome {
    /// It ran.
    Ran,
    /// It ran with this method: a
    /// `ReductionMethod::name`, or `tolerant depth` for
    /// [`ObjectIds`](ComicsStage::ObjectIds) that are not drawn at equal depth
    /// (`ObjectIdDepthTest`).
    RanWith(&'static str),
    /// It was left out, for this reason.
    Skipped(SkipReason),
}

/// Why a stage was left out.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SkipReason {
    /// No component of the camera requests it.
    NotRequested,
    /// It would change nothing: its amount or opacity is 0,
    /// [`StyleWeight`](crate::StyleWeight) is 0, or [`SplitView`](crate::SplitView)
    /// shows only the original.
    Negligible,
    /// No effect of the camera reads depth.
    NoDepthStyle,
    /// The effects of the camera read depth, but not the depth map.
    NoMapStyle,
    /// No effect of the camera divides tones or shades by them.
    NoToneStyle,
    /// The lines of the camera do not need it, or it needs lines and no effect
    /// requests any.
    NoSuchLines,
    /// The view shows no transparent mesh that asks for it (`DepthWrite`).
    NoSuchMeshes,
    /// The depth map spans fixed distances, not the visible range.
    FixedRange,
    /// The camera takes the visible range of another one ([`RangeOf`](crate::cameras::RangeOf)).
    RangeOf,
    /// The view has one sample per pixel.
    SingleSampled,
    /// The device has no compute shaders, or too few storage textures or buffers for
    /// them; all pixels are drawn.
    NoComputeShaders,
    /// The device has too few storage buffers for object ids.
    NoStorageBuffers,
    /// OpenGL cannot copy depth.
    NoDepthCopies,
    /// The view has no depth prepass.
    NoDepthPrepass,
    /// The view has no normal prepass.
    NoNormalPrepass,
    /// Another effect of the camera replaces it
    /// ([`Effect::REPLACES`](crate::Effect::REPLACES)).
    Replaced,
    /// Its shader has an error, which is in the log. The camera draws no effects.
    ShaderError,
    /// No effect of the camera is left to draw.
    NothingToDraw,
    /// The depth or normal texture is missing or has another number of samples: the game
    /// has given prepasses to two cameras of one target with different MSAA settings, which
    /// the engine cannot draw.
    SampleCountMismatch,
    /// A pipeline is still compiling, its shader has an error, or an input is not
    /// ready. The stage does not run in this frame.
    PipelineNotReady,
    /// Earlier copies to the game are not finished.
    Busy,
}

impl fmt::Display for SkipReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotRequested => "not requested",
            Self::Negligible => "it would change nothing",
            Self::NoDepthStyle => "no effect reads depth",
            Self::NoMapStyle => "no effect reads the depth map",
            Self::NoToneStyle => "no effect divides tones",
            Self::NoSuchLines => "no such lines are requested",
            Self::NoSuchMeshes => "no transparent mesh in view asks for it",
            Self::FixedRange => "the range is fixed",
            Self::RangeOf => "the range is that of another camera",
            Self::SingleSampled => "the view has one sample per pixel",
            Self::NoComputeShaders => {
                "the device lacks compute shaders or storage textures and buffers"
            }
            Self::NoStorageBuffers => "the device has too few storage buffers for object ids",
            Self::NoDepthCopies => "OpenGL cannot copy depth",
            Self::NoDepthPrepass => "the view has no depth prepass",
            Self::NoNormalPrepass => "the view has no normal prepass",
            Self::Replaced => "another effect replaces it",
            Self::ShaderError => "its shader has an error",
            Self::NothingToDraw => "there is no effect to draw",
            Self::SampleCountMismatch => "the depth texture has another number of samples",
            Self::PipelineNotReady => "the pipeline is not ready",
            Self::Busy => "earlier copies are not finished",
        })
    }
}

/// What ran for one camera.
#[derive(Reflect, Clone, Debug, Default, PartialEq, Eq)]
pub struct CameraStages {
    /// Every stage with its outcome, in order.
    pub stages: Vec<(ComicsStage, StageOutcome)>,
    /// Whether a pipeline for the camera's effects is compiling. Meanwhile the
    /// effects are drawn as before the change; if there were none, the picture is
    /// unstyled.
    pub compiling: bool,
    /// The number of the newest plan that is drawn as requested.
    #[reflect(ignore)]
    pub(crate) drawn: Option<u64>,
}

impl CameraStages {
    /// The outcome of a stage; `None` if nothing was reported for it.
    pub fn outcome(&self, stage: ComicsStage) -> Option<StageOutcome> {
        self.stages
            .iter()
            .find(|(s, _)| *s == stage)
            .map(|(_, outcome)| *outcome)
    }

    /// Whether a stage ran.
    pub fn ran(&self, stage: ComicsStage) -> bool {
        matches!(
            self.outcome(stage),
            Some(StageOutcome::Ran | StageOutcome::RanWith(_))
        )
    }

    pub(crate) fn set(&mut self, stage: ComicsStage, outcome: StageOutcome) {
        match self.stages.iter_mut().find(|(s, _)| *s == stage) {
            Some((_, old)) => *old = outcome,
            None => self.stages.push((stage, outcome)),
        }
    }
}

/// For each camera: which stages ran in its last rendered frame, which were left out,
/// and why. A camera that requests nothing of this crate is not listed.
#[derive(Resource, Reflect, Clone, Debug, Default)]
#[reflect(Resource, Default)]
pub struct ComicsDiagnostics {
    /// The stages by camera entity.
    pub cameras: EntityHashMap<CameraStages>,
    /// The impacts ([`Impact`](crate::Impact)) by camera entity, of cameras that had any.
    pub impacts: EntityHashMap<ImpactCounts>,
}

/// How many impacts a camera had since the app began.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImpactCounts {
    /// Impacts that were shown.
    pub shown: u32,
    /// Impacts that were refused, because they would have been the fourth flash in a second.
    pub refused: u32,
}

impl ComicsDiagnostics {
    /// Whether a pipeline for a camera's effects is compiling.
    pub fn is_compiling(&self, camera: Entity) -> bool {
        self.cameras
            .get(&camera)
            .is_some_and(|stages| stages.compiling)
    }

    /// Whether a stage ran for a camera in its last frame.
    pub fn ran(&self, camera: Entity, stage: ComicsStage) -> bool {
        self.cameras
            .get(&camera)
            .is_some_and(|stages| stages.ran(stage))
    }
}
