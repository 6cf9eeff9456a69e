//! Viewport, depth texture and depth map of a view, as shaders read them.

use bevy::{prelude::*, render::render_resource::ShaderType};

use super::{DepthFrame, RawDepth};

/// Bytes of `VisibleRange` in `view.wgsl`.
pub(crate) const RANGE_SIZE: u64 = 32;

/// `View` of `view.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ViewUniform {
    pub viewport: IVec4,
    pub depth_scale: Vec2,
    pub flip: u32,
    /// Raw depth from which on the picture may show a `Backdrop`; 0: there is none.
    pub backdrop: f32,
    /// What belongs at a place is drawn by this much before it, in physical pixels of the viewport.
    pub jitter: Vec2,
    /// A surface is in front of another one by this much raw depth: x * that of the other one + y.
    pub nearer: Vec2,
    pub raw: RawDepth,
    pub depth: DepthFrame,
}

impl ViewUniform {
    /// `viewport` is x, y, width, height in physical pixels. `main_pass_size` is the
    /// size of the main pass in pixels, if it differs from the viewport's.
    pub fn new(
        viewport: UVec4,
        main_pass_size: Option<UVec2>,
        flip: bool,
        raw: RawDepth,
        depth: DepthFrame,
    ) -> Self {
        Self {
            viewport: viewport.as_ivec4(),
            depth_scale: depth_scale(viewport, main_pass_size),
            flip: u32::from(flip),
            backdrop: 0.0,
            jitter: Vec2::ZERO,
            nearer: Vec2::ZERO,
            raw,
            depth,
        }
    }
}

/// Pixels of the depth texture per physical pixel of the viewport, 0 to 1.
pub(crate) fn depth_scale(viewport: UVec4, main_pass_size: Option<UVec2>) -> Vec2 {
    let size = viewport.zw().max(UVec2::ONE);
    main_pass_size.map_or(Vec2::ONE, |main| {
        (main.as_vec2() / size.as_vec2()).clamp(Vec2::ZERO, Vec2::ONE)
    })
}

/// The part of the depth texture that the main pass draws: x, y, width, height.
pub(crate) fn depth_rect(viewport: UVec4, main_pass_size: Option<UVec2>) -> UVec4 {
    let size = main_pass_size.map_or(viewport.zw(), |main| main.clamp(UVec2::ONE, viewport.zw()));
    UVec4::new(viewport.x, viewport.y, size.x, size.y)
}
