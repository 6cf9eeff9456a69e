//! The request for the depths of objects in the depth map.

use crate::effect::{EffectContext, Needs};
use bevy::{math::Vec2, render::view::ExtractedView};

use super::{Plan, ViewPlan};
use crate::{
    depth::{ProjectionKind, view::ViewUniform},
    objects::{ObjectDepthRequest, ObjectEye},
};

/// What the effects of a plan ask for that treat objects as a whole.
pub(super) fn object_depths(
    (plan, view): (&Plan, &ViewPlan),
    context: &EffectContext,
    uniform: ViewUniform,
    extracted: &ExtractedView,
) -> Option<ObjectDepthRequest> {
    let wanted = plan.draws() && plan.needs().contains(Needs::OBJECT_DEPTHS);
    wanted.then(|| ObjectDepthRequest {
        eye: ObjectEye {
            position: context.eye,
            orthographic: u32::from(view.projection.kind() == ProjectionKind::Orthographic),
            forward: *extracted.world_from_view.forward(),
            resets: 0,
            axis: context.depth_axis,
            spare: Vec2::ZERO,
            view: uniform,
        },
        mapping: plan.depth_map.mapping,
        cuts: view.cuts,
    })
}
