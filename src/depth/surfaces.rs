//! The depth and the normals that effects read: those of the engine's prepass, or copies of
//! them with transparent meshes drawn in.
//!
//! Every pass that reads them gets them here.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::component::Component,
    render::{render_resource::CachedRenderPipelineId, texture::CachedTexture},
};

/// On a view in the render world that draws transparent meshes into its depth: copies of its
/// prepass textures, with these meshes.
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
