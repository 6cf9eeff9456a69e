//! Cameras that draw to the picture of others.

use bevy::{
    camera::{Camera3dDepthLoadOp, NormalizedRenderTarget, RenderTarget},
    prelude::*,
};

use crate::{
    composite::{OwnPixels, StyleMask},
    fused::Plan,
};

/// Where an active camera with effects draws.
pub(super) struct Styled {
    camera: Entity,
    order: isize,
    target: NormalizedRenderTarget,
    viewport: URect,
}

impl Styled {
    /// `None` for a camera that draws nowhere.
    pub fn new(camera: EntityRef, primary_window: Option<Entity>) -> Option<Self> {
        let settings = camera.get::<Camera>().filter(|camera| camera.is_active)?;
        Some(Self {
            camera: camera.id(),
            order: settings.order,
            target: camera.get::<RenderTarget>()?.normalize(primary_window)?,
            viewport: settings.physical_viewport_rect()?,
        })
    }

    fn is_before(&self, other: &Self) -> bool {
        self.camera != other.camera
            && self.order < other.order
            && self.target == other.target
            && !self.viewport.intersect(other.viewport).is_empty()
    }
}

/// The pixels that the effects of a camera change; `None` for all. `styled`: the cameras with
/// effects.
pub(super) fn own_pixels(camera: EntityRef, plan: &Plan, styled: &[Styled]) -> Option<OwnPixels> {
    let masks = match camera.get().copied().unwrap_or_default() {
        StyleMask::Picture => {
            if shares_a_comic(camera, styled) {
                let camera = camera.id();
                warn_once!("`StyleMask::Picture`: {camera} changes the comic of another camera");
            }
            false
        }
        StyleMask::Own => true,
        StyleMask::Auto => shares_a_comic(camera, styled),
    };
    let loads = camera
        .get::<Camera3d>()
        .is_some_and(|camera| matches!(camera.depth_load_op, Camera3dDepthLoadOp::Load));
    masks.then_some(if loads && plan.has_ids() {
        OwnPixels::Ids
    } else {
        OwnPixels::Depth
    })
}

/// Whether a camera draws into the picture of another one that has effects.
fn shares_a_comic(camera: EntityRef, styled: &[Styled]) -> bool {
    let settings = camera.get::<Camera>();
    let clears =
        settings.is_none_or(|camera| !matches!(camera.clear_color, ClearColorConfig::None));
    let this = styled.iter().find(|this| this.camera == camera.id());
    !clears && this.is_some_and(|this| styled.iter().any(|other| other.is_before(this)))
}
