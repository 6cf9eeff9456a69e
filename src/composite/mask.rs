//! Which pixels the effects of a camera change.

use bevy::prelude::*;

/// On a camera that draws over the picture of another camera: which pixels its effects change.
///
/// Cameras with the same target, `Hdr` and `Msaa` draw to the same textures. Without a mask, the
/// effects of the second camera would change the comic of the first one again.
///
/// Lines are not masked, because half of a line lies outside its object. Effects that change all
/// pixels are: tones, colors, prints and paper.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub enum StyleMask {
    /// As [`Own`](Self::Own), if the camera clears no color ([`ClearColorConfig::None`]) and draws
    /// over an active camera of lower order that has effects; otherwise as
    /// [`Picture`](Self::Picture).
    #[default]
    Auto,
    /// The whole picture.
    Picture,
    /// The pixels where this camera draws geometry that is in its depth prepass. Transparent meshes
    /// count if they have the component `DepthWrite`. With [`Camera3dDepthLoadOp::Load`], object ids
    /// tell what this camera has drawn; without them, as with OpenGL, all geometry counts.
    ///
    /// [`Camera3dDepthLoadOp::Load`]: bevy::camera::Camera3dDepthLoadOp::Load
    Own,
}

/// What a camera's effects do where the picture shows something that writes depth, but is not in the
/// depth prepass: gizmos, opaque particles, materials without a prepass.
///
/// All but the default read the depth of the main pass, once for each sample. They do nothing with
/// OpenGL, whose prepass is that depth.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Component, Default, Clone, PartialEq, Hash)]
pub enum BeyondPrepass {
    /// Effects change its pixels as they do others, and lines of the surfaces behind are drawn over
    /// it.
    #[default]
    Styled,
    /// No lines are drawn over it.
    NoLines,
    /// No effect changes its pixels.
    Plain,
}

/// The binding of the depth that the main pass has drawn, see `mask.wgsl`.
pub(crate) const DRAWN_DEPTH_BINDING: u32 = 33;

/// How the pixels are found that a camera has drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum OwnPixels {
    /// They have a depth.
    Depth,
    /// They have an object id.
    Ids,
}
