//! Reference of `toon/hatch.wgsl`.

use bevy_comics::Hatching;

use super::hatching::Hatch;

/// The darkness of strokes where a share of all light arrives.
pub fn hatch_tone(settings: &Hatching, arriving: f64, all: f64) -> f64 {
    let share = if all > 0.0 { arriving / all } else { 0.0 };
    let tone = Hatch::new(settings).tone(share.clamp(0.0, 1.0).sqrt());
    tone * f64::from(settings.at_near)
}
