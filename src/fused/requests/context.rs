//! What effects are told about a view.

use bevy::{
    math::{Mat4, UVec4, Vec4, Vec4Swizzles},
    render::{camera::ExtractedCamera, view::ExtractedView},
};

use crate::{
    effect::{EffectContext, place_in},
    fused::{Plan, ViewPlan},
};

/// What the effects of a view are told about it.
pub(crate) fn effect_context(
    view: &ViewPlan,
    plan: &Plan,
    viewport: UVec4,
    (extracted, camera): (&ExtractedView, &ExtractedCamera),
) -> EffectContext {
    let view_from_world = extracted.world_from_view.to_matrix().inverse();
    let clip_from_world = view.clip_from_view * view_from_world;
    let target = view.target.and_then(|at| {
        let depth = -view_from_world.transform_point3(at).z;
        Some((place_in(viewport, clip_from_world, at)?, depth))
    });
    let context = EffectContext {
        viewport,
        target_size: camera.physical_target_size.unwrap_or(viewport.zw()),
        scale_factor: view.scale_factor,
        has_page: view.has_page,
        world_from_clip: world_from_clip(view, extracted),
        clip_from_world,
        relative_from_clip: relative_from_clip(view, extracted),
        eye: extracted.world_from_view.translation(),
        world_origin: view.origin,
        to_light: view.to_light,
        cuts: view.cuts,
        seconds: view.time,
        target: target.map(|(place, _)| place),
        target_depth: target.map(|(_, depth)| depth).filter(|d| d.is_finite()),
        depth_axis: view.projection.axis(),
        depth_reference: view.projection.reference(&view.clip_from_view),
        lines_implied: plan.lines_implied(),
        sheet: None,
    };
    let sheet = plan.line_modifiers(&context).sheet;
    EffectContext { sheet, ..context }
}

/// World position from normalized device coordinates.
fn world_from_clip(view: &ViewPlan, extracted: &ExtractedView) -> Mat4 {
    or_identity(extracted.world_from_view.to_matrix() * view.clip_from_view.inverse())
}

/// World axes relative to the eye from normalized device coordinates.
fn relative_from_clip(view: &ViewPlan, extracted: &ExtractedView) -> Mat4 {
    let mut world_from_view = extracted.world_from_view.to_matrix();
    world_from_view.w_axis = Vec4::W;
    or_identity(world_from_view * view.clip_from_view.inverse())
}

/// The identity for a projection that has no inverse.
fn or_identity(matrix: Mat4) -> Mat4 {
    if matrix.is_finite() {
        matrix
    } else {
        Mat4::IDENTITY
    }
}
