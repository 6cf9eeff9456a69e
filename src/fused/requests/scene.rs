//! The inputs that a view provides.

use std::sync::Arc;

use bevy::{
    camera::MainPassResolutionOverride,
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::entity::Entity,
    math::{UVec2, UVec4, Vec2, Vec3},
    render::{
        camera::TemporalJitter,
        render_resource::TextureUsages,
        view::{ExtractedView, ViewDepthTexture},
    },
};

use crate::{
    composite::BeyondPrepass,
    depth::view::depth_rect,
    fused::{Plan, plan::missing::Input},
    objects::QueuedDepth,
};

/// The inputs that a view provides.
#[derive(Clone, Copy)]
pub(crate) struct Scene {
    pub viewport: UVec4,
    /// Unit vector to the right of the camera, in world space; to the left of a mirrored one.
    pub right: Vec3,
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
    /// The depth of the main pass can be read.
    pub drawn_depth: bool,
    /// Transparent meshes are drawn with their ids.
    pub ids_queued: bool,
    /// The camera whose visible range the view takes, if that has one.
    pub leader: Option<Entity>,
}

/// The textures of a view, and what is drawn into copies of them.
pub(crate) type SceneTextures<'a> = (
    Option<&'a ViewPrepassTextures>,
    Option<&'a ViewDepthTexture>,
    Option<&'a QueuedDepth>,
);

/// Whether shaders can read the depth of the main pass.
fn can_be_read(depth: &ViewDepthTexture) -> bool {
    let usage = depth.texture.usage();
    usage.contains(TextureUsages::TEXTURE_BINDING)
}

impl Scene {
    pub fn new(
        extracted: &ExtractedView,
        (prepass, drawn, queued): SceneTextures,
        // The engine sets both in the render world.
        (resolution, jitter): (Option<&MainPassResolutionOverride>, Option<&TemporalJitter>),
    ) -> Self {
        let depth = prepass.and_then(|textures| textures.depth.as_ref());
        let camera = &extracted.world_from_view;
        Self {
            viewport: extracted.viewport,
            right: camera.up().cross(*camera.back()),
            main_pass_size: resolution.map(|resolution| resolution.0),
            jitter: jitter.map(|jitter| jitter.offset),
            depth: depth.map(|depth| {
                let texture = &depth.texture.texture;
                let size = UVec2::new(texture.width(), texture.height());
                (size, texture.sample_count())
            }),
            normals: prepass.is_some_and(|textures| textures.normal.is_some()),
            motion: prepass.is_some_and(|textures| textures.motion_vectors.is_some()),
            drawn_depth: drawn.is_some_and(can_be_read),
            ids_queued: queued.is_some_and(|queued| queued.ids),
            leader: None,
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
        if !self.drawn_depth && reduced.beyond != BeyondPrepass::Styled {
            Arc::make_mut(&mut reduced).beyond = BeyondPrepass::Styled;
        }
        reduced
    }
}
