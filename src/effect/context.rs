//! What an effect is told about the view that it is drawn on.

use bevy::math::{DVec3, Mat4, UVec2, UVec4, Vec2, Vec3};

use crate::{clock::animation_seed, lines::Sheet};

/// The view that an effect is drawn on, for the choice of its shader variants and for its uniform.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EffectContext {
    /// The viewport in physical pixels: x and y of its top left corner in the
    /// render target, width, height.
    pub viewport: UVec4,
    /// Width and height of the render target in physical pixels.
    pub target_size: UVec2,
    /// Physical pixels per unit of the lengths of settings: per logical pixel, or per page pixel if
    /// the camera has a [`PageHeight`](crate::style::PageHeight).
    pub scale_factor: f32,
    /// The camera has a page.
    pub has_page: bool,
    /// World position from normalized device coordinates and the texel of the depth texture.
    pub world_from_clip: Mat4,
    /// Clip space from world space.
    pub clip_from_world: Mat4,
    /// The same as `world_from_clip`, but relative to the eye: exact to a fraction of a pixel also
    /// far from the world's origin.
    pub relative_from_clip: Mat4,
    /// World position of the eye.
    pub eye: Vec3,
    /// True position of the origin of the world that is rendered, in world units; zero without a
    /// [`WorldOrigin`](crate::cameras::WorldOrigin).
    pub world_origin: DVec3,
    /// Unit vector towards the light that lines and strokes follow
    /// ([`KeyLight`](crate::KeyLight)), in world space.
    pub to_light: Vec3,
    /// Number of [`CameraCut`](crate::CameraCut)s of the camera so far.
    pub cuts: u32,
    /// Seconds of the app's default clock ([`Time`](bevy::time::Time)).
    pub seconds: f64,
    /// Where the object that effects point at ([`EffectTarget`](crate::effect::EffectTarget)) is in
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
    /// ([`Effect::line_modifiers`](crate::Effect::line_modifiers)).
    pub sheet: Option<Sheet>,
}

impl Default for EffectContext {
    /// A view of 1280 by 720 physical pixels, at scale factor 1 and time 0, whose world
    /// positions are its normalized device coordinates, with the depth of an infinite perspective
    /// from 0.1 on.
    fn default() -> Self {
        Self {
            viewport: UVec4::new(0, 0, 1280, 720),
            target_size: UVec2::new(1280, 720),
            scale_factor: 1.0,
            has_page: false,
            world_from_clip: Mat4::IDENTITY,
            clip_from_world: Mat4::IDENTITY,
            relative_from_clip: Mat4::IDENTITY,
            eye: Vec3::ZERO,
            world_origin: DVec3::ZERO,
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

impl EffectContext {
    /// Number of the drawing that is shown, as a seed for random numbers: 0 to 65535, then
    /// from 0 again. `rate`: drawings per second; at 0 there is one drawing for all time.
    ///
    /// All effects that use the same rate change in the same frame, and stand still while the
    /// game's clock does.
    pub fn animation_seed(&self, rate: f32) -> u32 {
        animation_seed(self.seconds, rate)
    }

    /// Physical pixels of a cell of a screen, from its size in settings. On a page at least 2.5:
    /// smaller dots become a plain tone.
    pub fn cell_size(&self, size: f32) -> f32 {
        let least = if self.has_page { 2.5 } else { 0.0 };
        (size * self.scale_factor).max(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_on_a_page_can_be_seen() {
        let mut view = EffectContext {
            scale_factor: 0.5,
            ..EffectContext::default()
        };
        assert_eq!([3.0, 8.0].map(|size| view.cell_size(size)), [1.5, 4.0]);
        view.has_page = true;
        assert_eq!([3.0, 8.0].map(|size| view.cell_size(size)), [2.5, 4.0]);
    }
}
