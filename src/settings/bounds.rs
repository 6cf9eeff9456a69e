//! Clamps. Settings come from files, sliders and arithmetic, so every number is
//! brought into its documented range before it reaches the GPU.

use bevy::prelude::*;

/// `value` clamped to `low` to `high`; `default` if it is NaN or infinite.
pub fn clamp_or_default(value: f32, default: f32, low: f32, high: f32) -> f32 {
    if value.is_finite() {
        value.clamp(low, high)
    } else {
        default
    }
}

/// As [`clamp_or_default`], for each component.
pub fn clamp_vec2_or_default(value: Vec2, default: Vec2, low: f32, high: f32) -> Vec2 {
    Vec2::new(
        clamp_or_default(value.x, default.x, low, high),
        clamp_or_default(value.y, default.y, low, high),
    )
}

/// As [`clamp_or_default`], for an optional setting: `None` stays `None`.
pub fn clamp_option_or_default(
    value: Option<f32>,
    default: f32,
    low: f32,
    high: f32,
) -> Option<f32> {
    value.map(|value| clamp_or_default(value, default, low, high))
}

/// A displayable color: every component, alpha included, clamped to 0 to 1 in
/// linear light. A color with a component that is NaN or infinite becomes
/// `default`.
pub fn clamp_color(color: Color, default: Color) -> Color {
    let linear = |color: Color| {
        let c = color.to_linear();
        [c.red, c.green, c.blue, c.alpha]
    };
    let mut parts = linear(color);
    if parts.iter().any(|part| !part.is_finite()) {
        parts = linear(default);
    }
    if parts.iter().all(|part| (0.0..=1.0).contains(part)) {
        // Nothing was clamped: return the color in its own color space, so that
        // it compares equal to the caller's.
        return if linear(color) == parts {
            color
        } else {
            default
        };
    }
    let [red, green, blue, alpha] = parts.map(|part| part.clamp(0.0, 1.0));
    LinearRgba {
        red,
        green,
        blue,
        alpha,
    }
    .into()
}
