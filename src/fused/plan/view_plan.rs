//! The plan of a view in the render world.

use std::sync::Arc;

use bevy::{math::DVec3, prelude::*};

use super::Plan;
use crate::{depth::frame::DepthProjection, lines::ViewFog};

/// On a view in the render world: the plan of its camera, and facts about the
/// camera.
#[derive(Component, Clone, Debug)]
pub(crate) struct ViewPlan {
    pub camera: Entity,
    pub plan: Arc<Plan>,
    /// The number of the plan in the main world; it grows with every change.
    pub number: u64,
    pub projection: DepthProjection,
    pub clip_from_view: Mat4,
    /// True position of the origin of the world that is rendered.
    pub origin: DVec3,
    /// Physical pixels per unit of length, see `LengthScale`.
    pub scale_factor: f32,
    /// The unit is a page pixel.
    pub has_page: bool,
    /// The largest line width that an object overrides, in units of length.
    pub widest_object: f32,
    /// Unit vector towards the light that lines follow, in world space.
    pub to_light: Vec3,
    /// The engine's distance fog of the camera.
    pub fog: Option<ViewFog>,
    /// World position of the object that effects point at.
    pub target: Option<Vec3>,
    /// A distance in world units below which there is no `Backdrop`, if the plan needs it and there are any.
    pub backdrop: Option<f32>,
    /// Seconds of the app's default clock.
    pub time: f64,
    /// Real time since the last frame, in seconds. Not the game's time: the camera
    /// of a paused game can still move.
    pub seconds: f32,
    /// Number of camera cuts so far.
    pub cuts: u32,
}
