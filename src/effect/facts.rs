//! The facts about a view that an effect can use.

use bevy::{
    math::{Mat4, UVec2, UVec4, Vec2, Vec3, Vec4, Vec4Swizzles},
    render::{camera::ExtractedCamera, view::ExtractedView},
};

use super::{Plan, ViewPlan, target::place_in};
use crate::{clock::drawing_seed, lines::Sheet};

/// Facts about a view that an effect can use when it selects its shader variants
/// and packs its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ViewFacts {
    /// The viewport in physical pixels: x and y of its top left corner in the
    /// render target, width, height.
    pub viewport: UVec4,
    /// Width and height of the render target in physical pixels.
    pub target_size: UVec2,
    /// Physical pixels per logical pixel.
    pub scale_factor: f32,
    /// World position from normalized device coordinates and the texel of the depth texture.
    pub world_from_clip: Mat4,
    /// Clip space from world space.
    pub clip_from_world: Mat4,
    /// The same as `world_from_clip`, but relative to the eye: exact to a fraction of a pixel also
    /// far from the world's origin.
    pub relative_from_clip: Mat4,
    /// World position of the eye.
    pub eye: Vec3,
    /// Unit vector towards the light that lines and strokes follow
    /// ([`KeyLight`](crate::KeyLight)), in world space.
    pub to_light: Vec3,
    /// Number of [`CameraCut`](crate::CameraCut)s of the camera so far.
    pub cuts: u32,
    /// Seconds of the app's default clock ([`Time`](bevy::time::Time)).
    pub seconds: f64,
    /// Where the object that effects point at ([`EffectTarget`](crate::EffectTarget)) is in
    /// the viewport, in physical pixels from its top left corner; `None` if the camera has
    /// none, or it is behind the camera.
    pub target: Option<Vec2>,
    /// The distance of that object along the view's axis, in world units.
    pub target_depth: Option<f32>,
    /// Two numbers that give the distance along the view's axis at a raw depth d: x / (d + y),
    /// in an orthographic view x + y * d.
    pub depth_axis: Vec2,
    /// In an orthographic view: the distance in world units from which a perspective view of 45
    /// degrees shows the same height.
    pub depth_reference: Option<f32>,
    /// The effect that requests the lines is not on the camera but implied by
    /// another one ([`Effect::implied`](crate::Effect::implied)). Also true if no
    /// effect requests lines.
    pub lines_implied: bool,
    /// The sheet that the view is printed on: that of the first effect in the chain that has one
    /// ([`Effect::sheet`](crate::Effect::sheet)).
    pub sheet: Option<Sheet>,
}

impl Default for ViewFacts {
    /// A view of 1280 by 720 physical pixels, at scale factor 1 and time 0, whose world
    /// positions are its normalized device coordinates, with the depth of an infinite perspective
    /// from 0.1 on.
    fn default() -> Self {
        Self {
            viewport: UVec4::new(0, 0, 1280, 720),
            target_size: UVec2::new(1280, 720),
            scale_factor: 1.0,
            world_from_clip: Mat4::IDENTITY,
            clip_from_world: Mat4::IDENTITY,
            relative_from_clip: Mat4::IDENTITY,
            eye: Vec3::ZERO,
            to_light: Vec3::Y,
            cuts: 0,
            seconds: 0.0,
            target: None,
            target_depth: None,
            depth_axis: Vec2::new(0.1, 0.0),
            depth_reference: None,
            lines_implied: false,
            sheet: None,
        }
    }
}

impl ViewFacts {
    pub(super) fn new(
        view: &ViewPlan,
        plan: &Plan,
        viewport: UVec4,
        (extracted, camera): (&ExtractedView, &ExtractedCamera),
    ) -> Self {
        let view_from_world = extracted.world_from_view.to_matrix().inverse();
        let clip_from_world = view.clip_from_view * view_from_world;
        let target = view.target.and_then(|at| {
            let depth = -view_from_world.transform_point3(at).z;
            Some((place_in(viewport, clip_from_world, at)?, depth))
        });
        let facts = Self {
            viewport,
            target_size: camera.physical_target_size.unwrap_or(viewport.zw()),
            scale_factor: view.scale_factor,
            world_from_clip: world_from_clip(view, extracted),
            clip_from_world,
            relative_from_clip: relative_from_clip(view, extracted),
            eye: extracted.world_from_view.translation(),
            to_light: view.to_light,
            cuts: view.cuts,
            seconds: view.time,
            target: target.map(|(place, _)| place),
            target_depth: target.map(|(_, depth)| depth).filter(|d| d.is_finite()),
            depth_axis: view.projection.axis(),
            depth_reference: view.projection.reference(&view.clip_from_view),
            lines_implied: plan.lines_implied(),
            sheet: None,
        };
        let sheet = plan.drawn().find_map(|effect| effect.any_sheet(&facts));
        Self { sheet, ..facts }
    }

    /// Number of the drawing that is shown, as a seed for random numbers: 0 to 65535, then
    /// from 0 again. `rate`: drawings per second; at 0 there is one drawing for all time.
    ///
    /// What asks for it with the same rate changes in the same frame, and stands still while
    /// the game's clock does.
    pub fn drawing(&self, rate: f32) -> u32 {
        drawing_seed(self.seconds, rate)
    }
}

/// World position from normalized device coordinates; the identity for a projection that
/// has no inverse.
fn world_from_clip(view: &ViewPlan, extracted: &ExtractedView) -> Mat4 {
    let matrix = extracted.world_from_view.to_matrix() * view.clip_from_view.inverse();
    if matrix.is_finite() {
        matrix
    } else {
        Mat4::IDENTITY
    }
}

/// World axes relative to the eye from normalized device coordinates; the identity for a
/// projection that has no inverse.
fn relative_from_clip(view: &ViewPlan, extracted: &ExtractedView) -> Mat4 {
    let mut world_from_view = extracted.world_from_view.to_matrix();
    world_from_view.w_axis = Vec4::W;
    let matrix = world_from_view * view.clip_from_view.inverse();
    if matrix.is_finite() {
        matrix
    } else {
        Mat4::IDENTITY
    }
}
