//! How lines fade with the distance from another one.

use bevy::{math::Vec2, render::render_resource::ShaderType};

/// Lines become thinner and fainter the farther their surface is from a distance.
///
/// Distances are along the view's axis. In perspective they are compared by their ratio, in an
/// orthographic view by their difference, as a fraction of
/// [`EffectContext::depth_reference`](crate::effect::EffectContext::depth_reference).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFade {
    /// The distance at which lines are whole, in world units; `None`: that in the middle of the view,
    /// which is smoothed if the effect needs
    /// [`Needs::MIDDLE_DEPTH`](crate::effect::Needs::MIDDLE_DEPTH).
    pub distance: Option<f32>,
    /// How far from there lines are whole: natural logarithm of the ratio, or the fraction.
    pub clear: f32,
    /// How far behind that the least is left of them; as `clear`, above 0.
    pub ramp: f32,
    /// The fraction of their width and opacity that they lose there, 0 to 1.
    pub amount: f32,
}

impl LineFade {
    /// As shaders take it. `axis`: see
    /// [`EffectContext::depth_axis`](crate::effect::EffectContext::depth_axis).
    pub(crate) fn uniform(self, axis: Vec2, reference: Option<f32>) -> LineFadeUniform {
        LineFadeUniform {
            axis,
            distance: self.distance.unwrap_or(1.0).max(1e-9),
            at_center: u32::from(self.distance.is_none()),
            reference: reference.unwrap_or(0.0),
            clear: self.clear,
            steepness: 1.0 / self.ramp,
            amount: self.amount,
        }
    }
}

/// `LineFade` of `fade.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LineFadeUniform {
    axis: Vec2,
    distance: f32,
    at_center: u32,
    reference: f32,
    clear: f32,
    steepness: f32,
    amount: f32,
}
