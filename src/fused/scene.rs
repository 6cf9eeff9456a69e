//! The inputs that a view provides.

use std::sync::Arc;

use bevy::{
    camera::MainPassResolutionOverride,
    core_pipeline::prepass::ViewPrepassTextures,
    math::{UVec2, UVec4, Vec2},
    render::{camera::TemporalJitter, view::ExtractedView},
};

use super::{Plan, missing::Input};
use crate::{depth::view::depth_rect, objects::QueuedDepth};

/// The inputs that a view provides.
#[derive(Clone, Copy)]
pub(super) struct Scene {
    pub viewport: UVec4,
    /// Size of the main pass in pixels, if it differs from the viewport.
    pub main_pass_size: Option<UVec2>,
    /// By how much the engine has moved the main pass in this frame, in its pixels,
    /// under temporal anti-aliasing.
    pub jitter: Option<Vec2>,
    /// Size in pixels and samples per pixel of the depth prepass, if there is one.
    pub depth: Option<(UVec2, u32)>,
    pub normals: bool,
    /// The engine draws motion vectors.
    pub motion: bool,
    /// Transparent meshes are drawn with their ids.
    pub ids_queued: bool,
}

impl Scene {
    pub fn new(
        extracted: &ExtractedView,
        (prepass, queued): (Option<&ViewPrepassTextures>, Option<&QueuedDepth>),
        // The engine sets both in the render world.
        (resolution, jitter): (Option<&MainPassResolutionOverride>, Option<&TemporalJitter>),
    ) -> Self {
        let depth = prepass.and_then(|textures| textures.depth.as_ref());
        Self {
            viewport: extracted.viewport,
            main_pass_size: resolution.map(|resolution| resolution.0),
            jitter: jitter.map(|jitter| jitter.offset),
            depth: depth.map(|depth| {
                let texture = &depth.texture.texture;
                let size = UVec2::new(texture.width(), texture.height());
                (size, texture.sample_count())
            }),
            normals: prepass.is_some_and(|textures| textures.normal.is_some()),
            motion: prepass.is_some_and(|textures| textures.motion_vectors.is_some()),
            ids_queued: queued.is_some_and(|queued| queued.ids),
        }
    }

    /// The part of the depth texture that the main pass draws: x, y, width, height.
    pub fn drawn(&self) -> UVec4 {
        depth_rect(self.viewport, self.main_pass_size)
    }

    /// The plan without the effects whose inputs this view does not provide.
    pub fn reduce(&self, plan: &Arc<Plan>) -> Arc<Plan> {
        let mut reduced = plan.clone();
        // With OpenGL, no multisampled texture can be read.
        let unreadable =
            plan.lacks.depth_copies && self.depth.is_some_and(|(_, samples)| samples > 1);
        if (self.depth.is_none() || unreadable) && reduced.needs_depth() {
            reduced = Arc::new(reduced.without(Input::DepthPrepass));
        }
        if (!self.normals || unreadable) && reduced.needs_normals() {
            reduced = Arc::new(reduced.without(Input::NormalPrepass));
        }
        reduced
    }
}
