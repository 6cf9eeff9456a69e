//! Decides, by counts of missing ids, whether ids are drawn with a tolerance.
//!
//! A pixel can be covered and rightly have no id: other crates draw into the depth prepass, and
//! a camera can keep the depth of another one. Such pixels cannot be told from those that the
//! test for equal depth lost, and no threshold separates the two. So a suspicion is tried out:
//! ids are drawn with a tolerance for a few frames, and the tolerance stays only if there are
//! clearly fewer pixels without an id. A needless trial does not show, because a tolerance gives
//! the same ids.

use bevy::ecs::entity::Entity;

/// What was counted of a view in one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Reading {
    pub camera: Entity,
    /// Counted pixels that the depth prepass covers.
    pub covered: u32,
    /// Those of them that have no id.
    pub missing: u32,
    /// Whether the ids were drawn with a tolerance.
    pub tolerant: bool,
}

impl Reading {
    /// The fraction of the covered pixels that have no id.
    fn fraction(&self) -> f32 {
        self.missing as f32 / self.covered.max(1) as f32
    }
}

/// The smallest suspicious fraction of covered pixels, and number of counted pixels, without an
/// id. A device whose positions differ loses whole triangles.
const LEAST_FRACTION: f32 = 0.01;
const LEAST_PIXELS: u32 = 8;
/// Suspicious counts of a camera in a row before a trial, and counts in a trial.
const COUNTS: u32 = 3;
/// A trial succeeds if this fraction of the pixels without an id is left, at most. Not half: some
/// of them may rightly have none.
const LEFT: f32 = 0.75;
/// Frames in which ids are counted often, and the frames from one count to the next during them
/// and after them.
const FIRST_FRAMES: u32 = 64;
const FIRST_PERIOD: u32 = 4;
const PERIOD: u32 = 64;
/// Frames after which a suspicion without a result ends: pipelines may take long.
const PATIENCE: u32 = 600;
/// Frames after which a trial without a result ends: its camera is gone, since ids are counted in
/// every frame of a trial.
const TRIAL: u32 = 60;

/// A camera with missing ids.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Suspect {
    camera: Entity,
    /// Suspicious counts in a row.
    counts: u32,
    /// The fraction of the last count.
    fraction: f32,
    /// The frame in which the stage began.
    since: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Ids are drawn at equal depth.
    Watching(Option<Suspect>),
    /// The same, while the pipelines of a trial compile.
    Compiling(Suspect),
    /// Ids are drawn with a tolerance. The sum of the fractions of the counts so far, and how
    /// many there are.
    Trying(Suspect, f32, u32),
    /// The trial has succeeded.
    Tolerant,
}

/// The history of the counts of all views.
#[derive(Debug)]
pub(super) struct Watch {
    stage: Stage,
    frame: u32,
    /// The largest fraction that a tolerance did not change. Only more than twice that is
    /// suspicious, so at most seven trials fail in an app.
    explained: f32,
}

impl Default for Watch {
    fn default() -> Self {
        Self {
            stage: Stage::Watching(None),
            frame: 0,
            explained: 0.0,
        }
    }
}

impl Watch {
    pub fn tolerant(&self) -> bool {
        matches!(self.stage, Stage::Trying(..) | Stage::Tolerant)
    }

    pub fn compiles(&self) -> bool {
        matches!(self.stage, Stage::Compiling(_))
    }

    pub fn watches(&self) -> bool {
        self.stage != Stage::Tolerant
    }

    /// Whether ids are counted in this frame.
    pub fn counts(&self) -> bool {
        match self.stage {
            Stage::Tolerant => false,
            Stage::Watching(None) if self.frame < FIRST_FRAMES => {
                self.frame.is_multiple_of(FIRST_PERIOD)
            }
            Stage::Watching(None) => self.frame.is_multiple_of(PERIOD),
            _ => true,
        }
    }

    /// Begins a frame. `ready`: the pipelines of a trial are compiled. If a trial has succeeded,
    /// returns the fraction of the covered pixels that had no id.
    pub fn advance(&mut self, readings: Vec<Reading>, ready: bool) -> Option<f32> {
        self.frame = self.frame.wrapping_add(1);
        for reading in &readings {
            self.read(reading);
        }
        let frame = self.frame;
        let age = |suspect: &Suspect| frame.wrapping_sub(suspect.since);
        let now = |suspect: Suspect| Suspect {
            since: frame,
            ..suspect
        };
        let mut success = None;
        self.stage = match self.stage {
            Stage::Watching(Some(suspect)) if suspect.counts >= COUNTS => {
                Stage::Compiling(now(suspect))
            }
            Stage::Compiling(suspect) if ready => Stage::Trying(now(suspect), 0.0, 0),
            Stage::Trying(suspect, sum, counts) if counts >= COUNTS => {
                if sum / counts as f32 <= LEFT * suspect.fraction {
                    success = Some(suspect.fraction);
                    Stage::Tolerant
                } else {
                    self.explained = self.explained.max(suspect.fraction);
                    Stage::Watching(None)
                }
            }
            Stage::Watching(Some(suspect)) | Stage::Compiling(suspect)
                if age(&suspect) > PATIENCE =>
            {
                Stage::Watching(None)
            }
            Stage::Trying(suspect, ..) if age(&suspect) > TRIAL => Stage::Watching(None),
            stage => stage,
        };
        success
    }

    fn read(&mut self, reading: &Reading) {
        let fraction = reading.fraction();
        let suspicious =
            reading.missing >= LEAST_PIXELS && fraction > LEAST_FRACTION.max(2.0 * self.explained);
        let own = |suspect: &Suspect| suspect.camera == reading.camera;
        self.stage = match self.stage {
            Stage::Watching(None) if suspicious && !reading.tolerant => {
                Stage::Watching(Some(Suspect {
                    camera: reading.camera,
                    counts: 1,
                    fraction,
                    since: self.frame,
                }))
            }
            Stage::Watching(Some(suspect)) if own(&suspect) && !reading.tolerant => {
                Stage::Watching(suspicious.then_some(Suspect {
                    counts: suspect.counts + 1,
                    fraction,
                    ..suspect
                }))
            }
            // A trial is compared with the last count before it.
            Stage::Compiling(suspect) if own(&suspect) && !reading.tolerant => {
                if suspicious {
                    Stage::Compiling(Suspect {
                        fraction,
                        ..suspect
                    })
                } else {
                    Stage::Watching(None)
                }
            }
            Stage::Trying(suspect, sum, counts) if own(&suspect) && reading.tolerant => {
                Stage::Trying(suspect, sum + fraction, counts + 1)
            }
            stage => stage,
        };
    }
}

#[cfg(test)]
mod tests;
