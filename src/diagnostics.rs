//! What ran for each camera, what was left out, and why.

use std::{
    fmt,
    sync::{Arc, Mutex, PoisonError},
};

use bevy::{
    ecs::{
        entity::{Entity, EntityHashMap},
        reflect::ReflectResource,
        resource::Resource,
        system::{Res, ResMut},
    },
    reflect::{Reflect, std_traits::ReflectDefault},
};

use crate::depth::ReductionMethod;

/// The stages of a styled camera's frame, in their order.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ComicsStage {
    /// The engine's depth prepass, asked for by this crate or by the game.
    DepthPrepass,
    /// The engine's normal prepass, which creases need.
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
    /// Tone bands, inside the fused pass.
    ToneBands,
    /// Desaturation, inside the fused pass.
    Desaturation,
    /// Colorization, inside the fused pass.
    Colorization,
    /// Black flats, inside the fused pass.
    BlackFlats,
    /// Contours, inside the fused pass.
    Contours,
    /// Outlines, inside the fused pass.
    Outlines,
    /// The sketch, inside the fused pass.
    Sketch,
    /// The fused full-screen pass.
    Stylize,
}

impl ComicsStage {
    /// Every stage, in order.
    pub const ALL: [Self; 16] = [
        Self::DepthPrepass,
        Self::NormalPrepass,
        Self::ObjectIds,
        Self::DepthRange,
        Self::RangeSmoothing,
        Self::RangeReadback,
        Self::OutlineEdges,
        Self::LineFlood,
        Self::ToneBands,
        Self::Desaturation,
        Self::Colorization,
        Self::BlackFlats,
        Self::Contours,
        Self::Outlines,
        Self::Sketch,
        Self::Stylize,
    ];

    /// The stage's name in reports and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::DepthPrepass => "depth prepass",
            Self::NormalPrepass => "normal prepass",
            Self::ObjectIds => "object ids",
            Self::DepthRange => "depth range",
            Self::RangeSmoothing => "range smoothing",
            Self::RangeReadback => "range readback",
            Self::OutlineEdges => "outline edges",
            Self::LineFlood => "line flood",
            Self::ToneBands => "tone bands",
            Self::Desaturation => "desaturation",
            Self::Colorization => "colorization",
            Self::BlackFlats => "black flats",
            Self::Contours => "contours",
            Self::Outlines => "outlines",
            Self::Sketch => "sketch",
            Self::Stylize => "stylize",
        }
    }
}

/// What became of a stage in a camera's last frame.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StageOutcome {
    /// It ran.
    Ran,
    /// It ran, as this reduction.
    Reduced(ReductionMethod),
    /// It was left out.
    LeftOut(LeftOut),
}

/// Why a stage was left out.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
            Some(StageOutcome::Ran | StageOutcome::Reduced(_))
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

/// The render world's side of [`ComicsDiagnostics`]. Render systems write it
/// through a lock, so that it gives them no order that they do not need.
#[derive(Resource, Default)]
pub(crate) struct StageLedger {
    /// What the current frame has done so far.
    current: Mutex<EntityHashMap<CameraStages>>,
    published: Arc<Mutex<EntityHashMap<CameraStages>>>,
}

impl StageLedger {
    pub fn set(&self, camera: Entity, stage: ComicsStage, outcome: StageOutcome) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        current.entry(camera).or_default().set(stage, outcome);
    }

    pub fn set_compiling(&self, camera: Entity) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        current.entry(camera).or_default().compiling = true;
    }

    /// A ledger that shares what is published with this one.
    pub fn reader(&self) -> LedgerReader {
        LedgerReader(self.published.clone())
    }
}

/// The main world's end of the ledger.
#[derive(Resource)]
pub(crate) struct LedgerReader(Arc<Mutex<EntityHashMap<CameraStages>>>);

pub(crate) fn publish_ledger(ledger: Res<StageLedger>) {
    let current = std::mem::take(
        &mut *ledger
            .current
            .lock()
            .unwrap_or_else(PoisonError::into_inner),
    );
    *ledger
        .published
        .lock()
        .unwrap_or_else(PoisonError::into_inner) = current;
}

pub(crate) fn read_ledger(reader: Res<LedgerReader>, mut diagnostics: ResMut<ComicsDiagnostics>) {
    let published = reader.0.lock().unwrap_or_else(PoisonError::into_inner);
    if diagnostics.cameras != *published {
        diagnostics.cameras.clone_from(&published);
    }
}
