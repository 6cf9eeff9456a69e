//! Cameras that share a visible range.

use bevy::prelude::*;

use crate::style::Comic;

/// Gives a camera the smoothed visible range of another one, so that equal distances have the same
/// place in the depth maps of both. For the second eye, the halves of a split screen, a minimap.
/// The camera then does not measure a range of its own.
///
/// If the other camera has a lower [`Camera::order`], the range is that of the same frame,
/// otherwise that of the frame before. It may have a `RangeOf` of its own, in chains of at most 8,
/// without cycles. The other camera must be active and have an effect; if not, in its first frame,
/// and without compute shaders, the camera measures its own range.
///
/// The camera's own [`DepthMap`](crate::DepthMap) says how the range is mapped; its `smoothing` and
/// `locked` have no effect. Equal colors need equal mappings.
/// [`DepthHistogram`](crate::depth::DepthHistogram) and
/// [`VisibleDepthRange`](crate::depth::VisibleDepthRange) of the camera count what it sees itself,
/// and so do [`DepthLayers`](crate::DepthLayers).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Clone, PartialEq)]
pub struct RangeOf(#[entities] pub Entity);

/// Most components in a row.
const LONGEST: usize = 8;

/// The camera at the end of a row; `None` if there is none. `has_range`: whether a camera can lend its range.
pub(super) fn leader(
    camera: EntityRef,
    cameras: &Query<EntityRef, With<Camera3d>>,
    has_range: impl Fn(Entity) -> bool,
) -> Option<Entity> {
    let RangeOf(mut at) = *camera.get()?;
    for _ in 0..LONGEST {
        let Ok(next) = cameras.get(at) else {
            break;
        };
        if let Some(RangeOf(next)) = next.get() {
            at = *next;
            continue;
        }
        if next.get::<Camera>().is_some_and(|camera| camera.is_active) {
            if has_range(at) {
                return Some(at);
            }
            // Its style may still load.
            if next.contains::<Comic>() {
                return None;
            }
        }
        break;
    }
    let camera = camera.id();
    warn_once!(
        "`RangeOf`: {camera} measures its own range: its row does not end with an active camera with \
         effects within {LONGEST} steps, but comes to {at}"
    );
    None
}
