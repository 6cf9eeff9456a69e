//! Cameras that mirror what they see ([`Camera::invert_culling`]).
//!
//! The engine's prepass does not heed the setting: it draws the back faces of a mirrored view, whose depth is
//! not that of the picture.

use bevy::{
    pbr::{MeshPipelineKey, ViewKeyPrepassCache, check_prepass_views_need_specialization},
    platform::collections::HashSet,
    prelude::*,
    render::{
        Render, RenderApp, RenderSystems,
        camera::DirtySpecializations,
        view::{ExtractedView, RetainedViewEntity},
    },
};

use crate::fused::ViewPlan;

/// Takes the bit away that the engine does not know: it would specialize the view anew in every frame.
fn hide_culling(mut keys: ResMut<ViewKeyPrepassCache>) {
    if keys
        .values()
        .any(|key| key.contains(MeshPipelineKey::INVERT_CULLING))
    {
        for key in keys.values_mut() {
            key.remove(MeshPipelineKey::INVERT_CULLING);
        }
    }
}

/// The materials of a view with this bit cull the other faces.
fn invert_culling(
    views: Query<&ExtractedView, With<ViewPlan>>,
    mut keys: ResMut<ViewKeyPrepassCache>,
    mut dirty: ResMut<DirtySpecializations>,
    mut inverted: Local<HashSet<RetainedViewEntity>>,
) {
    let views = views.iter().filter(|view| view.invert_culling);
    let now: HashSet<_> = views.map(|view| view.retained_view_entity).collect();
    for view in &now {
        if let Some(key) = keys.get_mut(view) {
            key.insert(MeshPipelineKey::INVERT_CULLING);
        }
    }
    dirty.views.extend(now.symmetric_difference(&inverted));
    *inverted = now;
}

/// Adds the systems. Needs the engine's prepass.
pub(super) fn build_render(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app.add_systems(
        Render,
        (
            hide_culling.before(check_prepass_views_need_specialization),
            invert_culling.after(check_prepass_views_need_specialization),
        )
            .in_set(RenderSystems::PrepareAssets)
            .run_if(resource_exists::<ViewKeyPrepassCache>),
    );
}
