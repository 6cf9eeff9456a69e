//! Undo and redo of everything that the panel edits.

use std::any::TypeId;

use bevy::{asset::UntypedAssetId, prelude::*};

use bevy_comics::ComicStyle;

/// The largest number of steps of each camera, and of all objects together, that can be
/// undone.
const DEPTH: usize = 256;

/// What a step changes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Subject {
    /// The style of a camera.
    Style(Entity),
    /// A component of an object.
    Part(Entity, TypeId),
    /// An asset.
    Asset(UntypedAssetId),
}

/// A value that was replaced, of something else than a camera.
pub trait Exchange: Send + Sync {
    fn subject(&self) -> Subject;

    /// Puts the value in its place. Returns what was there, which takes that back; `None` if
    /// the place is gone.
    fn exchange(self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>>;
}

/// A step: what was there before it.
#[expect(clippy::large_enum_variant, reason = "most steps are styles")]
pub enum Step {
    /// The style of a camera.
    Style(Entity, ComicStyle),
    /// A value of an object or of its material.
    Object(Box<dyn Exchange>),
}

impl Step {
    pub fn subject(&self) -> Subject {
        match self {
            Self::Style(camera, _) => Subject::Style(*camera),
            Self::Object(value) => value.subject(),
        }
    }

    /// The camera whose style it changes; `None` if it changes an object.
    fn camera(&self) -> Option<Entity> {
        match self {
            Self::Style(camera, _) => Some(*camera),
            Self::Object(_) => None,
        }
    }

    /// Whether undo and redo take it while a camera is shown: its own steps, and those of
    /// objects. Steps that are left out change nothing that the others change.
    fn is_of(&self, shown: Entity) -> bool {
        self.camera().is_none_or(|camera| camera == shown)
    }
}

/// Which way a step is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Undo,
    Redo,
}

/// The steps that were taken, and those that were undone, in order.
#[derive(Default)]
pub struct History {
    undo: Vec<Step>,
    redo: Vec<Step>,
    /// The gesture of the last step, and what it changed.
    gesture: Option<(u64, Subject)>,
}

impl History {
    /// Records a step while a camera is shown. All changes of one subject in one gesture,
    /// such as a drag, are one step.
    pub fn record(&mut self, step: Step, shown: Entity, gesture: Option<u64>) {
        self.redo.retain(|undone| !undone.is_of(shown));
        let gesture = gesture.map(|gesture| (gesture, step.subject()));
        if gesture.is_some() && self.gesture == gesture {
            return;
        }
        self.gesture = gesture;
        let camera = step.camera();
        let is_alike = |other: &Step| other.camera() == camera;
        if self.undo.iter().filter(|step| is_alike(step)).count() == DEPTH
            && let Some(oldest) = self.undo.iter().position(is_alike)
        {
            self.undo.remove(oldest);
        }
        self.undo.push(step);
    }

    /// Takes the last step back, or again. `exchange` puts what the step holds in its place and
    /// returns what was there; steps whose place is gone are dropped. Whether there was one.
    pub fn take(
        &mut self,
        way: Way,
        shown: Entity,
        mut exchange: impl FnMut(Step) -> Option<Step>,
    ) -> bool {
        self.gesture = None;
        let (from, to) = match way {
            Way::Undo => (&mut self.undo, &mut self.redo),
            Way::Redo => (&mut self.redo, &mut self.undo),
        };
        while let Some(last) = from.iter().rposition(|step| step.is_of(shown)) {
            if let Some(reverse) = exchange(from.remove(last)) {
                to.push(reverse);
                return true;
            }
        }
        false
    }

    /// Forgets the styles of cameras that do not exist any more.
    pub fn keep_cameras(&mut self, exists: impl Fn(Entity) -> bool) {
        let stays = |step: &Step| step.camera().is_none_or(&exists);
        self.undo.retain(stays);
        self.redo.retain(stays);
    }

    /// The numbers of steps that can be undone and redone while a camera is shown.
    pub fn steps(&self, shown: Entity) -> (usize, usize) {
        let count = |steps: &[Step]| steps.iter().filter(|step| step.is_of(shown)).count();
        (count(&self.undo), count(&self.redo))
    }
}

#[cfg(test)]
mod tests;
