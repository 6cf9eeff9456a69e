//! The textures of the scene that lines are found in.

use bevy::render::{
    render_resource::{BindGroupEntry, Buffer, IntoBinding, TextureView},
    texture::CachedTexture,
};

#[cfg(feature = "objects")]
use crate::objects::ViewLayer;
use crate::{
    depth::surfaces::{SurfaceParts, Surfaces},
    diagnostics::SkipReason,
    gpu::entry,
    lines::{find::Resolved, key::LineKey},
    objects::{ObjectDepths, ViewLineWidths, ViewObjectIds},
};

pub(super) const NOT_READY: SkipReason = SkipReason::PipelineNotReady;

/// The textures of the scene that lines are found in.
#[derive(Clone, Copy, Default)]
pub(super) struct Sources<'a> {
    pub depth: Option<&'a CachedTexture>,
    pub normal: Option<&'a TextureView>,
    pub ids: Option<&'a TextureView>,
    pub widths: Option<&'a TextureView>,
    pub motion: Option<&'a TextureView>,
    /// Depths of objects in the depth map.
    pub object_depths: Option<&'a Buffer>,
    /// Depth of the picture, which hides highlighted objects.
    pub picture: Option<&'a TextureView>,
}

impl<'a> Sources<'a> {
    /// The surfaces of the view, the object ids, the widths of lines and the depths of objects.
    pub fn new(
        surfaces: SurfaceParts<'a>,
        (ids, widths, object_depths): (
            Option<&'a ViewObjectIds>,
            Option<&'a ViewLineWidths>,
            Option<&'a ObjectDepths>,
        ),
    ) -> Self {
        let surfaces = Surfaces::from(surfaces);
        Self {
            depth: surfaces.depth(),
            normal: surfaces.normal().map(|normal| &normal.default_view),
            ids: ids.map(|ids| &ids.view),
            widths: widths.map(|widths| &widths.view),
            motion: surfaces.motion().map(|motion| &motion.default_view),
            object_depths: object_depths.map(|depths| &depths.table),
            picture: None,
        }
    }

    /// Those of highlighted objects.
    #[cfg(feature = "objects")]
    pub fn layer(self, layer: &'a ViewLayer) -> Self {
        Self {
            depth: Some(&layer.depth),
            ids: Some(&layer.ids.default_view),
            motion: self.motion,
            picture: self.depth.map(|depth| &depth.default_view),
            ..Default::default()
        }
    }
}

/// Textures with the depth, normal, object and width of lines of every pixel.
pub(super) struct Texels<'a> {
    pub depth: &'a TextureView,
    pub normal: Option<&'a TextureView>,
    pub ids: Option<&'a TextureView>,
    pub widths: Option<&'a TextureView>,
}

impl<'a> From<&'a Resolved> for Texels<'a> {
    fn from(resolved: &'a Resolved) -> Self {
        let view = |texture: &'a CachedTexture| &texture.default_view;
        Self {
            depth: &resolved.depth.default_view,
            normal: resolved.normal.as_ref().map(view),
            ids: resolved.ids.as_ref().map(view),
            widths: resolved.widths.as_ref().map(view),
        }
    }
}

impl<'a> Texels<'a> {
    /// Adds the bindings: the depth, and what else the pass of a part of a key reads.
    pub fn push(
        self,
        key: LineKey,
        entries: &mut Vec<BindGroupEntry<'a>>,
    ) -> Result<(), SkipReason> {
        entries.push(entry(2, self.depth.into_binding()));
        for (flag, binding, texture) in [
            (LineKey::NORMALS, 7, self.normal),
            (LineKey::OBJECT_IDS, 8, self.ids),
            (LineKey::WIDTH_MAP, 9, self.widths),
        ] {
            if key.contains(flag) {
                let texture = texture.ok_or(NOT_READY)?;
                entries.push(entry(binding, texture.into_binding()));
            }
        }
        Ok(())
    }
}
