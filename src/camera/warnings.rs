//! Warnings about cameras, each logged once.

use bevy::{
    camera::{CameraOutputMode, RenderTarget},
    prelude::*,
};

use super::CameraPlan;
use crate::{
    effect::EffectRegistry,
    fused::Plan,
    lines::{LineFog, has_fog},
    objects::ObjectChanges,
};

/// Warns about cameras with effects that this crate cannot draw on.
pub(super) fn warn_unsupported(
    flat: Query<EntityRef, With<Camera2d>>,
    targets: Query<(Entity, &RenderTarget), With<CameraPlan>>,
    registry: Res<EffectRegistry>,
) {
    let types = registry.types();
    for camera in &flat {
        if Plan::new(camera, &[], &types, ObjectChanges::default()).is_some() {
            warn_once!(
                "{} is a Camera2d: its effects are not drawn, they need a Camera3d",
                camera.id()
            );
        }
    }
    for (camera, target) in &targets {
        if matches!(target, RenderTarget::None { .. }) {
            warn_once!("{camera} has no color target: its effects are not drawn");
        }
    }
}

/// Components of the engine's crate of post-processing, which this crate does not depend on.
const LENS_DISTORTION: &str = "bevy_post_process::effect_stack::lens_distortion::LensDistortion";
const OPAQUE: [&str; 4] = [
    LENS_DISTORTION,
    "bevy_post_process::effect_stack::chromatic_aberration::ChromaticAberration",
    "bevy_post_process::effect_stack::vignette::Vignette",
    "bevy_post_process::dof::DepthOfField",
];
const FOGS: [&str; 2] = [
    "bevy_light::volumetric::VolumetricFog",
    "bevy_pbr::atmosphere::AtmosphereSettings",
];

/// Warns about components of the engine that do not go together with a camera's effects.
pub(super) fn warn_of_pairs(
    cameras: Query<EntityRef, With<CameraPlan>>,
    types: Option<Res<AppTypeRegistry>>,
) {
    let Some(types) = types.filter(|_| !cameras.is_empty()) else {
        return;
    };
    let types = types.read();
    for camera in &cameras {
        let has = |path: &&str| {
            let registration = types.get_with_type_path(path);
            registration.is_some_and(|known| camera.contains_type_id(known.type_id()))
        };
        let (id, plan) = (camera.id(), camera.get::<CameraPlan>());
        let lines = plan.and_then(|plan| plan.plan.lines);
        if lines.is_some() && has(&LENS_DISTORTION) {
            warn_once!(
                "`LensDistortion` on {id} bends the picture before lines are drawn: put it on an empty second camera"
            );
        }
        if is_overlay(camera) && OPAQUE.iter().any(has) {
            warn_once!("a full-screen effect of Bevy makes the picture of the overlay {id} opaque");
        }
        let fades = lines.is_some_and(|lines| lines.fog == LineFog::Fade);
        if fades && !has_fog(camera) && FOGS.iter().any(has) {
            warn_once!(
                "lines of {id} do not fade in its fog: `Outlines::fog` can be `LineFog::Visibility`"
            );
        }
    }
}

/// Whether a camera blends its picture over another one.
fn is_overlay(camera: EntityRef) -> bool {
    let clears = |camera: &Camera| match camera.clear_color {
        ClearColorConfig::Custom(color) => color.alpha() == 0.0,
        _ => false,
    };
    let blends = |camera: &Camera| {
        matches!(
            camera.output_mode,
            CameraOutputMode::Write {
                blend_state: Some(_),
                ..
            }
        )
    };
    camera
        .get::<Camera>()
        .is_some_and(|camera| clears(camera) && blends(camera))
}
