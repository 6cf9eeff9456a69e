//! The depth and the normals that effects read: those of the engine's prepass, or copies of
//! them with transparent meshes drawn in. With OpenGL, the depth that the engine draws with.
//!
//! Every pass that reads them gets them here.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    prelude::*,
    render::{
        render_resource::{CachedRenderPipelineId, TextureUsages},
        renderer::RenderAdapterInfo,
        texture::CachedTexture,
        view::ViewDepthTexture,
    },
};
use wgpu_types::Backend;

/// On a view in the render world that draws transparent meshes into its depth: copies of its
/// prepass textures, with these meshes. With OpenGL, on all views with a depth prepass: see
/// [`use_drawn_depth`].
#[derive(Component)]
#[cfg_attr(
    not(feature = "objects"),
    allow(dead_code, reason = "only the feature `objects` draws them")
)]
pub(crate) struct OwnSurfaces {
    /// Size, format and samples are those of the depth prepass.
    pub depth: CachedTexture,
    pub normal: Option<OwnNormals>,
    /// Whether the passes of this frame were recorded. Until then, the textures are empty.
    pub drawn: AtomicBool,
}

/// A copy of the normal prepass.
#[cfg_attr(
    not(feature = "objects"),
    allow(dead_code, reason = "only the feature `objects` draws them")
)]
pub(crate) struct OwnNormals {
    pub texture: CachedTexture,
    /// The pipeline that copies the normal prepass.
    pub copy: CachedRenderPipelineId,
}

/// Whether the engine's depth prepass is empty: wgpu 29 does not copy depth textures with OpenGL,
/// and no shader there can load from the depth textures that the engine binds for materials.
pub(crate) fn prepass_is_empty(adapter: &RenderAdapterInfo) -> bool {
    adapter.backend == Backend::Gl
}

/// With OpenGL, effects read the depth that the engine draws with. It holds the same, and opaque
/// meshes that are not in the prepass.
pub(super) fn use_drawn_depth(
    mut commands: Commands,
    adapter: Res<RenderAdapterInfo>,
    views: Query<(Entity, &ViewDepthTexture, Option<&ViewPrepassTextures>)>,
) {
    if !prepass_is_empty(&adapter) {
        return;
    }
    for (view, depth, prepass) in &views {
        let is_read = prepass.is_some_and(|prepass| prepass.depth.is_some())
            && depth
                .texture
                .usage()
                .contains(TextureUsages::TEXTURE_BINDING);
        if is_read {
            commands.entity(view).insert(OwnSurfaces {
                depth: CachedTexture {
                    texture: depth.texture.clone(),
                    default_view: depth.view().clone(),
                },
                normal: None,
                drawn: AtomicBool::new(true),
            });
        } else {
            commands.entity(view).remove::<OwnSurfaces>();
        }
    }
}

/// The textures of a view in which its surfaces are found.
#[derive(Clone, Copy)]
pub(crate) struct Surfaces<'a> {
    prepass: Option<&'a ViewPrepassTextures>,
    own: Option<&'a OwnSurfaces>,
}

/// The components of a view from which [`Surfaces`] are made.
pub(crate) type SurfaceParts<'a> = (Option<&'a ViewPrepassTextures>, Option<&'a OwnSurfaces>);

impl<'a> From<SurfaceParts<'a>> for Surfaces<'a> {
    fn from((prepass, own): SurfaceParts<'a>) -> Self {
        let own = own.filter(|own| own.drawn.load(Ordering::Relaxed));
        Self { prepass, own }
    }
}

impl<'a> Surfaces<'a> {
    /// The depth; `None` without a depth prepass.
    pub fn depth(self) -> Option<&'a CachedTexture> {
        let prepass = self.prepass?.depth.as_ref()?;
        Some(self.own.map_or(&prepass.texture, |own| &own.depth))
    }

    /// The normals; `None` without a normal prepass.
    pub fn normal(self) -> Option<&'a CachedTexture> {
        let prepass = self.prepass?.normal.as_ref()?;
        let own = self.own.and_then(|own| own.normal.as_ref());
        Some(own.map_or(&prepass.texture, |normal| &normal.texture))
    }

    /// The motion vectors, which are always those of the prepass.
    pub fn motion(self) -> Option<&'a CachedTexture> {
        let motion = self.prepass?.motion_vectors.as_ref()?;
        Some(&motion.texture)
    }
}
