//! What ran for each camera, what was left out, and why.

mod ledger;

use std::{borrow::Cow, fmt};

use bevy::{
    ecs::{
        entity::{Entity, EntityHashMap},
        reflect::ReflectResource,
        resource::Resource,
    },
    reflect::{Reflect, std_traits::ReflectDefault},
};

pub(crate) use ledger::{StageLedger, publish_ledger, read_ledger};

/// The stages of a styled camera's frame, in their order.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ComicsStage {
    /// The engine's depth prepass, asked for by this crate or by the game.
    DepthPrepass,
    /// The engine's normal prepass.
    NormalPrepass,
    /// The ids of the objects.
    ObjectIds,
    /// The min/max reduction of the depth.
    DepthRange,
    /// The step that keeps the range from flickering ([`RangeSmoothing`]).
    ///
    /// [`RangeSmoothing`]: crate::RangeSmoothing
    RangeSmoothing,
    /// The copy of the range to the game ([`VisibleDepthRange`]).
    ///
    /// [`VisibleDepthRange`]: crate::VisibleDepthRange
    RangeReadback,
    /// The pass that finds the edges of the outlines.
    OutlineEdges,
    /// The jump flood that carries wide lines.
    LineFlood,
    /// An effect, inside the fused pass, by its name
    /// ([`Effect::NAME`](crate::Effect::NAME)); see also
    /// [`ComicsStage::of`].
    Effect(&'static str),
    /// The fused full-screen pass.
    Stylize,
}

impl ComicsStage {
    /// The stages that are passes of their own, before the fused pass and its
    /// effects, in order.
    pub const SERVICES: &'static [Self] = &[
        Self::DepthPrepass,
        Self::NormalPrepass,
        Self::ObjectIds,
        Self::DepthRange,
        Self::RangeSmoothing,
        Self::RangeReadback,
        Self::OutlineEdges,
        Self::LineFlood,
    ];

    /// The stage's name in reports and files.
    pub fn name(self) -> Cow<'static, str> {
        Cow::Borrowed(match self {
            Self::DepthPrepass => "depth prepass",
            Self::NormalPrepass => "normal prepass",
            Self::ObjectIds => "object ids",
            Self::DepthRange => "depth range",
            Self::RangeSmoothing => "range smoothing",
            Self::RangeReadback => "range readback",
            Self::OutlineEdges => "outline edges",
            Self::LineFlood => "line flood",
            Self::Effect(name) => return Cow::Owned(name.replace('_', " ")),
            Self::Stylize => "stylize",
        })
    }
}

/// What became of a stage in a camera's last frame.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StageOutcome {
    /// It ran.
    Ran,
    /// It ran, in this form: the name of a
    /// [`ReductionMethod`](crate::ReductionMethod).
    RanAs(&'static str),
    /// It was left out.
    LeftOut(LeftOut),
}

/// Why a stage was left out.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LeftOut {
    /// The camera has no component that asks for it.
    NotRequested,
    /// Its settings change nothing (an amount or opacity of zero, Eq. 8).
    Negligible,
    /// No style of this camera reads depth.
    NoDepthStyle,
    /// No style of this camera reads the depth map, only depth itself.
    NoMapStyle,
    /// No outline of this camera needs it.
    NoSuchLines,
    /// The lines are narrow: the fused pass finds them by itself.
    NarrowLines,
    /// The depth map spans fixed distances.
    FixedRange,
    /// The view has no depth prepass.
    NoDepthPrepass,
    /// The view has no normal prepass.
    NoNormalPrepass,
    /// Another effect of this camera draws in its place.
    Replaced,
    /// Its shader has an error, which the log shows: the picture passes
    /// through.
    ShaderError,
    /// No style is left to draw.
    NothingToDraw,
    /// The depth texture belongs to a camera with another number of samples on
    /// the same target.
    SampleCountMismatch,
    /// The pipeline is still compiling, or its shader has an error: the picture
    /// passes through.
    PipelineNotReady,
    /// The last copies are still on their way.
    Busy,
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotRequested => "not requested",
            Self::Negligible => "its settings change nothing",
            Self::NoDepthStyle => "no style reads depth",
            Self::NoMapStyle => "no style reads the depth map",
            Self::NoSuchLines => "no outline needs it",
            Self::NarrowLines => "the lines are narrow",
            Self::FixedRange => "the range is fixed",
            Self::NoDepthPrepass => "the view has no depth prepass",
            Self::NoNormalPrepass => "the view has no normal prepass",
            Self::Replaced => "another effect draws in its place",
            Self::ShaderError => "its shader has an error",
            Self::NothingToDraw => "no style to draw",
            Self::SampleCountMismatch => "the depth has another number of samples",
            Self::PipelineNotReady => "the pipeline is not ready",
            Self::Busy => "earlier copies are still on their way",
        })
    }
}

/// What ran for one camera.
#[derive(Reflect, Clone, Debug, Default, PartialEq, Eq)]
pub struct CameraStages {
    /// Every stage with its outcome, in order.
    pub stages: Vec<(ComicsStage, StageOutcome)>,
    /// A pipeline of the camera's look is still being compiled: meanwhile the
    /// last look is drawn, or none where there is no last one.
    pub compiling: bool,
    /// The newest plan of the main world that was drawn as it was asked for.
    #[reflect(ignore)]
    pub(crate) drawn: Option<u64>,
}

impl CameraStages {
    /// The outcome of a stage; `None` if the camera was not looked at yet.
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
            Some(StageOutcome::Ran | StageOutcome::RanAs(_))
        )
    }

    pub(crate) fn set(&mut self, stage: ComicsStage, outcome: StageOutcome) {
        match self.stages.iter_mut().find(|(s, _)| *s == stage) {
            Some((_, old)) => *old = outcome,
            None => self.stages.push((stage, outcome)),
        }
    }
}

/// Per camera, which stages ran in its last rendered frame and which were left
/// out, and why. A camera without comics components is not listed: nothing is
/// done for it at all.
#[derive(Resource, Reflect, Clone, Debug, Default)]
#[reflect(Resource, Default)]
pub struct ComicsDiagnostics {
    /// By camera entity.
    pub cameras: EntityHashMap<CameraStages>,
}

impl ComicsDiagnostics {
    /// Whether a camera waits for a pipeline of its look.
    pub fn is_compiling(&self, camera: Entity) -> bool {
        self.cameras
            .get(&camera)
            .is_some_and(|stages| stages.compiling)
    }

    /// Whether a stage ran for a camera.
    pub fn ran(&self, camera: Entity, stage: ComicsStage) -> bool {
        self.cameras
            .get(&camera)
            .is_some_and(|stages| stages.ran(stage))
    }
}
