//! Brings the diagnostics from the render world to the main world.

use std::sync::{Arc, Mutex, PoisonError};

use bevy::{ecs::entity::EntityHashMap, prelude::*};

use super::{CameraStages, ComicsDiagnostics, ComicsStage, StageOutcome};

/// The render world's side of [`ComicsDiagnostics`]. Render systems write through a
/// lock, so that they do not conflict and need no order.
#[derive(Resource, Default)]
pub(crate) struct StageLedger {
    /// The stages of the current frame so far.
    current: Mutex<EntityHashMap<CameraStages>>,
    /// The stages of the last complete frame.
    published: Arc<Mutex<EntityHashMap<CameraStages>>>,
}

impl StageLedger {
    pub fn set(&self, camera: Entity, stage: ComicsStage, outcome: StageOutcome) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        current.entry(camera).or_default().set(stage, outcome);
    }

    /// Records that the plan with this number is drawn as requested.
    pub fn set_drawn(&self, camera: Entity, plan: u64) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        current.entry(camera).or_default().drawn = Some(plan);
    }

    /// Records that a pipeline of the camera's plan is compiling.
    pub fn set_compiling(&self, camera: Entity) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        current.entry(camera).or_default().compiling = true;
    }

    /// A reader of the published stages, for the main world.
    pub fn reader(&self) -> LedgerReader {
        LedgerReader(self.published.clone())
    }
}

/// The main world's side of the ledger.
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
