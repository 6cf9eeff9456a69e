//! How the render world tells the main world what it did.

use std::sync::{Arc, Mutex, PoisonError};

use bevy::ecs::{
    entity::{Entity, EntityHashMap},
    resource::Resource,
    system::{Res, ResMut},
};

use super::{CameraStages, ComicsDiagnostics, ComicsStage, StageOutcome};

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

    /// The plan of this number is drawn as the main world asked for it.
    pub fn set_drawn(&self, camera: Entity, plan: u64) {
        let mut current = self.current.lock().unwrap_or_else(PoisonError::into_inner);
        current.entry(camera).or_default().drawn = Some(plan);
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
