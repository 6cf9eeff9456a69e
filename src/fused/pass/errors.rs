//! Finds the effect whose shader keeps the fused pass from compiling.

use crate::effect::{AnyEffect, EffectType};
use std::sync::{Mutex, PoisonError};

use bevy::{
    ecs::resource::Resource,
    log::error,
    platform::collections::HashSet,
    render::render_resource::{CachedPipelineState, PipelineCache},
    shader::ShaderCacheError,
};
use naga_oil::compose::{Composer, ErrSource};

use super::prepare::FusedRequest;
use crate::diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome};

/// Names of the effects whose shader errors were logged, so that each is logged
/// once.
#[derive(Resource, Default)]
pub(crate) struct ShaderErrors(Mutex<HashSet<&'static str>>);

impl ShaderErrors {
    /// If a pipeline is missing because the shader of an effect has an error,
    /// reports the effect in the diagnostics, and once in the log.
    pub fn report(&self, cache: &PipelineCache, request: &FusedRequest, ledger: &StageLedger) {
        let states = request
            .pipelines()
            .map(|id| cache.get_render_pipeline_state(id));
        let failures = states.filter_map(|state| match state {
            CachedPipelineState::Err(failure) => Some(failure),
            _ => None,
        });
        let Some(failure) = failures.into_iter().next() else {
            return;
        };
        let effects = request.plan.drawn().map(AnyEffect::effect_type);
        let Some((effect, message)) = failed_effect(failure, effects) else {
            return;
        };
        let outcome = StageOutcome::Skipped(SkipReason::ShaderError);
        ledger.set(request.camera, ComicsStage::Effect(effect.name), outcome);
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if known.insert(effect.name) {
            error!(
                "the shader of the effect `{}` ({}) has an error, so cameras with it draw no effects: {message}",
                effect.name, effect.shader.path
            );
        }
    }
}

/// The effect whose module caused an error, and the error message.
fn failed_effect(
    failure: &ShaderCacheError,
    mut effects: impl Iterator<Item = &'static EffectType>,
) -> Option<(&'static EffectType, String)> {
    match failure {
        ShaderCacheError::ProcessShaderError(error) => {
            let message = error.inner.to_string();
            let place = match &error.source {
                ErrSource::Module { name, .. } => name,
                ErrSource::Constructing { path, .. } => path,
            };
            let effect = effects.find(|effect| {
                place == effect.shader.path
                    || *place == file_path(effect)
                    || message.contains(&decorated(effect))
            })?;
            Some((effect, message))
        }
        ShaderCacheError::CreateShaderModule(message) => {
            let effect = effects.find(|effect| message.contains(&decorated(effect)))?;
            Some((effect, message.clone()))
        }
        _ => None,
    }
}

/// The asset path of an effect's module, which the composer's error messages show.
pub(crate) fn file_path(effect: &EffectType) -> String {
    format!("effect `{}`: {}", effect.name, effect.shader.path)
}

/// The suffix that the composer adds to every name of an effect's module.
fn decorated(effect: &EffectType) -> String {
    Composer::decorated_name(Some(effect.shader.path), "")
}
